// What few ports do: preemption, cut-through, faults of the link.
#include <algorithm>

#include "models/egress/egress_port.hpp"

namespace takt::models {

void EgressPort::start_with_extras(sim::Simulation& simulation, FrameIndex frame, TrafficClass q) {
  const Frame& record = shared_->traffic->frame(frame);
  const sim::TrueTime now = simulation.now();
  const sim::TrueTime last_bit = now + octet_time() * (preamble_and_sfd.count + std::int64_t{record.length});
  sim::TrueTime arrival = last_bit + peer_delay();
  if (record.link_local) [[unlikely]] shared_->link_local->transmission_starts(simulation, id(), frame);
  MacMerge* const merge = extras_->merge.get();
  const bool preemptable = merge != nullptr && merge->is_preemptable(q);
  unsigned notes = extras_->conditional || record.marked || record.bad_fcs ? unsigned{conditional} : preemptable ? unsigned{withdrawable} : 0u;
  // A header that is as long as the frame is a frame that is stored.
  if (!preemptable && (extras_->noticed_priorities >> record.priority & 1) != 0 && header_notice(record).count < preamble_and_sfd.count + std::int64_t{record.length}) {
    arrival = now + octet_time() * header_notice(record).count + peer_delay();
    notes |= header_only | conditional;
  }
  busy_until_ = last_bit + octet_time() * inter_packet_gap.count;
  wire_octets_sent_ += wire_length(Octets{record.length}).count;
  simulation.schedule(source_, arrival, peer_order_, static_cast<sim::EventKind>(NodeEvent::frame_arrived),
                      ArrivalArgument::pack(frame, peer_port(), notes));
  if (preemptable)
    merge->started({frame, q, now, Octets{record.length}, arrival});
  else if (merge != nullptr)
    merge->express_started();
  if (sim::TraceSink* const trace = simulation.trace()) [[unlikely]]
    trace->record({now, static_cast<std::uint32_t>(Occurrence::started), id(), frame.value, TransmissionDetail{record.length, q}.pack()});
}

HoldRequest EgressPort::hold_request(sim::TrueTime now) {
  if (!shaping_) return {};
  return extras_->merge->hold_request(shaping_->gates(), clock_->local_at(now));
}

/// While the medium is busy at a port that preempts: cuts the frame under way if an express frame may start, or if the MAC is
/// asked to hold. Says when to look again.
sim::TrueTime EgressPort::look_while_busy(sim::Simulation& simulation, ClassSet candidates, const Heads& heads) {
  MacMerge& merge = *extras_->merge;
  const sim::TrueTime now = simulation.now();
  if (!merge.under_way()) return when_to_look(now);
  const std::optional<MacMerge::Cut> earliest = merge.earliest_cut(now);
  if (!earliest) return when_to_look(now);
  const HoldRequest hold = hold_request(now);
  sim::TrueTime next = busy_until_;
  bool wanted = hold.hold;
  if (!wanted) {
    const Selection express = select(now, candidates & static_cast<ClassSet>(~merge.preemptable()), heads, earliest->free_at - now);
    wanted = express.found;
    next = std::min({next, express.ask_again, when_to_look(now)});
  }
  if (!wanted) return next;
  cut(simulation, *earliest);
  return busy_until_;
}

/// The frame under way ends early; the medium is free when its mCRC and the gap are over.
void EgressPort::cut(sim::Simulation& simulation, const MacMerge::Cut& cut) {
  MacMerge& merge = *extras_->merge;
  const MacMerge::UnderWay fragment = *merge.under_way();
  extras_->withdrawn.push_back({fragment.arrival, fragment.frame});
  merge.cut(cut);
  busy_until_ = cut.free_at;
  wire_octets_sent_ += overhead_of_a_cut.count;
  if (shaping_) shaping_->cut(simulation.now(), fragment.traffic_class, cut.free_at);
  if (sim::TraceSink* const trace = simulation.trace()) [[unlikely]]
    trace->record({simulation.now(), static_cast<std::uint32_t>(Occurrence::cut), id(), fragment.frame.value,
                   TransmissionDetail{cut.data.count, fragment.traffic_class}.pack()});
}

void EgressPort::resume(sim::Simulation& simulation) {
  MacMerge& merge = *extras_->merge;
  const MacMerge::Rest rest = *merge.rest();
  const sim::TrueTime now = simulation.now();
  const sim::TrueTime last_bit = now + octet_time() * (preamble_and_sfd.count + std::int64_t{rest.remaining.count});
  const sim::TrueTime arrival = last_bit + peer_delay();
  busy_until_ = last_bit + octet_time() * inter_packet_gap.count;
  if (shaping_) {
    shaping_->resumed(now, rest.traffic_class, rest.remaining.count);
    sending_ = rest.traffic_class;
  }
  ++other_events_;
  simulation.schedule(source_, arrival, peer_order_, static_cast<sim::EventKind>(NodeEvent::frame_arrived),
                      ArrivalArgument::pack(rest.frame, peer_port(), extras_->conditional || shared_->traffic->frame(rest.frame).marked ? conditional : withdrawable));
  merge.started({rest.frame, rest.traffic_class, now, rest.remaining, arrival});
  if (sim::TraceSink* const trace = simulation.trace()) [[unlikely]]
    trace->record({now, static_cast<std::uint32_t>(Occurrence::resumed), id(), rest.frame.value,
                   TransmissionDetail{rest.remaining.count, rest.traffic_class}.pack()});
}

bool EgressPort::take_withdrawn(sim::TrueTime now, FrameIndex frame) {
  auto& withdrawn = extras_->withdrawn;
  const auto found = std::find_if(withdrawn.begin(), withdrawn.end(), [&](const Extras::Withdrawn& w) { return w.time == now && w.frame == frame; });
  if (found == withdrawn.end()) return false;
  withdrawn.erase(found);
  return true;
}

bool EgressPort::confirm(sim::Simulation& simulation, FrameIndex& frame, std::uint16_t notes) {
  if (!extras_) return true;
  const sim::TrueTime now = simulation.now();
  if (take_withdrawn(now, frame)) return false;
  LinkFault* const fault = extras_->fault.get();
  if (fault == nullptr) return true;
  const Frame& record = shared_->traffic->frame(frame);
  const std::uint16_t length = record.length;
  const Octets octets = (notes & header_only) != 0 ? header_notice(record) : preamble_and_sfd + Octets{length};
  const sim::TrueTime last_bit = now - node_delay_;  // of what has come
  const sim::TrueTime start = last_bit - (peer_delay() - node_delay_) - octet_time() * octets.count;
  if (fault->went_down_within(start, last_bit)) {
    give_up(simulation, frame, DropReason::link_down);
    return false;
  }
  if ((notes & confirmed) != 0 || !fault->is_impaired()) return true;
  const LinkFault::Fate fate = fault->fate_of(Octets{length}, last_bit);
  if (fate.lost) {
    give_up(simulation, frame, DropReason::link_loss);
    return false;
  }
  if (fate.doubled) {
    const FrameIndex twin = shared_->traffic->duplicate(frame);
    ++other_events_;
    // The double is stored, so of a header it comes when the frame is complete.
    const sim::TrueTime complete = now + octet_time() * (preamble_and_sfd.count + std::int64_t{length} - octets.count);
    simulation.schedule(source_, complete, peer_order_, static_cast<sim::EventKind>(NodeEvent::frame_arrived),
                        ArrivalArgument::pack(twin, peer_port(), static_cast<unsigned>(notes & ~header_only) | confirmed));
  }
  if (fate.damaged) {
    frame = shared_->traffic->own(frame);
    shared_->traffic->frame(frame).bad_fcs = true;
  }
  return true;
}

/// Frames of which only the header is here. True if one of them has started; the others come again when they are complete.
bool EgressPort::settle_headers(sim::Simulation& simulation) {
  std::vector<Extras::HeaderArrival>& headers = extras_->headers;
  const bool alone = headers.size() == 1 && !has_arrival_ && more_arrivals_.empty();
  bool started = false;
  for (const Extras::HeaderArrival& header : headers) {
    if (Extras* const link = header.sender->extras_.get(); link->fault)
      link->fault->cut_through(header.frame, shared_->traffic->frame(header.frame), simulation.now(), header.stored - header.sender->node_delay_);
    if (alone && may_cut_through(simulation, header)) {
      started = true;
      const TrafficClass q = class_of(header.frame);
      if (shaping_) shaping_->frame_waits(simulation.now(), q);
      ++extras_->frames_cut_through;
      if (shared_->traffic->frame(header.frame).bad_fcs) ++extras_->bad_fcs_forwarded;
      start_selected(simulation, header.frame, q, true);
      continue;
    }
    ++other_events_;
    simulation.schedule(source_, header.stored, sim::Phase::arrival, id(), stored_frame, static_cast<std::uint64_t>(header.rank) << 32 | header.frame.value);
  }
  headers.clear();
  return started;
}

void EgressPort::take_stored(sim::Simulation& simulation, std::uint64_t argument) {
  const FrameIndex frame{static_cast<std::uint32_t>(argument)};
  if (shared_->traffic->frame(frame).bad_fcs)
    give_up(simulation, frame, DropReason::bad_fcs);
  else
    offer(simulation, frame, static_cast<std::uint32_t>(argument >> 32));
}

bool EgressPort::may_cut_through(sim::Simulation& simulation, const Extras::HeaderArrival& header) {
  const TrafficClass q = class_of(header.frame);
  if (!contains(config_->cut_through, q) || header.sender->octet_time() != octet_time() || config_->untagged) return false;
  const sim::TrueTime now = simulation.now();
  if (now < busy_until_ || !queues_.empty() || is_down()) return false;
  if (extras_->merge && (extras_->merge->is_preemptable(q) || extras_->merge->rest())) return false;
  if (!shaping_) return true;
  const Frame& record = shared_->traffic->frame(header.frame);
  if (shaping_->is_timed(q) || !shaping_->fits_max_sdu(q, record.msdu + (record.r_tagged ? r_tag.count : 0))) return false;
  return shaping_->ready_time(now, q, {record.length, {}}) == now;
}

void EgressPort::expect_faults(const sim::Simulation& simulation, std::string_view path) {
  Extras& extras = make_extras();
  extras.conditional = true;
  find_gates();
  if (!extras.fault) extras.fault = std::make_unique<LinkFault>(simulation.seed(), path);
}

void EgressPort::set_up(sim::Simulation& simulation, bool up) {
  LinkFault& fault = *extras_->fault;
  if (fault.is_up() == up) return;
  fault.set_up(simulation.now(), up);
  if (up) return;
  fault.break_passing(simulation.now(), [&](FrameIndex frame) -> Frame& { return shared_->traffic->frame(frame); });
  flush(simulation, DropReason::link_down);
}

void EgressPort::flush(sim::Simulation& simulation, DropReason reason) {
  for (TrafficClass q = 0; q < traffic_class_count; ++q) {
    while (queues_.frames(q) > 0) give_up(simulation, pop(simulation, q), reason);
    if (shaping_) shaping_->none_waits(simulation.now(), q);
  }
  if (extras_ && extras_->merge && extras_->merge->rest()) {
    give_up(simulation, extras_->merge->rest()->frame, reason);
    extras_->merge->forget_rest();
  }
}

}  // namespace takt::models
