// The paper's next steps as changes of its scenarios: real-time Linux; gates and synchronised clocks.
#pragma once

#include "scenario/description.hpp"

namespace takt::papers::coexistence {

/// PREEMPT_RT in all nodes, native and virtualised: threads wake up as their profiles say instead of with the calibrated responses.
void use_real_time_linux(scenario::Scenario& scenario);

/// IEEE 802.1AS, and at the beginning of each millisecond a window in which ports send nothing but the topics, which get priority 6.
void use_tsn(scenario::Scenario& scenario);

/// Nothing but the topics on the network.
void unload(scenario::Scenario& scenario);

}  // namespace takt::papers::coexistence
