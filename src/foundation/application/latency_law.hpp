// SPDX-License-Identifier: Apache-2.0
// Latencies of files as distributions, from which simulated hosts and real nodes draw.
#pragma once

#include "plant/latency.hpp"
#include "sim/distribution.hpp"

namespace takt::application {

/// The distribution that a description stands for. A senseless one (from > to, min > max, no weight) is a diagnostic.
sim::Distribution distribution_of(const plant::Latency& latency, json::Diagnostics& diagnostics);

}  // namespace takt::application
