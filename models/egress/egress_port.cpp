// SPDX-License-Identifier: Apache-2.0
#include "models/egress/egress_port.hpp"

#include <algorithm>
#include <utility>

namespace takt::models {
namespace {

/// Stable, in place and without allocation; the frames of one instant are few.
template <class Arrivals>
void sort_by_rank(Arrivals& arrivals) {
  for (std::size_t i = 1; i < arrivals.size(); ++i)
    for (std::size_t j = i; j > 0 && arrivals[j].rank < arrivals[j - 1].rank; --j)
      std::swap(arrivals[j], arrivals[j - 1]);
}

}  // namespace

void EgressPort::connect(sim::Simulation& simulation, sim::ComponentId node, Shared& shared, const PortConfig& config,
                         const LocalClock& clock, sim::Duration octet_time, LinkEnd far_end, Link& incoming) {
  TAKT_CHECK(shared_ == nullptr, "a port has one link");
  const sim::ComponentId id = simulation.add(*this);
  simulation.group(id, node);
  link_.connect(id, node, *shared.traffic, octet_time, far_end);
  shared_ = &shared;
  config_ = &config;
  clock_ = &clock;
  incoming_ = &incoming;
  strict_priority_classes_ = static_cast<ClassSet>(~config.shaping.shared());
  if (!config.shaping.is_plain()) make_shaping();
  if (config.preemption || config.cut_through != 0 || config.untagged || strict_priority_classes_ != every_class)
    make_extras();
  if (config.preemption) extras_->merge = std::make_unique<MacMerge>(*config.preemption, octet_time);
  if (config.cut_through != 0) link_.check_arrivals();
}

/// To be called when frames begin or cease to wait.
void EgressPort::note_waiting() {
  const bool selects = extras_ && (!only_merges_ || extras_->merge->rest());
  starts_single_ = queues_.empty() && !selects && !(shaping_ && shaping_->limits_sdu());
  starts_at_once_ = starts_single_ && has_queues_only();
}

/// To be called when the port gets other features.
void EgressPort::note_features() {
  only_merges_ = extras_ && extras_->merge && !shaping_ && link_.is_plain() && !extras_->expects_headers;
  note_waiting();
}

PortShaping& EgressPort::make_shaping() {
  if (!shaping_) shaping_ = std::make_unique<PortShaping>(config_->shaping, *clock_, octet_time());
  note_features();
  return *shaping_;
}

EgressPort::Extras& EgressPort::make_extras() {
  if (!extras_) extras_ = std::make_unique<Extras>();
  return *extras_;
}

void EgressPort::prepare() {
  if (!link_.is_plain()) make_extras();
  note_features();
}

void EgressPort::handle(sim::Simulation& simulation, const sim::Event& event) {
  if (event.kind() == wake_up) [[likely]] {
    if (single_talker_port_) [[unlikely]]
      simulation.uncount_event();  // there for the recorder only
    wake(simulation, event.time);
  } else if (event.kind() == sim::Simulation::decide_now) {
    simulation.uncount_event();
    simulation.decide_later(id(), sim::Decision::egress);
  } else {
    handle_stored_frame(simulation, event);
  }
}

inline void EgressPort::wake(sim::Simulation& simulation, sim::TrueTime time) {
  if (time != wake_at_) return;  // an earlier wake-up took its place
  wake_at_ = sim::TrueTime::never();
  if (simulation.is_last()) [[likely]]
    decide_now(simulation);
  else
    decide_later(simulation);
}

void EgressPort::decide_later(sim::Simulation& simulation) {
  if (will_decide_) return;
  will_decide_ = true;
  simulation.decide_later(id(), sim::Decision::egress);
}

void EgressPort::offer(sim::Simulation& simulation, FrameIndex frame, std::uint32_t rank) {
  if (!has_arrival_) {
    has_arrival_ = true;
    arrival_ = {frame, rank};
  } else {
    more_arrivals_.push_back({frame, rank});
  }
  decide_later(simulation);
}

inline void EgressPort::enqueue(sim::Simulation& simulation, FrameIndex frame) {
  const Frame& record = shared_->traffic->frame(frame);
  const TrafficClass q = config_->traffic_class_of_priority[record.queue_priority];
  DropReason reason{};
  const bool has_room = queues_.has_room(q, record.length, config_->queue_limits[q], reason);
  if (!has_room || simulation.trace() != nullptr || (shaping_ && shaping_->is_timed(q))) [[unlikely]]
    enqueue_slow(simulation, frame, record, q);
  else
    queues_.push(q, frame, record.length, shared_->entries);
}

/// A frame that comes alone to the free medium while nothing waits.
inline void EgressPort::start_single(sim::Simulation& simulation, FrameIndex frame, const Frame& record) {
  const TrafficClass q = config_->traffic_class_of_priority[record.queue_priority];
  if (shaping_) {
    if (!shaping_->starts_at_once(simulation.now(), q, record)) [[unlikely]] {
      start_if_shaping_allows(simulation, frame, record);
      return;
    }
    sending_ = q;
  }
  if (extras_)
    start_merging(simulation, frame, record, q);
  else
    start(simulation, frame, record);
}

/// Of the only frame of this instant, which does not just start.
void EgressPort::offer_single(sim::Simulation& simulation, FrameIndex frame, const Frame& record, std::uint32_t rank) {
  if (simulation.now() >= link_.free_at() && starts_single_) {
    start_single(simulation, frame, record);
    return;
  }
  has_arrival_ = true;
  arrival_ = {frame, rank};
  decide_now(simulation);
}

void EgressPort::decide(sim::Simulation& simulation) {
  will_decide_ = false;
  decide_now(simulation);
}

/// Which case it is. Each is a tail call, so that the common ones save no registers.
void EgressPort::decide_now(sim::Simulation& simulation) {
  if (!more_arrivals_.empty() || (extras_ && !only_merges_)) [[unlikely]] {
    select_and_start(simulation);
  } else if (!has_arrival_) {
    !shaping_ || is_one_class(queues_.waiting()) ? start_waiting(simulation) : select_and_start(simulation);
  } else if (simulation.now() < link_.free_at()) {
    enqueue_behind_busy_medium(simulation);
  } else if (starts_single_) {
    has_arrival_ = false;
    start_single(simulation, arrival_.frame, shared_->traffic->frame(arrival_.frame));
  } else if (simulation.now() < head_eligible_at_ && head_eligible_at_ != sim::TrueTime::never() &&
             simulation.trace() == nullptr) {
    enqueue_behind_known_head(simulation);
  } else {
    select_and_start(simulation);
  }
}

/// The same where the cheap tests say nothing.
void EgressPort::start_if_shaping_allows(sim::Simulation& simulation, FrameIndex frame, const Frame& record) {
  const TrafficClass q = config_->traffic_class_of_priority[record.queue_priority];
  const sim::TrueTime ready = shaping_->start_slow(simulation.now(), q, {record.length, eligible_of(record)});
  if (ready == simulation.now()) [[likely]] {
    sending_ = q;
    start(simulation, frame, record);
    return;
  }
  enqueue(simulation, frame);
  note_waiting();
  head_eligible_at_ = shaping_->is_gated_only(q) ? ready : sim::TrueTime::never();
  if (queues_.empty()) return;  // a frame that found no room is no more, and nobody waits
  if (simulation.trace() != nullptr) [[unlikely]]
    trace_blocked(simulation, q, frame, ready);
  wake_at(simulation, ready);
}

/// One frame has come to a busy medium: whatever waits, it waits, too.
void EgressPort::enqueue_behind_busy_medium(sim::Simulation& simulation) {
  has_arrival_ = false;
  head_eligible_at_ = sim::TrueTime::never();
  if (shaping_) {
    if (shaping_->limits_sdu() && !passes_max_sdu(simulation, arrival_.frame)) return;
    shaping_->frame_waits(simulation.now(), class_of(arrival_.frame));
  }
  enqueue(simulation, arrival_.frame);
  has_new_head_ = false;  // the heads are looked at when the medium is free
  wait_for_medium(simulation);
}

/// One frame has come to a free medium, where others wait for a gate that has promised when the first of them may
/// start: it waits behind them if they are of its class.
void EgressPort::enqueue_behind_known_head(sim::Simulation& simulation) {
  const TrafficClass q = class_of(arrival_.frame);
  if (queues_.waiting() == only(q) && !shaping_->is_timed(q) && !shaping_->limits_sdu()) [[likely]] {
    has_arrival_ = false;
    enqueue(simulation, arrival_.frame);
    if (!has_new_head_) [[likely]]
      return;
    has_new_head_ = false;
  }
  select_and_start(simulation);
}

/// The medium is busy. Where express frames wait, a preemptable frame under way may be cut.
inline void EgressPort::wait_for_medium(sim::Simulation& simulation) {
  if (const MacMerge* const merge = merge_of();
      merge != nullptr && merge->under_way() && (queues_.waiting() & ~merge->preemptable()) != 0)
    if (const std::optional<MacMerge::Cut> earliest = merge->earliest_cut(simulation.now())) cut(simulation, *earliest);
  note_waiting();
  if (!queues_.empty() || (extras_ && extras_->merge->rest())) wake_at(simulation, link_.free_at());
}

/// A port wakes up, and frames of one class wait, or of several which nothing but their order keeps. At a port that
/// preempts express frames come first, then the rest of a frame that was cut.
void EgressPort::start_waiting(sim::Simulation& simulation) {
  const sim::TrueTime now = simulation.now();
  if (now < link_.free_at()) {
    wait_for_medium(simulation);
    return;
  }
  ClassSet waiting = queues_.waiting();
  if (MacMerge* const merge = merge_of(); merge != nullptr) {
    const auto express = static_cast<ClassSet>(waiting & ~merge->preemptable());
    if (express == 0 && merge->rest()) {
      resume(simulation);
      wait_for_medium(simulation);
      return;
    }
    if (express != 0) waiting = express;
  }
  if (waiting == 0) {
    note_waiting();
    return;
  }
  const TrafficClass q = highest_class(waiting);
  const FrameIndex frame = queues_.head(q, shared_->entries);
  const Frame& record = shared_->traffic->frame(frame);
  if (shaping_) {
    const sim::TrueTime ready = head_eligible_at_ == now ? now : shaping_->ready_time_of_head(now, q, record);
    if (ready != now) {
      if (simulation.trace() != nullptr) [[unlikely]]
        trace_blocked(simulation, q, frame, ready);
      wake_at(simulation, ready);
      return;
    }
  }
  pop(simulation, q);
  if (shaping_) {
    shaping_->started(now, q, record.length, queues_.frames(q) == 0);
    sending_ = q;
  }
  if (extras_)
    start_merging(simulation, frame, record, q);
  else
    start(simulation, frame, record);
  note_waiting();
  if (!queues_.empty() || (extras_ && extras_->merge->rest())) wake_at(simulation, link_.free_at());
}

/// The general case: whatever has come at this instant and waits. One frame starts, if it may, and the others wait.
void EgressPort::select_and_start(sim::Simulation& simulation) {
  head_eligible_at_ = sim::TrueTime::never();
  if (has_arrival_) more_arrivals_.insert(more_arrivals_.begin(), arrival_);
  has_arrival_ = false;
  if (!link_.is_up()) {
    for (const Arrival& arrival : more_arrivals_) drop(simulation, arrival.frame, DropReason::link_down);
    more_arrivals_.clear();
    store_headers(simulation, Storing::link_down);
    return;
  }
  sort_by_rank(more_arrivals_);
  const sim::TrueTime now = simulation.now();
  if (!shaping_ && !extras_) {  // only the classes count: worth a path of its own, since such ports are most of all
    if (now >= link_.free_at()) start_highest(simulation);
    enqueue_arrivals(simulation);
    note_waiting();
    if (!queues_.empty()) wake_at(simulation, link_.free_at());
    return;
  }
  if (shaping_) {
    std::erase_if(more_arrivals_, [&](const Arrival& arrival) { return !passes_max_sdu(simulation, arrival.frame); });
    for (const Arrival& arrival : more_arrivals_) shaping_->frame_waits(now, class_of(arrival.frame));
  }
  MacMerge* const merge = extras_ ? extras_->merge.get() : nullptr;
  sim::TrueTime next = link_.free_at();
  if (now >= next) {
    if (simulation.trace() != nullptr) [[unlikely]]
      trace_all_blocked(simulation);
    const Selection selection = select_at_free_medium(now);
    next = selection.ask_again;
    if (selection.found) {
      if (selection.is_rest)
        resume(simulation);
      else
        start_first(simulation, selection);
    }
    if (selection.found || cut_through(simulation)) {
      // An express frame that waits for its gate or its credit may want to cut what has just started.
      next = merge == nullptr ? link_.free_at() : merge->under_way() ? next_cut_or_end(simulation) : when_to_look(now);
      store_headers(simulation, Storing::goes_first);
    }
    enqueue_arrivals(simulation);
  } else {
    // A frame that finds no room is no reason to cut another one.
    enqueue_arrivals(simulation);
    if (merge != nullptr) next = next_cut_or_end(simulation);
    store_headers(simulation, Storing::medium_busy);
  }
  if (has_new_head_) [[unlikely]] {
    // What was selected, or asked to come again, knew other heads: those of now may start although the ones before them
    // might not.
    has_new_head_ = false;
    select_and_start(simulation);
    return;
  }
  note_waiting();
  if (!queues_.empty() || merge != nullptr) wake_at(simulation, next);
}

inline void EgressPort::start_highest(sim::Simulation& simulation) {
  int greatest = queues_.empty() ? -1 : highest_class(queues_.waiting());
  std::size_t first = more_arrivals_.size();  // none of this instant, but the head of a queue
  for (std::size_t i = 0; i < more_arrivals_.size(); ++i) {
    const int q = class_of(more_arrivals_[i].frame);
    if (q <= greatest) continue;
    greatest = q;
    first = i;
  }
  if (first < more_arrivals_.size()) {
    start(simulation, more_arrivals_[first].frame);
    more_arrivals_.erase(more_arrivals_.begin() + static_cast<std::ptrdiff_t>(first));
  } else if (greatest >= 0) {
    start(simulation, pop(simulation, static_cast<TrafficClass>(greatest)));
  }
}

inline void EgressPort::enqueue_arrivals(sim::Simulation& simulation) {
  for (const Arrival& arrival : more_arrivals_) enqueue(simulation, arrival.frame);
  more_arrivals_.clear();
}

/// The classes that have a frame, in their queue or among those of this instant.
ClassSet EgressPort::candidates() const {
  ClassSet candidates = queues_.waiting();
  for (const Arrival& arrival : more_arrivals_) candidates = with(candidates, class_of(arrival.frame));
  return candidates;
}

/// The first frame of a class: the head of its queue, or of those of this instant. In a timed class the one with the
/// earliest time.
EgressPort::First EgressPort::head_of_line(TrafficClass q) const {
  First first;
  if (queues_.frames(q) > 0) first.frame = queues_.head(q, shared_->entries);
  const bool is_timed = shaping_ && shaping_->is_timed(q);
  for (std::uint32_t i = 0; i < more_arrivals_.size(); ++i) {
    const FrameIndex frame = more_arrivals_[i].frame;
    if (class_of(frame) != q ||
        (!first.frame.is_none() && !(is_timed && eligible_of(frame) < eligible_of(first.frame))))
      continue;
    first = {frame, i};
  }
  return first;
}

/// Of these classes the most urgent one that may start, now or `delay` later. No lower one is blocked by a higher one
/// that may not (IEEE 802.1Q 8.6.8). Classes that share bandwidth come behind all others.
EgressPort::Selection EgressPort::select(sim::TrueTime now, ClassSet classes, sim::Duration delay) {
  Selection selection;
  for (ClassSet left = candidates() & classes & strict_priority_classes_; left != 0 && !selection.found;
       left = without(left, selection.traffic_class)) {
    selection.traffic_class = highest_class(left);
    selection.first = head_of_line(selection.traffic_class);
    const FrameIndex frame = selection.first.frame;
    const sim::TrueTime ready =
        shaping_ ? shaping_->ready_time(now, selection.traffic_class,
                                        {shared_->traffic->frame(frame).length, eligible_of(frame)}, delay)
                 : now;
    selection.found = ready == now;
    if (!selection.found) selection.ask_again = std::min(selection.ask_again, ready);
  }
  if (!selection.found && strict_priority_classes_ != every_class)
    select_by_share(now, candidates() & classes & static_cast<ClassSet>(~strict_priority_classes_), delay, selection);
  return selection;
}

/// Express frames come first; then the rest of a frame that was cut, before any other preemptable one.
EgressPort::Selection EgressPort::select_at_free_medium(sim::TrueTime now) {
  if (!extras_ || !extras_->merge) return select(now, every_class);
  const MacMerge& merge = *extras_->merge;
  const Selection express = select(now, static_cast<ClassSet>(~merge.preemptable()));
  if (express.found) return express;
  Selection other;
  if (merge.rest() || (candidates() & merge.preemptable()) != 0) {
    if (const HoldRequest hold = hold_request(now); hold.hold)
      other.ask_again = hold.until == sim::LocalTime::never() ? sim::TrueTime::never() : clock_->true_at(hold.until);
    else if (merge.rest())
      other = select_rest(now, *merge.rest());
    else
      other = select(now, merge.preemptable());
  }
  if (!other.found) other.ask_again = std::min(other.ask_again, express.ask_again);
  return other;
}

/// When to look again after a frame has started: at its end, or at a port that preempts when the MAC will be asked to
/// hold.
sim::TrueTime EgressPort::when_to_look(sim::TrueTime now) {
  if (!extras_ || !extras_->merge) return link_.free_at();
  const MacMerge& merge = *extras_->merge;
  sim::TrueTime next =
      queues_.empty() && more_arrivals_.empty() && !merge.rest() ? sim::TrueTime::never() : link_.free_at();
  if (merge.under_way() && now < link_.free_at()) {
    const HoldRequest hold = hold_request(now);
    if (!hold.hold && hold.until != sim::LocalTime::never())
      if (const sim::TrueTime begin = clock_->true_at(hold.until); begin < link_.free_at())
        next = std::min(next, begin);
  }
  return next;
}

void EgressPort::start_first(sim::Simulation& simulation, const Selection& selection) {
  const TrafficClass q = selection.traffic_class;
  if (selection.first.is_in_queue())
    pop(simulation, q);
  else
    more_arrivals_.erase(more_arrivals_.begin() + selection.first.arrival);
  const bool is_last = shaping_ && !contains(candidates(), q);
  start_selected(simulation, selection.first.frame, q, is_last);
}

FrameIndex EgressPort::pop(sim::Simulation& simulation, TrafficClass q) {
  const FrameIndex frame = queues_.pop(q, shared_->entries);
  if (sim::TraceSink* const trace = simulation.trace()) [[unlikely]]
    trace->record({simulation.now(), static_cast<std::uint32_t>(Occurrence::dequeued), id(), frame.value, q});
  return frame;
}

void EgressPort::start_selected(sim::Simulation& simulation, FrameIndex frame, TrafficClass q, bool queue_is_empty) {
  if (shaping_) {
    shaping_->started(simulation.now(), q, shared_->traffic->frame(frame).length, queue_is_empty);
    sending_ = q;
  }
  if (extras_)
    start_with_extras(simulation, frame, q);
  else
    start(simulation, frame);
}

void EgressPort::drop(sim::Simulation& simulation, FrameIndex frame, DropReason reason) {
  ++frames_dropped_;
  shared_->traffic->drop(frame, reason, id(), simulation);
}

/// Puts a frame on the free medium. Nothing that is called here comes back, so that the common case saves no registers.
void EgressPort::start(sim::Simulation& simulation, FrameIndex frame, const Frame& record) {
  if (record.link_local || simulation.trace() != nullptr) [[unlikely]]
    start_announced(simulation, frame, record);
  else if (link_.folds_latency()) [[unlikely]]  // at the edge of a network only
    link_.transmit_folded(simulation, frame, record);
  else
    link_.transmit(simulation, frame, record);
}

/// The same where somebody wants to know.
void EgressPort::start_announced(sim::Simulation& simulation, FrameIndex frame, const Frame& record) {
  if (record.link_local) shared_->link_local->transmission_starts(simulation, id(), frame);
  if (link_.folds_latency() && !record.link_local)
    link_.transmit_folded(simulation, frame, record);
  else
    link_.transmit(simulation, frame, record);
  if (sim::TraceSink* const trace = simulation.trace())
    trace->record({simulation.now(), static_cast<std::uint32_t>(Occurrence::started), id(), frame.value,
                   TransmissionDetail{record.length, class_of(frame)}.pack()});
}

void EgressPort::wake_at(sim::Simulation& simulation, sim::TrueTime time) {
  if (time >= wake_at_) return;
  wake_at_ = time;
  link_.schedule_for_sender(simulation, time, wake_up, 0);
}

}  // namespace takt::models
