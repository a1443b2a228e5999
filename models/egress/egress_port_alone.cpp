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

/// offer_last() where the instant may not be complete, or the frame does not just start.
void EgressPort::take_last(sim::Simulation& simulation, FrameIndex frame, const Frame& record, std::uint32_t rank) {
  if (!simulation.instant_is_complete()) {
    offer(simulation, frame, rank);
    return;
  }
  take_only(simulation, frame, record, rank);
}

void EgressPort::take_only(sim::Simulation& simulation, FrameIndex frame, const Frame& record, std::uint32_t rank) {
  if (simulation.now() < link_.free_at() || path_ == Path::general)
    take_among_others(simulation, frame, rank);
  else
    pass_alone(simulation, frame, record);
}

/// offer_last() at an instant that is complete, of a frame that does not come alone to a free medium.
void EgressPort::take_among_others(sim::Simulation& simulation, FrameIndex frame, std::uint32_t rank) {
  has_arrival_ = true;
  arrival_ = {frame, rank};
  settle_many(simulation);
}

void EgressPort::settle(sim::Simulation& simulation) {
  settling_ = false;
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
  if (is_in_known_window(simulation.now(), q, record)) [[likely]] {
    sending_ = q;
    start(simulation, frame, record);
  } else {
    pass_gate_later(simulation, frame, record);
  }
}

/// Or in the same window of a later cycle.
void EgressPort::pass_gate_later(sim::Simulation& simulation, FrameIndex frame, const Frame& record) {
  const TrafficClass q = config_->traffic_class_of_priority[record.queue_priority];
  if (clock_->is_ideal() && only_gates_->is_in_next_known_window(q, clock_->local_at(simulation.now()), occupancy_until_last_bit(record))) {
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
  if (record.link_local || simulation.trace() != nullptr) [[unlikely]] {
    start_with_extras(simulation, frame, q);
    return;
  }
  MacMerge& merge = *extras_->merge;
  const sim::TrueTime now = simulation.now();
  std::uint64_t flags = 0;
  if (merge.is_preemptable(q)) {
    merge.started({frame, q, now, Octets{record.length}, link_.arrival_of(now, record)});
    flags = ArrivalArgument::preemptable;
  } else {
    merge.express_started();
  }
  link_.transmit(simulation, frame, record, flags);
}

}  // namespace takt::models
