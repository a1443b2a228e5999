// The digest of a run: 64 bits over what happened.
#pragma once

#include <cstdint>

#include "sim/time.hpp"

namespace takt::sim {

/// A bijective mixer of 64 bits (the finaliser of SplitMix64).
constexpr std::uint64_t mix64(std::uint64_t x) {
  x ^= x >> 30;
  x *= 0xBF58476D1CE4E5B9ULL;
  x ^= x >> 27;
  x *= 0x94D049BB133111EBULL;
  return x ^ (x >> 31);
}

/// A sum of hashed records. A sum, so that the order in which records of one instant are added does not matter:
/// the digest says what happened when, not in which order the program worked through an instant.
class Digest {
 public:
  /// `kind` names the sort of record, `who` the place, `what` the content.
  void add(std::uint32_t kind, std::uint64_t who, TrueTime when, std::uint64_t what) { add(key_of(kind, who), when, what); }

  /// What records of one sort from one place share: who writes many of them makes it once.
  struct Key {
    std::uint64_t hash = 0;
  };
  static constexpr Key key_of(std::uint32_t kind, std::uint64_t who) { return {mix64(who + 0x9E3779B97F4A7C15ULL * (kind + 1))}; }
  void add(Key key, TrueTime when, std::uint64_t what) {
    const std::uint64_t hash = mix64(key.hash ^ static_cast<std::uint64_t>(when.ps()));
    sum_ += mix64(hash + what);
  }
  std::uint64_t value() const { return sum_; }

 private:
  std::uint64_t sum_ = 0;
};

}  // namespace takt::sim
