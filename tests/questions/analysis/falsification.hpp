// SPDX-License-Identifier: Apache-2.0
// Runs a scenario and holds what happened against what analysis says can happen.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "analysis/bounds.hpp"
#include "scenario/resolve.hpp"
#include "scenario/run/run.hpp"

namespace takt::analysis::test {

/// What one run says of the bounds.
struct Verdict {
  std::vector<std::string> violations;  ///< empty if every bound held
  std::size_t compared = 0;             ///< streams with a bound that were delivered
  std::size_t unbounded = 0;            ///< streams without one that were delivered
  std::size_t queues = 0;               ///< ports with bounds of all their queues that were used
  std::size_t full_queues =
      0;  ///< of those, with as many frames in a queue as there may be, but for the one on the wire
  std::size_t second_opinions = 0;  ///< streams with a bound by separated-flow analysis
  std::size_t wrong_second_opinions = 0;
  std::size_t better_second_opinions = 0;  ///< that is less than that by total-flow analysis
  double tightest = 0;                     ///< the greatest simulated latency as a share of its bound
  std::vector<double> shares;              ///< of all streams with a bound
};

inline std::string microseconds(sim::Duration value) {
  return std::to_string(static_cast<double>(value.ps()) / 1e6) + " us";
}

/// The most frames and octets that waited in each queue, against what may be in it.
inline void judge_queues(const scenario::Run& run, const Bounds& bounds, Verdict& verdict) {
  for (const QueueBound& queue : bounds.queues) {
    const models::EgressPort& port = run.network().ports(queue.node)[queue.port];
    if (port.frames_sent() == 0 || !queue.frames) continue;
    const std::uint64_t frames = port.queues().peak_frames(queue.traffic_class);
    const std::uint64_t octets = port.queues().peak_octets(queue.traffic_class);
    ++verdict.queues;
    if (frames + 1 >= *queue.frames) ++verdict.full_queues;  // one of them is on the wire
    if (frames > *queue.frames || 8 * octets > *queue.bits)
      verdict.violations.push_back(run.resolved().plan.nodes[queue.node.value].name + ":" + std::to_string(queue.port) +
                                   " class " + std::to_string(queue.traffic_class) + ": " + std::to_string(frames) +
                                   " frames of " + std::to_string(octets) + " octets in the queue, at most " +
                                   std::to_string(*queue.frames) + " of " + std::to_string(*queue.bits / 8));
  }
}

/// Streams and queues: reactions are compared where Programs are.
inline Verdict judge(const scenario::Run& run, const Bounds& bounds) {
  Verdict verdict;
  for (std::size_t s = 0; s < bounds.streams.size(); ++s) {
    const models::Stream& stream = run.network().traffic().streams()[s];
    const StreamBound& bound = bounds.streams[s];
    if (bound.loses_nothing && bound.latency && stream.dropped_in_all() > 0)
      verdict.violations.push_back(bound.name + ": " + std::to_string(stream.dropped_in_all()) +
                                   " frames dropped of a stream that loses none");
    if (stream.latency.empty()) continue;
    ++(bound.latency ? verdict.compared : verdict.unbounded);
    if (stream.latency.minimum() < bound.least)
      verdict.violations.push_back(bound.name + ": " + microseconds(stream.latency.minimum()) +
                                   " is less than the least, " + microseconds(bound.least));
    if (bound.separated_flow && stream.latency.maximum() > *bound.separated_flow) ++verdict.wrong_second_opinions;
    for (const auto& [which, latency] :
         {std::pair("total-flow", bound.total_flow), std::pair("separated-flow", bound.separated_flow)})
      if (latency && stream.latency.maximum() > *latency)
        verdict.violations.push_back(bound.name + ": simulated " + microseconds(stream.latency.maximum()) +
                                     " of at most " + microseconds(*latency) + " by " + which + " analysis");
    if (bound.separated_flow) {
      ++verdict.second_opinions;
      if (!bound.total_flow || *bound.separated_flow < *bound.total_flow) ++verdict.better_second_opinions;
    }
    if (!bound.latency) continue;
    const double share = static_cast<double>(stream.latency.maximum().ps()) / static_cast<double>(bound.latency->ps());
    verdict.shares.push_back(share);
    verdict.tightest = std::max(verdict.tightest, share);
  }
  judge_queues(run, bounds, verdict);
  return verdict;
}

inline Verdict simulate(const scenario::Resolved& resolved, const Bounds& bounds) {
  scenario::Run run(resolved);
  run.advance();
  return judge(run, bounds);
}

}  // namespace takt::analysis::test
