// SPDX-License-Identifier: Apache-2.0
#include "gateway/shared_buffer.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <deque>

namespace takt::gateway::shared_buffer_test {
namespace {

using namespace sim::literals;  // NOLINT

sim::LocalTime at(std::int64_t ms) { return sim::LocalTime::from_ps(ms * 1'000'000'000); }

void push(SharedBuffer& buffer, int value, std::int64_t ms) {
  const std::byte octet{static_cast<unsigned char>(value)};
  buffer.push(Octets(&octet, 1), at(ms));
}

/// The value, or -1.
int pull(SharedBuffer& buffer, std::int64_t ms) {
  const auto value = buffer.pull(at(ms));
  return value ? std::to_integer<int>(value->octets[0]) : -1;
}

TEST(SharedBuffer, FirstInFirstOut) {
  SharedBuffer buffer({.capacity = 3});
  push(buffer, 1, 0);
  push(buffer, 2, 1);
  EXPECT_EQ(pull(buffer, 2), 1);
  push(buffer, 3, 2);
  EXPECT_EQ(pull(buffer, 3), 2);
  EXPECT_EQ(pull(buffer, 3), 3);
  EXPECT_EQ(pull(buffer, 3), -1);
  EXPECT_EQ(buffer.figures(), (BufferFigures{.received = 3, .forwarded = 3}));
}

TEST(SharedBuffer, OverwritesTheOldest) {
  SharedBuffer buffer({.capacity = 2, .overflow = Overflow::overwrite_oldest});
  for (int i = 1; i <= 5; ++i) push(buffer, i, i);
  EXPECT_EQ(pull(buffer, 6), 4);
  EXPECT_EQ(pull(buffer, 6), 5);
  EXPECT_EQ(pull(buffer, 6), -1);
  EXPECT_EQ(buffer.figures(), (BufferFigures{.received = 5, .forwarded = 2, .overwritten = 3}));
}

TEST(SharedBuffer, DropsTheNewest) {
  SharedBuffer buffer({.capacity = 2, .overflow = Overflow::drop_newest});
  for (int i = 1; i <= 5; ++i) push(buffer, i, i);
  EXPECT_EQ(pull(buffer, 6), 1);
  push(buffer, 6, 6);
  EXPECT_EQ(pull(buffer, 6), 2);
  EXPECT_EQ(pull(buffer, 6), 6);
  EXPECT_EQ(buffer.figures(), (BufferFigures{.received = 6, .forwarded = 3, .dropped = 3}));
}

TEST(SharedBuffer, KeepsTheLatestWhateverItsCapacity) {
  SharedBuffer buffer({.capacity = 10, .overflow = Overflow::keep_latest});
  for (int i = 1; i <= 4; ++i) push(buffer, i, i);
  EXPECT_EQ(pull(buffer, 5), 4);
  EXPECT_EQ(pull(buffer, 5), -1) << "a value goes once";
  EXPECT_EQ(buffer.figures(), (BufferFigures{.received = 4, .forwarded = 1, .overwritten = 3}));
}

// By hand: values at 0, 4, 9 and 10 ms; limit 5 ms. At 10 ms that of 0 is 10 ms old, that of 4 is 6 ms old: both stale.
// That of 9 goes. At 15 ms that of 10 is exactly 5 ms old and goes; at 16 ms it would not.
TEST(SharedBuffer, StaleValuesAreCountedAndNotSent) {
  SharedBuffer buffer({.capacity = 8, .stale_after = 5_ms});
  push(buffer, 1, 0);
  push(buffer, 2, 4);
  push(buffer, 3, 9);
  push(buffer, 4, 10);
  EXPECT_EQ(pull(buffer, 10), 3);
  EXPECT_EQ(buffer.figures().stale, 2u);
  EXPECT_EQ(pull(buffer, 15), 4);
  push(buffer, 5, 15);
  EXPECT_EQ(pull(buffer, 21), -1);
  EXPECT_EQ(buffer.figures(), (BufferFigures{.received = 5, .forwarded = 2, .stale = 3}));
}

// Ages by hand: 10 - 9 = 1 ms and 15 - 10 = 5 ms.
TEST(SharedBuffer, AgesAreThoseOfValuesThatWent) {
  SharedBuffer buffer({.capacity = 8});
  push(buffer, 1, 9);
  push(buffer, 2, 10);
  pull(buffer, 10);
  pull(buffer, 15);
  EXPECT_EQ(buffer.age(), (AgeFigures{.count = 2, .least = 1_ms, .greatest = 5_ms, .sum_ps = (6_ms).ps()}));
  EXPECT_EQ(buffer.age().mean(), 3_ms);
}

// Two values of 60 days each: their sum is beyond what a time can be.
TEST(SharedBuffer, MeanAgeOfMuchWaiting) {
  constexpr std::int64_t days60 = std::int64_t{60} * 24 * 3600 * 1000;
  SharedBuffer buffer({.capacity = 8});
  push(buffer, 1, 0);
  push(buffer, 2, 0);
  pull(buffer, days60);
  pull(buffer, days60);
  EXPECT_EQ(buffer.age().mean().ps(), days60 * 1'000'000'000);
}

/// What a buffer is, written down once more in the plainest way.
struct Model {
  BufferSettings settings;
  std::deque<std::pair<int, std::int64_t>> waiting;
  BufferFigures figures;

  void push(int value, std::int64_t ms) {
    ++figures.received;
    const std::size_t room = settings.overflow == Overflow::keep_latest ? 1 : settings.capacity;
    if (waiting.size() == room && settings.overflow == Overflow::drop_newest) return void(++figures.dropped);
    if (waiting.size() == room) ++figures.overwritten, waiting.pop_front();
    waiting.emplace_back(value, ms);
  }
  int pull(std::int64_t ms) {
    while (!waiting.empty()) {
      const auto [value, since] = waiting.front();
      waiting.pop_front();
      if (settings.stale_after && at(ms) - at(since) > *settings.stale_after) {
        ++figures.stale;
        continue;
      }
      ++figures.forwarded;
      return value;
    }
    return -1;
  }
};

RC_GTEST_PROP(SharedBufferProperty, IsItsModel, ()) {
  BufferSettings settings;
  settings.capacity = *rc::gen::inRange<std::size_t>(1, 6);
  settings.overflow = *rc::gen::element(Overflow::overwrite_oldest, Overflow::drop_newest, Overflow::keep_latest);
  if (*rc::gen::arbitrary<bool>())
    settings.stale_after = sim::Duration::from_ps(*rc::gen::inRange<std::int64_t>(0, 8) * 1'000'000'000);
  SharedBuffer buffer(settings);
  Model model{settings, {}, {}};
  std::int64_t now = 0;
  int next = 0;
  for (const int step : *rc::gen::container<std::vector<int>>(rc::gen::inRange(0, 6))) {
    now += step / 2;
    if (step % 2 == 0) {
      next = (next + 1) % 256;
      push(buffer, next, now);
      model.push(next, now);
    } else {
      RC_ASSERT(pull(buffer, now) == model.pull(now));
    }
    const BufferFigures& figures = buffer.figures();
    RC_ASSERT(figures == model.figures);
    RC_ASSERT(figures.received ==
              figures.forwarded + figures.overwritten + figures.dropped + figures.stale + buffer.waiting());
  }
}

}  // namespace
}  // namespace takt::gateway::shared_buffer_test
