#include "sim/random.hpp"

#include <bit>

#include "sim/check.hpp"
#include "sim/digest.hpp"
#include "sim/time.hpp"

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

std::uint64_t RandomStream::next() {
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

std::uint64_t RandomStream::below(std::uint64_t bound) {
  TAKT_CHECK(bound > 0, "a draw below zero");
  // Lemire's method: the high half of a product is uniform once the few biased low halves are rejected.
  uint128 product = static_cast<uint128>(next()) * bound;
  if (static_cast<std::uint64_t>(product) < bound) {
    const std::uint64_t threshold = (0 - bound) % bound;
    while (static_cast<std::uint64_t>(product) < threshold) product = static_cast<uint128>(next()) * bound;
  }
  return static_cast<std::uint64_t>(product >> 64);
}

}  // namespace takt::sim
