// SPDX-License-Identifier: Apache-2.0
#include "analysis/misses_bound.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "analysis/outages.hpp"
#include "json/quantity.hpp"
#include "results/run_result.hpp"
#include "scenario/figures/requirement.hpp"

namespace takt::analysis {
namespace {

/// In which frames that are produced may be lost: both ends belong to it, and it may have no end.
struct LossyTime {
  Ps begin = 0;
  Ps end = 0;
};

class MissesBounder {
 public:
  MissesBounder(const scenario::Resolved& r, const FlowGraph& graph, const StreamBound& stream,
                const scenario::RequiredFigure& required)
      : r_(r), graph_(graph), stream_(stream), required_(required) {}

  RequirementBound make() {
    made_.assumptions = stream_.assumptions;
    if (required_.deadline && (!stream_.latency || *stream_.latency > *required_.deadline)) {
      made_.reason = !stream_.latency ? stream_.reason
                                      : "its latency is at most " + json::to_text(*stream_.latency) +
                                            ", beyond the deadline: nothing shows how many in a row are late";
      return made_;
    }
    if (stream_.reaches_all) {
      made_.count = 0;
      return made_;
    }
    if (const std::string why = why_unknown(); !why.empty())
      made_.reason = why;
    else
      count_losses();
    return made_;
  }

 private:
  /// Why losses are not known by their times; empty: they are.
  std::string why_unknown() const {
    if (!stream_.loses_by_faults_only || !stream_.latency) return stream_.loss_reason;
    if (r_.scenario.rerouting || has_bypass(r_)) return "ways change when links fail: " + stream_.loss_reason;
    if (flow() == nullptr || !flow()->source.is_limited())
      return "nothing is known of how many frames come: " + stream_.loss_reason;
    return {};
  }

  /// Its only flow; null if it has several, or none.
  const Flow* flow() const {
    const auto found = std::ranges::find(graph_.flows, stream_.index, &Flow::stream);
    return found == graph_.flows.end() || std::ranges::count(graph_.flows, stream_.index, &Flow::stream) != 1 ? nullptr
                                                                                                              : &*found;
  }

  void add(sim::TrueTime from, sim::TrueTime until) {
    const Ps begin = from.since_start().ps() - stream_.latency->ps();
    const Ps end = until == sim::TrueTime::never() ? unbounded_ps : until.since_start().ps();
    if (end >= required_.from.ps()) times_.push_back({begin, end});
  }

  void find_times() {
    const Outages outages(r_);
    for (const std::uint32_t h : flow()->hops) {
      const GraphPort& port = graph_.ports[graph_.hops[h].port];
      for (const Outage& outage : outages.of_link(port.link)) add(outage.down, outage.up);
      for (const models::ImpairmentPlan& each : r_.plan.impairments)
        if (each.link == port.link && each.from_a_to_b == port.from_a &&
            (each.impairment.loss || each.impairment.corruption))
          add(each.impairment.from, each.impairment.until);
    }
    std::ranges::sort(times_, {}, &LossyTime::begin);
  }

  /// The longest that no frame is produced for, of a stream in the scenario that says its period.
  Ps longest_gap() const {
    const auto& streams = r_.scenario.streams;
    const auto stream = std::ranges::find(streams, stream_.name, &scenario::Stream::name);
    // Twice the period is more than any clock makes of it.
    return stream == streams.end() || !stream->every ? unbounded_ps : 2 * stream->every->ps() + stream->jitter.ps();
  }

  /// Times between which a frame comes are apart: a row does not go over both.
  void count_losses() {
    find_times();
    std::int64_t all = 0, longest = 0;
    for (std::size_t i = 0; i < times_.size();) {
      LossyTime joined = times_[i++];
      while (i < times_.size() && (!is_bounded(joined.end) || times_[i].begin - joined.end <= longest_gap()))
        joined.end = std::max(joined.end, times_[i++].end);
      if (!is_bounded(joined.end)) {
        made_.reason = "losses have no end: " + stream_.loss_reason;
        return;
      }
      // By when frames come to the egress queue of the talker.
      const std::int64_t count = flow()->source.count(sum(joined.end - joined.begin, flow()->worst_source));
      all += count;
      longest = std::max(longest, count);
    }
    made_.count = static_cast<std::uint64_t>(required_.kind == results::RequirementKind::met ? all : longest);
  }

  const scenario::Resolved& r_;
  const FlowGraph& graph_;
  const StreamBound& stream_;
  const scenario::RequiredFigure& required_;
  std::vector<LossyTime> times_;
  RequirementBound made_;
};

}  // namespace

RequirementBound misses_bound(const scenario::Resolved& resolved, const FlowGraph& graph, const StreamBound& stream,
                              const scenario::RequiredFigure& required) {
  return MissesBounder(resolved, graph, stream, required).make();
}

}  // namespace takt::analysis
