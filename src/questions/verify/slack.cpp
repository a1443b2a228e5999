// SPDX-License-Identifier: Apache-2.0
#include "verify/slack.hpp"

#include <algorithm>
#include <tuple>

#include "scenario/figures/requirement.hpp"
#include "scenario/resolve.hpp"
#include "sim/check.hpp"
#include "verify/frame_log.hpp"
#include "verify/reaction_chain.hpp"

namespace takt::verify {
namespace {

using results::RequirementKind;
using sim::Duration;

Duration sum_of(const std::vector<SlackPart>& parts, Duration SlackPart::*what) {
  Duration sum;
  for (const SlackPart& part : parts) sum += part.*what;
  return sum;
}

/// What the bound of a frame of the class may wait for at the port.
std::string causes_at(const models::NetworkPlan& plan, const analysis::PassageBound& passage) {
  std::uint32_t number = plan.nodes[passage.node.value].port_config;
  for (const models::LinkPlan& link : plan.links)
    for (const models::LinkPlan::End* const end : {&link.a, &link.b})
      if (end->node == passage.node && end->port == passage.port && end->port_config) number = *end->port_config;
  const models::PortConfig& config = plan.port_configs[number];
  std::string causes;
  if (passage.is_held) causes += "eligibility times, ";
  if (config.shaping.gates) causes += "gates, ";
  if (config.shaping.shaper_of(passage.traffic_class) != nullptr) causes += "credit, ";
  if (config.preemption) causes += "preemption, ";
  return causes + "blocking and other frames";
}

/// A latency along the way of the slowest frame of the run.
class LatencyParts {
 public:
  LatencyParts(const scenario::Resolved& resolved, const analysis::Bounds& bounds, const analysis::StreamBound& stream,
               const FrameLog& log)
      : plan_(resolved.plan), bounds_(bounds), stream_(stream), log_(log) {}

  /// Nothing where one of the ports has no bound of its own, for then they say nothing.
  std::vector<SlackPart> make() {
    const Arrival& slowest = *log_.delivered();
    Duration bound_so_far;
    sim::TrueTime run_so_far = slowest.produced;
    const auto add = [&](std::string where, std::string what, Duration bound, sim::TrueTime run) {
      parts_.push_back({std::move(where), std::move(what), bound - bound_so_far, run - run_so_far});
      bound_so_far = bound;
      run_so_far = run;
    };
    for (const Passage& passage : log_.way()) {
      const analysis::PassageBound* const bound = bound_of(passage);
      if (bound == nullptr || !bound->comes || !bound->left) return {};
      const std::string where = plan_.nodes[passage.node.value].name + ":" + std::to_string(passage.port);
      if (parts_.empty())
        add(plan_.nodes[passage.node.value].name, "the talker's jitter and operating system", *bound->comes,
            passage.came);
      add(where, causes_at(plan_, *bound), *bound->left, passage.left);
    }
    if (parts_.empty()) return {};
    const Duration of_listener = *stream_.by_listener[listener()];
    const models::NodePlan& node = plan_.nodes[slowest.listener.value];
    const sim::Distribution& receive = plan_.os_latencies[node.os_latency].receive;
    const std::string& name = node.name;
    add(name, "cable and operating system of the listener",
        bound_so_far + cable() + node.greatest_forwarding_delay() + receive.greatest(), slowest.at);
    add("the whole way", "separated flows bound it by less than the sum of the ports", of_listener, slowest.at);
    add("another listener", "the bound of " + name + " is less", *stream_.latency, slowest.at);
    return std::move(parts_);
  }

 private:
  const analysis::PassageBound* bound_of(const Passage& passage) const {
    const auto place = [](const auto& each) { return std::tuple(each.stream, each.node, each.port); };
    const std::tuple wanted(stream_.index, passage.node, passage.port);
    const auto found =
        std::lower_bound(bounds_.passages.begin(), bounds_.passages.end(), wanted,
                         [&](const analysis::PassageBound& each, const auto& key) { return place(each) < key; });
    return found != bounds_.passages.end() && place(*found) == wanted ? &*found : nullptr;
  }
  std::size_t listener() const {
    const std::vector<models::NodeIndex>& listeners = plan_.streams[stream_.index.value].listeners;
    return static_cast<std::size_t>(std::find(listeners.begin(), listeners.end(), log_.delivered()->listener) -
                                    listeners.begin());
  }
  Duration cable() const {
    const Passage& last = log_.way().back();
    for (const models::LinkPlan& link : plan_.links)
      for (const models::LinkPlan::End* const end : {&link.a, &link.b})
        if (end->node == last.node && end->port == last.port) return link.delay;
    return {};
  }

