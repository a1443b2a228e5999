// SPDX-License-Identifier: Apache-2.0
// Newer or older: sequence numbers that roll over (OPC 10000-14, 7.2.3).
#pragma once

#include <concepts>
#include <cstdint>
#include <limits>
#include <optional>

namespace takt::uadp {

enum class Sequence : std::uint8_t {
  newer,    ///< take it
  older,    ///< the same again, or overtaken: ignore it
  invalid,  ///< too far away to be either: ignore it
};

/// With d = (received - 1 - last) modulo 2^bits: newer below a quarter of the range, older above three quarters.
template <std::unsigned_integral T>
constexpr Sequence compare_sequence(T received, T last) {
  constexpr auto quarter = static_cast<T>(std::numeric_limits<T>::max() / 4 + 1);
  const auto distance = static_cast<T>(received - last - 1);
  if (distance < quarter) return Sequence::newer;
  return distance > 3 * quarter ? Sequence::older : Sequence::invalid;
}

/// Remembers the last number taken. After a silence of a receiver's time-out any number is the first again: `forget`.
class SequenceWindow {
 public:
  /// Says what a number is and remembers a newer one.
  Sequence take(std::uint16_t received) {
    const Sequence sequence = last_ ? compare_sequence(received, *last_) : Sequence::newer;
    if (sequence == Sequence::newer) {
      missed_ += last_ ? static_cast<std::uint16_t>(received - *last_ - 1) : 0U;
      last_ = received;
    }
    return sequence;
  }
  void forget() { last_.reset(); }
  std::optional<std::uint16_t> last() const { return last_; }
  /// Numbers that were jumped over: lost messages, or such that came too late.
  std::uint64_t missed() const { return missed_; }

 private:
  std::optional<std::uint16_t> last_;
  std::uint64_t missed_ = 0;
};

}  // namespace takt::uadp
