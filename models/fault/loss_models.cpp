// SPDX-License-Identifier: Apache-2.0
#include "models/fault/loss_models.hpp"

namespace takt::models {
namespace {

/// base^exponent, each product rounded to the nearest multiple of 2^-63; an error of at most one multiple for each bit
/// of a frame.
Probability power(Probability base, std::uint64_t exponent) {
  const auto times = [](Probability a, Probability b) {
    constexpr sim::uint128 half = sim::uint128{1} << 62;
    return Probability::from_multiple(
        static_cast<std::uint64_t>((static_cast<sim::uint128>(a.multiple()) * b.multiple() + half) >> 63));
  };
  Probability result = Probability::from_multiple(Probability::one);
  for (; exponent > 0; exponent >>= 1) {
    if ((exponent & 1) != 0) result = times(result, base);
    base = times(base, base);
  }
  return result;
}

}  // namespace

Corruption Corruption::per_frame(Probability probability) {
  Corruption corruption;
  corruption.rate_ = probability;
  return corruption;
}

Corruption Corruption::per_bit(Probability bit_error_rate) {
  Corruption corruption;
  corruption.rate_ = bit_error_rate;
  corruption.per_bit_ = true;
  return corruption;
}

Probability Corruption::probability(sim::Octets length) {
  if (!per_bit_) return rate_;
  if (length != known_length_) {
    known_length_ = length;
    known_ = power(rate_.complement(), 8 * std::uint64_t{length.count}).complement();
  }
  return known_;
}

}  // namespace takt::models
