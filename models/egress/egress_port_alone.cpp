// What a port does with a frame that comes alone to a free medium while nothing waits. Each function ends with what it calls, so that the common case saves no registers.
#include "models/egress/egress_port.hpp"

namespace takt::models {

/// The path is not the general one.
inline void EgressPort::pass_alone(sim::Simulation& simulation, FrameIndex frame, const Frame& record) {
  if (path_ == Path::gated)
    pass_gate(simulation, frame, record);
  else if (path_ == Path::shaped)
    pass_shaping(simulation, frame, record);
  else if (path_ == Path::merging)
    pass_merging(simulation, frame, record);
  else
    start(simulation, frame, record);
}

/// offer_last() of the only frame of this instant, which does not just start.
void EgressPort::take_only(sim::Simulation& simulation, FrameIndex frame, const Frame& record, std::uint32_t rank) {
  if (simulation.now() < link_.free_at() || path_ == Path::general)
    take_among_others(simulation, frame, rank);
  else
    pass_alone(simulation, frame, record);
}

void EgressPort::take_among_others(sim::Simulation& simulation, FrameIndex frame, std::uint32_t rank) {
  has_arrival_ = true;
  arrival_ = {frame, rank};
  settle_many(simulation);
}

void EgressPort::decide(sim::Simulation& simulation) {
  will_decide_ = false;
  // The common case: one frame, nothing waits, the medium is free.
  if (has_arrival_ && path_ != Path::general && more_arrivals_.empty() && simulation.now() >= link_.free_at()) [[likely]] {
    has_arrival_ = false;
    pass_alone(simulation, arrival_.frame, shared_->traffic->frame(arrival_.frame));
    return;
  }
  settle_many(simulation);
}

/// A port that has gates and nothing else: most often in the window of the frame before it.
void EgressPort::pass_gate(sim::Simulation& simulation, FrameIndex frame, const Frame& record) {
  const TrafficClass q = config_->traffic_class_of_priority[record.queue_priority];
  if (is_surely_in_known_window(simulation.now(), q, record)) [[likely]] {
    sending_ = q;
    start(simulation, frame, record);
  } else {
    pass_gate_later(simulation, frame, record);
  }
}

/// Or in one that was found for a frame that waited, or in the same window of a later cycle.
void EgressPort::pass_gate_later(sim::Simulation& simulation, FrameIndex frame, const Frame& record) {
  const sim::TrueTime now = simulation.now();
  const TrafficClass q = config_->traffic_class_of_priority[record.queue_priority];
  const auto is_known = [&] { return is_in_known_window(now, q, record) || only_gates_->is_in_next_known_window(q, clock_->local_at(now), occupancy_until_last_bit(record)); };
  if (clock_->is_ideal() && is_known()) {
    open_class_ = q;
    open_until_ = clock_->true_at(only_gates_->known_window_end());
    sending_ = q;
    start(simulation, frame, record);
  } else {
    pass_gate_exactly(simulation, frame, record);
  }
}

void EgressPort::pass_gate_exactly(sim::Simulation& simulation, FrameIndex frame, const Frame& record) {
  const sim::TrueTime now = simulation.now();
  const TrafficClass q = config_->traffic_class_of_priority[record.queue_priority];
  const StartAnswer answer = only_gates_->may_start(q, clock_->local_at(now), occupancy_until_last_bit(record));
  if (answer.may_start) [[likely]] {
    sending_ = q;
    start(simulation, frame, record);
    return;
  }
  admit(simulation, frame);
  if (queues_.empty()) return;   // a frame that found no room is no more, and nobody waits
  path_ = Path::general;
  promised_ = clock_->true_after(answer.ask_again, now);
  if (simulation.trace() != nullptr) [[unlikely]] tell_refusal(simulation, q, frame, promised_);
  wake_at(simulation, promised_);
}

/// A port that has other shapers, too: most often without gates, and what the frame asks for is there.
void EgressPort::pass_shaping(sim::Simulation& simulation, FrameIndex frame, const Frame& record) {
  const TrafficClass q = config_->traffic_class_of_priority[record.queue_priority];
  if (clock_->is_ideal() && shaping_->starts_at_once(simulation.now(), clock_->local_at(simulation.now()), q, record)) [[likely]] {
    sending_ = q;
    start(simulation, frame, record);
  } else {
    pass_shaping_exactly(simulation, frame, record);
  }
}

void EgressPort::pass_shaping_exactly(sim::Simulation& simulation, FrameIndex frame, const Frame& record) {
  const sim::TrueTime now = simulation.now();
  const TrafficClass q = config_->traffic_class_of_priority[record.queue_priority];
  const sim::TrueTime ready = shaping_->start_alone(now, q, {record.length, eligible_of(record)});
  if (ready == now) [[likely]] {
    sending_ = q;
    start(simulation, frame, record);
    return;
  }
  admit(simulation, frame);
  find_path();
  promised_ = shaping_->is_gated_only(q) ? ready : sim::TrueTime::never();
  if (queues_.empty()) return;   // as above
  if (simulation.trace() != nullptr) [[unlikely]] tell_refusal(simulation, q, frame, ready);
  wake_at(simulation, ready);
}

/// A port that preempts and has nothing else.
void EgressPort::pass_merging(sim::Simulation& simulation, FrameIndex frame, const Frame& record) {
  const TrafficClass q = config_->traffic_class_of_priority[record.queue_priority];
  start_merging(simulation, frame, record, q);
}

inline void EgressPort::start_merging(sim::Simulation& simulation, FrameIndex frame, const Frame& record, TrafficClass q) {
  if (record.link_local || simulation.trace() != nullptr) [[unlikely]] {
    start_with_extras(simulation, frame, q);
    return;
  }
  MacMerge& merge = *extras_->merge;
  if (merge.is_preemptable(q))
    merge.started({frame, q, simulation.now(), Octets{record.length}, link_.arrival_of(simulation.now(), record)});
  else
    merge.express_started();
  link_.transmit(simulation, frame, record);
}

/// Something has come to, or waits at, a port that preempts and has nothing else: what settle_all_classes() does there.
void EgressPort::settle_merging(sim::Simulation& simulation) {
  const bool is_busy = simulation.now() < link_.free_at();
  const bool has_come = has_arrival_;
  if (has_come && !is_busy && path_ != Path::merging) {   // it is one of several that may start
    settle_all_classes(simulation);
    return;
  }
  has_arrival_ = false;
  if (is_busy)
    wait_or_cut(simulation, has_come ? arrival_.frame : FrameIndex{});
  else if (has_come)
    pass_merging(simulation, arrival_.frame, shared_->traffic->frame(arrival_.frame));
  else
    go_on_merging(simulation);
}

/// The medium is busy, and a frame may have come. One that finds no room is no reason to cut another one.
inline void EgressPort::wait_or_cut(sim::Simulation& simulation, FrameIndex frame) {
  if (!frame.is_none()) admit(simulation, frame);
  const MacMerge& merge = *extras_->merge;
  if (merge.under_way() && (queues_.waiting() & ~merge.preemptable()) != 0)
    if (const std::optional<MacMerge::Cut> earliest = merge.earliest_cut(simulation.now())) cut(simulation, *earliest);
  find_path();
  if (path_ == Path::general) wake_at(simulation, link_.free_at());
}

/// The medium is free: what waits goes on, express frames first, then the rest of a frame that was cut.
inline void EgressPort::go_on_merging(sim::Simulation& simulation) {
  const MacMerge& merge = *extras_->merge;
  const auto express = static_cast<ClassSet>(queues_.waiting() & ~merge.preemptable());
  if (express == 0 && merge.rest()) {
    resume(simulation);
  } else if (!queues_.empty()) {
    const TrafficClass q = highest_class(express != 0 ? express : queues_.waiting());
    const FrameIndex frame = pop(simulation, q);
    start_merging(simulation, frame, shared_->traffic->frame(frame), q);
  }
  find_path();
  if (path_ == Path::general) wake_at(simulation, link_.free_at());
}

}  // namespace takt::models
