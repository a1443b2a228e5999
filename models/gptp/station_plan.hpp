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

struct StationPlan {
  std::vector<InstanceConfig> instances = {InstanceConfig{}};
  LinkDelayConfig link = {};
  ClockTargetConfig target = {};
  std::optional<std::int8_t> log_gptp_capable_interval = {};   ///< see NodeConfig
  std::optional<HotStandbyConfig> standby = {};   ///< instances 0 and 1 are primary and secondary
  sim::Distribution processing = sim::Distribution::constant(sim::Duration::from_ps(5'000'000));   ///< from a decision to send to the egress queue
};

}  // namespace takt::models::gptp
