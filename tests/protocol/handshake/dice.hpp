// SPDX-License-Identifier: Apache-2.0
// Random numbers for schedules that are the same everywhere, and how many schedules a test takes.
#pragma once

#include <cstdint>
#include <cstdlib>
#include <string>

#include "tests/support/case_count.hpp"

namespace takt::handshake {

/// splitmix64: a seed gives the same numbers everywhere.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : state_(seed * 0x9E3779B97F4A7C15ULL) {}
  std::uint32_t below(std::uint32_t bound) {
    std::uint64_t z = state_ += 0x9E3779B97F4A7C15ULL;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
    return static_cast<std::uint32_t>((z ^ (z >> 31)) % bound);
  }

 private:
  std::uint64_t state_;
};

/// TAKT_SCHEDULES if it is set, for a long search by hand.
inline std::uint64_t schedules_wanted(std::uint64_t release, std::uint64_t debug) {
#ifdef NDEBUG
  constexpr bool is_release = true;
#else
  constexpr bool is_release = false;
#endif
  return support::case_count("TAKT_SCHEDULES", is_release ? release : debug);
}

}  // namespace takt::handshake
