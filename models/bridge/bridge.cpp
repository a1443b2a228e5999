#include "models/bridge/bridge.hpp"

#include "sim/insertion_sort.hpp"

namespace takt::models {
namespace {
constexpr auto leaves_now = static_cast<sim::EventKind>(NodeEvent::first_free);
constexpr auto stored_for_host = static_cast<sim::EventKind>(static_cast<unsigned>(NodeEvent::first_free) + 1);
}

/// Of a frame that is on its stream's route the port is remembered.
inline std::uint32_t Bridge::port_for(Frame& frame) {
  if (routes_ == nullptr || !frame.on_route || frame.hop >= Routes::most_hops) return filtering_database_.port_at_once(frame.vlan, frame.destination);
  const std::uint32_t port = routes_->at(frame) - first_port_;
  if (port >= port_count_) [[unlikely]] return look_up(frame);
  ++frame.hop;
  return port;
}

std::uint32_t Bridge::look_up(Frame& frame) {
  const FilteringDatabase::Entry entry = filtering_database_.find(frame.vlan, frame.destination);
  const bool is_one = entry.found() && entry.is_one_port();
  if (is_one) routes_->at(frame) = first_port_ + entry.port();
  ++frame.hop;
  return is_one ? entry.port() : FilteringDatabase::not_at_once;
}

/// The way of nearly every frame: it calls nothing but what it ends with.
inline void Bridge::pass_on(sim::Simulation& simulation, const sim::Event& event, ArrivalArgument arrival) {
  Frame& frame = traffic_->frame(arrival.frame);
  const std::uint32_t port = port_for(frame);
  if (port != FilteringDatabase::not_at_once && port != arrival.port && simulation.instant_is_surely_complete() && !holds_) [[likely]]
    ports_[port].offer_last(simulation, arrival.frame, frame, arrival.port);
  else
    pass_on_among_others(simulation, event, arrival, port, frame);
}

/// Something else happens at this instant, but seldom does more come to the bridge: then a plain port need not wait for its end, when it has long left the cache. Here, too, nothing is
/// called but what it ends with.
void Bridge::pass_on_among_others(sim::Simulation& simulation, const sim::Event& event, ArrivalArgument arrival, std::uint32_t port, const Frame& frame) {
  if (port == FilteringDatabase::not_at_once || port == arrival.port || holds_) [[unlikely]]
    pass_on_closely(simulation, event, arrival, port);
  else if (EgressPort& egress = ports_[port]; routes_ == nullptr || !egress.decides_by_itself() || !simulation.events_follow_targets())
    egress.offer_last(simulation, arrival.frame, frame, arrival.port);
  else if (simulation.surely_none_follows(event)) [[likely]]
    egress.take_alone(simulation, arrival.frame, frame, arrival.port);
  else
    pass_on_closely(simulation, event, arrival, port);
}

void Bridge::pass_on_closely(sim::Simulation& simulation, const sim::Event& event, ArrivalArgument arrival, std::uint32_t port) {
  if (port == FilteringDatabase::not_at_once || port == arrival.port || holds_ || simulation.another_follows(event))
    gather(simulation, event, arrival, port);
  else
    ports_[port].take_alone(simulation, arrival.frame, traffic_->frame(arrival.frame), arrival.port);
}

/// More may come to the bridge at this instant. All of it is for the bridge's own events, one after the other.
void Bridge::gather(sim::Simulation& simulation, const sim::Event& event, ArrivalArgument arrival, std::uint32_t port) {
  if (port == FilteringDatabase::not_at_once || port == arrival.port) {
    forward(simulation, arrival.frame, arrival.port, nullptr);
  } else if (EgressPort& egress = ports_[port]; routes_ == nullptr || !egress.decides_by_itself() || !simulation.events_follow_targets()) {
    egress.offer_last(simulation, arrival.frame, traffic_->frame(arrival.frame), arrival.port);
  } else if (holds_ || simulation.another_follows(event)) {
    if (egress.gather(arrival.frame, arrival.port)) held_.push_back(&egress);
    holds_ = true;
  } else {
    egress.take_alone(simulation, arrival.frame, traffic_->frame(arrival.frame), arrival.port);
  }
  release_if_last(simulation, event);
}

/// When nothing more comes to the bridge at this instant, whatever the last event was.
inline void Bridge::release_if_last(sim::Simulation& simulation, const sim::Event& event) {
  if (!holds_ || simulation.another_follows(event)) return;
  for (EgressPort* const port : held_) port->decide(simulation);
  held_.clear();
  holds_ = false;
}

void Bridge::handle(sim::Simulation& simulation, const sim::Event& event) {
  const ArrivalArgument arrival = ArrivalArgument::unpack(event.argument);
  const bool has_arrived = event.kind() == static_cast<sim::EventKind>(NodeEvent::frame_arrived);
  if (!attention_.is_needed() && arrival.flags == 0 && has_arrived) [[likely]]
    pass_on(simulation, event, arrival);
  else if (only_polices_ && has_arrived && (arrival.flags & ~unsigned{ArrivalArgument::check}) == 0 && simulation.instant_is_surely_complete() && !attention_.asks_links())
    police_alone(simulation, arrival);
  else if (!attention_.is_demanded() && arrival.flags == 0 && has_arrived)
    receive_perhaps_cut(simulation, event, arrival);
  else
    handle_seldom(simulation, event, arrival);
}

/// The way of nearly every frame through a bridge with a chain: nothing else comes at this instant, so nothing can come before it, and the frame stays as it is.
void Bridge::police_alone(sim::Simulation& simulation, ArrivalArgument arrival) {
  Frame& frame = traffic_->frame(arrival.frame);
  const bool is_uncertain = arrival.flags != 0 && !ports_[arrival.port].incoming().surely_delivers();
  if (is_uncertain || frame.bad_fcs || frame.link_local || (frame.marked && frame.references != 1)) [[unlikely]] {
    police_alone_exactly(simulation, arrival);
    return;
  }
  if (frame.marked) unmark(frame);
  if (!chain_->passes_as_it_is(frame, arrival.port, simulation.now() - forwarding_delay_)) [[unlikely]] {
    police_alone_exactly(simulation, arrival);
    return;
  }
  const std::uint32_t port = port_for(frame);
  if (port != FilteringDatabase::not_at_once && port != arrival.port) [[likely]]
    ports_[port].take_only(simulation, arrival.frame, frame, arrival.port);
  else
    forward(simulation, arrival.frame, arrival.port, nullptr);
}

void Bridge::police_alone_exactly(sim::Simulation& simulation, ArrivalArgument arrival) {
  FrameIndex frame = arrival.frame;
  if (arrival.flags != 0 && !ports_[arrival.port].incoming().receive(simulation, frame, arrival.flags)) return;
  Frame& record = traffic_->frame(frame);
  if (record.bad_fcs || record.link_local) [[unlikely]] {
    take_in(simulation, frame, arrival.port, nullptr);
    return;
  }
  if (record.marked) frame = unmarked(frame, record);
  const std::span<const FrameIndex> passed = chain_->pass(simulation, {frame, arrival.port, simulation.now() - forwarding_delay_});
  if (passed.size() == 1) [[likely]] {
    Frame& going_on = traffic_->frame(passed.front());
    const std::uint32_t port = port_for(going_on);
    if (port != FilteringDatabase::not_at_once && port != arrival.port) [[likely]] {
      ports_[port].take_only(simulation, passed.front(), going_on, arrival.port);
      return;
    }
  }
  for (const FrameIndex copy : passed) forward(simulation, copy, arrival.port, nullptr);
}

void Bridge::handle_seldom(sim::Simulation& simulation, const sim::Event& event, ArrivalArgument arrival) {
  if (event.kind() == static_cast<sim::EventKind>(NodeEvent::frame_arrived))
    look_closer(simulation, arrival);
  else if (event.kind() == stored_for_host)
    take_stored(simulation, arrival);
  else
    leave(simulation, event.kind(), arrival.port);
  release_if_last(simulation, event);
}

/// A frame is through the part of the bridge that takes a random time.
void Bridge::leave(sim::Simulation& simulation, sim::EventKind kind, std::uint16_t from) {
  TAKT_CHECK(kind == leaves_now, "an event of another component");
  jitter_->leave(from, [&](FrameIndex frame) { forward(simulation, frame, from, nullptr); });
}

/// A frame was cut whose arrival has been announced to this bridge.
void Bridge::receive_perhaps_cut(sim::Simulation& simulation, const sim::Event& event, ArrivalArgument arrival) {
  if (ports_[arrival.port].incoming().receive(simulation, arrival.frame, arrival.flags))
    pass_on(simulation, event, arrival);
  else
    release_if_last(simulation, event);
}

void Bridge::prefetch(const sim::Event& event, Ahead ahead) const {
  const Frame& frame = traffic_->frame(ArrivalArgument::unpack(event.argument).frame);
  if (routes_ != nullptr && frame.on_route && frame.hop < Routes::most_hops) {
    if (ahead == Ahead::two_events)
      routes_->prefetch(frame);
    else if (const std::uint32_t port = routes_->at(frame) - first_port_; port < port_count_)
      ports_[port].prefetch_hot();
    return;
  }
  if (ahead == Ahead::two_events) {
    filtering_database_.prefetch(frame.vlan, frame.destination);
    return;
  }
  const FilteringDatabase::Entry entry = filtering_database_.find(frame.vlan, frame.destination);
  if (entry.found() && entry.is_one_port()) ports_[entry.port()].prefetch_hot();
}

/// A frame in a condition of its own, or a bridge that does more than forward.
void Bridge::look_closer(sim::Simulation& simulation, ArrivalArgument arrival) {
  FrameIndex frame = arrival.frame;
  Link& link = ports_[arrival.port].incoming();
  if ((arrival.is_uncertain() || attention_.asks_links()) && !link.receive(simulation, frame, arrival.flags)) return;
  if (tells_arrivals_ && simulation.trace() != nullptr)
    simulation.trace()->record(
        {simulation.now(), static_cast<std::uint32_t>(Occurrence::arrived), id_, frame.value,
         ArrivalDetail{arrival.port, link.sender(), (arrival.flags & ArrivalArgument::header_only) != 0}.pack()});
  Header header;
  if ((arrival.flags & ArrivalArgument::header_only) != 0) {
    header = {link.complete_at(simulation.now(), traffic_->frame(frame)), &link};
    take_in(simulation, frame, arrival.port, &header);
  } else {
    take_in(simulation, frame, arrival.port, nullptr);
  }
}

/// A frame that has come, or its header.
void Bridge::take_in(sim::Simulation& simulation, FrameIndex frame, std::uint16_t from, const Header* header) {
  if (header == nullptr && traffic_->frame(frame).bad_fcs) {
    traffic_->drop(frame, DropReason::bad_fcs, id_, simulation);
    return;
  }
  if (traffic_->frame(frame).link_local) {
    forward(simulation, frame, from, nullptr);
    return;
  }
  if (Frame& record = traffic_->frame(frame); record.marked) frame = unmarked(frame, record);
  if (chain_ == nullptr) {
    pass_through(simulation, std::span(&frame, 1), from, header);
    return;
  }
  if (arrived_.empty()) simulation.settle_first(*this);
  arrived_.push_back({frame, from, header != nullptr, header != nullptr ? *header : Header{}});
}

void Bridge::settle(sim::Simulation& simulation) {
  sim::insertion_sort(arrived_, [](const Arrived& a, const Arrived& b) { return a.port < b.port; });
  for (const Arrived& arrived : arrived_)
    pass_through(simulation, chain_->pass(simulation, {arrived.frame, arrived.port, simulation.now() - forwarding_delay_}), arrived.port, arrived.only_header ? &arrived.header : nullptr);
  arrived_.clear();
}

/// What has come in by one arrival goes on, at once or when its random time is over.
void Bridge::pass_through(sim::Simulation& simulation, std::span<const FrameIndex> frames, std::uint16_t from, const Header* header) {
  if (jitter_ == nullptr) {
    for (const FrameIndex frame : frames) forward(simulation, frame, from, header);
    return;
  }
  TAKT_CHECK(header == nullptr, "a bridge with jitter cuts nothing through");
  if (!frames.empty()) simulation.schedule(source_, jitter_->enter(from, simulation.now(), frames), sim::Phase::arrival, id_, leaves_now, ArrivalArgument::pack(frames[0], from));
}

void Bridge::send(sim::Simulation& simulation, FrameIndex frame, std::uint32_t sender) {
  if (const std::uint32_t port = port_of_own(traffic_->frame(frame)); port != FilteringDatabase::not_at_once) [[likely]]
    ports_[port].offer(simulation, frame, rank_of_own(sender));
  else
    forward(simulation, frame, rank_of_own(sender), nullptr);
}

void Bridge::forward(sim::Simulation& simulation, FrameIndex frame, std::uint32_t rank, const Header* header) {
  const Frame& record = traffic_->frame(frame);
  if (record.link_local && link_local_ != nullptr) {
    link_local_->receive(simulation, frame, static_cast<std::uint16_t>(rank), simulation.now() - forwarding_delay_);
    return;
  }
  const FilteringDatabase::Entry entry = filtering_database_.find(record.vlan, record.destination);
  const std::uint16_t one = entry.port();
  if (!entry.found())
    forward_to_many(simulation, frame, rank, {}, header);
  else
    forward_to_many(simulation, frame, rank, entry.is_one_port() ? std::span(&one, 1) : filtering_database_.ports_of(entry), header);
}

void Bridge::forward_to_many(sim::Simulation& simulation, FrameIndex frame, std::uint32_t rank, std::span<const std::uint16_t> egress,
                             const Header* header) {
  // The last port gets the frame itself, so that nobody looks at a record that has been released.
  std::uint16_t last = 0;
  bool found = false;
  for (const std::uint16_t port : egress) {
    TAKT_CHECK(port < port_count_ || (port == internal_port && host_ != nullptr), "a filtering entry names a port of its bridge");
    if (port == rank || (port == internal_port && rank >= rank_of_own(0))) continue;
    if (found) {
      traffic_->copy(frame);
      hand_over(simulation, frame, rank, last, header);
    }
    last = port;
    found = true;
  }
  if (found)
    hand_over(simulation, frame, rank, last, header);
  else
    traffic_->drop(frame, DropReason::no_filtering_entry, id_, simulation);
}

void Bridge::hand_over(sim::Simulation& simulation, FrameIndex frame, std::uint32_t rank, std::uint16_t number, const Header* header) {
  if (number == internal_port) {
    hand_to_host(simulation, frame, static_cast<std::uint16_t>(rank), header);
    return;
  }
  EgressPort& port = ports_[number];
  if (port.untags() && traffic_->frame(frame).tagged) {
    frame = traffic_->own(frame, id_);
    traffic_->set_tags(frame, false, traffic_->frame(frame).r_tagged);
  }
  if (header != nullptr)
    port.offer_header(simulation, frame, rank, header->stored, *header->link);
  else
    port.offer(simulation, frame, rank);
}

/// A host gets whole frames.
void Bridge::hand_to_host(sim::Simulation& simulation, FrameIndex frame, std::uint16_t from, const Header* header) {
  if (header == nullptr) {
    host_->receive_internally(simulation, frame, from);
    return;
  }
  header->link->passed_on(simulation.now(), frame, traffic_->frame(frame), header->stored);
  simulation.schedule(source_, header->stored, sim::Phase::arrival, id_, stored_for_host, ArrivalArgument::pack(frame, from));
}

void Bridge::take_stored(sim::Simulation& simulation, ArrivalArgument arrival) {
  if (traffic_->frame(arrival.frame).bad_fcs)
    traffic_->drop(arrival.frame, DropReason::bad_fcs, id_, simulation);
  else
    host_->receive_internally(simulation, arrival.frame, arrival.port);
}

}  // namespace takt::models
