// A state of the group and its network, packed into 2 n + 4 words of 32 bits for n slaves (40 bytes for three).
//
//   0 .. n            the participants, as numbers (Members)
//   n+1 .. 2n         the registers of the 2 n channels, two a word, as numbers of words; 0: nothing was published
//   2n+1              the delayed copy: its word, its channel, how far it was overtaken
//   2n+2              the ghost, as a number
//   2n+3              calls left, faults left, and for each channel whether its data is from before the receiver's round
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "explore/hash_index.hpp"
#include "explore/members.hpp"

namespace takt::explore {

/// Where a delayed copy stands among what the receiver has heard.
enum class Late : std::uint8_t { none, same, newer_sent, overtaken };

class State {
 public:
  static constexpr std::size_t most_words = 2 * most_slaves + 4;
  static constexpr std::size_t words_for(std::size_t slaves) { return 2 * slaves + 4; }

  explicit State(std::size_t slaves = 1) : slaves_(static_cast<std::uint32_t>(slaves)) {}

  std::size_t slaves() const { return slaves_; }
  std::uint32_t* data() { return words_.data(); }
  const std::uint32_t* data() const { return words_.data(); }

  MemberId member(std::size_t i) const { return words_[i]; }
  void set_member(std::size_t i, MemberId member) { words_[i] = member; }

  WordId reg(std::size_t channel) const { return static_cast<WordId>(words_[slaves_ + 1 + channel / 2] >> 16 * (channel % 2)); }
  void set_reg(std::size_t channel, WordId word) {
    std::uint32_t& both = words_[slaves_ + 1 + channel / 2];
    const unsigned shift = 16 * (channel % 2);
    both = (both & ~(0xFFFFU << shift)) | static_cast<std::uint32_t>(word) << shift;
  }

  Late late() const { return static_cast<Late>(words_[2 * slaves_ + 1] >> 24); }
  WordId late_word() const { return static_cast<WordId>(words_[2 * slaves_ + 1]); }
  std::size_t late_channel() const { return (words_[2 * slaves_ + 1] >> 16) & 0xFFU; }
  void set_late(Late late, std::size_t channel, WordId word) {
    words_[2 * slaves_ + 1] = static_cast<std::uint32_t>(late) << 24 | static_cast<std::uint32_t>(channel) << 16 | word;
  }
  void set_late(Late late) { set_late(late, late_channel(), late_word()); }
  void clear_late() { words_[2 * slaves_ + 1] = 0; }

  std::uint32_t ghost() const { return words_[2 * slaves_ + 2]; }
  void set_ghost(std::uint32_t ghost) { words_[2 * slaves_ + 2] = ghost; }

  std::uint32_t commands_left() const { return rest() & 0xFU; }
  void set_commands_left(std::uint32_t count) { rest() = (rest() & ~0xFU) | count; }
  std::uint32_t faults_left() const { return (rest() >> 4) & 0xFU; }
  void set_faults_left(std::uint32_t count) { rest() = (rest() & ~0xF0U) | count << 4; }
  /// `paper`: the data in the register (channel 2 n: in the delayed copy) was sent before the receiver's round began.
  bool outdated(std::size_t channel) const { return ((rest() >> (8 + channel)) & 1U) != 0; }
  void set_outdated(std::size_t channel, bool value) {
    rest() = (rest() & ~(1U << (8 + channel))) | static_cast<std::uint32_t>(value) << (8 + channel);
  }
  bool any_outdated() const { return rest() >> 8 != 0; }

  std::uint64_t hash() const {
    std::uint64_t digest = 0x9E3779B97F4A7C15ULL;
    for (std::size_t i = 0; i < words_for(slaves_); i += 2) {
      digest ^= words_[i] | std::uint64_t{words_[i + 1]} << 32;
      digest *= 0xD6E8FEB86659FD93ULL;
      digest ^= digest >> 32;
    }
    return digest * 0xD6E8FEB86659FD93ULL;
  }
  bool operator==(const State&) const = default;
  auto operator<=>(const State&) const = default;

 private:
  std::uint32_t& rest() { return words_[2 * slaves_ + 3]; }
  std::uint32_t rest() const { return words_[2 * slaves_ + 3]; }

  std::uint32_t slaves_ = 1;
  std::array<std::uint32_t, most_words> words_{};
};

}  // namespace takt::explore
