// SPDX-License-Identifier: Apache-2.0
// What chance does to frames on a link: loss, bursts of loss, corruption, duplication. Integer comparisons only.
//
// Every question takes the same number of draws whatever the probabilities are, so two variants of a study share their
// luck.
#pragma once

#include <cstdint>
#include <variant>

#include "sim/check.hpp"
#include "sim/random.hpp"
#include "sim/units.hpp"

namespace takt::models {

/// A probability from 0 to 1, both included, as a multiple of 2^-63.
class Probability {
 public:
  static constexpr std::uint64_t one = std::uint64_t{1} << 63;

  constexpr Probability() = default;
  /// numerator / denominator, rounded to the nearest. Precondition: numerator <= denominator, denominator > 0.
  static constexpr Probability ratio(std::uint64_t numerator, std::uint64_t denominator) {
    TAKT_CHECK(denominator > 0 && numerator <= denominator, "a probability is at most 1");
    return from_multiple(
        static_cast<std::uint64_t>(((static_cast<sim::uint128>(numerator) << 63) + denominator / 2) / denominator));
  }
  static constexpr Probability from_multiple(std::uint64_t of_2_to_minus_63) {
    Probability p;
    p.multiple_ = of_2_to_minus_63;
    return p;
  }
  constexpr std::uint64_t multiple() const { return multiple_; }
  constexpr Probability complement() const { return from_multiple(one - multiple_); }
  constexpr auto operator<=>(const Probability&) const = default;

  /// Draws once.
  bool occurs(sim::RandomStream& chance) const { return chance.next() >> 1 < multiple_; }

 private:
  std::uint64_t multiple_ = 0;
};

/// Each frame is lost with the same probability, independently. One draw a frame.
struct IndependentLoss {
  Probability loss;
  bool lost(sim::RandomStream& chance) { return loss.occurs(chance); }
  bool operator==(const IndependentLoss&) const = default;
};

/// Gilbert-Elliott: losses in bursts. A channel that is good or bad; for each frame it first changes its state with the
/// probability of that state, then the frame is lost with the probability of the new state. It begins good. Two draws a
/// frame. In the long run it is bad for good_to_bad / (good_to_bad + bad_to_good) of the frames; a bad spell lasts 1 /
/// bad_to_good.
struct GilbertElliottLoss {
  Probability good_to_bad;
  Probability bad_to_good;
  Probability loss_in_good;
  Probability loss_in_bad = Probability::from_multiple(Probability::one);
  bool bad = false;

  bool lost(sim::RandomStream& chance) {
    if ((bad ? bad_to_good : good_to_bad).occurs(chance)) bad = !bad;
    return (bad ? loss_in_bad : loss_in_good).occurs(chance);
  }
  bool operator==(const GilbertElliottLoss&) const = default;
};

using LossModel = std::variant<IndependentLoss, GilbertElliottLoss>;
inline bool lost(LossModel& model, sim::RandomStream& chance) {
  return std::visit([&](auto& each) { return each.lost(chance); }, model);
}

/// Bit errors that the FCS finds. One draw a frame.
class Corruption {
 public:
  Corruption() = default;
  /// Each frame with the same probability, whatever its length.
  static Corruption per_frame(Probability probability);
  /// Each bit independently with that bit error rate: a frame of n bits survives with (1 - rate)^n.
  static Corruption per_bit(Probability bit_error_rate);

  /// `length`: the octets from DA to FCS.
  bool corrupts(sim::Octets length, sim::RandomStream& chance) { return probability(length).occurs(chance); }
  /// The probability for a frame of that length, exact to about 2^-48.
  Probability probability(sim::Octets length);

 private:
  Probability rate_;  // per frame, or per bit
  bool per_bit_ = false;
  sim::Octets known_length_{0};  // frames come in few lengths: the last answer
  Probability known_;
};

/// A frame comes twice. One draw a frame.
struct Duplication {
  Probability probability;
  bool duplicates(sim::RandomStream& chance) { return probability.occurs(chance); }
  bool operator==(const Duplication&) const = default;
};

}  // namespace takt::models
