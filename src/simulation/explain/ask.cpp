// SPDX-License-Identifier: Apache-2.0
#include "explain/ask.hpp"

#include <algorithm>

#include "explain/way_recorder.hpp"
#include "scenario/run/run.hpp"

namespace takt::explain {
namespace {

/// False if it was interrupted.
bool run_to_the_end(scenario::Run& run, const Interrupted& interrupted) {
  constexpr std::uint64_t events_a_slice = 100'000;
  while (!run.advance(events_a_slice))
    if (interrupted && interrupted()) return false;
  return true;
}

/// Follows one frame to the ends that are asked for.
class FrameSeeker final : public WaySink {
 public:
  /// `delivery`: that end alone. `all_losses`: of each copy, else the first.
  FrameSeeker(const models::Network& network, const FrameName& frame, FrameQuestion::Which which,
              std::optional<Delivery> delivery, bool all_losses)
      : network_(&network), frame_(frame), which_(which), delivery_(delivery), all_losses_(all_losses) {}

  bool wants(models::StreamIndex stream) const override { return stream == frame_.stream; }
  bool wants_frame(const models::Frame& frame) override { return frame.sequence == frame_.sequence; }
  bool wants_delivery(const models::Frame& frame, models::NodeIndex listener, TrueTime now) override {
    if (which_ == FrameQuestion::Which::number) return true;
    return delivery_ && found.empty() && listener == delivery_->listener && now - frame.produced == delivery_->latency;
  }
  bool wants_loss(const models::Frame&, models::DropReason reason) override {
    if (which_ == FrameQuestion::Which::number) return true;
    return which_ == FrameQuestion::Which::lost && reason != models::DropReason::duplicate &&
           (all_losses_ || found.empty());
  }
  void ended(const Way& way) override {
    if (way.end == Way::End::under_way && which_ != FrameQuestion::Which::number) return;
    found.push_back(explained(*network_, way));
  }

  std::vector<ExplainedFrame> found;

 private:
  const models::Network* network_;
  FrameName frame_;
  FrameQuestion::Which which_;
  std::optional<Delivery> delivery_;
  bool all_losses_;
};

/// All arrivals of words, in the order of time.
class Words final : public sim::TraceSink {
 public:
  Words(const models::Network& network, std::vector<bool> streams) : network_(&network), streams_(std::move(streams)) {}
  void record(const sim::TraceRecord& record) override {
    if (record.kind != static_cast<std::uint32_t>(models::Occurrence::received)) return;
    const models::StreamIndex stream{static_cast<std::uint32_t>(record.detail >> 32)};
    if (!streams_[stream.value]) return;
    arrivals.push_back({stream,
                        {static_cast<std::uint32_t>(record.detail)},
                        network_->traffic().frame({static_cast<std::uint32_t>(record.what)}).produced,
                        record.time});
  }
  std::vector<Arrival> arrivals;

 private:
  const models::Network* network_;
  std::vector<bool> streams_;
};

/// The messages of a chain.
class MessageSeeker final : public WaySink {
 public:
  MessageSeeker(const models::Network& network, const std::vector<ChainLink>& chain, const scenario::Resolved& resolved)
      : network_(&network) {
    for (const ChainLink& link : chain)
      if (link.kind == ChainLink::Kind::message)
        wanted_.push_back(
            {link.stream, resolved.programs[link.to.program].members[link.to.number].node, link.begin, link.end});
  }
  bool wants(models::StreamIndex stream) const override {
    return std::ranges::any_of(wanted_, [&](const Arrival& each) { return each.stream == stream; });
  }
  bool wants_frame(const models::Frame& frame) override {
    return std::ranges::any_of(
        wanted_, [&](const Arrival& each) { return each.stream == frame.stream && each.produced == frame.produced; });
  }
  bool wants_delivery(const models::Frame& frame, models::NodeIndex listener, TrueTime now) override {
    return std::ranges::any_of(wanted_, [&](const Arrival& each) {
      return each.stream == frame.stream && each.listener == listener && each.produced == frame.produced &&
             each.at == now;
    });
  }
  bool wants_loss(const models::Frame&, models::DropReason) override { return false; }
  void ended(const Way& way) override {
    if (way.end == Way::End::delivered) ways_.push_back(way);
  }
  std::optional<ExplainedFrame> message(const ChainLink& link) const {
    for (const Way& way : ways_)
      if (way.frame.stream == link.stream && way.produced == link.begin && way.ended == link.end)
        return explained(*network_, way);
    return std::nullopt;
  }

