// SPDX-License-Identifier: Apache-2.0
// A state of the group and its network, packed into few words of 32 bits (for three slaves in a star on registers: 40
// octets).
//
//   participants      as numbers (Members)
//   channels          numbers of words, two in a word of 32 bits; 0: nothing was published.
//                     `channels`: what is in flight (Contents), one in a word
//   late              `registers` only: the delayed copy: its word, its channel, how far it was overtaken
//   observer          the observer, as a number
//   rest              calls left, faults left, for each register whether its data is from before the receiver's round,
//   and what
//                     follows from a forged word
//   recordings        with the fault `replay`: of each participant, as a number (Recording)
#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>

#include "explore/model/hash_index.hpp"
#include "explore/model/members.hpp"
#include "explore/model/wiring.hpp"

namespace takt::explore {

/// Where a delayed copy stands among what the receiver has heard.
enum class Late : std::uint8_t { none, same, newer_sent, overtaken };

/// Where what stands in the states of one query.
struct Shape {
  std::uint8_t channels_at = 2;
  std::uint8_t late_at = 3;
  std::uint8_t observer_at = 4;
  std::uint8_t rest_at = 5;
  std::uint8_t recordings_at = 6;
  std::uint8_t words = 6;  ///< in all, an even number
  bool wide = false;       ///< a word of 32 bits for each channel, and no delayed copy

  constexpr Shape() = default;
  Shape(const Query& query, std::size_t channels) : wide(query.network == Network::channels) {
    const std::size_t participants = query.slaves + 1U;
    channels_at = static_cast<std::uint8_t>(participants);
    late_at = static_cast<std::uint8_t>(participants + (wide ? channels : (channels + 1) / 2));
    observer_at = static_cast<std::uint8_t>(wide ? late_at : late_at + 1);
    rest_at = static_cast<std::uint8_t>(observer_at + 1);
    recordings_at = static_cast<std::uint8_t>(rest_at + 1);
    words = static_cast<std::uint8_t>((recordings_at + (query.has_recordings() ? participants : 0U) + 1U) / 2U * 2U);
  }
  constexpr bool operator==(const Shape&) const = default;
  constexpr auto operator<=>(const Shape&) const = default;
};

class State {
 public:
  static constexpr std::size_t most_words = 20;

  State() = default;
  explicit State(const Shape& shape) : shape_(shape) {}

  const Shape& shape() const { return shape_; }
  std::size_t words() const { return shape_.words; }
  std::uint32_t* data() { return words_.data(); }
  const std::uint32_t* data() const { return words_.data(); }

  MemberId member(std::size_t i) const { return words_[i]; }
  void set_member(std::size_t i, MemberId member) { words_[i] = member; }

  /// `registers`: the word that stands in a register.
  WordId reg(std::size_t channel) const {
    return static_cast<WordId>(words_[shape_.channels_at + channel / 2] >> 16 * (channel % 2));
  }
  void set_reg(std::size_t channel, WordId word) {
    std::uint32_t& both = words_[shape_.channels_at + channel / 2];
    const unsigned shift = 16 * (channel % 2);
    both = (both & ~(0xFFFFU << shift)) | static_cast<std::uint32_t>(word) << shift;
  }
  /// `channels`: what is in flight.
  std::uint32_t content(std::size_t channel) const { return words_[shape_.channels_at + channel]; }
  void set_content(std::size_t channel, std::uint32_t content) { words_[shape_.channels_at + channel] = content; }

  Late late() const { return shape_.wide ? Late::none : static_cast<Late>(words_[shape_.late_at] >> 24); }
  WordId late_word() const { return static_cast<WordId>(words_[shape_.late_at]); }
  std::size_t late_channel() const { return (words_[shape_.late_at] >> 16) & 0xFFU; }
  void set_late(Late late, std::size_t channel, WordId word) {
    words_[shape_.late_at] = static_cast<std::uint32_t>(late) << 24 | static_cast<std::uint32_t>(channel) << 16 | word;
  }
  void set_late(Late late) { set_late(late, late_channel(), late_word()); }
  void clear_late() { words_[shape_.late_at] = 0; }

  std::uint32_t observer() const { return words_[shape_.observer_at]; }
  void set_observer(std::uint32_t observer) { words_[shape_.observer_at] = observer; }

  std::uint32_t recording(std::size_t i) const { return words_[shape_.recordings_at + i]; }
  void set_recording(std::size_t i, std::uint32_t recording) { words_[shape_.recordings_at + i] = recording; }

  std::uint32_t commands_left() const { return rest() & 0xFU; }
  void set_commands_left(std::uint32_t count) { rest() = (rest() & ~0xFU) | count; }
  std::uint32_t faults_left() const { return (rest() >> 4) & 0xFU; }
  void set_faults_left(std::uint32_t count) { rest() = (rest() & ~0xF0U) | count << 4; }
  /// `paper` on registers: the data in the register (late_data: in the delayed copy) was sent before the receiver's
  /// round began.
  static constexpr std::size_t late_data = most_channels;
  bool outdated(std::size_t channel) const { return ((rest() >> (8 + channel)) & 1U) != 0; }
  void set_outdated(std::size_t channel, bool value) {
    rest() = (rest() & ~(1U << (8 + channel))) | static_cast<std::uint32_t>(value) << (8 + channel);
  }
  bool any_outdated() const { return (rest() & ~(misled_bit | promised_bit)) >> 8 != 0; }
  /// A stranger has spoken, and since then not all were Halted and had heard so of each other.
  bool misled() const { return (rest() & misled_bit) != 0; }
  void set_misled(bool value) { rest() = (rest() & ~misled_bit) | (value ? misled_bit : 0); }
  /// Start was called when all were Halted and had heard so of each other; nothing else was called and no fault has
  /// come since.
  bool promised() const { return (rest() & promised_bit) != 0; }
  void set_promised(bool value) { rest() = (rest() & ~promised_bit) | (value ? promised_bit : 0); }

  std::uint64_t hash() const {
    std::uint64_t digest = 0x9E3779B97F4A7C15ULL;
    for (std::size_t i = 0; i < shape_.words; i += 2) {
      digest ^= words_[i] | std::uint64_t{words_[i + 1]} << 32;
      digest *= 0xD6E8FEB86659FD93ULL;
      digest ^= digest >> 32;
    }
    return digest * 0xD6E8FEB86659FD93ULL;
  }
  bool operator==(const State&) const = default;
  auto operator<=>(const State&) const = default;

 private:
  static constexpr std::uint32_t promised_bit = 1U << 30;
  static constexpr std::uint32_t misled_bit = 1U << 31;
  static_assert(8 + late_data < 30);
  std::uint32_t& rest() { return words_[shape_.rest_at]; }
  std::uint32_t rest() const { return words_[shape_.rest_at]; }

  Shape shape_;
  std::array<std::uint32_t, most_words> words_{};
};

}  // namespace takt::explore
