// SPDX-License-Identifier: Apache-2.0
// The kernel: virtual time, the event loop, the end of a node's instant, digest and trace. It knows no network.
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
  /// Prefetch distance.
  enum class Ahead : std::uint8_t { two_events, one_event };
  /// `event` will soon be handled: brings what it will need towards the cache, first what is found at once, then what
  /// only that leads to. Called in large simulations only, changes nothing.
  virtual void prefetch(const Event& event, Ahead ahead) const { static_cast<void>(event), static_cast<void>(ahead); }
  /// Follows decide_later(): every event of the node at this instant has been handled.
  virtual void decide(Simulation& simulation) { static_cast<void>(simulation); }
};

/// What a node decides first at the end of its instant, since others decide about what comes of it.
enum class Decision : std::uint8_t {
  ingress,    ///< frames that have come pass on
  processor,  ///< jobs end and begin
  reception,  ///< a host takes frames in
  egress,     ///< ports select what they send
};

/// One run. An object: many of them can live in one process and in threads side by side.
class Simulation {
 public:
  explicit Simulation(std::uint64_t seed) : seed_(seed) {}
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  /// Registers a component; it must outlive the run. Ids are dense and given in order.
  ComponentId add(Component& component);
  /// The component belongs to the node that has the id of `front`, a component that belongs to itself. Others are nodes
  /// of their own. Before the component schedules an event.
  void group(ComponentId component, ComponentId front);
  ComponentId node_of(ComponentId component) const { return node_of_[component.index]; }

  TrueTime now() const { return event_.time; }
  std::uint64_t seed() const { return seed_; }
  std::uint64_t event_count() const { return events_; }
  /// Excludes the event that is being handled from event_count(): one that exists only for tracing, or only to have a
  /// node decide or judged.
  void uncount_event() { --events_; }
  std::size_t pending() const { return queue_.size(); }
  std::size_t pending_peak() const { return pending_peak_; }

  /// Schedules an event for `target`: the source itself, or a component whose id its node has. `time` is not before
  /// now(). At the present instant nothing of a node reaches another node; control reaches all nodes, and monitors are
  /// reached by all.
  void schedule(EventSource& source, TrueTime time, Phase phase, ComponentId target, EventKind kind,
                std::uint64_t argument) {
    schedule(source, time, order_of(phase, target, source.id()), kind, argument);
  }
  /// The order of such events, for a component that schedules many and makes the word once.
  std::uint64_t order_of(Phase phase, ComponentId target, ComponentId source) const {
    return target == source ? Event::own_order_of(phase, node_of(source), source)
                            : Event::order_of(phase, target, source);
  }
  void schedule(EventSource& source, TrueTime time, std::uint64_t order, EventKind kind, std::uint64_t argument) {
    const std::uint64_t serial_kind = source.next_serial_word() | kind;
    if (time <= now() || tie_shuffle_ != 0) [[unlikely]]
      push_checked(time, order, serial_kind, argument);
    else
      queue_.push({time, order, serial_kind, argument});
  }

  // One run in several simulations at once, of which each acts for some of the components: see models/parts.
  /// An event of a source that acts in another simulation of the same run. Precondition: run() has not come to `time`
  /// yet.
  void receive(TrueTime time, std::uint64_t order, std::uint64_t serial_kind, std::uint64_t argument) {
    TAKT_CHECK(time > now(), "an event of another part comes before its time");
    if (tie_shuffle_ != 0) [[unlikely]]
      push_shuffled(time, order, serial_kind, argument);
    else
      queue_.push({time, order, serial_kind, argument});
  }
  /// The time of the next event, or never. Precondition: run() has come to an end.
  TrueTime next_time() { return queue_.first_time(); }
  /// What has happened in another simulation of the same run has happened here, but for the last `repeated` events,
  /// which were handled in both.
  void adopt(const Simulation& other, std::uint64_t repeated) {
    events_ += other.events_ - repeated;
    digest_.add(other.digest_);
  }

