// SPDX-License-Identifier: Apache-2.0
// What is in flight in a channel, as numbers: the messages of the network `channels`, oldest first.
//
// A message is heard in its turn, or, once it *strays* (the fault has delayed it, or made it as a copy), at any time.
// Whoever strays is overtaken as soon as a later message is heard; the handshake knows that by the sequence number.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "explore/model/hash_index.hpp"
#include "explore/model/members.hpp"
#include "explore/model/query.hpp"
#include "explore/model/renaming.hpp"

namespace takt::explore {

struct Message {
  WordId word = no_word;
  bool strays = false;
  bool overtaken = false;  ///< something later was heard
  bool twin = false;       ///< the next message is the one of which this is a copy: neither overtakes the other
  bool outdated = false;   ///< `paper`: its data was sent before the receiver's round began
  constexpr bool operator==(const Message&) const = default;
};

/// A value; what changes it never takes it beyond its capacity.
class Content {
 public:
  std::size_t size() const { return size_; }
  const Message& operator[](std::size_t i) const { return message_[i]; }
  Message& operator[](std::size_t i) { return message_[i]; }
  const Message* last() const { return size_ == 0 ? nullptr : &message_[size_ - 1U]; }
  /// The first that does not stray.
  std::optional<std::size_t> next() const;

  void push(WordId word);
  /// It is lost.
  void remove(std::size_t i);
  /// It is heard: what is older was overtaken.
  Message take(std::size_t i);
  /// A copy of it strays.
  void copy(std::size_t i);

  bool operator==(const Content&) const = default;
  std::uint64_t hash() const;

 private:
  std::uint8_t size_ = 0;
  std::array<Message, most_capacity> message_{};
};

class Contents {
 public:
  Contents(const Members& members, const Renamings& renamings) : members_(&members), renamings_(&renamings) {
    intern(Content{});
  }

  static constexpr std::uint32_t empty = 0;
  std::uint32_t intern(const Content& content);
  const Content& operator[](std::uint32_t id) const { return contents_[id]; }
  std::uint32_t renamed(std::uint32_t id, std::size_t renaming) const {
    return renamed_[id * renamings_->size() + renaming];
  }
  /// The same number for whatever differs in names only.
  std::uint32_t orbit(std::uint32_t id) const { return orbit_[id]; }
  std::size_t size() const { return contents_.size(); }

 private:
  struct Hash {
    std::size_t operator()(const Content& content) const { return content.hash(); }
  };
  const Members* members_;
  const Renamings* renamings_;
  Interner<Content, Hash> contents_;
  std::vector<std::uint32_t> renamed_;
  std::vector<std::uint32_t> orbit_;
};

}  // namespace takt::explore
