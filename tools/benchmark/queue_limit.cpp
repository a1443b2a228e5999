// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <vector>

#include "measure.hpp"
#include "sim/digest.hpp"
#include "sim/event_queue.hpp"
#include "workloads.hpp"

namespace takt::benchmark {
namespace {

/// Gaps between an event and the one that it causes, as they occur in the line: many of one length, some of others. A
/// table, so that making them costs nothing.
class Gaps {
 public:
  Gaps() {
    std::uint64_t x = 42;
    for (std::int64_t& gap : gaps_) {
      x = sim::mix64(x);
      gap = 1'000'000 + static_cast<std::int64_t>(x >> 40);
    }
  }
  sim::Duration next() { return sim::Duration::from_ps(gaps_[at_++ % gaps_.size()]); }

 private:
  std::array<std::int64_t, 256> gaps_;
  std::size_t at_ = 0;
};

/// The simplest good queue: a 4-ary heap in a vector, pop and push as one knows them.
class PlainHeap {
 public:
  void push(const sim::Event& event) {
    items_.push_back(event);
    std::size_t at = items_.size() - 1;
    while (at > 0 && event < items_[(at - 1) / 4]) {
      items_[at] = items_[(at - 1) / 4];
      at = (at - 1) / 4;
    }
    items_[at] = event;
  }
  sim::Event pop() {
    const sim::Event first = items_.front();
    const sim::Event last = items_.back();
    items_.pop_back();
    std::size_t at = 0;
    const std::size_t size = items_.size();
    for (;;) {
      const std::size_t child = 4 * at + 1;
      if (child >= size) break;
      std::size_t least = child;
      for (std::size_t c = child + 1; c < std::min(child + 4, size); ++c)
        if (items_[c] < items_[least]) least = c;
      if (!(items_[least] < last)) break;
      items_[at] = items_[least];
      at = least;
    }
    if (size > 0) items_[at] = last;
    return first;
  }

 private:
  std::vector<sim::Event> items_;
};

template <class Queue, class Pop>
double bare_loop(std::uint64_t events, std::size_t population, Queue& queue, Pop pop) {
  Gaps gaps;
  sim::EventSource source(sim::ComponentId{1});
  for (std::size_t i = 0; i < population; ++i)
    queue.push({sim::TrueTime() + gaps.next(),
                sim::Event::order_of(sim::Phase::arrival, {static_cast<std::uint32_t>(i)}, {1}),
                source.next_serial_word(), 0});
  const double before = cpu_seconds();
  for (std::uint64_t i = 0; i < events; ++i) {
    sim::Event event = pop(queue);
    event.time += gaps.next();
    event.serial_kind = source.next_serial_word();
    queue.push(event);
  }
  return cpu_seconds() - before;
}

}  // namespace

double bare_loop_own_queue(std::uint64_t events, std::size_t population) {
  sim::EventQueue queue;
  return bare_loop(events, population, queue, [](sim::EventQueue& q) {
    static_cast<void>(q.first_time());
    return q.pop();
  });
}

double bare_loop_plain_heap(std::uint64_t events, std::size_t population) {
  PlainHeap queue;
  return bare_loop(events, population, queue, [](PlainHeap& q) { return q.pop(); });
}

}  // namespace takt::benchmark