  /// True if the event that is being handled is the last one of its node at this instant, and no component of the node
  /// is to decide. Then what a handler does as its last act need not wait for decide(). False also where the next event
  /// is not known without work; then decide() follows at once.
  bool is_last() const {
    const Event* const next = queue_.upcoming(0);
    return next != nullptr && (next->time > now() || Event::place_of(next->order ^ event_.order) != 0) &&
           deciding_.empty();
  }
  /// Asks for component.decide() at the end of the present instant of the component's node. The component remembers
  /// that it has asked. Where another node is at work (as a script is), it gets an event of kind decide_now and asks
  /// again.
  void decide_later(ComponentId component, Decision decision) {
    const std::uint64_t order = Event::own_order_of(Phase::decision, node_of(component), component);
    if (Event::place_of(order ^ event_.order) == 0 && tie_shuffle_ == 0 &&
        (deciding_.empty() || deciding_.back().decision <= decision)) [[likely]] {
      deciding_.push_back({components_[component.index], decision});
    } else {
      decide_later_slow(component, decision, order);
    }
  }
  static constexpr EventKind decide_now = 0xFFF0;
  /// Of the event that is being handled; `decision` while components decide.
  Phase phase() const { return Event::phase_of(event_.order); }
  /// Who handles it; the node while its components decide.
  ComponentId target() const { return Event(now(), at_work(), 0, 0).target(); }

  /// Whether the state of components does not stay in the nearest caches.
  bool has_many_components() const { return components_.size() >= many_components; }

  /// Handles the events up to and including `until`, at most about `max_events` of them. Returns true when `until` has
  /// been reached (now() is `until` then), false when there is more to do. It never stops in the middle of an instant.
  bool run(TrueTime until, std::uint64_t max_events = ~0ULL);

  Digest& digest() { return digest_; }
  const Digest& digest() const { return digest_; }

  /// The recorder, or null. Recording costs one predictable branch when nobody listens.
  TraceSink* trace() const { return trace_; }
  void set_trace(TraceSink* sink) { trace_ = sink; }

  /// Tests only: permutes the nodes of an instant, and the sources within a phase of a node. Events of one source to
  /// one target are cause and effect and keep their order. Results must not change. 0 switches it off. To be called
  /// before anything is scheduled.
  void set_tie_shuffle(std::uint64_t key);

 private:
  /// From so many components on, their state does not stay in the nearest caches: the loop then looks ahead.
  static constexpr std::size_t many_components = 2048;
  struct Decides {
    Component* component;
    Decision decision;
  };
  template <bool is_shuffled, bool looks_ahead>
  bool loop(TrueTime until, std::uint64_t max_events);
  void look_ahead() const;
  [[gnu::noinline]] void decide_all();
  [[gnu::noinline]] void decide_later_slow(ComponentId component, Decision decision, std::uint64_t order);
  void push_checked(TrueTime time, std::uint64_t order, std::uint64_t serial_kind, std::uint64_t argument);
  void push_shuffled(TrueTime time, std::uint64_t order, std::uint64_t serial_kind, std::uint64_t argument);
  std::uint64_t unshuffled(std::uint64_t order) const;
  /// Order of the event that is being handled.
  std::uint64_t at_work() const { return tie_shuffle_ == 0 ? event_.order : unshuffled(event_.order); }
  [[noreturn]] void rethrow_with_context(const InvariantBroken& broken) const;

  Event event_;  // that is being handled, as it was in the queue; its time is now(). Between runs one of control
  std::vector<Component*> components_;
  std::vector<ComponentId> node_of_;  // by component
  std::vector<Decides> deciding_;     // at the end of the present instant of the node at work, in the order of Decision
  std::size_t decided_ = 0;           // so many of them have been asked to
  EventQueue queue_;
  std::uint64_t events_ = 0;
  std::uint64_t tuned_at_ = 0;  // events_ at the last tuning of the queue
  std::size_t pending_peak_ = 0;
  Digest digest_;
  TraceSink* trace_ = nullptr;
  std::uint64_t seed_;
  std::uint64_t tie_shuffle_ = 0;
};

}  // namespace takt::sim
