// SPDX-License-Identifier: Apache-2.0
// Is this a schedule of that instance, and does this certificate prove that there is none? From the definitions alone;
// nothing is shared with search and refuters but the values that are judged.
#pragma once

#include <string>
#include <vector>

#include "schedule/certificate.hpp"
#include "schedule/decide.hpp"
#include "schedule/solution.hpp"

namespace takt::schedule_check {

/// What is wrong, one sentence each that begins with its kind, at most `most`; empty if the schedule is sound. Kinds:
/// stream, start, route, class, release, precedence, no-wait, strict, overlap, deadline, latency, jitter, order (a
/// queue would have to send a later frame first), gate-list, gate-entries, gate-closed, gate-other.
std::vector<std::string> check(const schedule::Problem& problem, const schedule::Solution& solution,
                               std::size_t most = 20);

/// Why the certificate proves nothing; empty: it is a proof.
std::string why_not_proved(const schedule::Problem& problem, const schedule::Certificate& certificate);

/// `schedule::decide` with that judge: an infeasible problem has a certificate that is a proof.
schedule::Decision decide_judged(const schedule::Problem& problem, schedule::SearchOptions options,
                                 schedule::Objective objective = schedule::Objective::feasible);

}  // namespace takt::schedule_check
