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

void EgressPort::connect(sim::Simulation& simulation, Shared& shared, const PortConfig& config, const LocalClock& clock,
                         sim::Duration octet_time, LinkEnd far_end) {
  TAKT_CHECK(shared_ == nullptr, "a port has one link");
  TAKT_CHECK(octet_time.ps() > 0 && octet_time.ps() < (1 << 20), "an octet lasts between 1 ps and 1 us");
  TAKT_CHECK(far_end.delay.ps() >= 0 && far_end.delay.ps() < (std::int64_t{1} << 44), "a link and its far node delay a frame by at most 17 s");
  source_ = sim::EventSource(simulation.add(*this));
  shared_ = &shared;
  config_ = &config;
  clock_ = &clock;
  if (!config.shaping.is_plain()) shaping_ = std::make_unique<PortShaping>(config.shaping, clock, octet_time);
  detours_ = shaping_ != nullptr;
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
  if (has_arrival_ && !detours_ && more_arrivals_.empty() && simulation.now() >= busy_until_) [[likely]] {
    has_arrival_ = false;
    start(simulation, arrival_.frame);
    return;
  }
  settle_many(simulation);
}

/// The common case of a port with gates or shapers: one frame, nothing waits.
void EgressPort::settle_one(sim::Simulation& simulation, FrameIndex frame) {
  if (!passes_max_sdu(simulation, frame)) return;
  const sim::TrueTime now = simulation.now();
  const TrafficClass q = class_of(frame);
  shaping_->frame_waits(now, q);
  if (now < busy_until_) {
    admit(simulation, frame);
    wake_at(simulation, busy_until_);
    return;
  }
  const sim::TrueTime ready = shaping_->ready_time(now, q, shared_->traffic->frame(frame).length);
  if (ready == now) {
    start_selected(simulation, frame, q, true);
    return;
  }
  admit(simulation, frame);
  wake_at(simulation, ready);
}

void EgressPort::settle_many(sim::Simulation& simulation) {
  if (has_arrival_ && more_arrivals_.empty() && queues_.empty() && shaping_) {
    has_arrival_ = false;
    settle_one(simulation, arrival_.frame);
    return;
  }
  if (has_arrival_) more_arrivals_.insert(more_arrivals_.begin(), arrival_);
  has_arrival_ = false;
  sort_by_rank(more_arrivals_);
  const sim::TrueTime now = simulation.now();
  if (shaping_) {
    std::erase_if(more_arrivals_, [&](const Arrival& arrival) { return !passes_max_sdu(simulation, arrival.frame); });
    for (const Arrival& arrival : more_arrivals_) shaping_->frame_waits(now, class_of(arrival.frame));
  }

  sim::TrueTime next = busy_until_;
  if (now >= busy_until_) {
    // Selection looks at the head of each class; a frame that has just come is the head of a class that had none.
    ClassSet candidates = queues_.waiting();
    for (const Arrival& arrival : more_arrivals_) candidates = static_cast<ClassSet>(candidates | 1u << class_of(arrival.frame));
    const Selection selection = select(now, candidates);
    next = selection.ask_again;
    if (selection.found) {
      const TrafficClass q = selection.traffic_class;
      const auto is_of_class = [&](const Arrival& arrival) { return class_of(arrival.frame) == q; };
      if ((queues_.waiting() >> q & 1) != 0) {
        const FrameIndex frame = queues_.pop(q, shared_->entries);
        const bool is_last = queues_.frames(q) == 0 && std::none_of(more_arrivals_.begin(), more_arrivals_.end(), is_of_class);
        start_selected(simulation, frame, q, is_last);
      } else {
        const auto first = std::find_if(more_arrivals_.begin(), more_arrivals_.end(), is_of_class);
        const FrameIndex frame = first->frame;
        more_arrivals_.erase(first);
        start_selected(simulation, frame, q, std::none_of(more_arrivals_.begin(), more_arrivals_.end(), is_of_class));
      }
      next = busy_until_;
    }
  }
  for (const Arrival& arrival : more_arrivals_) admit(simulation, arrival.frame);
  more_arrivals_.clear();
  detours_ = !queues_.empty() || shaping_;
  if (!queues_.empty()) wake_at(simulation, next);
}

Selection EgressPort::select(sim::TrueTime now, ClassSet candidates) {
  if (!shaping_) return select_transmission(candidates);
  HeadLengths heads{};
  for (const Arrival& arrival : more_arrivals_) {
    const Frame& frame = shared_->traffic->frame(arrival.frame);
    std::uint16_t& head = heads[config_->traffic_class_of_priority[frame.priority]];
    if (head == 0) head = frame.length;  // the first of its class
  }
  for (ClassSet waiting = queues_.waiting(); waiting != 0;) {
    const TrafficClass q = highest_class(waiting);
    heads[q] = shared_->traffic->frame(queues_.head(q, shared_->entries)).length;
    waiting = static_cast<ClassSet>(waiting & ~(1u << q));
  }
  return shaping_->select(now, candidates, heads);
}

void EgressPort::start_selected(sim::Simulation& simulation, FrameIndex frame, TrafficClass q, bool queue_is_empty) {
  if (shaping_) shaping_->started(simulation.now(), q, shared_->traffic->frame(frame).length, queue_is_empty);
  start(simulation, frame);
}

bool EgressPort::passes_max_sdu(sim::Simulation& simulation, FrameIndex frame) {
  const Frame& record = shared_->traffic->frame(frame);
  const Octets overhead = mac_header + frame_check_sequence + (record.tagged ? vlan_tag : Octets{0});
  if (shaping_->fits_max_sdu(config_->traffic_class_of_priority[record.priority], record.length - overhead.count)) return true;
  ++frames_dropped_;
  shared_->traffic->drop(frame, DropReason::queue_max_sdu, id(), simulation);
  return false;
}

ConfigChange EgressPort::request_gates(sim::Simulation& simulation, const GateConfig& gates) {
  if (!shaping_) shaping_ = std::make_unique<PortShaping>(config_->shaping, *clock_, sim::Duration::from_ps(static_cast<std::int64_t>(octet_time_ps_)));
  detours_ = true;
  const ConfigChange change = shaping_->request_gates(simulation.now(), gates);
  // What waits may become ready earlier or later than was thought.
  if (!queues_.empty() && !settling_) {
    settling_ = true;
    simulation.settle_later(*this);
  }
  return change;
}

void EgressPort::admit(sim::Simulation& simulation, FrameIndex frame) {
  const Frame& record = shared_->traffic->frame(frame);
  const TrafficClass q = config_->traffic_class_of_priority[record.priority];
  DropReason reason{};
  if (!queues_.has_room(q, record.length, config_->queue_limits[q], reason)) {
    ++frames_dropped_;
    shared_->traffic->drop(frame, reason, id(), simulation);
    if (shaping_ && queues_.frames(q) == 0) shaping_->none_waits(simulation.now(), q);
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
