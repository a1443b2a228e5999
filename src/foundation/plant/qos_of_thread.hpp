// SPDX-License-Identifier: Apache-2.0
// The quality of service of a writer or reader: what its thread says replaces what its topic says, policy by policy.
#pragma once

#include <optional>

#include "plant/dds.hpp"

namespace takt::plant {

/// What a table has refused counts as not said.
Qos merged(const std::optional<Qos>& topic, const std::optional<Qos>& thread);

}  // namespace takt::plant
