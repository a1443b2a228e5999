// SPDX-License-Identifier: Apache-2.0
// How long what runs on the processors of hosts takes at most: Programs, applications, loads and the protocol stack.
//
// What comes to a thread depends on how late the network and other threads are, and these on the thread: bounds.cpp
// goes round, from no interference at all upwards, until nothing changes.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/response_times.hpp"
#include "scenario/resolved/resolved.hpp"

namespace takt::analysis {

/// Frames that come at one instant are taken in one by one, a picosecond apart (models::LatencyLine::pass_strictly), so
/// many of them at most.
inline constexpr Ps waits_in_order = 1'000;

struct FlowGraph;
struct ClockQuality;
struct NetworkResult;
struct BoundOptions;

/// Each call of a thread of an application has ended when the next one is due.
bool overtakes_none(const scenario::ResolvedThread& thread, const ThreadTime& cpu, const ClockQuality& clock);

class HostTimes {
 public:
  /// Each job takes its own execution time.
  explicit HostTimes(const scenario::Resolved& resolved);

  bool has_processors() const { return has_processors_; }
  /// By node and thread of its processor; empty where there is none.
  const std::vector<std::vector<ThreadTime>>& nodes() const { return nodes_; }
  /// Of what runs on no thread: none at all.
  const ThreadTime& of(models::NodeIndex node, const std::optional<std::uint32_t>& thread) const {
    return thread ? nodes_[node.value][*thread] : none_;
  }
  const ThreadTime& receive(models::NodeIndex node) const { return of_stack(node, &models::CpuPlan::receive); }
  const ThreadTime& transmit(models::NodeIndex node) const { return of_stack(node, &models::CpuPlan::transmit); }
  /// From a timer's expiry until a job of what runs on that thread is ready.
  const sim::Distribution& wake_up(models::NodeIndex node, const std::optional<std::uint32_t>& thread) const;

  /// Takes what the graph and the network say into account. Times grow only. False if nothing has changed.
  bool refine(const FlowGraph& graph, const NetworkResult& network, const BoundOptions& options);
  /// What has not come to rest never will.
  void give_up();

 private:
  const ThreadTime& of_stack(models::NodeIndex node, std::optional<std::uint32_t> models::CpuPlan::*part) const {
    const models::CpuPlan* const cpu = r_->plan.nodes[node.value].cpu.get();
    return cpu != nullptr && (cpu->*part) ? nodes_[node.value][*(cpu->*part)] : none_;
  }

  const scenario::Resolved* r_;
  std::vector<std::vector<ThreadTime>> nodes_;
  std::vector<std::pair<std::size_t, std::size_t>> moving_;  // what has changed in the last round
  bool has_processors_ = false;
  ThreadTime none_;
};

}  // namespace takt::analysis
