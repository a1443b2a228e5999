// SPDX-License-Identifier: Apache-2.0
// Open addressing over positions in a table of values: the building block of every look-up here. Results depend on the
// order of insertion only.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "sim/check.hpp"

namespace takt::explore {

constexpr std::uint64_t mixed(std::uint64_t value) {
  value ^= value >> 32;
  value *= 0xD6E8FEB86659FD93ULL;
  value ^= value >> 32;
  value *= 0xD6E8FEB86659FD93ULL;
  return value ^ value >> 32;
}

/// Values numbered in the order of their first appearance. `Hash` is a function of a value, equality is ==.
template <class Value, class Hash>
class Interner {
 public:
  std::size_t size() const { return values_.size(); }
  const Value& operator[](std::size_t id) const { return values_[id]; }

  /// The number of a value, a new one if it was never seen.
  std::uint32_t intern(const Value& value) {
    if (2 * (values_.size() + 1) > slots_.size()) grow();
    const std::size_t slot = find(value);
    if (slots_[slot] == 0) {
      values_.push_back(value);
      slots_[slot] = static_cast<std::uint32_t>(values_.size());
    }
    return slots_[slot] - 1;
  }

  /// The number of a value that was interned; nothing if it never was.
  std::optional<std::uint32_t> number_of(const Value& value) const {
    if (slots_.empty()) return std::nullopt;
    const std::uint32_t slot = slots_[find(value)];
    return slot == 0 ? std::nullopt : std::optional(slot - 1);
  }

  /// Appends a value that is never found by intern().
  std::uint32_t append(const Value& value) {
    values_.push_back(value);
    hidden_.push_back(static_cast<std::uint32_t>(values_.size()));
    return static_cast<std::uint32_t>(values_.size() - 1);
  }

 private:
  std::size_t find(const Value& value) const {
    const std::size_t mask = slots_.size() - 1;
    std::size_t slot = Hash{}(value)&mask;
    while (slots_[slot] != 0 && !(values_[slots_[slot] - 1] == value)) slot = (slot + 1) & mask;
    return slot;
  }
  void grow() {
    const std::size_t wanted = slots_.empty() ? 64 : 2 * slots_.size();
    slots_.assign(wanted, 0);
    std::size_t next_hidden = 0;
    for (std::uint32_t i = 0; i < values_.size(); ++i) {
      if (next_hidden < hidden_.size() && hidden_[next_hidden] == i + 1) {
        ++next_hidden;
        continue;
      }
      slots_[find(values_[i])] = i + 1;
    }
  }

  std::vector<Value> values_;
  std::vector<std::uint32_t> slots_;  ///< position + 1; 0 is free
  std::vector<std::uint32_t> hidden_;
};

/// From a key (not ~0) to a value, both 64 bits.
class Memo {
 public:
  static constexpr std::uint64_t absent = ~std::uint64_t{0};

  /// `absent` if there is none.
  std::uint64_t find(std::uint64_t key) const {
    if (slots_.empty()) return absent;
    const std::size_t mask = slots_.size() - 1;
    for (std::size_t slot = mixed(key) & mask;; slot = (slot + 1) & mask) {
      if (slots_[slot].key == key) return slots_[slot].value;
      if (slots_[slot].key == absent) return absent;
    }
  }
  /// Calls seen(key, value) for each entry.
  template <class Seen>
  void each(Seen&& seen) const {
    for (const Slot& slot : slots_)
      if (slot.key != absent) seen(slot.key, slot.value);
  }
  void insert(std::uint64_t key, std::uint64_t value) {
    TAKT_CHECK(key != absent && value != absent, "the marker of free slots is neither key nor value");
    if (2 * (used_ + 1) > slots_.size()) grow();
    place({key, value});
  }

 private:
  struct Slot {
    std::uint64_t key = absent;
    std::uint64_t value = absent;
  };
  void place(Slot entry) {
    const std::size_t mask = slots_.size() - 1;
    std::size_t slot = mixed(entry.key) & mask;
    while (slots_[slot].key != absent && slots_[slot].key != entry.key) slot = (slot + 1) & mask;
    if (slots_[slot].key == absent) ++used_;
    slots_[slot] = entry;
  }
  void grow() {
    std::vector<Slot> old(slots_.empty() ? 64 : 2 * slots_.size());
    old.swap(slots_);
    used_ = 0;
    for (const Slot& each : old)
      if (each.key != absent) place(each);
  }
  std::vector<Slot> slots_;
  std::size_t used_ = 0;
};

}  // namespace takt::explore
