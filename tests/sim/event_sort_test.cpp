// SPDX-License-Identifier: Apache-2.0
// Sorting without guesses against std::sort: the same events, the last one first, whatever they have in common.
#include "sim/event_sort.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "sim/random.hpp"

namespace takt::sim {
namespace {

bool is_same(const Event& a, const Event& b) {
  return a.time == b.time && a.order == b.order && a.serial_kind == b.serial_kind && a.argument == b.argument;
}

/// How alike the events are.
struct Likeness {
  std::int64_t start;  ///< of the span of time
  int span_log2;
  std::uint64_t times;  ///< so many different ones, at most
  std::uint32_t phases;
  std::uint32_t targets;
  std::uint32_t first_target;
};

Event any_event(const Likeness& likeness, std::uint64_t number, RandomStream& chance) {
  const std::uint64_t span = std::uint64_t{1} << likeness.span_log2;
  const std::uint64_t step = std::max<std::uint64_t>(span / likeness.times, 1);
  const auto time =
      likeness.start + static_cast<std::int64_t>(chance.below(std::min(likeness.times, span)) * step % span);
  const auto phase = static_cast<Phase>(chance.below(likeness.phases));
  const ComponentId target{likeness.first_target + static_cast<std::uint32_t>(chance.below(likeness.targets))};
  const ComponentId source{static_cast<std::uint32_t>(chance.below(3))};
  return {TrueTime::from_ps(time), Event::order_of(phase, target, source), number << 16 | chance.below(4), number * 7};
}

constexpr std::int64_t far = std::int64_t{1} << 50;
constexpr Likeness likenesses[] = {
    {0, 16, 65'536, 1, 1'000, 0},
    {far, 16, 5, 1, 1'000, 0},
    {far, 16, 1, 1, 40'000, 17},
    {far, 16, 1, 1, 1, 9},
    {far, 17, 131'072, 3, 50'000, 1u << 28},
    {far, 26, 1'000'000, 1, 30, 0},
    {far, 40, 1'000'000, 1, 30, 0},
    {far, 40, 3, 3, 1'000'000, 0},
    {0, 40, 1u << 30, 3, 2, 5},
    {far, 20, 2, 3, 1u << 28, 1u << 28},
};

TEST(EventSort, OfFewIsTheSortedVector) {
  RandomStream chance(1, "few", "event sort");
  for (const Likeness& likeness : likenesses)
    for (std::size_t count = 0; count <= most_few_events; ++count)
      for (int time = 0; time < 5; ++time) {
        std::vector<Event> events;
        for (std::size_t i = 0; i < count; ++i) events.push_back(any_event(likeness, i, chance));
        std::vector<const Event*> pointers;
        for (const Event& event : events) pointers.push_back(&event);
        std::vector<Event> sorted(count);
        sort_few(pointers, TrueTime::from_ps(likeness.start), likeness.span_log2, sorted.data());
        std::sort(events.rbegin(), events.rend());
        ASSERT_TRUE(std::equal(events.begin(), events.end(), sorted.begin(), sorted.end(), is_same))
            << count << " events within 2^" << likeness.span_log2 << " ps";
      }
}

TEST(EventSort, OfManyIsTheSortedVector) {
  RandomStream chance(2, "many", "event sort");
  EventSorter sorter;
  for (const Likeness& likeness : likenesses)
    for (const std::size_t count : {0u, 1u, 2u, 3u, 49u, 255u, 256u, 1'000u, 5'000u}) {
      std::vector<Event> events;
      for (std::size_t i = 0; i < count; ++i) events.push_back(any_event(likeness, i, chance));
      std::vector<Event> sorted = events;
      sorter.sort(sorted);
      std::sort(events.rbegin(), events.rend());
      ASSERT_TRUE(std::equal(events.begin(), events.end(), sorted.begin(), sorted.end(), is_same))
          << count << " events within 2^" << likeness.span_log2 << " ps";
    }
}

}  // namespace
}  // namespace takt::sim
