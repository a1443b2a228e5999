#include "sim/simulation.hpp"

#include <algorithm>
#include <string>

namespace takt::sim {
namespace {

// A bijection on 60 bits: two rounds of odd multiplication and xor-shift, so that the target can be found again.
constexpr std::uint64_t multiplier = 0x5851F42D4C957F2DULL;

constexpr std::uint64_t inverse_of(std::uint64_t odd) {
  std::uint64_t inverse = odd;  // Newton's iteration doubles the number of right bits each time
  for (int i = 0; i < 6; ++i) inverse *= 2 - odd * inverse;
  return inverse;
}
static_assert(multiplier * inverse_of(multiplier) == 1);

constexpr std::uint64_t scramble(std::uint64_t x, std::uint64_t key) {
  for (int round = 0; round < 2; ++round) {
    x = ((x ^ key) * multiplier) & Event::pair_mask;
    x ^= x >> 30;
  }
  return x & Event::pair_mask;
}

constexpr std::uint64_t unscramble(std::uint64_t x, std::uint64_t key) {
  for (int round = 0; round < 2; ++round) {
    x ^= x >> 30;  // its own inverse, since 30 is half of 60
    x = ((x * inverse_of(multiplier)) & Event::pair_mask) ^ key;
  }
  return x & Event::pair_mask;
}

constexpr std::uint64_t phase_mask = ~Event::pair_mask;

}  // namespace

ComponentId Simulation::add(Component& component) {
  TAKT_CHECK(components_.size() < max_components, "too many components");
  components_.push_back(&component);
  return {static_cast<std::uint32_t>(components_.size() - 1)};
}

void Simulation::set_tie_shuffle(std::uint64_t key) {
  TAKT_CHECK(queue_.empty() && events_ == 0, "tie shuffle must be set before the first event");
  tie_shuffle_ = key & Event::pair_mask;
}

void Simulation::push_shuffled(TrueTime time, std::uint64_t order, std::uint64_t serial_kind, std::uint64_t argument) {
  queue_.push({time, (order & phase_mask) | scramble(order & Event::pair_mask, tie_shuffle_), serial_kind, argument});
}

std::uint64_t Simulation::unshuffled(std::uint64_t order) const {
  return (order & phase_mask) | unscramble(order & Event::pair_mask, tie_shuffle_);
}

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
  if (const Event* const event = queue_.upcoming(nearer)) components[event->target().index]->prefetch(*event, Component::Ahead::two_events);
  if (const Event* const event = queue_.upcoming(nearest)) components[event->target().index]->prefetch(*event, Component::Ahead::one_event);
}

template <bool is_shuffled, bool looks_ahead>
bool Simulation::loop(TrueTime until, std::uint64_t max_events) {
  const std::uint64_t stop_at = max_events > ~0ULL - events_ ? ~0ULL : events_ + max_events;
  const TrueTime last = std::min(until, TrueTime::never() - Duration::from_ps(1));
  // From so many events on it looks whether to stop, and how many are pending.
  std::uint64_t pause_at = std::min(stop_at, (events_ | 0x3FF) + 1);
  Event event;
  try {
    for (;;) {
      if (!settling_.empty() && queue_.has_none_until(now_)) {
        settle_all();
        continue;
      }
      const TrueTime next = queue_.first_time();
      if (!judging_.empty() && next > now_) [[unlikely]] judge_all();
      if (next > last) break;
      if (events_ >= pause_at) [[unlikely]] {
        if (events_ >= stop_at && next > now_) return false;
        pending_peak_ = std::max(pending_peak_, queue_.size());
        queue_.tune(events_ - tuned_at_);
        tuned_at_ = events_;
        pause_at = std::min(stop_at, (events_ | 0x3FF) + 1);
      }
      event = queue_.pop();
      if constexpr (is_shuffled) event.order = unshuffled(event.order);
      if constexpr (looks_ahead) look_ahead();
      now_ = event.time;
      ++events_;
      components_[event.target().index]->handle(*this, event);
    }
  } catch (const InvariantBroken& broken) {
    rethrow_with_context(broken, event);
  }
  now_ = std::max(now_, until);
  return true;
}

void Simulation::settle_all() {
  // A component may ask again while it settles (never for itself twice); the list may therefore grow.
  for (std::size_t i = 0; i < settling_.size(); ++i) settling_[i]->settle(*this);
  settling_.clear();
  settling_first_ = 0;
}

void Simulation::judge_all() {
  for (Component* const component : judging_) component->settle(*this);
  judging_.clear();
}

void Simulation::rethrow_with_context(const InvariantBroken& broken, const Event& event) const {
  throw InvariantBroken(std::string(broken.what()) + "\n  at " + std::to_string(now_.ps()) + " ps, event " +
                        std::to_string(events_) + " (kind " + std::to_string(event.kind()) + " for component " +
                        std::to_string(event.target().index) + "), seed " + std::to_string(seed_));
}

}  // namespace takt::sim
