// SPDX-License-Identifier: Apache-2.0
#include "explore/search/state_store.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

#include "sim/check.hpp"

namespace takt::explore {

StateStore::StateStore(const Shape& shape, std::uint64_t capacity)
    : shape_(shape), words_(shape.words), stride_(words_ + 1), capacity_(capacity) {
  TAKT_CHECK(capacity >= 1 && capacity <= most_states, "positions have 32 bits");
  const auto position_bits = static_cast<unsigned>(std::bit_width(capacity + 1));
  tag_bits_ = std::min(32U - position_bits, 8U);
  tag_mask_ = (1U << tag_bits_) - 1U;
  slot_count_ = std::size_t{1} << 12;
  slots_ = Pages(slot_count_);
  slot_shift_ = 64 - 12;
}

State StateStore::operator[](Position position) const {
  TAKT_CHECK(position < size_, "only stored states can be read");
  State state(shape_);
  std::memcpy(state.data(), record(position), words_ * sizeof(std::uint32_t));
  return state;
}

bool StateStore::holds(Position position, const State& state) const {
  // A loop: a call of memcmp for so few words takes longer. The words of a state are an even number.
  const std::uint32_t* stored = record(position);
  const std::uint32_t* wanted = state.data();
  std::uint32_t difference = 0;
  for (std::size_t i = 0; i < words_; i += 2) difference |= (stored[i] ^ wanted[i]) | (stored[i + 1] ^ wanted[i + 1]);
  return difference == 0;
}

auto StateStore::find(const State& state, std::uint64_t hash) const -> Position {
  const std::size_t mask = slot_count_ - 1;
  for (std::size_t at = home(hash); slots_[at] != 0; at = (at + 1) & mask)
    if (tag_of(slots_[at]) == tag(hash) && holds(position_of(slots_[at]), state)) return position_of(slots_[at]);
  return nowhere;
}

auto StateStore::insert(const State& state, std::uint64_t hash, Position parent) -> Inserted {
  const std::size_t mask = slot_count_ - 1;
  std::size_t at = home(hash);
  for (; slots_[at] != 0; at = (at + 1) & mask)
    if (tag_of(slots_[at]) == tag(hash) && holds(position_of(slots_[at]), state))
      return {position_of(slots_[at]), false};
  if (is_full()) return {nowhere, true};
  const auto position = static_cast<Position>(size_);
  if ((size_ & (chunk_size - 1)) == 0) chunks_.emplace_back(chunk_size * stride_);
  std::uint32_t* target = &chunks_[position >> chunk_bits][(position & (chunk_size - 1)) * stride_];
  std::memcpy(target, state.data(), words_ * sizeof(std::uint32_t));
  target[words_] = parent;
  ++size_;
  slots_[at] = static_cast<std::uint32_t>(size_) << tag_bits_ | tag(hash);
  if (3 * size_ > 2 * slot_count_) grow();
  return {position, true};
}

/// States come in the order of discovery; a few ahead are hashed so that their slots are there in time.
void StateStore::grow() {
  slots_ = Pages{};
  slot_count_ *= 2;
  slots_ = Pages(slot_count_);
  slot_shift_ -= 1;
  const std::size_t mask = slot_count_ - 1;
  constexpr std::size_t ahead = 64;
  std::array<std::uint64_t, ahead> hashes{};
  for (std::size_t i = 0; i < size_ + ahead; ++i) {
    if (i >= ahead) {
      const std::uint64_t hash = hashes[i % ahead];
      std::size_t at = home(hash);
      while (slots_[at] != 0) at = (at + 1) & mask;
      slots_[at] = static_cast<std::uint32_t>(i - ahead + 1) << tag_bits_ | tag(hash);
    }
    if (i >= size_) continue;
    hashes[i % ahead] = (*this)[static_cast<Position>(i)].hash();
    prefetch_slot(hashes[i % ahead]);
  }
}

std::uint64_t StateStore::memory() const {
  return size_ * stride_ * sizeof(std::uint32_t) + slot_count_ * sizeof(std::uint32_t);
}

}  // namespace takt::explore
