// SPDX-License-Identifier: Apache-2.0
// The pending events of a simulation, smallest first in the order of Event.
//
// The events of the near future lie in a short sorted array, where a pop is a decrement and a push moves the few events
// that come before it. From a few dozen events on, later ones wait unsorted in a calendar of equally wide buckets, and
// those beyond the calendar in a heap; so the cost of an event hardly grows with the population. Many events at one
// instant cannot be spread over buckets: they are sorted once, and the array is filled from them. The order never
// depends on the layout: every event passes through the near part, which holds all events before `near_end_`.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "sim/check.hpp"
#include "sim/event.hpp"
#include "sim/event_sort.hpp"

namespace takt::sim {

/// A 4-ary min-heap of events with a lazy root: after pop() the root is a hole which the next push() may fill directly.
class EventHeap {
 public:
  bool empty() const { return size() == 0; }
  std::size_t size() const { return items_.size() - (hole_ ? 1 : 0); }

  /// The time of the first event. Precondition: not empty.
  TrueTime first_time() const {
    if (!hole_) return items_[0].time;
    const std::size_t end = items_.size() < 5 ? items_.size() : 5;
    std::int64_t first = items_[1].time.ps();
    for (std::size_t child = 2; child < end; ++child) {
      const std::int64_t time = items_[child].time.ps();
      first = time < first ? time : first;
    }
    return TrueTime::from_ps(first);
  }

  /// The first event. Precondition: not empty.
  const Event& first() {
    if (hole_) fill_hole();
    return items_[0];
  }

  /// Removes and returns the first event. Precondition: not empty.
  Event pop() {
    if (hole_) fill_hole();
    hole_ = true;
    return items_[0];
  }

  void push(const Event& event) {
    if (hole_) {
      hole_ = false;
      sift_down(event, items_.size());
      return;
    }
    items_.push_back(event);
    sift_up(items_.size() - 1, event);
  }

  /// Removes all events in no particular order and hands each to `sink`.
  template <class Sink>
  void drain(Sink&& sink) {
    for (std::size_t i = hole_ ? 1 : 0; i < items_.size(); ++i) sink(items_[i]);
    items_.clear();
    hole_ = false;
  }

 private:
  void fill_hole() {
    hole_ = false;
    const Event last = items_.back();
    items_.pop_back();
    if (!items_.empty()) sift_down(last, items_.size());
  }

  void sift_up(std::size_t at, const Event& event) {
    Event* const items = items_.data();
    while (at > 0) {
      const std::size_t parent = (at - 1) / 4;
      if (!(event < items[parent])) break;
      items[at] = items[parent];
      at = parent;
    }
    items[at] = event;
  }

  /// Puts `event` where it belongs on the way down from the root, which is free.
  void sift_down(const Event& event, std::size_t size) {
    Event* const items = items_.data();
    std::size_t at = 0;
    for (;;) {
      const std::size_t first = 4 * at + 1;
      if (first >= size) break;
      std::size_t least = first;
      const std::size_t end = first + 4 < size ? first + 4 : size;
      for (std::size_t child = first + 1; child < end; ++child) least = items[child] < items[least] ? child : least;
      if (!(items[least] < event)) break;
      items[at] = items[least];
      at = least;
    }
    items[at] = event;
  }

  std::vector<Event> items_;
  bool hole_ = false;
};

/// The near part: a short sorted array of the very next events, and behind them the rest, of which a part is sorted
/// once and what comes later is in a heap.
class NearEvents {
 public:
  static constexpr std::uint32_t most_sorted = 64;
  /// Below this many events in the array more are fetched, if any are near, so that prefetching sees them.
  static constexpr std::uint32_t few = 8;

  bool empty() const { return count_ == 0 && !has_rest(); }
  bool has_rest() const { return !batch_.empty() || !heap_.empty(); }
  std::uint32_t sorted_count() const { return count_; }
  std::size_t size() const { return count_ + batch_.size() + heap_.size(); }

  /// The event that will be popped after `ahead` others, if that is known without work. Behind it in memory are those
  /// that are popped before.
  const Event* upcoming(std::uint32_t ahead) const { return ahead < count_ ? &sorted_[count_ - 1 - ahead] : nullptr; }
  /// The first event, or null.
  const Event* first() {
    if (count_ == 0) [[unlikely]] {
      if (!has_rest()) return nullptr;
      refill();
    }
    return &sorted_[count_ - 1];
  }

