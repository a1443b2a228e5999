// SPDX-License-Identifier: Apache-2.0
// The paper's next steps as changes of its scenarios: real-time Linux; gates and synchronised clocks.
#pragma once

#include <string_view>

#include "scenario/description/description.hpp"

namespace takt::papers::coexistence {

/// PREEMPT_RT in all nodes, native and virtualised: threads wake up as their profiles say instead of with the
/// calibrated responses.
void use_real_time_linux(scenario::Scenario& scenario);

/// IEEE 802.1AS, and at the beginning of each millisecond a window in which ports send nothing but the topics, which
/// get priority 6.
void use_tsn(scenario::Scenario& scenario);

/// The OPC UA control node publishes every 100 ms only, so that it can be told which publication an edge of the output
/// answers.
void command_rarely(scenario::Scenario& scenario);
inline constexpr std::string_view commanding_application = "ua-control";
inline constexpr std::string_view commanding_thread = "publish";

/// Nothing but the topics on the network.
void unload(scenario::Scenario& scenario);

}  // namespace takt::papers::coexistence
