// SPDX-License-Identifier: Apache-2.0
// Proofs that there is no schedule, whatever the search: each looks for one kind of certificate (certificate.hpp).
#pragma once

#include <optional>

#include "schedule/certificate.hpp"
#include "schedule/search.hpp"

namespace takt::schedule {

/// Some stream cannot keep its latency or deadline even if it were alone.
std::optional<Certificate> refute_by_latency(const Problem& problem);

/// All kinds, cheap ones first; nothing proves nothing.
std::optional<Certificate> refute(
    const Problem& problem, const Stop& stop = [] { return false; });

}  // namespace takt::schedule
