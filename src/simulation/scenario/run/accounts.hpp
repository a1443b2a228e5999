// SPDX-License-Identifier: Apache-2.0
// From which instants on a run keeps accounts, so that each requirement is judged by what began when it says.
#pragma once

#include <vector>

#include "models/network.hpp"
#include "scenario/resolved/resolved.hpp"

namespace takt::scenario {

/// The instants from which requirements and the figures of the result count, ascending, each once; the scenario's
/// warm_up is one of them.
std::vector<Duration> account_instants(const Resolved& resolved);

/// Has the network keep the accounts of streams that begin later than the run, and tell first copies from others where
/// there are copies.
void keep_accounts(const Resolved& resolved, models::Network& network);

}  // namespace takt::scenario
