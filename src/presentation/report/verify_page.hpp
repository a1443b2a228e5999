// SPDX-License-Identifier: Apache-2.0
// The page of a verification.
#pragma once

#include <string>
#include <vector>

#include "scenario/resolved/resolved.hpp"
#include "verify/verification.hpp"

namespace takt::report {

/// The verdict in a sentence; simulated, worst found, bound and limit of each requirement on one axis; what is assumed;
/// where bounds give away most; the network with the loads that are asked for. `files` replay the worst runs, by
/// requirement; empty: not written.
std::string verify_page(const scenario::Resolved& resolved, const verify::Verification& verification,
                        const std::vector<std::string>& files);

}  // namespace takt::report
