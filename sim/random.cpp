// SPDX-License-Identifier: Apache-2.0
#include "sim/random.hpp"

#include "sim/check.hpp"
#include "sim/digest.hpp"

namespace takt::sim {
namespace {

std::uint64_t absorb(std::uint64_t hash, std::string_view text) {
  for (const char c : text) hash = mix64(hash + static_cast<unsigned char>(c) + 0x9E3779B97F4A7C15ULL);
  return mix64(hash ^ (text.size() + 1));
}

}  // namespace

RandomStream::RandomStream(std::uint64_t seed, std::string_view path, std::string_view purpose) {
  std::uint64_t word = absorb(absorb(mix64(seed + 0x9E3779B97F4A7C15ULL), path), purpose);
  for (std::uint64_t& part : state_) {
    word += 0x9E3779B97F4A7C15ULL;
    part = mix64(word);
  }
}

std::uint64_t RandomStream::below_rejecting(uint128 product, std::uint64_t bound) {
  TAKT_CHECK(bound > 0, "a draw below zero");
  const std::uint64_t threshold = (0 - bound) % bound;
  while (static_cast<std::uint64_t>(product) < threshold) product = static_cast<uint128>(next()) * bound;
  return static_cast<std::uint64_t>(product >> 64);
}

}  // namespace takt::sim
