#include "sim/event_queue.hpp"

#include <algorithm>
#include <bit>

namespace takt::sim {

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

/// Moves the events of the next bucket that has any into the empty near heap.
void EventQueue::advance() {
  TAKT_CHECK(near_.empty() && waiting_ > 0, "the calendar advances only when the heap is empty");
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
  load_bucket(bucket);
  while (!beyond_.empty() && beyond_.first_time() < horizon_) {
    const Event event = beyond_.pop();
    if (event.time < near_end_) {
      near_.push(event);
      --waiting_;
    } else {
      put_into_bucket(event);
    }
  }
  TAKT_CHECK(!near_.empty(), "an occupied bucket holds an event");
}

void EventQueue::load_bucket(std::size_t bucket) {
  std::uint32_t slot = buckets_[bucket];
  buckets_[bucket] = none;
  occupied_[bucket / 64] &= ~(1ULL << (bucket % 64));
  while (slot != none) {
    Waiting& waiting = pool_[slot];
    const std::uint32_t next = waiting.next;
    if (next != none) __builtin_prefetch(&pool_[next]);  // while this one is sorted in
    near_.push(waiting.event);
    waiting.next = free_;
    free_ = slot;
    slot = next;
    --waiting_;
    --in_buckets_;
  }
}

/// Lays the events out anew with buckets so narrow that the near heap stays small. Called when the near heap is crowded.
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

  // The nearer half of the events says how densely they lie; far time-outs must not widen the buckets.
  std::sort(all.begin(), all.end());
  const std::size_t half = all.size() / 2;
  const std::int64_t start = all.front().time.ps();
  const std::int64_t spacing = (all[half].time.ps() - start) / static_cast<std::int64_t>(half + 1);
  width_log2_ = std::min(40, static_cast<int>(std::bit_width(static_cast<std::uint64_t>(std::max<std::int64_t>(1, 8 * spacing)))));
  near_end_ = buckets_after(TrueTime::from_ps(start >> width_log2_ << width_log2_), 1);
  horizon_ = buckets_after(near_end_, buckets_.size() - 1);
  for (const Event& event : all) {
    if (event.time < near_end_)
      near_.push(event);
    else
      push_far(event);
  }
  // Many events at one instant cannot be spread; do not try again before the heap has doubled.
  crowded_ = std::max<std::size_t>(near_only_limit, 2 * near_.size());
}

/// Back to one heap: few events are left.
void EventQueue::collapse() {
  near_end_ = horizon_ = TrueTime::never();
  for (std::size_t bucket = 0; bucket < buckets_.size() && in_buckets_ > 0; ++bucket)
    if (buckets_[bucket] != none) load_bucket(bucket);
  beyond_.drain([this](const Event& event) { near_.push(event); });
  waiting_ = 0;
  crowded_ = near_only_limit;
}

}  // namespace takt::sim
