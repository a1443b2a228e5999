// SPDX-License-Identifier: Apache-2.0
// How long a sample of a topic takes from its write to a reader: one way where nothing is lost, and over DDS, where its
// first message is lost, until it has been repaired.
#pragma once

#include "analysis/bounds.hpp"

namespace takt::analysis {

/// In the order of the readers, then of what they hear. `bounds` has its streams.
std::vector<DeliveryBound> delivery_bounds(const scenario::Resolved& resolved, const BoundOptions& options,
                                           const Bounds& bounds);

}  // namespace takt::analysis
