// SPDX-License-Identifier: Apache-2.0
// The queue against a sorted set: the same events in the same order, whatever the layout inside.
#include "sim/event_queue.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "sim/digest.hpp"
#include "sim/random.hpp"

namespace takt::sim {
namespace {

/// The queue and its oracle side by side, used as a simulation would: nothing is pushed before the last popped time.
class Pair {
 public:
  std::size_t size() const { return oracle_.size(); }
  std::int64_t now() const { return now_; }

  void push_at(std::int64_t time, std::uint32_t target = 0) {
    const Event event{TrueTime::from_ps(time), Event::order_of(Phase::arrival, {target}, {1}), serial_ << 16,
                      serial_ * 3};
    ++serial_;
    queue_.push(event);
    oracle_.insert(event);
  }
  void push_after(std::uint64_t delay) {
    push_at(now_ + static_cast<std::int64_t>(delay), static_cast<std::uint32_t>(mix64(serial_) % 5));
  }

  /// False at the first difference.
  bool pop() {
    if (queue_.size() != oracle_.size() || queue_.empty() != oracle_.empty()) return false;
    const Event expected = *oracle_.begin();
    oracle_.erase(oracle_.begin());
    if (queue_.first_time() != expected.time) return false;
    const Event event = queue_.pop();
    now_ = event.time.ps();
    if (++popped_ % 512 == 0) queue_.tune(512);  // as a simulation does
    return event.time == expected.time && event.order == expected.order && event.serial_kind == expected.serial_kind &&
           event.argument == expected.argument;
  }
  bool drain_to(std::size_t left) {
    while (oracle_.size() > left)
      if (!pop()) return false;
    return left > 0 || (queue_.empty() && queue_.size() == 0 && queue_.first_time() == TrueTime::never());
  }

