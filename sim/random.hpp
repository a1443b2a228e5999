// SPDX-License-Identifier: Apache-2.0
// Chance: named streams of random numbers, the same on every machine.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <string_view>

#include "sim/time.hpp"

namespace takt::sim {

/// A stream of random numbers (xoshiro256++ by Blackman and Vigna) that is a function of (seed, component path,
/// purpose). Adding a component moves no other component's numbers, so variants of a study share their luck.
class RandomStream {
 public:
  RandomStream(std::uint64_t seed, std::string_view path, std::string_view purpose);

  /// 64 equally likely bits.
  std::uint64_t next() {
    const std::uint64_t result = std::rotl(state_[0] + state_[3], 23) + state_[0];
    const std::uint64_t shifted = state_[1] << 17;
    state_[2] ^= state_[0];
    state_[3] ^= state_[1];
    state_[1] ^= state_[2];
    state_[0] ^= state_[3];
    state_[2] ^= shifted;
    state_[3] = std::rotl(state_[3], 45);
    return result;
  }

  /// A number in (0, 1): 52 bits and a half, never 0 and never 1, so that its logarithm is finite.
  double unit() { return (static_cast<double>(next() >> 12) + 0.5) * 0x1p-52; }

  /// An integer in [0, bound), without bias. Precondition: bound > 0.
  std::uint64_t below(std::uint64_t bound) {
    // Lemire's method: the high half of a product is uniform once the few biased low halves are rejected.
    const uint128 product = static_cast<uint128>(next()) * bound;
    if (static_cast<std::uint64_t>(product) > bound) [[likely]]
      return static_cast<std::uint64_t>(product >> 64);
    return below_rejecting(product, bound);
  }

 private:
  std::uint64_t below_rejecting(uint128 product, std::uint64_t bound);

  std::array<std::uint64_t, 4> state_;
};

}  // namespace takt::sim
