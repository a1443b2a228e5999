#include "sim/event_queue.hpp"

#include <algorithm>
#include <bit>

namespace takt::sim {

void NearEvents::load(std::vector<Event>& events) {
  TAKT_CHECK(empty(), "events are loaded when none are left");
  std::swap(batch_, events);
  std::sort(batch_.begin(), batch_.end(), [](const Event& a, const Event& b) { return b < a; });
  find_rest_time();
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

Event NearEvents::take_of_rest() {
  if (heap_.empty()) {
    const Event event = batch_.back();
    batch_.pop_back();
    return event;
  }
  if (!batch_.empty() && (batch_.back().time < heap_.first_time() || (batch_.back().time == heap_.first_time() && batch_.back() < heap_.first()))) {
    const Event event = batch_.back();
    batch_.pop_back();
    return event;
  }
  return heap_.pop();
}

void NearEvents::refill() {
  std::uint32_t taken = 0;
  if (heap_.empty()) {
    taken = static_cast<std::uint32_t>(std::min<std::size_t>(refilled, batch_.size()));
    std::copy(batch_.end() - taken, batch_.end(), sorted_.begin());
    batch_.resize(batch_.size() - taken);
    count_ = taken;
    rest_time_ = batch_.empty() ? TrueTime::never() : batch_.back().time;
    return;
  }
  while (taken < refilled && has_rest()) sorted_[most_sorted - ++taken] = take_of_rest();   // the first at the top
  std::copy(sorted_.end() - taken, sorted_.end(), sorted_.begin());
  count_ = taken;
  find_rest_time();
}

void EventQueue::push_elsewhere(TrueTime time, std::uint64_t order, std::uint64_t serial_kind, std::uint64_t argument) {
  const Event event(time, order, serial_kind, argument);
  if (time >= near_end_) {
    push_far(event);
    return;
  }
  near_.push(event);
  if (near_.size() > crowded_) spread();
}

void EventQueue::push_far(const Event& event) {
  ++waiting_;
  if (event.time < horizon_)
    put_into_bucket(event);
  else
    beyond_.push(event);
}

void EventQueue::put_into_bucket(const Event& event) {
  std::uint32_t slot = free_;
  if (slot == none) {
    slot = static_cast<std::uint32_t>(pool_.size());
    pool_.push_back({});
  } else {
    free_ = pool_[slot].next;
  }
  const std::size_t bucket = bucket_of(event.time);
  pool_[slot] = {event, buckets_[bucket]};
  buckets_[bucket] = slot;
  occupied_[bucket / 64] |= 1ULL << (bucket % 64);
  ++in_buckets_;
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

/// Moves the events of the next bucket that has any into the empty near part.
void EventQueue::advance() {
  TAKT_CHECK(near_.empty() && waiting_ > 0, "the calendar advances only when the near part is empty");
  if (waiting_ < near_only_limit / 4) {
    collapse();
    return;
  }
  if (waiting_ > 4 * size_when_spread_) {
    spread();
    if (!near_.empty()) return;
  }
  if (in_buckets_ == 0) {
    // Everything lies beyond the horizon: go straight to the bucket of the first such event.
    const std::int64_t start = beyond_.first_time().ps() >> width_log2_ << width_log2_;
    near_end_ = TrueTime::from_ps(start);
  } else {
    const std::size_t here = bucket_of(near_end_);
    const std::size_t ahead = (next_occupied(here) - here) & (buckets_.size() - 1);
    near_end_ = buckets_after(near_end_, ahead);
  }
  const std::size_t bucket = bucket_of(near_end_);
  near_end_ = buckets_after(near_end_, 1);
  horizon_ = buckets_after(near_end_, buckets_.size() - 1);
  scratch_.clear();
  empty_bucket(bucket, scratch_);
  while (!beyond_.empty() && beyond_.first_time() < horizon_) {
    const Event event = beyond_.pop();
    if (event.time < near_end_) {
      scratch_.push_back(event);
      --waiting_;
    } else {
      put_into_bucket(event);
    }
  }
  TAKT_CHECK(!scratch_.empty(), "an occupied bucket holds an event");
  near_.load(scratch_);
}

void EventQueue::empty_bucket(std::size_t bucket, std::vector<Event>& into) {
  std::uint32_t slot = buckets_[bucket];
  buckets_[bucket] = none;
  occupied_[bucket / 64] &= ~(1ULL << (bucket % 64));
  while (slot != none) {
    Waiting& waiting = pool_[slot];
    const std::uint32_t next = waiting.next;
    if (next != none) __builtin_prefetch(&pool_[next]);  // while this one is copied
    into.push_back(waiting.event);
    waiting.next = free_;
    free_ = slot;
    slot = next;
    --waiting_;
    --in_buckets_;
  }
}

/// Lays the events out anew with buckets so narrow that the near part stays small. Called when it is crowded.
void EventQueue::spread() {
  std::vector<Event>& all = scratch_;
  all.clear();
  const auto keep = [&all](const Event& event) { all.push_back(event); };
  near_.drain(keep);
  beyond_.drain(keep);
  for (const std::uint32_t head : buckets_)
    for (std::uint32_t slot = head; slot != none; slot = pool_[slot].next) keep(pool_[slot].event);
  size_when_spread_ = all.size();
  const std::size_t bucket_count = std::clamp<std::size_t>(std::bit_ceil(2 * all.size()), 1024, std::size_t{1} << 20);
  buckets_.assign(bucket_count, none);
  occupied_.assign(bucket_count / 64, 0);
  pool_.clear();
  free_ = none;
  waiting_ = in_buckets_ = 0;

  // The nearest events say how densely they lie: far time-outs, and what comes a cycle later, must not widen the buckets.
  std::sort(all.begin(), all.end());
  const std::size_t near = all.size() / 8;
  const std::int64_t start = all.front().time.ps();
  const std::int64_t spacing = (all[near].time.ps() - start) / static_cast<std::int64_t>(near + 1);
  width_log2_ = std::clamp(static_cast<int>(std::bit_width(static_cast<std::uint64_t>(2 * spacing))), narrowest_log2, widest_log2);
  near_end_ = buckets_after(TrueTime::from_ps(start >> width_log2_ << width_log2_), 1);
  horizon_ = buckets_after(near_end_, buckets_.size() - 1);
  const auto far = std::find_if(all.begin(), all.end(), [this](const Event& event) { return event.time >= near_end_; });
  std::for_each(far, all.end(), [this](const Event& event) { push_far(event); });
  all.erase(far, all.end());
  near_.load(all);
  // Many events at one instant cannot be spread; do not try again before they have doubled.
  crowded_ = std::max<std::size_t>(near_only_limit, 2 * near_.size());
}

/// Back to the near part alone: few events are left.
void EventQueue::collapse() {
  near_end_ = horizon_ = TrueTime::never();
  scratch_.clear();
  for (std::size_t bucket = 0; bucket < buckets_.size() && in_buckets_ > 0; ++bucket)
    if (buckets_[bucket] != none) empty_bucket(bucket, scratch_);
  beyond_.drain([this](const Event& event) { scratch_.push_back(event); });
  near_.load(scratch_);
  waiting_ = 0;
  crowded_ = near_only_limit;
}

}  // namespace takt::sim
