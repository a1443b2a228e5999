// SPDX-License-Identifier: Apache-2.0
// What an action of the script does, in one word for the digest: faults and commands count even where no frame notices
// them.
#pragma once

#include <cstdint>

#include "scenario/resolved/resolved.hpp"

namespace takt::scenario {

/// Equal for actions that do the same. The kind of action and its time are not in it: the record says them.
std::uint64_t content_of(const ResolvedAction& action);

}  // namespace takt::scenario
