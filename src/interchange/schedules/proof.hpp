// What a certificate says, in words.
#pragma once

#include <string>

#include "schedule/certificate.hpp"
#include "schedule/problem.hpp"

namespace takt::interchange::schedules {

/// "latency", "load", "interval", "folded", "pair" or "clausal".
std::string kind_of(const schedule::Certificate& certificate);
/// One sentence: why there is no schedule.
std::string proof_of(const schedule::Problem& problem, const schedule::Certificate& certificate);

}  // namespace takt::interchange::schedules
