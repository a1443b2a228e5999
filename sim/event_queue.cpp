// SPDX-License-Identifier: Apache-2.0
#include "sim/event_queue.hpp"

#include <algorithm>
#include <bit>

namespace takt::sim {

void NearEvents::load(std::vector<Event>& events, EventSorter& sorter) {
  TAKT_CHECK(!has_rest(), "events are loaded when none are left");
  sorter.sort(events);
  std::swap(batch_, events);
  events.clear();
  refill();
}

void NearEvents::load_few(std::span<const Event* const> events, TrueTime start, int span_log2) {
  move_up(static_cast<std::uint32_t>(events.size()));
  sort_few(events, start, span_log2, sorted_.data());
}

inline void NearEvents::move_up(std::uint32_t places) {
  for (std::uint32_t i = count_; i-- > 0;) sorted_[i + places] = sorted_[i];
  count_ += places;
}

void NearEvents::find_rest_time() {
  rest_time_ = TrueTime::never();
  if (!batch_.empty()) rest_time_ = batch_.back().time;
  if (!heap_.empty()) rest_time_ = std::min(rest_time_, heap_.first_time());
}

/// The array is full, or the event is not before the rest; of the same instant it may come before what the array holds.
void NearEvents::push_long(const Event& event) {
  if (count_ == most_sorted) {
    const std::uint32_t spilt = most_sorted - refilled;
    for (std::uint32_t i = 0; i < spilt; ++i) heap_.push(sorted_[i]);
    std::copy(sorted_.begin() + spilt, sorted_.begin() + count_, sorted_.begin());
    count_ -= spilt;
  }
  if (count_ > 0 && event < sorted_[0])
    insert(event);
  else
    heap_.push(event);
  find_rest_time();
}

Event NearEvents::pop_rest() {
  if (heap_.empty()) {
    const Event event = batch_.back();
    batch_.pop_back();
    return event;
  }
  if (!batch_.empty() && (batch_.back().time < heap_.first_time() ||
                          (batch_.back().time == heap_.first_time() && batch_.back() < heap_.first()))) {
    const Event event = batch_.back();
    batch_.pop_back();
    return event;
  }
  return heap_.pop();
}

void NearEvents::refill() {
  const auto most = static_cast<std::uint32_t>(std::min<std::size_t>(refilled - count_, batch_.size()));
  std::uint32_t taken = most;
  if (!heap_.empty()) {
    const TrueTime end = heap_.first_time();
    for (taken = 0; taken < most && batch_[batch_.size() - 1 - taken].time < end;) ++taken;
  }
  if (taken == 0) {
    refill_one_by_one();
    return;
  }
  move_up(taken);
  std::copy(batch_.end() - taken, batch_.end(), sorted_.begin());
  batch_.resize(batch_.size() - taken);
  find_rest_time();
}

/// Batch and heap have events of one time, or the heap the earlier ones.
void NearEvents::refill_one_by_one() {
  std::array<Event, refilled> next;  // the first one at the end
  std::uint32_t taken = 0;
  while (count_ + taken < refilled && has_rest()) next[refilled - ++taken] = pop_rest();
  move_up(taken);
  std::copy(next.end() - taken, next.end(), sorted_.begin());
  find_rest_time();
}

/// The way of nearly all in a large network calls nothing, so that it saves no registers.
void EventQueue::push_to_calendar(TrueTime time, std::uint64_t order, std::uint64_t serial_kind,
                                  std::uint64_t argument) {
  if (time < near_end_ || time >= horizon_ || free_ == none) [[unlikely]]
    push_slow(time, order, serial_kind, argument);
  else
    put_into_bucket(time, order, serial_kind, argument);
}

void EventQueue::push_slow(TrueTime time, std::uint64_t order, std::uint64_t serial_kind, std::uint64_t argument) {
  const Event event(time, order, serial_kind, argument);
  if (time >= near_end_) {
    push_far(event);
    return;
  }
  near_.push(event);
  if (near_.size() > crowded_) spread(widest_log2);
}

void EventQueue::push_far(const Event& event) {
  if (free_ == none) make_slots();
  if (event.time < horizon_)
    put_into_bucket(event.time, event.order, event.serial_kind, event.argument);
  else
    beyond_.push(event);
}

/// Precondition: a slot is free.
inline void EventQueue::put_into_bucket(TrueTime time, std::uint64_t order, std::uint64_t serial_kind,
                                        std::uint64_t argument) {
  const std::uint32_t slot = free_;
  const std::size_t bucket = bucket_of(time);
  std::uint32_t& next = next_[slot];
  std::uint32_t& head = buckets_[bucket];
  Event& event = pool_[slot].event;
  event.time = time;
  event.order = order;
  event.serial_kind = serial_kind;
  event.argument = argument;
  free_ = next;
  next = head;
  head = slot;
  occupied_[bucket / 64] |= 1ULL << (bucket % 64);
  ++in_buckets_;
}

/// So many more, in a row.
void EventQueue::make_slots() {
  constexpr std::size_t more = 64;
  const std::size_t had = pool_.size();
  pool_.resize(had + more);
  next_.resize(had + more);
  for (std::size_t slot = had; slot < had + more; ++slot) next_[slot] = static_cast<std::uint32_t>(slot + 1);
  next_.back() = free_;
  free_ = static_cast<std::uint32_t>(had);
}

std::size_t EventQueue::next_occupied(std::size_t from) const {
  std::size_t word = from / 64;
  std::uint64_t bits = occupied_[word] & (~0ULL << (from % 64));
  while (bits == 0) {
    word = (word + 1) % occupied_.size();
    bits = occupied_[word];
  }
  return word * 64 + static_cast<std::size_t>(std::countr_zero(bits));
}

/// Few events are left in the near array: fetches more, of the rest or of the next bucket. False: there is no event at
/// all.
bool EventQueue::top_up() {
  low_water_ = NearEvents::few;
  if (near_.has_rest()) {
    near_.refill();
    return true;
  }
  const bool is_empty = near_.sorted_count() == 0;
  if (waiting() == 0) {
    low_water_ = 1;
    return !is_empty;
  }
  if (waiting() < near_only_limit / 4) {
    collapse();
    return true;
  }
  // What is far ahead waits until nothing else is left: what the present events cause may come before it.
  const std::size_t ahead = in_buckets_ == 0 ? buckets_.size() : buckets_to_next();
  if (!is_empty && ahead > close_by)
    low_water_ = 1;
  else
    advance(ahead);
  return true;
}

/// Moves the events of the bucket so many buckets ahead, the next one that has any, into the near part, where there is
/// no rest.
void EventQueue::advance(std::size_t ahead) {
  if (waiting() > 4 * size_when_spread_) {
    spread(widest_log2);
    return;
  }
  if (in_buckets_ == 0)  // everything lies beyond the horizon: go straight to the bucket of the first such event
    near_end_ = TrueTime::from_ps(beyond_.first_time().ps() >> width_log2_ << width_log2_);
  else
    near_end_ = buckets_after(near_end_, ahead);
  const TrueTime start = near_end_;
  const std::size_t bucket = bucket_of(start);
  near_end_ = buckets_after(start, 1);
  horizon_ = buckets_after(start, buckets_.size());
  while (!beyond_.empty() && beyond_.first_time() < horizon_) push_far(beyond_.pop());
  load_bucket(bucket, start);
}

void EventQueue::load_bucket(std::size_t bucket, TrueTime start) {
  std::array<const Event*, most_few_events> few;
  std::size_t count = 0;
  std::uint32_t slot = buckets_[bucket];
  TAKT_CHECK(slot != none, "an occupied bucket holds an event");
  std::uint32_t last = slot;
  for (; slot != none && count < few.size(); slot = next_[slot]) {
    few[count++] = &pool_[slot].event;
    last = slot;
  }
  if (slot == none) [[likely]] {
    near_.load_few({few.data(), count}, start, width_log2_);
  } else {
    scratch_.clear();
    for (slot = buckets_[bucket]; slot != none; slot = next_[slot]) {
      scratch_.push_back(pool_[slot].event);
      last = slot;
    }
    count = scratch_.size();
    near_.load(scratch_, sorter_);
  }
  next_[last] = free_;  // all its slots at once
  free_ = buckets_[bucket];
  buckets_[bucket] = none;
  occupied_[bucket / 64] &= ~(1ULL << (bucket % 64));
  in_buckets_ -= count;
  ++loads_;
}

void EventQueue::tune(std::uint64_t popped) {
  popped_ += popped;
  if (popped_ < observed) return;
  const std::uint64_t mean = popped_ / std::max<std::uint64_t>(loads_, 1);
  const bool is_crowded = loads_ > 0 && mean > most_in_bucket && width_log2_ > narrowest_log2;
  popped_ = loads_ = 0;
  if (is_crowded) spread(width_log2_ - static_cast<int>(std::bit_width(mean / wanted_in_bucket - 1)));
}

/// Lays the events out anew with buckets so narrow that the near part stays small, and not wider than `widest`. Called
/// when it is crowded.
void EventQueue::spread(int widest) {
  std::vector<Event>& all = scratch_;
  all.clear();
  const auto keep = [&all](const Event& event) { all.push_back(event); };
  near_.drain(keep);
  beyond_.drain(keep);
  for (const std::uint32_t head : buckets_)
    for (std::uint32_t slot = head; slot != none; slot = next_[slot]) keep(pool_[slot].event);
  size_when_spread_ = all.size();
  pool_.clear();
  next_.clear();
  free_ = none;
  in_buckets_ = 0;

  // The nearest events say how densely they lie: far time-outs, and what comes a cycle later, must not widen the
  // buckets.
  std::sort(all.begin(), all.end());
  const std::size_t near = all.size() / 8;
  const std::int64_t start = all.front().time.ps();
  const std::int64_t spacing = (all[near].time.ps() - start) / static_cast<std::int64_t>(near + 1);
  const int width =
      std::clamp(std::min(widest, static_cast<int>(std::bit_width(static_cast<std::uint64_t>(2 * spacing)))),
                 narrowest_log2, widest_log2);
  // Narrower buckets reach as far as those before did, if that does not take too many: twice as many as there are
  // events do in any case.
  constexpr std::size_t most_to_reach = std::size_t{1} << 17;
  const std::size_t as_far =
      widest == widest_log2 ? 0 : std::min(buckets_.size() << (width_log2_ - width), most_to_reach);
  const std::size_t bucket_count =
      std::clamp<std::size_t>(std::max(std::bit_ceil(2 * all.size()), as_far), 1024, std::size_t{1} << 20);
  width_log2_ = width;
  buckets_.assign(bucket_count, none);
  occupied_.assign(bucket_count / 64, 0);
  popped_ = loads_ = 0;
  near_end_ = buckets_after(TrueTime::from_ps(start >> width_log2_ << width_log2_), 1);
  horizon_ = buckets_after(near_end_, buckets_.size() - 1);
  const auto far = std::find_if(all.begin(), all.end(), [this](const Event& event) { return event.time >= near_end_; });
  std::for_each(far, all.end(), [this](const Event& event) { push_far(event); });
  all.erase(far, all.end());
  near_.load(all, sorter_);
  low_water_ = NearEvents::few;
  // Many events at one instant cannot be spread; do not try again before they have doubled.
  crowded_ = std::max<std::size_t>(near_only_limit, 2 * near_.size());
}

/// Back to the near part alone: few events are left.
void EventQueue::collapse() {
  near_end_ = horizon_ = TrueTime::never();
  scratch_.clear();
  for (std::uint32_t& head : buckets_) {
    if (in_buckets_ == 0) break;
    for (std::uint32_t slot = head; slot != none; slot = next_[slot]) {
      scratch_.push_back(pool_[slot].event);
      --in_buckets_;
    }
    head = none;
  }
  buckets_.clear();
  occupied_.clear();
  pool_.clear();
  next_.clear();
  free_ = none;
  beyond_.drain([this](const Event& event) { scratch_.push_back(event); });
  near_.load(scratch_, sorter_);
  crowded_ = near_only_limit;
}

}  // namespace takt::sim
