// SPDX-License-Identifier: Apache-2.0
#include "verify/reaction_chain.hpp"

#include <algorithm>

#include "explain/reaction_chain.hpp"

namespace takt::verify {
namespace {

using explain::ChainLink;
using explain::Participant;
using sim::Duration;

/// What the bound grants the links of a chain.
class Grants {
 public:
  Grants(const scenario::Resolved& resolved, const analysis::Bounds& bounds, const handshake::Reaction& reaction)
      : resolved_(resolved), bounds_(bounds), reaction_(reaction) {}

  SlackPart part_of(const ChainLink& link) const {
    const std::string& who = explain::name_of(resolved_, link.who);
    const Duration run = link.end - link.begin;
    const auto of_participant = [&]() -> const analysis::ParticipantBound& {
      return bounds_.participants[link.who.program][link.who.number];
    };
    switch (link.kind) {
      case ChainLink::Kind::message:
        return {who + " to " + explain::name_of(resolved_, link.to), "latency of the word", latency(link), run};
      case ChainLink::Kind::publication:
        return {who, "wait for the next publication", of_participant().publish_wait.value_or(Duration()), run};
      case ChainLink::Kind::opening:
        return {who, "opening the message", resolved_.programs[link.who.program].members[link.who.number].open, run};
      case ChainLink::Kind::initialisation:
        return {who, "INIT", of_participant().initialise.value_or(Duration()), run};
      case ChainLink::Kind::beginning:
        break;
    }
    return {who, "noticing the cause", noticed(), run};
  }

 private:
  Duration latency(const ChainLink& link) const {
    const std::vector<models::NodeIndex>& listeners = resolved_.plan.streams[link.stream.value].listeners;
    const models::NodeIndex node = resolved_.programs[link.to.program].members[link.to.number].node;
    const auto listener =
        static_cast<std::size_t>(std::find(listeners.begin(), listeners.end(), node) - listeners.begin());
    return bounds_.streams[link.stream.value].by_listener[listener].value_or(Duration());
  }
  Duration noticed() const {
    Duration noticed;
    for (const analysis::ReactionBound& bound : bounds_.reactions)
      if (bound.cause == reaction_.cause && bound.cause != handshake::Cause::command && bound.bound &&
          !bound.parts.empty())
        noticed = std::max(noticed, bound.parts.front().duration);
    return noticed;
  }

  const scenario::Resolved& resolved_;
  const analysis::Bounds& bounds_;
  const handshake::Reaction& reaction_;
};

}  // namespace

std::vector<SlackPart> reaction_parts(const scenario::Run& run, const FrameLog& log, const analysis::Bounds& bounds,
                                      const scenario::RequiredFigure& required, Duration measured, Duration bound) {
  const explain::FoundReaction found =
      explain::find_reaction(run, *scenario::reaction_of(required.figure), sim::TrueTime() + required.from, measured);
  if (found.reaction == nullptr) return {};
  const Grants grants(run.resolved(), bounds, *found.reaction);
  std::vector<SlackPart> parts;
  Duration chain;
  for (const ChainLink& link : explain::chain_of(run, log.arrivals(), found)) {
    parts.push_back(grants.part_of(link));
    chain += parts.back().bound;
  }
  parts.push_back({"another chain", "the slowest that the bound reckons with", bound - chain, Duration()});
  return parts;
}

}  // namespace takt::verify
