// SPDX-License-Identifier: Apache-2.0
#include "models/ethernet/link.hpp"

#include <algorithm>
#include <cstddef>

namespace takt::models {

void Link::connect(sim::ComponentId sender, sim::ComponentId node, Traffic& traffic, sim::Duration octet_time,
                   LinkEnd far_end) {
  TAKT_CHECK(octet_time.ps() > 0 && octet_time.ps() < (1 << 20), "an octet lasts between 1 ps and 1 us");
  source_ = sim::EventSource(sender);
  order_for_sender_ = sim::Event::own_order_of(sim::Phase::arrival, node, sender);
  traffic_ = &traffic;
  static_assert(offsetof(Link, latency_) == 48,
                "what every frame touches lies in the first cache line of the sending port");
  octet_time_ps_ = static_cast<std::uint32_t>(octet_time.ps()) & 0x7FFF'FFFF;
  redirect({far_end});
}

void Link::redirect(const Reception& reception) {
  const LinkEnd& far_end = reception.far_end;
  TAKT_CHECK(far_end.delay.ps() >= 0 && far_end.delay.ps() < (std::int64_t{1} << 44),
             "a link and its far node delay a frame by at most 17 s");
  order_ = sim::Event::order_of(sim::Phase::arrival, far_end.node, sender());
  set_every_arrival(far_end.port, checks() ? unsigned{ArrivalArgument::check} : 0u);
  delay_ps_ = static_cast<std::uint64_t>(far_end.delay.ps()) & 0xFFF'FFFF'FFFF;
  reception_ = reception;
}

void Link::expect_faults(const sim::Simulation& simulation, std::string_view path) {
  check_arrivals();
  if (!fault_) fault_ = std::make_unique<LinkFault>(simulation.seed(), path);
}

void Link::transmit_folded(sim::Simulation& simulation, FrameIndex frame, const Frame& record) {
  transmit_at(simulation, simulation.now(), frame, record);
}

sim::TrueTime Link::transmit_any(sim::Simulation& simulation, FrameIndex frame, const Frame& record,
                                 bool is_preemptable) {
  unsigned flags = checks() || record.marked || record.bad_fcs ? unsigned{ArrivalArgument::check} : 0u;
  Octets reported_after = preamble_and_sfd + Octets{record.length};
  // A header that is as long as the frame is a frame that is stored.
  if (!is_preemptable && (reception_.noticed_priorities >> record.priority & 1) != 0 &&
      header_notice(record) < reported_after) {
    reported_after = header_notice(record);
    flags |= ArrivalArgument::header_only | ArrivalArgument::check;
  }
  free_at_ = simulation.now() + octet_time() * wire_length(Octets{record.length}).count;
  wire_octets_sent_ += wire_length(Octets{record.length}).count;
  return schedule_arrival(simulation, frame, reported_after, flags);
}

sim::TrueTime Link::transmit_rest(sim::Simulation& simulation, FrameIndex frame, const Frame& record,
                                  Octets remaining) {
  ++other_events_;
  free_at_ = simulation.now() + octet_time() * wire_length(remaining).count;
  return schedule_arrival(simulation, frame, preamble_and_sfd + remaining,
                          checks() || record.marked ? unsigned{ArrivalArgument::check} : 0u);
}

sim::TrueTime Link::schedule_arrival(sim::Simulation& simulation, FrameIndex frame, Octets reported_after,
                                     unsigned flags) {
  TAKT_CHECK(!folds_latency_, "the latencies of a host are drawn in the order of its frames");
  const sim::TrueTime arrival = simulation.now() + octet_time() * reported_after.count + delay();
  constexpr auto kind = static_cast<sim::EventKind>(NodeEvent::frame_arrived);
  if (exchange_ != nullptr) [[unlikely]]
    exchange_->send(
        far_part_,
        {arrival, order_, source_.next_serial_word() | kind, ArrivalArgument::pack(FrameIndex{0}, port(), flags)},
        frame);
  else
    simulation.schedule(source_, arrival, order_, kind, ArrivalArgument::pack(frame, port(), flags));
  return arrival;
}

/// The event of the arrival that will not be comes all the same: the receiver asks, and the link forgets it. Who is
/// asked about each arrival need not call for reception_checks.
void Link::cut(FrameIndex frame, sim::TrueTime arrival, sim::TrueTime free_at) {
  cancelled_arrivals_.push_back({arrival, frame});
  if (!checks()) reception_.far_end.reception_checks->arrival_cancelled();
  free_at_ = free_at;
  wire_octets_sent_ += overhead_of_a_cut.count;
}

bool Link::consume_cancelled(sim::TrueTime now, FrameIndex frame) {
  const auto found = std::find_if(cancelled_arrivals_.begin(), cancelled_arrivals_.end(),
                                  [&](const Withdrawn& w) { return w.time == now && w.frame == frame; });
  if (found == cancelled_arrivals_.end()) return false;
  cancelled_arrivals_.erase(found);
  if (!checks()) reception_.far_end.reception_checks->cancelled_arrival_is_over();
  return true;
}

bool Link::passes_faults(sim::Simulation& simulation, FrameIndex& frame, std::uint16_t flags) {
  const sim::TrueTime now = simulation.now();
  const Frame& record = traffic_->frame(frame);
  const Octets length{record.length};
  const Octets octets = (flags & ArrivalArgument::header_only) != 0 ? header_notice(record) : preamble_and_sfd + length;
  const sim::Duration node_delay = reception_.far_end.node_delay;
  const sim::TrueTime last_bit = now - node_delay;  // of what has come
  const sim::TrueTime start = last_bit - (delay() - node_delay) - octet_time() * octets.count;
  if (fault_->went_down_within(start, last_bit)) {
    lose(simulation, frame, DropReason::link_down);
    return false;
  }
  if ((flags & ArrivalArgument::duplicate) != 0 || !fault_->is_impaired()) return true;
  const LinkFault::Fate fate = fault_->fate_of(length, last_bit);
  if (fate.lost) {
    lose(simulation, frame, DropReason::link_loss);
    return false;
  }
  if (fate.doubled) {
    const FrameIndex twin = traffic_->duplicate(frame, reception_.far_end.node);
    ++other_events_;
    // The double is stored, so of a header it comes when the frame is complete.
    const sim::TrueTime complete =
        now + octet_time() * (std::int64_t{preamble_and_sfd.count} + length.count - octets.count);
    simulation.schedule(
        source_, complete, order_, static_cast<sim::EventKind>(NodeEvent::frame_arrived),
        ArrivalArgument::pack(
            twin, port(), static_cast<unsigned>(flags & ~ArrivalArgument::header_only) | ArrivalArgument::duplicate));
  }
  if (fate.damaged) {
    frame = traffic_->own(frame, reception_.far_end.node);
    traffic_->frame(frame).bad_fcs = true;
  }
  return true;
}

bool Link::set_up(sim::Simulation& simulation, bool up) {
  if (fault_->is_up() == up) return false;
  fault_->set_up(simulation.now(), up);
  if (!up) fault_->break_passing(simulation.now(), [this](FrameIndex frame) { return traffic_->find_frame(frame); });
  return true;
}

void Link::lose(sim::Simulation& simulation, FrameIndex frame, DropReason reason) {
  ++frames_lost_;
  traffic_->drop(frame, reason, sender(), simulation);
}

}  // namespace takt::models
