// SPDX-License-Identifier: Apache-2.0
#include "sim/event_sort.hpp"

#include <algorithm>
#include <bit>
#include <limits>
#include <utility>

namespace takt::sim {
namespace {

constexpr auto later_first = [](const Event& a, const Event& b) { return b < a; };

/// The same order for events that differ in source or serial only. Rarely more than two.
void sort_the_last_first(Event* begin, Event* end) {
  constexpr std::ptrdiff_t many = 16;
  if (end - begin > many) {
    std::sort(begin, end, later_first);
    return;
  }
  for (Event* at = begin + 1; at < end; ++at) {
    const Event event = *at;
    Event* hole = at;
    for (; hole != begin && hole[-1] < event; --hole) *hole = hole[-1];
    *hole = event;
  }
}

}  // namespace

void sort_few(std::span<const Event* const> events, TrueTime start, int span_log2, Event* sorted) {
  using Lane = std::int16_t;  // eight of them in a register of the plainest processor
  constexpr std::size_t lanes = 8;
  constexpr int lane_bits = 16;
  const std::size_t count = events.size();
  const int shift = std::max(0, span_log2 - lane_bits);
  std::array<Lane, most_few_events> key;
  std::array<Lane, most_few_events> rank;
  const std::size_t padded = (count + lanes - 1) / lanes * lanes;  // what is behind the last one is not looked at
  for (std::size_t i = 0; i < count; ++i)
    key[i] = static_cast<Lane>(((events[i]->time - start).ps() >> shift) + std::numeric_limits<Lane>::min());
  for (std::size_t i = count; i < padded; ++i) key[i] = 0;
  for (std::size_t i = 0; i < padded; ++i) rank[i] = 0;
  for (std::size_t j = 0; j < count; ++j) {
    const Lane other = key[j];
    for (std::size_t i = 0; i < padded; ++i)
      rank[i] = static_cast<Lane>(rank[i] + (other > key[i] ? 1 : 0));  // later ones come first
  }
  std::array<std::uint8_t, most_few_events> taken{};
  unsigned most_alike = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const auto at = static_cast<std::size_t>(rank[i]);
    const unsigned alike = taken[at]++;
    most_alike |= alike;
    sorted[at + alike] = *events[i];
  }
  if (most_alike != 0) sort_the_last_first(sorted, sorted + count);
}

/// Bits that never order two events wrongly: of the time those that differ among the events, and behind them, as far as
/// there is room, those of phase and target. Returns how many.
int EventSorter::find_keys(std::span<const Event> events) {
  std::uint64_t any_time = 0;
  std::uint64_t every_time = ~0ULL;
  std::uint64_t any_order = 0;
  std::uint64_t every_order = ~0ULL;
  for (const Event& event : events) {
    const auto time = static_cast<std::uint64_t>(event.time.ps());  // of events never negative
    any_time |= time;
    every_time &= time;
    any_order |= event.order;
    every_order &= event.order;
  }
  // The bits above the first that differs are alike, and so are those below the last one.
  const std::uint64_t times = any_time ^ every_time;
  const int low = times == 0 ? 0 : std::countr_zero(times);
  const int time_bits = static_cast<int>(std::bit_width(times)) - low;
  const int low_time = low + std::max(0, time_bits - key_bits);
  const int place_bits = static_cast<int>(std::bit_width((any_order ^ every_order) >> Event::source_bits));
  const int room = std::max(0, key_bits - time_bits);
  const int kept = std::min(room, place_bits);
  const int low_place = Event::source_bits + place_bits - kept;
  const std::uint64_t time_mask = (1ULL << std::min(time_bits, key_bits)) - 1;
  const std::uint64_t place_mask = (1ULL << kept) - 1;
  Item* const items = items_.data();
  for (std::size_t i = 0; i < events.size(); ++i) {
    const Event& event = events[i];
    const std::uint64_t time = static_cast<std::uint64_t>(event.time.ps()) >> low_time & time_mask;
    items[i] = (time << kept | (event.order >> low_place & place_mask)) << 32 | i;
  }
  return std::min(time_bits, key_bits) + kept;
}

/// By the least digit first, each pass in the order of the one before.
void EventSorter::sort_by_keys(int bits) {
  const auto digits = static_cast<std::size_t>((bits + digit_bits - 1) / digit_bits);
  for (auto& counts : counts_) counts.fill(0);
  for (const Item item : items_)
    for (std::size_t digit = 0; digit < most_digits; ++digit)
      ++counts_[digit][item >> (32 + digit_bits * digit) & (values - 1)];
  other_.resize(items_.size());
  for (std::size_t digit = 0; digit < digits; ++digit) {
    const auto shift = 32 + digit_bits * digit;
    auto& counts = counts_[digit];
    if (counts[items_.front() >> shift & (values - 1)] == items_.size()) continue;  // all have the same
    std::uint32_t before = 0;
    for (std::uint32_t& count : counts) before += std::exchange(count, before);
    Item* const other = other_.data();
    for (const Item item : items_) other[counts[item >> shift & (values - 1)]++] = item;
    items_.swap(other_);
  }
}

void EventSorter::sort(std::vector<Event>& events) {
  if (events.size() < 2) return;
  items_.resize(events.size());
  sort_by_keys(find_keys(events));
  sorted_.resize(events.size());
  Event* const end = sorted_.data() + sorted_.size();
  Event* at = end;
  Event* alike = end;  // behind the last of those that have one key
  for (std::size_t i = 0; i < items_.size(); ++i) {
    if (i > 0 && items_[i] >> 32 != items_[i - 1] >> 32) {
      if (alike - at > 1) sort_the_last_first(at, alike);
      alike = at;
    }
    *--at = events[items_[i] & 0xFFFF'FFFF];
  }
  if (alike - at > 1) sort_the_last_first(at, alike);
  events.swap(sorted_);
}

}  // namespace takt::sim
