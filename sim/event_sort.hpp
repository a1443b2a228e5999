// SPDX-License-Identifier: Apache-2.0
// Sorting of events whose order nobody can guess: of thousands at one instant, or of the few of a bucket. Branches that
// depend on them would be guessed wrong every second time, and each of those costs as much as twenty comparisons that
// need no guess.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "sim/event.hpp"

namespace takt::sim {

/// So many that each is compared with each.
inline constexpr std::size_t most_few_events = 48;

/// Copies the events, at most most_few_events, into `sorted`, which has room for them, the last one first. They are not
/// before `start` and before `start` + 2^`span_log2` ps.
void sort_few(std::span<const Event* const> events, TrueTime start, int span_log2, Event* sorted);

/// Sorts any number of events, the last one first, by the digits of what decides nearly always: time, phase and target.
class EventSorter {
 public:
  void sort(std::vector<Event>& events);

 private:
  /// The key in the upper half, where the event is in the lower one.
  using Item = std::uint64_t;
  static constexpr int digit_bits = 8;
  static constexpr std::size_t most_digits = 3;
  static constexpr int key_bits = digit_bits * most_digits;  // events that agree in them are sorted one by one
  static constexpr std::size_t values = std::size_t{1} << digit_bits;

  int find_keys(std::span<const Event> events);
  void sort_by_keys(int bits);

  std::vector<Item> items_;
  std::vector<Item> other_;
  std::vector<Event> sorted_;
  std::array<std::array<std::uint32_t, values>, most_digits> counts_;
};

}  // namespace takt::sim
