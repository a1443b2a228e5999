// SPDX-License-Identifier: Apache-2.0
// Is a clausal proof one? Each axiom is judged from what its literals mean, each step by the clauses that it names.
#pragma once

#include <string>

#include "schedule/certificate.hpp"

namespace takt::schedule_check {

/// Empty if it proves that the certificate's streams have no place beside each other; else what is wrong with it.
std::string why_clauses_prove_nothing(const schedule::Problem& problem, const schedule::Certificate& certificate);

}  // namespace takt::schedule_check