  // Precondition of these: sorted_count() is not 0.
  TrueTime first_time() const { return sorted_[count_ - 1].time; }
  const Event* upcoming_first() const { return &sorted_[count_ - 1]; }
  void drop_first() { --count_; }
  [[gnu::always_inline]] Event pop() { return sorted_[--count_]; }

  /// Sorts the event in, where it comes before the rest and the array has room for it; otherwise it does nothing and
  /// returns false.
  [[gnu::always_inline]] bool push_if_short(const Event& event) {
    if (count_ >= most_sorted || event.time >= rest_time_) [[unlikely]]
      return false;
    insert(event);
    return true;
  }

  void push(const Event& event) {
    if (!push_if_short(event)) [[unlikely]]
      push_long(event);
  }

  /// Moves events of the rest, if there are any, into the array. Precondition: sorted_count() is less than `few`.
  void refill();
  /// Takes over events in any order, none of which comes before those in the array. Preconditions: there is no rest,
  /// and sorted_count() is less than `few`. `events` is empty afterwards.
  void load(std::vector<Event>& events, EventSorter& sorter);
  /// The same for at most most_few_events of a span of time (sort_few()).
  void load_few(std::span<const Event* const> events, TrueTime start, int span_log2);

  template <class Sink>
  void drain(Sink&& sink) {
    while (count_ > 0) sink(sorted_[--count_]);
    for (const Event& event : batch_) sink(event);
    batch_.clear();
    heap_.drain(sink);
    rest_time_ = TrueTime::never();
  }

 private:
  static constexpr std::uint32_t refilled = 48;  // leaves room for what is pushed meanwhile
  static_assert(most_few_events + few <= most_sorted);

  [[gnu::always_inline]] void insert(const Event& event) {
    Event* const first = sorted_.data();
    Event* at = first + count_++;
    while (at != first && at[-1] < event) {
      *at = at[-1];
      --at;
    }
    *at = event;
  }
  void push_long(const Event& event);
  void refill_one_by_one();
  /// Makes room for so many later events at the front of the array.
  void move_up(std::uint32_t places);
  /// The first event of the rest. Precondition: has_rest().
  Event pop_rest();
  void find_rest_time();

  std::uint32_t count_ = 0;
  TrueTime rest_time_ = TrueTime::never();  ///< of the first event of the rest: what is earlier belongs into the array
  std::array<Event, most_sorted> sorted_;   ///< descending: the first event is the last one
  std::vector<Event> batch_;                ///< descending
  EventHeap heap_;
};

class EventQueue {
 public:
  bool empty() const { return near_.empty() && waiting() == 0; }
  std::size_t size() const { return near_.size() + waiting(); }

  /// The time of the first event, or never. It may move events from the calendar to the near part.
  TrueTime first_time() {
    if (near_.sorted_count() < low_water_) [[unlikely]] {
      if (!top_up()) return TrueTime::never();
    }
    return near_.first_time();
  }

  /// The first event, or null. It may move events from the calendar to the near part.
  const Event* first() {
    if (near_.sorted_count() < low_water_) [[unlikely]] {
      if (!top_up()) return nullptr;
    }
    return near_.upcoming_first();
  }
  /// Removes it. Precondition: first() has just been asked and was not null.
  void drop_first() { near_.drop_first(); }
  /// Removes and returns the first event. Precondition: first_time() has just been asked and was not never.
  Event pop() { return near_.pop(); }

  /// The first event if it is of this instant, exactly; null otherwise. Precondition: an event of `now` has been popped
  /// last.
  const Event* next_at(TrueTime now) {
    const Event* const event = near_.first();  // what is not in the near part is later
    return event != nullptr && event->time == now ? event : nullptr;
  }

  /// The event that will probably be popped after `ahead` others, or null; that after `ahead` - 1 is behind it, and so
  /// on. A hint: a push may come in between.
  const Event* upcoming(std::uint32_t ahead) const { return near_.upcoming(ahead); }

  void push(const Event& event) {
    if (event.time < near_end_ && near_.push_if_short(event)) [[likely]]
      return;
    push_to_calendar(event.time, event.order, event.serial_kind, event.argument);
  }

