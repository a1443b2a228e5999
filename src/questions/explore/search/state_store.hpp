// SPDX-License-Identifier: Apache-2.0
// Every state that was found, once, in the order of discovery, with the state from which it was found first.
//
// States stand packed in chunks that never move; an open-addressing table of 32-bit slots finds them. The bits of a
// slot that the greatest position does not need hold a piece of the hash, so that few other states are looked at.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "explore/model/state.hpp"
#include "explore/search/pages.hpp"

namespace takt::explore {

class StateStore {
 public:
  using Position = std::uint32_t;
  static constexpr Position nowhere = ~Position{0};

  /// At most `capacity` states of this shape.
  StateStore(const Shape& shape, std::uint64_t capacity);

  std::size_t size() const { return size_; }
  bool is_full() const { return size_ >= capacity_; }
  State operator[](Position position) const;
  Position parent(Position position) const { return record(position)[words_]; }

  struct Inserted {
    Position position = nowhere;  ///< nowhere: it is new, but there is no room
    bool is_new = false;
  };
  Inserted insert(const State& state, std::uint64_t hash, Position parent);
  /// nowhere if it is not there.
  Position find(const State& state, std::uint64_t hash) const;

  /// Ask for the memory that an insertion will look at: first the slot, some time later the state.
  void prefetch_slot(std::uint64_t hash) const { __builtin_prefetch(&slots_[home(hash)]); }
  void prefetch_state(std::uint64_t hash) const {
    const std::uint32_t slot = slots_[home(hash)];
    if (slot != 0 && tag_of(slot) == tag(hash)) __builtin_prefetch(record(position_of(slot)));
  }
  /// Octets in use for states and table.
  std::uint64_t memory() const;

 private:
  static constexpr std::size_t chunk_bits = 17;
  static constexpr std::size_t chunk_size = std::size_t{1} << chunk_bits;

  const std::uint32_t* record(Position position) const {
    return &chunks_[position >> chunk_bits][(position & (chunk_size - 1)) * stride_];
  }
  std::size_t home(std::uint64_t hash) const { return hash >> slot_shift_; }
  std::uint32_t tag(std::uint64_t hash) const { return static_cast<std::uint32_t>(hash) & tag_mask_; }
  std::uint32_t tag_of(std::uint32_t slot) const { return slot & tag_mask_; }
  Position position_of(std::uint32_t slot) const { return (slot >> tag_bits_) - 1; }
  bool holds(Position position, const State& state) const;
  void grow();

  Shape shape_;
  std::size_t words_;
  std::size_t stride_;  ///< words of a record: the state, and its parent
  std::uint64_t capacity_;
  unsigned tag_bits_ = 0;
  std::uint32_t tag_mask_ = 0;
  unsigned slot_shift_ = 0;
  std::size_t size_ = 0;
  std::vector<Pages> chunks_;
  std::size_t slot_count_ = 0;
  Pages slots_;  ///< (position + 1) and tag; 0 is free
};

}  // namespace takt::explore
