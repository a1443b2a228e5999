// SPDX-License-Identifier: Apache-2.0
// How a node takes part in gPTP, as plain data.
#pragma once

#include <optional>
#include <vector>

#include "models/gptp/clock_target.hpp"
#include "models/gptp/hot_standby.hpp"
#include "models/gptp/node.hpp"
#include "sim/distribution.hpp"
#include "sim/time.hpp"

namespace takt::models::gptp {

/// A node asks a neighbour for other intervals, once.
struct TimedIntervalRequest {
  sim::TrueTime at;
  std::uint16_t port = 0;    ///< of the node, from 0
  std::size_t instance = 0;  ///< of StationPlan::instances
  IntervalRequest request = {};
};

struct StationPlan {
  std::vector<InstanceConfig> instances = {InstanceConfig{}};
  LinkDelayConfig link = {};
  std::vector<std::uint16_t> ports_without_threshold =
      {};  ///< from 0: whatever delay their links show, it is not too long
  ClockTargetConfig target = {};
  std::optional<std::int8_t> log_gptp_capable_interval = {};  ///< see NodeConfig
  std::optional<HotStandbyConfig> standby = {};               ///< instances 0 and 1 are primary and secondary
  std::vector<TimedIntervalRequest> interval_requests = {};
  sim::Distribution processing =
      sim::Distribution::constant(sim::Duration::from_ps(5'000'000));  ///< from a decision to send to the egress queue
};

}  // namespace takt::models::gptp