 private:
  EventQueue queue_;
  std::multiset<Event> oracle_;
  std::uint64_t serial_ = 0;
  std::int64_t now_ = 0;
  std::uint64_t popped_ = 0;
};

/// How far ahead events are scheduled.
using Delay = std::uint64_t (*)(RandomStream&);
std::uint64_t near(RandomStream& chance) { return chance.below(1'000); }
std::uint64_t wide(RandomStream& chance) { return chance.below(1'000'000'000); }
std::uint64_t at_once(RandomStream&) { return 0; }
std::uint64_t clusters(RandomStream& chance) { return 1'000'000 * chance.below(3); }
/// Many events at times that are edges of buckets, whatever the width of the buckets.
std::uint64_t edges(RandomStream& chance) { return chance.below(256) << 24; }
/// Mostly packets, sometimes a time-out of seconds, rarely one of weeks.
std::uint64_t mixed(RandomStream& chance) {
  const std::uint64_t pick = chance.below(1'000);
  if (pick < 700) return 672'000 + chance.below(12'336'000);
  if (pick < 900) return 0;
  if (pick < 995) return chance.below(5'000'000'000'000);
  return 1'000'000'000'000'000'000 + chance.below(1'000'000);
}
/// Every power of two alike.
std::uint64_t logarithmic(RandomStream& chance) { return chance.next() >> (4 + chance.below(60)); }

struct Load {
  const char* name;
  Delay delay;
  std::size_t population;
};

class EventQueueLoad : public testing::TestWithParam<Load> {};

// 10^5 hold operations (pop one, push one) at a steady population, then all out.
TEST_P(EventQueueLoad, HoldsTheOrder) {
  RandomStream chance(1, GetParam().name, "event queue");
  Pair pair;
  for (std::size_t i = 0; i < GetParam().population; ++i) pair.push_after(GetParam().delay(chance));
  for (int i = 0; i < 100'000; ++i) {
    ASSERT_TRUE(pair.pop()) << "operation " << i;
    // Weeks pass too quickly under far time-outs alone; stay within the 106 days.
    if (pair.now() < 2'000'000'000'000'000'000)
      pair.push_after(GetParam().delay(chance));
    else if (pair.size() < GetParam().population)
      pair.push_after(chance.below(1'000'000));
  }
  EXPECT_TRUE(pair.drain_to(0));
}

INSTANTIATE_TEST_SUITE_P(Loads, EventQueueLoad,
                         testing::Values(Load{"one", wide, 1}, Load{"array", wide, 30}, Load{"array_limit", wide, 41},
                                         Load{"near_only_limit", wide, 65}, Load{"hundreds", wide, 257},
                                         Load{"calendar", wide, 1'000}, Load{"large_calendar", wide, 50'000},
                                         Load{"dense", near, 5'000}, Load{"one_instant", at_once, 3'000},
                                         Load{"small_instant", at_once, 50}, Load{"clusters", clusters, 3'000},
                                         Load{"edges", edges, 1'000}, Load{"many_edges", edges, 20'000},
                                         Load{"mixed_small", mixed, 300}, Load{"mixed_large", mixed, 20'000},
                                         Load{"logarithmic_small", logarithmic, 100},
                                         Load{"logarithmic_large", logarithmic, 3'000}),
                         [](const auto& param_info) { return std::string(param_info.param.name); });

// First few components at work, then many, closer and closer to one another: buckets that were right at first hold
// hundreds, until they are laid out anew.
TEST(EventQueue, BecomesDense) {
  RandomStream chance(3, "dense", "event queue");
  Pair pair;
  for (std::size_t i = 0; i < 100; ++i) pair.push_after(chance.below(1'000'000'000'000));
  for (const std::uint64_t span : {1'000'000'000u, 10'000'000u, 2'000'000u, 100'000u}) {
    while (pair.size() < 2'000) pair.push_after(chance.below(span));
    for (int i = 0; i < 60'000; ++i) {
      ASSERT_TRUE(pair.pop()) << "operation " << i << " of those within " << span << " ps";
      pair.push_after(chance.below(span));
    }
  }
  EXPECT_TRUE(pair.drain_to(0));
}

// From an empty queue to a calendar and back to few events, many times, each time at another scale of time.
TEST(EventQueue, CollapsesAndSpreadsBackAndForth) {
  RandomStream chance(2, "swing", "event queue");
  Pair pair;
  for (int swing = 0; swing < 60; ++swing) {
    const std::uint64_t span = 1ULL << (swing * 7 % 43);
    for (int i = 0; i < 1'500; ++i) pair.push_after(chance.below(span));
    ASSERT_TRUE(pair.drain_to(swing % 3 == 0 ? 0 : static_cast<std::size_t>(swing))) << "swing " << swing;
  }
  EXPECT_TRUE(pair.drain_to(0));
}

// The calendar is laid out for nanoseconds, then lives through seconds of silence and comes back.
TEST(EventQueue, CrossesLongSilence) {
  Pair pair;
  for (std::uint64_t i = 0; i < 600; ++i) pair.push_after(i);
  for (std::uint64_t i = 0; i < 600; ++i) pair.push_after(3'000'000'000'000'000 + i * 40'000'000'000'000);
  ASSERT_TRUE(pair.drain_to(300));
  for (std::uint64_t i = 0; i < 600; ++i) pair.push_after(i * 1'000);
  EXPECT_TRUE(pair.drain_to(0));
}

// Far events in pairs, one on the edge of a bucket (a high power of two is an edge at every width) and one right before
// it. When the first of a pair is popped, an event comes that belongs between the two. The many near events make the
// buckets so narrow that each pair lies beyond the horizon until its time has come.
TEST(EventQueue, FarEventsOnTheEdgesOfBuckets) {
  Pair pair;
  for (std::uint64_t i = 0; i < 2'000; ++i) pair.push_after(i);
  for (std::int64_t k = 1; k <= 300; ++k) {
    pair.push_at((k << 43) - 1, 4);
    pair.push_at(k << 43, 4);
  }
  ASSERT_TRUE(pair.drain_to(600));
  for (std::int64_t k = 1; k <= 300; ++k) {
    ASSERT_TRUE(pair.pop());
    ASSERT_EQ(pair.now(), (k << 43) - 1);
    pair.push_at(k << 43, 2);
    ASSERT_TRUE(pair.pop()) << k;
    ASSERT_TRUE(pair.pop()) << k;
  }
  EXPECT_TRUE(pair.drain_to(0));
}

// A growing population: 1000 events at one instant and then 100 000 later ones force the calendar to be laid out anew.
TEST(EventQueue, GrowsTwoOrdersOfMagnitude) {
  RandomStream chance(3, "growth", "event queue");
  Pair pair;
  for (int i = 0; i < 1'000; ++i) pair.push_after(0);
  for (int i = 0; i < 100'000; ++i) pair.push_after(1 + chance.below(10'000'000'000));
  EXPECT_TRUE(pair.drain_to(0));
}

TEST(EventQueue, AnyMixOfPushesAndPops) {
  EXPECT_TRUE(rc::check("the queue is the sorted set", [] {
    Pair pair;
    // Batches: push `count` events spread over 2^log2 ps, then pop `pops`.
    const auto batches = *rc::gen::container<std::vector<std::tuple<int, int, int>>>(
        rc::gen::tuple(rc::gen::inRange(0, 700), rc::gen::inRange(0, 50), rc::gen::inRange(0, 900)));
    RandomStream chance(*rc::gen::arbitrary<std::uint64_t>(), "batches", "event queue");
    for (const auto& [count, log2, pops] : batches) {
      for (int i = 0; i < count; ++i) pair.push_after(chance.below(1ULL << log2));
      for (int i = 0; i < pops && pair.size() > 0; ++i) RC_ASSERT(pair.pop());
    }
    RC_ASSERT(pair.drain_to(0));
  }));
}

// BUG (reported, not fixed): more than a few events (16) within one calendar span of the end of time, once the calendar
// is in use. advance() computes horizon_ = near_end_ + width * (buckets - 1) beyond 2^63, which overflows; then
// CHECK(!near_.empty(), "an occupied bucket holds an event") fails.
TEST(EventQueue, EventsNearTheEndOfTime) {
  Pair pair;
  for (std::uint64_t i = 0; i < 600; ++i) pair.push_after(i * 1'000'000);
  for (int i = 0; i < 40; ++i) pair.push_at(INT64_MAX - 1 - i);
  EXPECT_NO_THROW(EXPECT_TRUE(pair.drain_to(0)));
}

}  // namespace
}  // namespace takt::sim
