// Chance: named streams of random numbers, the same on every machine.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace takt::sim {

/// A stream of random numbers (xoshiro256++ by Blackman and Vigna) that is a function of (seed, component path, purpose).
/// Adding a component moves no other component's numbers, so variants of a study share their luck.
class RandomStream {
 public:
  RandomStream(std::uint64_t seed, std::string_view path, std::string_view purpose);

  /// 64 equally likely bits.
  std::uint64_t next();

  /// A number in (0, 1): 53 bits, never 0 and never 1, so that its logarithm is finite.
  double unit() { return (static_cast<double>(next() >> 12) + 0.5) * 0x1p-52; }

  /// An integer in [0, bound), without bias. Precondition: bound > 0.
  std::uint64_t below(std::uint64_t bound);

 private:
  std::array<std::uint64_t, 4> state_;
};

}  // namespace takt::sim
