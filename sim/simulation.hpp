// The kernel: virtual time, the event loop, settling, digest and trace. It knows no network.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "sim/check.hpp"
#include "sim/digest.hpp"
#include "sim/event.hpp"
#include "sim/event_queue.hpp"
#include "sim/trace.hpp"

namespace takt::sim {

class Simulation;

/// Anything that receives events. Components are owned by the model; the kernel keeps a reference.
class Component {
 public:
  virtual ~Component() = default;
  /// An event for this component has come due; simulation.now() is its time.
  virtual void handle(Simulation& simulation, const Event& event) = 0;
  /// How near an event is that prefetch() is told of.
  enum class Ahead : std::uint8_t { two_events, one_event };
  /// `event` will soon be handled: brings what it will need towards the cache, first what is found at once, then what only
  /// that leads to. Called in large simulations only, changes nothing.
  virtual void prefetch(const Event& event, Ahead ahead) const { static_cast<void>(event), static_cast<void>(ahead); }
  /// The instant at which this component called settle_later() is complete: every event of it has been handled.
  virtual void settle(Simulation& simulation) { static_cast<void>(simulation); }
};

/// One run. An object: many of them can live in one process and in threads side by side.
class Simulation {
 public:
  explicit Simulation(std::uint64_t seed) : seed_(seed) {}
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  /// Registers a component; it must outlive the run. Ids are dense and given in order.
  ComponentId add(Component& component);

  TrueTime now() const { return now_; }
  std::uint64_t seed() const { return seed_; }
  std::uint64_t event_count() const { return events_; }
  /// The event that is being handled is there for a recorder only: without one it would not be, and a run counts the same with and without.
  void uncount_event() { --events_; }
  std::size_t pending() const { return queue_.size(); }
  std::size_t pending_peak() const { return pending_peak_; }

  /// Schedules an event. `time` is not before now().
  void schedule(EventSource& source, TrueTime time, Phase phase, ComponentId target, EventKind kind,
                std::uint64_t argument) {
    schedule(source, time, Event::order_of(phase, target, source.id()), kind, argument);
  }

  /// The same for who schedules many events to one target in one phase and has made the word of their order once.
  void schedule(EventSource& source, TrueTime time, std::uint64_t order, EventKind kind, std::uint64_t argument) {
    TAKT_CHECK(time >= now_, "an event cannot be scheduled in the past");
    const std::uint64_t serial_kind = source.next_serial_word() | kind;
    if (tie_shuffle_ != 0) [[unlikely]]
      push_shuffled(time, order, serial_kind, argument);
    else
      queue_.push({time, order, serial_kind, argument});
  }

  // One run in several simulations at once, of which each acts for some of the components: see models/parts.
  /// An event of a source that acts in another simulation of the same run. Precondition: run() has not come to `time` yet.
  void receive(TrueTime time, std::uint64_t order, std::uint64_t serial_kind, std::uint64_t argument) {
    TAKT_CHECK(time > now_, "an event of another part comes before its time");
    if (tie_shuffle_ != 0) [[unlikely]]
      push_shuffled(time, order, serial_kind, argument);
    else
      queue_.push({time, order, serial_kind, argument});
  }
  /// The time of the next event, or never. Precondition: run() has come to an end.
  TrueTime next_time() { return queue_.first_time(); }
  /// What has happened in another simulation of the same run has happened here, but for the last `repeated` events, which were handled in both.
  void adopt(const Simulation& other, std::uint64_t repeated) {
    events_ += other.events_ - repeated;
    digest_.add(other.digest_);
  }

  /// Asks for component.settle() at the end of the present instant. The component remembers that it has asked.
  void settle_later(Component& component) { settling_.push_back(&component); }

  /// The same for a component whose settling is what others wait for: it settles before all who asked by settle_later().
  void settle_first(Component& component) { settling_.insert(settling_.begin() + settling_first_++, &component); }

  /// Asks for component.settle() when the present instant is over for all nodes: every event has been handled, and all who asked have settled. For monitors, which
  /// see what several nodes did and cause nothing.
  void judge_later(Component& component) { judging_.push_back(&component); }

  /// True if nothing else happens at the present instant: no event is pending for it and nobody waits to settle. A handler
  /// may then do as its last act what it would otherwise leave to settle().
  bool instant_is_complete() { return settling_.empty() && queue_.has_none_until(now_); }
  /// The same as far as it is known without work: false also where instant_is_complete() must be asked.
  bool instant_is_surely_complete() const {
    const Event* const next = queue_.upcoming(0);
    return next != nullptr && next->time > now_ && settling_.empty();
  }

  /// Whether the next event is for the same component, in the same phase of the present instant. Those of one component follow one another, but with
  /// the tie shuffle. Precondition: `event` is being handled, and events_follow_targets().
  bool another_follows(const Event& event) {
    const Event* const next = queue_.next_at(now_);
    return next != nullptr && (next->order ^ event.order) >> Event::source_bits == 0;
  }
  /// True if no other one follows, as far as that is known without work: false also where another_follows() must be asked.
  bool surely_none_follows(const Event& event) const {
    const Event* const next = queue_.upcoming(0);
    return next != nullptr && (next->time > now_ || (next->order ^ event.order) >> Event::source_bits != 0);
  }
  /// Neither the tie shuffle nor a recorder, which is told in the order of settling, is there.
  bool events_follow_targets() const { return tie_shuffle_ == 0 && trace_ == nullptr; }
  /// Whether their state does not stay in the nearest caches.
  bool has_many_components() const { return components_.size() >= many_components; }

  /// Handles the events up to and including `until`, at most about `max_events` of them. Returns true when `until` has been
  /// reached (now() is `until` then), false when there is more to do. It never stops in the middle of an instant.
  bool run(TrueTime until, std::uint64_t max_events = ~0ULL);

  Digest& digest() { return digest_; }
  const Digest& digest() const { return digest_; }

  /// The recorder, or null. Recording costs one predictable branch when nobody listens.
  TraceSink* trace() const { return trace_; }
  void set_trace(TraceSink* sink) { trace_ = sink; }

  /// Tests only: permutes events that are equal in (time, phase), except those of one source to one target, which are
  /// cause and effect. Results must not change. 0 switches it off. To be called before anything is scheduled.
  void set_tie_shuffle(std::uint64_t key);

 private:
  /// From so many components on, their state does not stay in the nearest caches: the loop then looks ahead.
  static constexpr std::size_t many_components = 2048;
  template <bool is_shuffled, bool looks_ahead>
  bool loop(TrueTime until, std::uint64_t max_events);
  void look_ahead() const;
  void settle_all();
  void judge_all();
  void push_shuffled(TrueTime time, std::uint64_t order, std::uint64_t serial_kind, std::uint64_t argument);
  std::uint64_t unshuffled(std::uint64_t order) const;
  [[noreturn]] void rethrow_with_context(const InvariantBroken& broken, const Event& event) const;

  TrueTime now_;
  std::vector<Component*> components_;
  std::vector<Component*> settling_;
  std::vector<Component*> judging_;
  std::ptrdiff_t settling_first_ = 0;  // so many at the front of settling_ asked by settle_first()
  EventQueue queue_;
  std::uint64_t events_ = 0;
  std::uint64_t tuned_at_ = 0;         // events_ when the queue was told last
  std::size_t pending_peak_ = 0;
  Digest digest_;
  TraceSink* trace_ = nullptr;
  std::uint64_t seed_;
  std::uint64_t tie_shuffle_ = 0;
};

}  // namespace takt::sim