  const models::NetworkPlan& plan_;
  const analysis::Bounds& bounds_;
  const analysis::StreamBound& stream_;
  const FrameLog& log_;
  std::vector<SlackPart> parts_;
};

/// Runs the scenario once more with the log. False if it was interrupted.
bool replay(scenario::Run& run, FrameLog& log, const std::function<bool()>& interrupted) {
  run.simulation().set_trace(&log);
  constexpr std::uint64_t events_a_slice = 100'000;
  while (!run.advance(events_a_slice))
    if (interrupted && interrupted()) return false;
  run.simulation().set_trace(nullptr);
  return true;
}

std::vector<SlackPart> parts_of_latency(const LooseEnd& end, const analysis::Bounds& bounds,
                                        const scenario::Resolved& resolved, const std::function<bool()>& interrupted) {
  const auto stream =
      std::find_if(bounds.streams.begin(), bounds.streams.end(),
                   [&](const analysis::StreamBound& each) { return each.name == end.requirement.subject; });
  if (stream == bounds.streams.end() || !stream->latency) return {};
  const std::optional<explain::FoundFrames> frames = explain::find_frames(
      resolved, {.stream = stream->index, .from = sim::TrueTime() + end.requirement.from}, interrupted);
  if (!frames || !frames->slowest) return {};
  const bool is_jitter = end.requirement.taken_as == RequirementKind::jitter;
  const Duration least = is_jitter ? frames->fastest->latency : Duration();
  if (frames->slowest->latency - least != end.measured) return {};  // of a frame that is under way at the end
  scenario::Run run(resolved);
  FrameLog log(run.network(), frames->slowest, {});
  if (!replay(run, log, interrupted) || !log.delivered()) return {};
  std::vector<SlackPart> parts = LatencyParts(resolved, bounds, *stream, log).make();
  if (is_jitter && !parts.empty())
    parts.push_back({"the fastest frame", "the least that it can take", -stream->least, -least});
  return parts;
}

std::vector<SlackPart> parts_of_reaction(const LooseEnd& end, const analysis::Bounds& bounds,
                                         const scenario::Resolved& resolved, const std::function<bool()>& interrupted) {
  if (!end.requirement.requirement) return {};
  scenario::Run run(resolved);
  FrameLog log(run.network(), {}, explain::streams_of_words(resolved));
  if (!replay(run, log, interrupted)) return {};
  return reaction_parts(run, log, bounds, resolved.requirements[*end.requirement.requirement], end.measured, end.bound);
}

}  // namespace

bool is_tight(RequirementKind kind, double tightness) {
  return tightness >= (kind == RequirementKind::reaction ? 0.9 : 0.85);
}

std::vector<SlackPart> parts_in_order(const LooseEnd& end, const analysis::Bounds& bounds,
                                      const std::function<bool()>& interrupted) {
  json::Diagnostics diagnostics;
  const auto resolved = scenario::resolve(end.worst, diagnostics);
  if (!resolved) return {};
  std::vector<SlackPart> parts;
  if (end.requirement.taken_as == RequirementKind::latency || end.requirement.taken_as == RequirementKind::jitter)
    parts = parts_of_latency(end, bounds, *resolved, interrupted);
  else if (end.requirement.taken_as == RequirementKind::reaction)
    parts = parts_of_reaction(end, bounds, *resolved, interrupted);
  std::erase_if(parts, [](const SlackPart& part) { return part.bound == Duration() && part.run == Duration(); });
  if (parts.empty()) return parts;
  TAKT_CHECK(sum_of(parts, &SlackPart::run) == end.measured, "the parts of a run add up to what it took");
  TAKT_CHECK(sum_of(parts, &SlackPart::bound) == end.bound, "the parts of a bound add up to it");
  return parts;
}

std::vector<SlackPart> slack_of(const LooseEnd& end, const analysis::Bounds& bounds,
                                const std::function<bool()>& interrupted) {
  std::vector<SlackPart> parts = parts_in_order(end, bounds, interrupted);
  std::stable_sort(parts.begin(), parts.end(),
                   [](const SlackPart& a, const SlackPart& b) { return a.given_away() > b.given_away(); });
  return parts;
}

}  // namespace takt::verify
