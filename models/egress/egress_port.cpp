#include "models/egress/egress_port.hpp"

#include <algorithm>
#include <utility>

#include "models/egress/transmission_selection.hpp"

namespace takt::models {
namespace {
constexpr sim::EventKind wake_up = 0;

/// Stable, in place and without allocation; the frames of one instant are few.
template <class Arrivals>
void sort_by_rank(Arrivals& arrivals) {
  for (std::size_t i = 1; i < arrivals.size(); ++i)
    for (std::size_t j = i; j > 0 && arrivals[j].rank < arrivals[j - 1].rank; --j) std::swap(arrivals[j], arrivals[j - 1]);
}

}  // namespace

void EgressPort::connect(sim::Simulation& simulation, Shared& shared, const PortConfig& config, sim::Duration octet_time,
                         LinkEnd far_end) {
  TAKT_CHECK(shared_ == nullptr, "a port has one link");
  TAKT_CHECK(octet_time.ps() > 0 && octet_time.ps() < (1 << 20), "an octet lasts between 1 ps and 1 us");
  TAKT_CHECK(far_end.delay.ps() >= 0 && far_end.delay.ps() < (std::int64_t{1} << 44), "a link and its far node delay a frame by at most 17 s");
  source_ = sim::EventSource(simulation.add(*this));
  shared_ = &shared;
  config_ = &config;
  octet_time_ps_ = static_cast<std::uint64_t>(octet_time.ps()) & 0xFFFFF;
  peer_node_ = far_end.node;
  peer_port_ = far_end.port;
  peer_delay_ps_ = static_cast<std::uint64_t>(far_end.delay.ps()) & 0xFFF'FFFF'FFFF;
}

void EgressPort::handle(sim::Simulation& simulation, const sim::Event& event) {
  TAKT_CHECK(event.kind() == wake_up, "a port knows one kind of event");
  if (event.time != wake_at_) return;  // an earlier wake-up took its place
  wake_at_ = sim::TrueTime::never();
  if (settling_) return;
  settling_ = true;
  simulation.settle_later(*this);
}

void EgressPort::settle(sim::Simulation& simulation) {
  settling_ = false;
  // The common case: one frame, nothing waits, the medium is free.
  if (has_arrival_ && !waits_ && more_arrivals_.empty() && simulation.now() >= busy_until_) [[likely]] {
    has_arrival_ = false;
    start(simulation, arrival_.frame);
    return;
  }
  settle_many(simulation);
}

void EgressPort::settle_many(sim::Simulation& simulation) {
  if (has_arrival_) more_arrivals_.insert(more_arrivals_.begin(), arrival_);
  has_arrival_ = false;
  sort_by_rank(more_arrivals_);

  if (simulation.now() >= busy_until_) {
    // Selection looks at the head of each class; a frame that has just come is the head of a class that had none.
    ClassSet candidates = queues_.waiting();
    for (const Arrival& arrival : more_arrivals_) candidates = static_cast<ClassSet>(candidates | 1u << class_of(arrival.frame));
    const Selection selection = select_transmission(candidates);
    if (selection.found) {
      const TrafficClass q = selection.traffic_class;
      if ((queues_.waiting() >> q & 1) != 0) {
        start(simulation, queues_.pop(q, shared_->entries));
      } else {
        const auto first = std::find_if(more_arrivals_.begin(), more_arrivals_.end(),
                                        [&](const Arrival& arrival) { return class_of(arrival.frame) == q; });
        start(simulation, first->frame);
        more_arrivals_.erase(first);
      }
    }
  }
  for (const Arrival& arrival : more_arrivals_) admit(simulation, arrival.frame);
  more_arrivals_.clear();
  waits_ = !queues_.empty();
  if (waits_) wake_at(simulation, busy_until_);
}

void EgressPort::admit(sim::Simulation& simulation, FrameIndex frame) {
  const Frame& record = shared_->traffic->frame(frame);
  const TrafficClass q = config_->traffic_class_of_priority[record.priority];
  DropReason reason{};
  if (!queues_.has_room(q, record.length, config_->queue_limits[q], reason)) {
    ++frames_dropped_;
    shared_->traffic->drop(frame, reason, id(), simulation);
    return;
  }
  queues_.push(q, frame, record.length, shared_->entries);
  if (sim::TraceSink* const trace = simulation.trace()) [[unlikely]]
    trace->record({simulation.now(), static_cast<std::uint32_t>(Occurrence::enqueued), id(), frame.value, q});
}

void EgressPort::start(sim::Simulation& simulation, FrameIndex frame) {
  const Frame& record = shared_->traffic->frame(frame);
  const auto octet = static_cast<std::int64_t>(octet_time_ps_);
  const std::int64_t until_last_bit = octet * (preamble_and_sfd.count + record.length);
  const sim::TrueTime now = simulation.now();
  busy_until_ = now + sim::Duration::from_ps(until_last_bit + octet * inter_packet_gap.count);
  wire_octets_sent_ += wire_length(Octets{record.length}).count;
  simulation.schedule(source_, now + sim::Duration::from_ps(until_last_bit + static_cast<std::int64_t>(peer_delay_ps_)), sim::Phase::arrival, peer_node_,
                      static_cast<sim::EventKind>(NodeEvent::frame_arrived), ArrivalArgument::pack(frame, peer_port_));
  if (sim::TraceSink* const trace = simulation.trace()) [[unlikely]]
    trace->record({now, static_cast<std::uint32_t>(Occurrence::started), id(), frame.value, record.length});
}

void EgressPort::wake_at(sim::Simulation& simulation, sim::TrueTime time) {
  if (time >= wake_at_) return;
  wake_at_ = time;
  ++wake_ups_;
  simulation.schedule(source_, time, sim::Phase::arrival, id(), wake_up, 0);
}

}  // namespace takt::models
