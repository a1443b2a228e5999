// SPDX-License-Identifier: Apache-2.0
// How much and how long files may ask for: wide enough for every plant, and narrow enough that no sum leaves its type.
#pragma once

#include <cstddef>

#include "sim/time.hpp"

namespace takt::plant {

/// An instant of a run: 100 days; the clock ends at 106.
inline constexpr sim::Duration longest = sim::Duration::from_ps(8'640'000'000'000'000'000);
/// What is added to an instant of a run, so that no sum passes the end of the clock: 24 h.
inline constexpr sim::Duration longest_step = sim::Duration::from_ps(86'400'000'000'000'000);
/// Entries of a list or an object that people or generators write.
inline constexpr std::size_t most_names = 100'000;
/// PublisherIds are UInt16.
inline constexpr std::size_t most_publishers = 0xFFFF;

}  // namespace takt::plant
