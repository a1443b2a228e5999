// SPDX-License-Identifier: Apache-2.0
// The observer of an explored group, or tree of groups, as a small value: S1, S2 and S4 by the very rules of
// handshake::Observer. (S3 and S5 can be seen in a step alone.) The explorer keeps one in each state, as a number.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "explore/model/hash_index.hpp"
#include "explore/model/renaming.hpp"
#include "explore/properties/property.hpp"
#include "handshake/io.hpp"
#include "handshake/run_history.hpp"

namespace takt::explore {

/// What a step means to whoever watches. Equal effects are one number (Members).
struct Effect {
  std::uint8_t change_count = 0;
  std::array<handshake::StateChange, handshake::Outputs::max_changes> change{};
  std::uint32_t run = 0;  ///< after the step
  bool joins = false;     ///< Ready before and after, but in another run
  bool raised = false;
  handshake::IntentKind kind = handshake::IntentKind::Start;  ///< of what was raised
  std::uint32_t started_run = 0;  ///< an inner group was started: its run, and the outer one for which it was
  std::uint32_t outer_run = 0;
  PropertySet properties;  ///< S5, F1, S3 of `robust` violated; transitions reached

  constexpr std::span<const handshake::StateChange> changes() const { return {change.data(), change_count}; }
  constexpr bool operator==(const Effect&) const = default;
  /// A round of `paper` begins (handshake/invariants.hpp).
  bool begins_round() const;
};

/// Storage of a handshake::RunHistory for a few participants and runs, without allocation.
struct SmallStorage {
  class Set {
   public:
    constexpr Set() = default;
    explicit constexpr Set(std::size_t participants) { TAKT_CHECK(participants <= 16, "a group to explore is small"); }
    constexpr void insert(std::size_t i) { bits_ = static_cast<std::uint16_t>(bits_ | 1U << i); }
    constexpr void erase(std::size_t i) { bits_ = static_cast<std::uint16_t>(bits_ & ~(1U << i)); }
    constexpr bool contains(std::size_t i) const { return ((bits_ >> i) & 1U) != 0; }
    constexpr void add(Set other) { bits_ = static_cast<std::uint16_t>(bits_ | other.bits_); }
    template <class To>
    constexpr Set renamed(To&& to) const {
      Set result;
      for (std::size_t i = 0; i < 16; ++i)
        if (contains(i)) result.insert(to(i));
      return result;
    }
    constexpr bool operator==(const Set&) const = default;
    template <class Mix>
    void hash_into(Mix&& mix) const {
      mix(bits_);
    }

   private:
    std::uint16_t bits_ = 0;
  };

  template <class T>
  class List {
   public:
    static constexpr std::size_t most = 20;
    const T* begin() const { return values_.data(); }
    const T* end() const { return values_.data() + size_; }
    T* begin() { return values_.data(); }
    T* end() { return values_.data() + size_; }
    std::size_t size() const { return size_; }
    T& operator[](std::size_t i) { return values_[i]; }
    const T& operator[](std::size_t i) const { return values_[i]; }
    void insert(T* at, const T& value) {
      TAKT_CHECK(size_ < most, "the runs of an exploration are few: a start costs a call");
      std::copy_backward(at, end(), end() + 1);
      *at = value;
      ++size_;
    }
    bool operator==(const List& other) const { return std::equal(begin(), end(), other.begin(), other.end()); }

   private:
    std::uint8_t size_ = 0;
    std::array<T, most> values_{};
  };
};

/// Participants are numbered as the tree does, which is the same in all calls.
class SmallObserver {
 public:
  /// All Halted.
  SmallObserver(handshake::Variant variant, const handshake::GroupTree& tree);

  /// The step of a participant; S1, S2 and S4 if they are violated by it.
  PropertySet on_effect(const handshake::GroupTree& tree, std::size_t participant, const Effect& effect);
  void on_restart(std::size_t participant);

  /// `paper` only: the goals of the calls since the group was last at rest; any of them may be what it settles in.
  bool asked(handshake::PublishedState goal) const { return ((asked_ >> handshake::index_of(goal)) & 1U) != 0; }
  void at_rest() { asked_ = 0; }

  SmallObserver renamed(const Renaming& renaming) const;
  bool operator==(const SmallObserver&) const = default;
  std::uint64_t hash() const;

 private:
  void ask(handshake::PublishedState goal) {
    asked_ = static_cast<std::uint8_t>(asked_ | 1U << handshake::index_of(goal));
  }

  bool is_paper_ = false;
  std::uint8_t asked_ = 0;  ///< `paper` only
  handshake::RunHistory<SmallStorage> history_;
};

struct HashOfObserver {
  std::size_t operator()(const SmallObserver& observer) const { return observer.hash(); }
};

}  // namespace takt::explore
