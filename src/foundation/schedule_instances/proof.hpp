// SPDX-License-Identifier: Apache-2.0
// What a certificate says, in words.
#pragma once

#include <string>

#include "schedule/certificate.hpp"
#include "schedule/problem.hpp"

namespace takt::schedule_instances {

/// "latency", "load", "interval", "folded", "pair" or "clausal".
std::string kind_of(const schedule::Certificate& certificate);
/// One sentence: why there is no schedule.
std::string proof_of(const schedule::Problem& problem, const schedule::Certificate& certificate);

}  // namespace takt::schedule_instances
