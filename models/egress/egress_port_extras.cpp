// SPDX-License-Identifier: Apache-2.0
// What few ports do: preemption, cut-through, shared bandwidth, full queues. Traces of all ports. Faults: changed
// gates, failing links.
#include <algorithm>

#include "models/egress/egress_port.hpp"
#include "sim/insertion_sort.hpp"

namespace takt::models {

void EgressPort::start_merging(sim::Simulation& simulation, FrameIndex frame, const Frame& record, TrafficClass q) {
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

void EgressPort::start_with_extras(sim::Simulation& simulation, FrameIndex frame, TrafficClass q) {
  const Frame& record = shared_->traffic->frame(frame);
  const sim::TrueTime now = simulation.now();
  if (record.link_local) [[unlikely]]
    shared_->link_local->transmission_starts(simulation, id(), frame);
  MacMerge* const merge = extras_->merge.get();
  const bool is_preemptable = merge != nullptr && merge->is_preemptable(q);
  const sim::TrueTime arrival = link_.transmit_any(simulation, frame, record, is_preemptable);
  if (is_preemptable)
    merge->started({frame, q, now, Octets{record.length}, arrival});
  else if (merge != nullptr)
    merge->express_started();
  if (sim::TraceSink* const trace = simulation.trace()) [[unlikely]]
    trace->record({now, static_cast<std::uint32_t>(Occurrence::started), id(), frame.value,
                   TransmissionDetail{record.length, q}.pack()});
}

/// Of classes that share bandwidth the one whose turn it is among those that may start. What is selected for the
/// present instant starts, and pays; for a later one the question is only whether it is worth cutting another frame.
void EgressPort::select_by_share(sim::TrueTime now, ClassSet classes, sim::Duration delay, Selection& selection) {
  DeficitRoundRobin::PerClass first{};
  for (ClassSet left = classes; left != 0;) {
    const TrafficClass q = highest_class(left);
    left = without(left, q);
    const FrameIndex frame = head_of_line(q).frame;
    const sim::TrueTime ready = shaping_->ready_time(now, q, {shared_->traffic->frame(frame).length, {}}, delay);
    if (ready == now) {
      selection.found = true;
      first[q] = octets_on_medium(frame);
    } else {
      selection.ask_again = std::min(selection.ask_again, ready);
    }
  }
  if (!selection.found) return;
  selection.traffic_class = shaping_->round()->choose(first);
  selection.first = head_of_line(selection.traffic_class);
  if (delay > sim::Duration()) return;
  const auto is_alike = [&](const Arrival& arrival) { return class_of(arrival.frame) == selection.traffic_class; };
  const auto frames = queues_.frames(selection.traffic_class) +
                      static_cast<std::size_t>(std::count_if(more_arrivals_.begin(), more_arrivals_.end(), is_alike));
  shaping_->round()->started(selection.traffic_class, first[selection.traffic_class], frames == 1);
}

EgressPort::Selection EgressPort::select_rest(sim::TrueTime now, const MacMerge::Rest& rest) {
  const sim::TrueTime ready = shaping_ ? shaping_->rest_ready_time(now, rest.traffic_class, rest.remaining.count) : now;
  return {.found = ready == now, .is_rest = true, .traffic_class = rest.traffic_class, .ask_again = ready};
}

HoldRequest EgressPort::hold_request(sim::TrueTime now) {
  if (!shaping_) return {};
  return extras_->merge->hold_request(shaping_->gates(), clock_->local_at(now));
}

/// While the medium is busy at a port that preempts: cuts the frame under way if an express frame may start, or if the
/// MAC is asked to hold. Says when to look again.
sim::TrueTime EgressPort::next_cut_or_end(sim::Simulation& simulation) {
  MacMerge& merge = *extras_->merge;
  const sim::TrueTime now = simulation.now();
  if (!merge.under_way()) return when_to_look(now);
  const std::optional<MacMerge::Cut> earliest = merge.earliest_cut(now);
  if (!earliest) return when_to_look(now);
  const HoldRequest hold = hold_request(now);
  sim::TrueTime next = sim::TrueTime::never();
  bool wanted = hold.hold;
  if (!wanted) {
    const Selection express = select(now, static_cast<ClassSet>(~merge.preemptable()), earliest->free_at - now);
    wanted = express.found;
    next = std::min(express.ask_again, when_to_look(now));
  }
  if (!wanted) return next;
  cut(simulation, *earliest);
  return link_.free_at();
}

/// The frame under way ends early; the medium is free when its mCRC and the gap are over.
void EgressPort::cut(sim::Simulation& simulation, const MacMerge::Cut& cut) {
  MacMerge& merge = *extras_->merge;
  const MacMerge::UnderWay fragment = *merge.under_way();
  link_.cut(fragment.frame, fragment.arrival, cut.free_at);
  merge.cut(cut);
  if (shaping_) shaping_->cut(simulation.now(), fragment.traffic_class, cut.free_at);
  if (sim::TraceSink* const trace = simulation.trace()) [[unlikely]]
    trace->record({simulation.now(), static_cast<std::uint32_t>(Occurrence::cut), id(), fragment.frame.value,
                   TransmissionDetail{cut.data.count, fragment.traffic_class}.pack()});
}

void EgressPort::resume(sim::Simulation& simulation) {
  MacMerge& merge = *extras_->merge;
  const MacMerge::Rest rest = *merge.rest();
  const sim::TrueTime now = simulation.now();
  if (shaping_) {
    shaping_->resumed(now, rest.traffic_class, rest.remaining.count);
    sending_ = rest.traffic_class;
  }
  const sim::TrueTime arrival =
      link_.transmit_rest(simulation, rest.frame, shared_->traffic->frame(rest.frame), rest.remaining);
  merge.started({rest.frame, rest.traffic_class, now, rest.remaining, arrival});
  if (sim::TraceSink* const trace = simulation.trace()) [[unlikely]]
    trace->record({now, static_cast<std::uint32_t>(Occurrence::resumed), id(), rest.frame.value,
                   TransmissionDetail{rest.remaining.count, rest.traffic_class}.pack()});
}

/// Of the frames of which only the header is here the first that may start does, and the others come again when they
/// are complete. Preconditions: the medium is free, and nothing else may start now. False: all are stored.
bool EgressPort::cut_through(sim::Simulation& simulation) {
  if (!extras_ || extras_->headers.empty()) return false;
  std::vector<Extras::HeaderArrival>& headers = extras_->headers;
  sim::insertion_sort(headers, [this](const Extras::HeaderArrival& a, const Extras::HeaderArrival& b) {
    const TrafficClass p = class_of(a.frame), q = class_of(b.frame);
    return p != q ? p > q : a.rank < b.rank;
  });
  for (auto header = headers.begin(); header != headers.end(); ++header) {
    if (why_stored(simulation.now(), *header)) continue;
    const Extras::HeaderArrival first = *header;
    headers.erase(header);
    first.from->passed_on(simulation.now(), first.frame, shared_->traffic->frame(first.frame), first.stored);
    start_before_it_has_come(simulation, first.frame);
    return true;
  }
  store_headers(simulation, Storing::refused);
  return false;
}

void EgressPort::start_before_it_has_come(sim::Simulation& simulation, FrameIndex frame) {
  const TrafficClass q = class_of(frame);
  if (shaping_) shaping_->frame_waits(simulation.now(), q);
  if (!contains(strict_priority_classes_, q)) {  // no other class that shares bandwidth may start
    DeficitRoundRobin::PerClass first{};
    first[q] = octets_on_medium(frame);
    shaping_->round()->started(shaping_->round()->choose(first), first[q], true);
  }
  ++extras_->frames_cut_through;
  if (shared_->traffic->frame(frame).bad_fcs) ++extras_->bad_fcs_forwarded;
  start_selected(simulation, frame, q, true);
}

/// What has its header here is offered when it has come wholly. `reason` is that of frames which might be cut through
/// otherwise.
void EgressPort::store_headers(sim::Simulation& simulation, Storing reason) {
  if (!extras_ || extras_->headers.empty()) return;
  for (const Extras::HeaderArrival& header : extras_->headers) {
    header.from->passed_on(simulation.now(), header.frame, shared_->traffic->frame(header.frame), header.stored);
    if (sim::TraceSink* const trace = simulation.trace()) [[unlikely]] {
      const StoringDetail detail = why_stored(simulation.now(), header).value_or(StoringDetail{reason});
      trace->record(
          {simulation.now(), static_cast<std::uint32_t>(Occurrence::stored), id(), header.frame.value, detail.pack()});
    }
    link_.schedule_for_sender(simulation, header.stored, stored_frame,
                              static_cast<std::uint64_t>(header.rank) << 32 | header.frame.value);
  }
  extras_->headers.clear();
}

void EgressPort::handle_stored_frame(sim::Simulation& simulation, const sim::Event& event) {
  TAKT_CHECK(event.kind() == stored_frame, "an event of another component");
  const FrameIndex frame{static_cast<std::uint32_t>(event.argument)};
  if (shared_->traffic->frame(frame).bad_fcs)
    drop(simulation, frame, DropReason::bad_fcs);
  else
    offer(simulation, frame, static_cast<std::uint32_t>(event.argument >> 32));
}

/// Why the frame may not start before it has come, but for what the medium does now; nothing if it may.
std::optional<StoringDetail> EgressPort::why_stored(sim::TrueTime now, const Extras::HeaderArrival& header) {
  const TrafficClass q = class_of(header.frame);
  const bool may_ever =
      contains(config_->cut_through, q) && !config_->untagged && !(extras_->merge && extras_->merge->is_preemptable(q));
  if (!may_ever || (shaping_ && shaping_->is_timed(q))) return StoringDetail{Storing::not_asked_to};
  if (header.from->octet_time() != octet_time()) return StoringDetail{Storing::other_rate};
  if (now < link_.free_at()) return std::nullopt;
  if (contains(candidates(), q)) return StoringDetail{Storing::order};
  if (!shaping_) return std::nullopt;
  const Frame& record = shared_->traffic->frame(header.frame);
  if (!shaping_->fits_max_sdu(q, record.msdu + (record.r_tagged ? r_tag.count : 0)))
    return StoringDetail{Storing::too_long};
  const Head head{record.length, {}};
  if (shaping_->ready_time(now, q, head) == now) return std::nullopt;
  return StoringDetail{Storing::refused, shaping_->refusal(now, q, head)};
}

void EgressPort::tell(sim::Simulation& simulation, const BlockedRecord& refusal, sim::TrueTime until) {
  simulation.trace()->record({simulation.now(), static_cast<std::uint32_t>(Occurrence::refused), id(),
                              static_cast<std::uint64_t>(until.ps()), refusal.pack()});
}

void EgressPort::trace_blocked(sim::Simulation& simulation, TrafficClass q, FrameIndex first, sim::TrueTime until) {
  tell(simulation, shaping_->refusal(simulation.now(), q, {shared_->traffic->frame(first).length, eligible_of(first)}),
       until);
}

/// Asks what transmission selection will ask now, of each class; to ask twice changes nothing.
void EgressPort::trace_all_blocked(sim::Simulation& simulation) {
  const sim::TrueTime now = simulation.now();
  MacMerge* const merge = extras_ ? extras_->merge.get() : nullptr;
  // What keeps all preemptable classes: a hold, or the rest of a cut frame, before which none of them may go.
  std::optional<BlockedRecord> of_preemptable;
  sim::TrueTime until = sim::TrueTime::never();
  if (merge != nullptr) {
    const HoldRequest hold = hold_request(now);
    if (hold.hold) {
      of_preemptable = BlockedRecord{.hindrance = BlockReason::hold};
      if (hold.until != sim::LocalTime::never()) until = clock_->true_at(hold.until);
    } else if (merge->rest() && shaping_) {
      const MacMerge::Rest& rest = *merge->rest();
      const sim::TrueTime ready = shaping_->rest_ready_time(now, rest.traffic_class, rest.remaining.count);
      if (ready != now) {
        of_preemptable = shaping_->gate_refusal(now, rest.traffic_class);
        until = ready;
      }
    }
  }
  const auto trace_blocked_preemptable = [&](TrafficClass q, bool of_rest) {
    BlockedRecord refusal = *of_preemptable;
    refusal.traffic_class = q;
    refusal.of_rest = of_rest;
    tell(simulation, refusal, until);
  };
  for (ClassSet left = candidates(); left != 0;) {
    const TrafficClass q = highest_class(left);
    left = without(left, q);
    if (of_preemptable && merge->is_preemptable(q)) {
      trace_blocked_preemptable(q, false);
    } else if (shaping_) {
      const FrameIndex first = head_of_line(q).frame;
      const sim::TrueTime ready =
          shaping_->ready_time(now, q, {shared_->traffic->frame(first).length, eligible_of(first)});
      if (ready != now) trace_blocked(simulation, q, first, ready);
    }
  }
  if (of_preemptable && merge->rest()) trace_blocked_preemptable(merge->rest()->traffic_class, true);
}

ConfigChange EgressPort::request_gates(sim::Simulation& simulation, const GateConfig& gates) {
  TAKT_CHECK(!single_talker_port_, "it is known before the run that gates will change");
  make_shaping();
  const ConfigChange change = shaping_->request_gates(simulation.now(), gates);
  gates_changed(simulation);
  return change;
}

void EgressPort::force_gate(sim::Simulation& simulation, TrafficClass q, std::optional<bool> open) {
  make_shaping().force_gate(simulation.now(), q, open);
  gates_changed(simulation);
}

void EgressPort::gates_changed(sim::Simulation& simulation) {
  if (const sim::TrueTime last_bit = link_.last_bit(); last_bit > simulation.now())
    shaping_->check_overrun(simulation.now(), sending_, last_bit);
  note_features();
  ask_again(simulation);
}

void EgressPort::clock_changed(sim::Simulation& simulation) {
  if (!shaping_) return;
  shaping_->find_gated();
  ask_again(simulation);
}

void EgressPort::ask_again(sim::Simulation& simulation) {
  head_eligible_at_ = sim::TrueTime::never();
  if (extras_ && extras_->merge) extras_->merge->gates_changed();
  if (!queues_.empty() || (extras_ && extras_->merge)) decide_later(simulation);
  if (sim::TraceSink* const trace = simulation.trace()) [[unlikely]]
    trace->record({simulation.now(), static_cast<std::uint32_t>(Occurrence::gates_changed), id(), 0, 0});
}

void EgressPort::set_link_up(sim::Simulation& simulation, bool up) {
  if (link_.set_up(simulation, up) && !up) flush(simulation, DropReason::link_down);
}

void EgressPort::flush(sim::Simulation& simulation, DropReason reason) {
  for (TrafficClass q = 0; q < traffic_class_count; ++q) {
    while (queues_.frames(q) > 0) drop(simulation, pop(simulation, q), reason);
    if (shaping_) shaping_->none_waits(simulation.now(), q);
  }
  if (extras_ && extras_->merge && extras_->merge->rest()) {
    drop(simulation, extras_->merge->rest()->frame, reason);
    extras_->merge->forget_rest();
  }
}

bool EgressPort::passes_max_sdu(sim::Simulation& simulation, FrameIndex frame) {
  const Frame& record = shared_->traffic->frame(frame);
  const std::uint32_t msdu = record.msdu + (record.r_tagged ? r_tag.count : 0);
  if (shaping_->fits_max_sdu(config_->traffic_class_of_priority[record.queue_priority], msdu)) return true;
  drop(simulation, frame, DropReason::queue_max_sdu);
  return false;
}

/// To a full queue, to one in the order of eligibility, or with a trace sink.
void EgressPort::enqueue_slow(sim::Simulation& simulation, FrameIndex frame, const Frame& record, TrafficClass q) {
  DropReason reason{};
  if (!queues_.has_room(q, record.length, config_->queue_limits[q], reason)) {
    enqueue_to_full_queue(simulation, frame, q, reason);
    return;
  }
  if (shaping_ && shaping_->is_timed(q))
    queues_.push_in_order(q, frame, record.length, shared_->entries, [this](FrameIndex f) { return eligible_of(f); });
  else
    queues_.push(q, frame, record.length, shared_->entries);
  if (sim::TraceSink* const trace = simulation.trace())
    trace->record({simulation.now(), static_cast<std::uint32_t>(Occurrence::enqueued), id(), frame.value, q});
}

/// The frame is lost, or, if it is to be so and it fits at all, the oldest ones are until it fits.
void EgressPort::enqueue_to_full_queue(sim::Simulation& simulation, FrameIndex frame, TrafficClass q,
                                       DropReason reason) {
  const std::uint32_t length = shared_->traffic->frame(frame).length;
  const QueueLimit& limit = config_->queue_limits[q];
  if (!limit.drops_oldest || limit.frames == 0 || length > limit.octets) {
    drop(simulation, frame, reason);
    if (shaping_ && queues_.frames(q) == 0) shaping_->none_waits(simulation.now(), q);
    return;
  }
  do drop(simulation, pop(simulation, q), reason);
  while (!queues_.has_room(q, length, limit, reason));
  has_new_head_ = shaping_ != nullptr;  // without gates and shapers every head is ready
  enqueue_slow(simulation, frame, shared_->traffic->frame(frame), q);
}

}  // namespace takt::models
