// SPDX-License-Identifier: Apache-2.0
// What a verification may cost, and who may end it. It is counted in events of runs, so that the same scenario gives
// the same result on every machine.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <utility>

#include "analysis/bounds.hpp"
#include "scenario/resolved/resolved.hpp"

namespace takt::verify {

class Budget {
 public:
  /// `interrupted`: asked now and then; once it says true, all ends.
  Budget(std::uint64_t events, std::function<bool()> interrupted)
      : events_(events), interrupted_(std::move(interrupted)) {}
  Budget(const Budget&) = delete;
  Budget& operator=(const Budget&) = delete;

  std::uint64_t events() const { return events_; }
  std::uint64_t spent() const { return spent_; }
  std::uint64_t left() const { return events_ - std::min(events_, spent_); }
  void spend(std::uint64_t events) { spent_ += events; }
  bool is_interrupted() const { return interrupted_ && interrupted_(); }
  const std::function<bool()>& interrupted() const { return interrupted_; }

 private:
  std::uint64_t events_;
  std::uint64_t spent_ = 0;
  std::function<bool()> interrupted_;
};

/// Of building a run, in events.
inline std::uint64_t cost_of_building(const scenario::Resolved& resolved) {
  return 300 * static_cast<std::uint64_t>(resolved.plan.nodes.size());
}
/// Of a run with so many events. Those of gPTP, with its clocks and servos, and of threads on processors take several
/// times as long as those of frames.
inline std::uint64_t cost_of_run(const scenario::Resolved& resolved, std::uint64_t events) {
  const bool has_threads =
      std::ranges::any_of(resolved.plan.nodes, [](const models::NodePlan& node) { return node.cpu != nullptr; });
  return cost_of_building(resolved) + events * (!resolved.plan.gptp_stations.empty() ? 4 : has_threads ? 2 : 1);
}
/// Of an analysis like this one, in events; a port is looked at for each of its flows.
inline std::uint64_t cost_of_bounds(const scenario::Resolved& resolved, const analysis::Bounds& bounds) {
  const std::uint64_t flows = bounds.passages.size() + 1;
  const std::uint64_t ports = resolved.plan.links.size() * 2 + 1;
  return cost_of_building(resolved) + bounds.port_analyses * (500 + 100 * (flows / ports));
}

}  // namespace takt::verify