 private:
  const models::Network* network_;
  std::vector<Arrival> wanted_;
  std::vector<Way> ways_;
};

const char* words_of(ChainLink::Kind kind) {
  switch (kind) {
    case ChainLink::Kind::beginning:
      return "noticing the cause";
    case ChainLink::Kind::publication:
      return "wait for the next publication";
    case ChainLink::Kind::message:
      return "message";
    case ChainLink::Kind::opening:
      return "opening the message";
    case ChainLink::Kind::initialisation:
      return "initialisation or own timer";
  }
  return "?";
}

}  // namespace

std::optional<models::StreamIndex> stream_named(const scenario::Resolved& resolved, const std::string& name) {
  const auto& streams = resolved.plan.streams;
  const auto found = std::ranges::find_if(streams, [&](const auto& each) { return each.name == name; });
  return found == streams.end()
             ? std::nullopt
             : std::optional(models::StreamIndex{static_cast<std::uint32_t>(found - streams.begin())});
}

std::vector<ExplainedFrame> explain_frame(const scenario::Resolved& resolved, const FrameQuestion& question,
                                          const Interrupted& interrupted) {
  std::optional<FrameName> frame;
  FoundFrames found;
  if (question.which == FrameQuestion::Which::number) {
    frame = {*question.stream, question.number};
  } else {
    const std::optional<FoundFrames> all = find_frames(resolved, question, interrupted);
    if (!all) return {};
    found = *all;
    if (question.which == FrameQuestion::Which::lost)
      frame = found.lost;
    else if (found.slowest)
      frame = found.slowest->frame;
  }
  if (!frame) return {};
  scenario::Run run(resolved);
  FrameSeeker seeker(run.network(), *frame, question.which, found.slowest, found.lost_has_copies);
  WayRecorder recorder(run.network(), seeker);
  run.explain_to(&recorder);
  if (!run_to_the_end(run, interrupted)) return {};
  recorder.finish(run.simulation().now());
  return std::move(seeker.found);
}

std::optional<ExplainedReaction> explain_reaction(const scenario::Resolved& resolved,
                                                  const scenario::AskedReaction& asked, TrueTime from,
                                                  std::optional<Duration> took, const Interrupted& interrupted) {
  scenario::Run first(resolved);
  Words words(first.network(), streams_of_words(resolved));
  first.simulation().set_trace(&words);
  if (!run_to_the_end(first, interrupted)) return std::nullopt;
  const FoundReaction found = find_reaction(first, asked, from, took);
  if (found.reaction == nullptr) return std::nullopt;
  const std::vector<ChainLink> chain = chain_of(first, words.arrivals, found);

  scenario::Run second(resolved);
  MessageSeeker seeker(second.network(), chain, resolved);
  WayRecorder recorder(second.network(), seeker);
  second.explain_to(&recorder);
  if (!run_to_the_end(second, interrupted)) return std::nullopt;

  const handshake::Reaction& reaction = *found.reaction;
  ExplainedReaction made{resolved.programs[found.programs.front()].name,
                         std::string(handshake::name_of(reaction.kind)),
                         std::string(scenario::spelling(reaction.cause)),
                         reaction.began,
                         reaction.completed - reaction.began,
                         {}};
  TrueTime at = reaction.began;
  for (const ChainLink& link : chain) {
    TAKT_CHECK(link.begin == at && link.end >= at, "the links of a chain follow each other");
    at = link.end;
    if (link.begin == link.end && link.kind != ChainLink::Kind::message) continue;
    ExplainedStep step{words_of(link.kind), name_of(resolved, link.who), link.begin, link.end - link.begin, {}};
    if (link.kind == ChainLink::Kind::message) {
      step.who += " to " + name_of(resolved, link.to);
      step.message = seeker.message(link);
    }
    made.steps.push_back(std::move(step));
  }
  TAKT_CHECK(at == reaction.completed, "the links of a chain add up to the reaction");
  return made;
}

void explain_measured(const scenario::Resolved& resolved, const results::RequirementResult& requirement,
                      Explanation& explanation, const Interrupted& interrupted) {
  using results::RequirementKind;
  const TrueTime from = TrueTime() + requirement.from;
  if (requirement.taken_as == RequirementKind::reaction && requirement.requirement && requirement.measured)
    explanation.reaction =
        explain_reaction(resolved, *scenario::reaction_of(resolved.requirements[*requirement.requirement].figure), from,
                         *requirement.measured, interrupted);
  else if (requirement.taken_as == RequirementKind::latency || requirement.taken_as == RequirementKind::jitter)
    explanation.frames =
        explain_frame(resolved, {.stream = stream_named(resolved, requirement.subject), .from = from}, interrupted);
}

}  // namespace takt::explain
