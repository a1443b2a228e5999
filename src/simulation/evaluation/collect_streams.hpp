// SPDX-License-Identifier: Apache-2.0
// The accounts of streams and ports.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "results/run_result.hpp"
#include "scenario/run/run.hpp"

namespace takt::evaluation {

/// Every stream but that of gPTP: of its frames that were produced at `from` or later. Where no account of a stream
/// begins then, it is left empty.
std::vector<results::StreamResult> streams_of(const scenario::Run& run, sim::Duration from);

/// What all streams, gPTP's as well, have lost of such frames, by reason in the order of DropReason.
std::vector<std::pair<std::string, std::uint64_t>> drops_of(const scenario::Run& run, sim::Duration from);

results::LatencySummary summary_of(const sim::Histogram& histogram);

}  // namespace takt::evaluation
