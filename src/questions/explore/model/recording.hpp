// SPDX-License-Identifier: Apache-2.0
// What a stranger who replays has recorded of one participant, and what its hearers would take of it (the fault
// `replay`).
//
// Entries stand in the order in which they were said. Publishing is cyclic, so each stands for any number of messages
// that say the same, signed with the same key: whoever has taken one of them may take another one. Signed messages are
// taken by security::Freshness, the very values of a node's replay window.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "explore/model/members.hpp"
#include "explore/model/wiring.hpp"
#include "security/replay_window.hpp"

namespace takt::explore {

/// More than a participant says in a run that can be searched.
inline constexpr std::size_t most_recorded = 40;
/// Of a run.
inline constexpr std::uint8_t most_key_changes = 2;

struct Recorded {
  WordId word = no_word;
  std::uint8_t token = 0;  ///< changes of the key until then
  std::uint8_t life = 0;
  constexpr bool operator==(const Recorded&) const = default;
};

/// A value. Places count from 1, the oldest entry; 0 is none, or one that is forgotten. Hearers are participants.
class Recording {
 public:
  std::size_t size() const { return size_; }
  const Recorded& operator[](std::size_t place) const { return entries_[place - 1]; }

  std::uint8_t token() const { return token_; }
  void change_key() { ++token_; }

  /// It is said now; what was said last goes on. Returns its place, the last one.
  std::size_t say(WordId word, std::uint8_t life);
  /// The last one is just that.
  bool says(WordId word, std::uint8_t life) const {
    return size_ != 0 && entries_[size_ - 1U] == Recorded{word, token_, life};
  }

  /// What stands in the register of a hearer.
  std::size_t standing(std::size_t hearer) const { return standing_[hearer]; }
  void set_standing(std::size_t hearer, std::size_t place) { standing_[hearer] = static_cast<std::uint8_t>(place); }
  /// The last one that it took of those that are not older than others that it took.
  std::size_t taken(std::size_t hearer) const { return taken_[hearer]; }
  void take(std::size_t hearer, std::size_t place);

  /// Signed: a hearer whose key is `token` takes it: it has the key, and has taken nothing newer.
  bool takes(std::size_t hearer, std::size_t place, std::uint8_t token) const;
  /// What a message that says so has in its nonce.
  security::Freshness freshness(std::size_t place) const;

  /// Drops what none of the hearers (bit i for participant i) takes any more.
  void forget(std::uint32_t hearers);

  bool operator==(const Recording&) const = default;
  std::uint64_t hash() const;

 private:
  std::uint8_t size_ = 0;
  std::uint8_t token_ = 0;
  std::array<std::uint8_t, most_participants> standing_{};
  std::array<std::uint8_t, most_participants> taken_{};
  std::array<Recorded, most_recorded> entries_{};
};

struct HashOfRecording {
  std::size_t operator()(const Recording& recording) const { return recording.hash(); }
};

/// The key of `token` is current where `now` changes have been seen, or the one before or behind it:
/// security::KeyRing::find.
constexpr bool is_known_key(std::uint8_t token, std::uint8_t now) { return token <= now + 1 && now <= token + 1; }

}  // namespace takt::explore
