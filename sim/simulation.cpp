// SPDX-License-Identifier: Apache-2.0
#include "sim/simulation.hpp"

#include <algorithm>
#include <string>

namespace takt::sim {
namespace {

// A bijection on the bits of an id: two rounds of odd multiplication and xor-shift, so that the id can be found again.
constexpr std::uint64_t multiplier = 0x5851F42D4C957F2DULL;
constexpr int shift = 15;
static_assert(2 * shift >= Event::source_bits, "a shift by half is its own inverse");

constexpr std::uint64_t inverse_of(std::uint64_t odd) {
  std::uint64_t inverse = odd;  // Newton's iteration doubles the number of right bits each time
  for (int i = 0; i < 6; ++i) inverse *= 2 - odd * inverse;
  return inverse;
}
static_assert(multiplier * inverse_of(multiplier) == 1);

constexpr std::uint64_t scramble(std::uint64_t x, std::uint64_t key) {
  for (int round = 0; round < 2; ++round) {
    x = ((x ^ key) * multiplier) & Event::id_mask;
    x ^= x >> shift;
  }
  return x;
}

constexpr std::uint64_t unscramble(std::uint64_t x, std::uint64_t key) {
  for (int round = 0; round < 2; ++round) {
    x ^= x >> shift;
    x = ((x * inverse_of(multiplier)) & Event::id_mask) ^ (key & Event::id_mask);
  }
  return x;
}

/// Node and source each by a half of the key; the rest stays.
template <class Change>
std::uint64_t with_ids(std::uint64_t order, std::uint64_t key, Change&& change) {
  constexpr std::uint64_t ids = Event::id_mask << Event::node_shift | Event::id_mask;
  return (order & ~ids) | change(order >> Event::node_shift & Event::id_mask, key >> 30) << Event::node_shift |
         change(order & Event::id_mask, key);
}

}  // namespace

ComponentId Simulation::add(Component& component) {
  TAKT_CHECK(components_.size() < max_components, "too many components");
  components_.push_back(&component);
  node_of_.push_back({static_cast<std::uint32_t>(components_.size() - 1)});
  return node_of_.back();
}

void Simulation::group(ComponentId component, ComponentId front) {
  TAKT_CHECK(node_of(front) == front, "a node has the id of one of its components");
  node_of_[component.index] = front;
}

void Simulation::set_tie_shuffle(std::uint64_t key) {
  TAKT_CHECK(queue_.empty() && events_ == 0, "tie shuffle must be set before the first event");
  tie_shuffle_ = key & ((1ULL << 60) - 1);
}

void Simulation::push_shuffled(TrueTime time, std::uint64_t order, std::uint64_t serial_kind, std::uint64_t argument) {
  queue_.push({time, with_ids(order, tie_shuffle_, scramble), serial_kind, argument});
}

std::uint64_t Simulation::unshuffled(std::uint64_t order) const { return with_ids(order, tie_shuffle_, unscramble); }

bool Simulation::run(TrueTime until, std::uint64_t max_events) {
  if (tie_shuffle_ != 0) return loop<true, false>(until, max_events);
  return has_many_components() ? loop<false, true>(until, max_events) : loop<false, false>(until, max_events);
}

/// Three steps: the component itself, then what it will need, then what only that leads to.
inline void Simulation::look_ahead() const {
  constexpr std::uint32_t far = 7;
  constexpr std::uint32_t nearer = 4;
  constexpr std::uint32_t nearest = 2;
  Component* const* const components = components_.data();
  if (const Event* const event = queue_.upcoming(far)) [[likely]] {
    __builtin_prefetch(components[event->target().index]);
    const Event& second = event[far - nearer];
    const Event& third = event[far - nearest];
    components[second.target().index]->prefetch(second, Component::Ahead::two_events);
    components[third.target().index]->prefetch(third, Component::Ahead::one_event);
    return;
  }
  if (const Event* const event = queue_.upcoming(nearer))
    components[event->target().index]->prefetch(*event, Component::Ahead::two_events);
  if (const Event* const event = queue_.upcoming(nearest))
    components[event->target().index]->prefetch(*event, Component::Ahead::one_event);
}

template <bool is_shuffled, bool looks_ahead>
bool Simulation::loop(TrueTime until, std::uint64_t max_events) {
  const std::uint64_t stop_at = max_events > ~0ULL - events_ ? ~0ULL : events_ + max_events;
  const TrueTime last = std::min(until, TrueTime::never() - Duration::from_ps(1));
  // From so many events on it looks whether to stop, and how many are pending.
  std::uint64_t pause_at = std::min(stop_at, (events_ | 0x3FF) + 1);
  try {
    for (;;) {
      const Event* first = queue_.first();
      if (first == nullptr || first->time > last) break;
      if (events_ >= pause_at) [[unlikely]] {
        if (events_ >= stop_at && first->time > now()) {
          event_.order = 0;
          return false;
        }
        pending_peak_ = std::max(pending_peak_, queue_.size());
        queue_.tune(events_ - tuned_at_);
        tuned_at_ = events_;
        pause_at = std::min(stop_at, (events_ | 0x3FF) + 1);
        first = queue_.first();
      }
      event_ = *first;
      queue_.drop_first();
      if constexpr (looks_ahead) look_ahead();
      ++events_;
      if constexpr (is_shuffled) {
        const Event event(event_.time, at_work(), event_.serial_kind, event_.argument);
        components_[event.target().index]->handle(*this, event);
      } else {
        components_[event_.target().index]->handle(*this, event_);
      }
      if (!deciding_.empty()) [[unlikely]]
        decide_all();
    }
  } catch (const InvariantBroken& broken) {
    rethrow_with_context(broken);
  }
  event_ = Event(std::max(now(), until), 0, 0, 0);
  return true;
}

/// Of the node at work, if that was its last event of the instant.
void Simulation::decide_all() {
  const Event* const next = queue_.next_at(now());
  if (next != nullptr && Event::place_of(next->order ^ event_.order) == 0) return;
  event_.order = Event::with_phase(event_.order, Phase::decision) & ~Event::is_own;
  // A component may ask again while it decides; the list may therefore grow.
  while (decided_ < deciding_.size()) deciding_[decided_++].component->decide(*this);
  deciding_.clear();
  decided_ = 0;
}

void Simulation::decide_later_slow(ComponentId component, Decision decision, std::uint64_t order) {
  if (Event::place_of(order ^ at_work()) != 0) {
    EventSource source(component);
    schedule(source, now(), order, decide_now, 0);
    return;
  }
  auto at = deciding_.end();
  while (at != deciding_.begin() + static_cast<std::ptrdiff_t>(decided_) && decision < at[-1].decision) --at;
  deciding_.insert(at, {components_[component.index], decision});
}

/// What is scheduled for the present instant, and everything under the tie shuffle.
void Simulation::push_checked(TrueTime time, std::uint64_t order, std::uint64_t serial_kind, std::uint64_t argument) {
  TAKT_CHECK(time >= now(), "an event cannot be scheduled in the past");
  if (time == now() && Event::place_of(order ^ at_work()) != 0) {
    const std::uint64_t stage = order >> Event::stage_shift;
    const std::uint64_t stage_at_work = event_.order >> Event::stage_shift;
    TAKT_CHECK(stage > stage_at_work || stage_at_work == 0,
               "nothing of one node reaches another one at the same instant");
  }
  if (tie_shuffle_ != 0)
    push_shuffled(time, order, serial_kind, argument);
  else
    queue_.push({time, order, serial_kind, argument});
}

void Simulation::rethrow_with_context(const InvariantBroken& broken) const {
  const Event event(event_.time, at_work(), event_.serial_kind, event_.argument);
  throw InvariantBroken(std::string(broken.what()) + "\n  at " + std::to_string(now().ps()) + " ps, event " +
                        std::to_string(events_) + " (kind " + std::to_string(event.kind()) + " for component " +
                        std::to_string(event.target().index) + "), seed " + std::to_string(seed_));
}

}  // namespace takt::sim