  /// So many events were popped since it was called last: buckets that hold too much are made narrower. When they were
  /// laid out, few components may have been at work.
  void tune(std::uint64_t popped);

 private:
  /// An event in the calendar: two share a cache line, none lies in two.
  struct alignas(32) Waiting {
    Event event;
  };
  static constexpr std::uint32_t none = 0xFFFF'FFFF;
  static constexpr std::size_t near_only_limit = 64;
  /// Widths of buckets, as powers of two ps. What many components do at one instant says nothing of how densely events
  /// lie; 66 ns are less than a short frame takes, so that a bucket gets hardly anything while it is worked on.
  static constexpr int narrowest_log2 = 16;
  static constexpr int widest_log2 = 40;
  /// How many events should come and go while a bucket is worked on, and from how many on, of so many events, the
  /// calendar is laid out anew with narrower ones.
  static constexpr std::uint64_t wanted_in_bucket = 12;
  static constexpr std::uint64_t most_in_bucket = 28;
  static constexpr std::uint64_t observed = 20'000;
  /// So many buckets ahead the next events are fetched while some of the present ones are left.
  static constexpr std::size_t close_by = 4;
  static_assert(near_only_limit >= NearEvents::most_sorted, "a near part that is a sorted array is never crowded");

  /// The way of what does not fit into the sorted array. It takes words, since a reference would keep every event in
  /// memory.
  void push_to_calendar(TrueTime time, std::uint64_t order, std::uint64_t serial_kind, std::uint64_t argument);
  [[gnu::noinline]] void push_slow(TrueTime time, std::uint64_t order, std::uint64_t serial_kind,
                                   std::uint64_t argument);
  void push_far(const Event& event);
  void put_into_bucket(TrueTime time, std::uint64_t order, std::uint64_t serial_kind, std::uint64_t argument);
  void make_slots();
  [[gnu::noinline]] bool top_up();
  void advance(std::size_t ahead);
  void load_bucket(std::size_t bucket, TrueTime start);
  void spread(int widest);
  void collapse();
  std::size_t waiting() const { return in_buckets_ + beyond_.size(); }
  std::size_t bucket_of(TrueTime time) const {
    return static_cast<std::size_t>(time.ps() >> width_log2_) & (buckets_.size() - 1);
  }
  std::size_t next_occupied(std::size_t from) const;
  /// How many buckets after the one that begins at near_end_ the next events lie. Precondition: in_buckets_ is not 0.
  std::size_t buckets_to_next() const {
    const std::size_t here = bucket_of(near_end_);
    return (next_occupied(here) - here) & (buckets_.size() - 1);
  }
  /// The start of the bucket that lies so many buckets after `start`; never() beyond the end of time.
  TrueTime buckets_after(TrueTime start, std::size_t buckets) const {
    const int128 ps = start.ps() + (static_cast<int128>(buckets) << width_log2_);
    return ps >= TrueTime::never().ps() ? TrueTime::never() : TrueTime::from_ps(static_cast<std::int64_t>(ps));
  }

  NearEvents near_;
  TrueTime near_end_ = TrueTime::never();  // events before it are in near_
  TrueTime horizon_ = TrueTime::never();   // events from it on are in beyond_
  std::uint32_t low_water_ = 1;            // fewer sorted events in near_ are a reason to look for more
  std::uint32_t free_ = none;
  int width_log2_ = 0;                     // a bucket spans 2^width_log2_ ps
  std::size_t crowded_ = near_only_limit;  // size of near_ at which the calendar is (re)built
  std::size_t in_buckets_ = 0;
  std::size_t size_when_spread_ = 0;
  std::uint64_t popped_ = 0;             // since it was tuned last
  std::uint64_t loads_ = 0;              // buckets that were loaded since then
  std::vector<std::uint32_t> buckets_;   // head of each bucket's list; a power of two of them
  std::vector<std::uint64_t> occupied_;  // one bit a bucket
  std::vector<Waiting> pool_;
  std::vector<std::uint32_t> next_;  // of each slot of the pool: the next one of its bucket, or of those that are free
  EventHeap beyond_;
  EventSorter sorter_;
  std::vector<Event> scratch_;  // of spread() and advance(), kept so that it allocates once
};

}  // namespace takt::sim
