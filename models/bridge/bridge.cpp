// SPDX-License-Identifier: Apache-2.0
#include "models/bridge/bridge.hpp"

#include "sim/insertion_sort.hpp"

namespace takt::models {
namespace {
constexpr auto leaves_now = static_cast<sim::EventKind>(NodeEvent::first_free);
constexpr auto stored_for_host = static_cast<sim::EventKind>(static_cast<unsigned>(NodeEvent::first_free) + 1);
}  // namespace

template <bool is_last>
inline void Bridge::route_to(sim::Simulation& simulation, FrameIndex index, const Frame& frame, std::uint16_t from,
                             std::uint32_t port) {
  if (port == FilteringDatabase::not_at_once || port == from) [[unlikely]]
    forward(simulation, index, from, nullptr);
  else if constexpr (is_last)
    ports_[port].offer_only(simulation, index, frame, from);
  else
    ports_[port].offer_last(simulation, index, frame, from);
}

/// A frame that has passed whatever comes before the filtering database. Of one that is on its stream's route the port
/// is remembered. All calls are tail calls, so that no registers are saved.
template <bool is_last>
inline void Bridge::route(sim::Simulation& simulation, FrameIndex index, Frame& frame, std::uint16_t from) {
  if (routes_ == nullptr || !frame.on_route || frame.hop >= Routes::most_hops) {
    route_to<is_last>(simulation, index, frame, from,
                      filtering_database_.single_egress_port(frame.vlan, frame.destination));
  } else if (const std::uint32_t port = routes_->at(frame) - first_port_; port < port_count_) [[likely]] {
    ++frame.hop;
    route_to<is_last>(simulation, index, frame, from, port);
  } else {
    route_looked_up(simulation, index, frame, from);
  }
}

void Bridge::route_looked_up(sim::Simulation& simulation, FrameIndex index, Frame& frame, std::uint16_t from) {
  route_to<false>(simulation, index, frame, from, look_up(frame));
}

std::uint32_t Bridge::look_up(Frame& frame) {
  const FilteringDatabase::Entry entry = filtering_database_.find(frame.vlan, frame.destination);
  const bool is_one = entry.found() && entry.is_one_port();
  if (is_one) routes_->at(frame) = first_port_ + entry.port();
  ++frame.hop;
  return is_one ? entry.port() : FilteringDatabase::not_at_once;
}

void Bridge::handle(sim::Simulation& simulation, const sim::Event& event) {
  const ArrivalArgument arrival = ArrivalArgument::unpack(event.argument);
  if (event.kind() != static_cast<sim::EventKind>(NodeEvent::frame_arrived)) [[unlikely]]
    handle_internal(simulation, event, arrival);
  else if (arrival.flags == 0 && !reception_checks_.is_needed()) [[likely]]
    route<false>(simulation, arrival.frame, traffic_->frame(arrival.frame), arrival.port);
  else if (only_polices_ && simulation.is_last() && !reception_checks_.has_cancelled_arrivals())
    pass_chain(simulation, arrival);
  else
    receive(simulation, arrival);
}

/// Most frames through a bridge with a chain, at the last event of the instant: sound, and they stay as they are. If
/// not, nothing has changed, and receive() follows.
void Bridge::pass_chain(sim::Simulation& simulation, ArrivalArgument arrival) {
  Frame& frame = traffic_->frame(arrival.frame);
  const bool is_uncertain = arrival.flags != 0 && ((arrival.flags & ArrivalArgument::header_only) != 0 ||
                                                   !ports_[arrival.port].incoming().is_loss_free());
  if (is_uncertain || frame.bad_fcs || frame.link_local || (frame.marked && frame.references != 1)) [[unlikely]] {
    receive(simulation, arrival);
    return;
  }
  if (frame.marked) unmark(frame);
  if (!chain_->passes_as_it_is(frame, arrival.port, simulation.now() - forwarding_delay_)) [[unlikely]]
    receive(simulation, arrival);
  else
    route<true>(simulation, arrival.frame, frame, arrival.port);
}

/// A frame that its link may have lost, or a bridge that does more than forward.
void Bridge::receive(sim::Simulation& simulation, ArrivalArgument arrival) {
  FrameIndex frame = arrival.frame;
  Link& link = ports_[arrival.port].incoming();
  if ((arrival.is_uncertain() || reception_checks_.has_cancelled_arrivals()) &&
      !link.receive(simulation, frame, arrival.flags))
    return;
  if (tells_arrivals_ && simulation.trace() != nullptr)
    simulation.trace()->record(
        {simulation.now(), static_cast<std::uint32_t>(Occurrence::arrived), id_, frame.value,
         ArrivalDetail{arrival.port, link.sender(), (arrival.flags & ArrivalArgument::header_only) != 0}.pack()});
  if (arrival.flags == 0 &&
      !reception_checks_
           .is_always_required()) {  // a plain bridge, to which the arrival of a frame that was cut has been announced
    route<false>(simulation, frame, traffic_->frame(frame), arrival.port);
  } else if ((arrival.flags & ArrivalArgument::header_only) == 0) {
    accept(simulation, frame, arrival.port, nullptr);
  } else {
    const Header header{link.complete_at(simulation.now(), traffic_->frame(frame)), &link};
    accept(simulation, frame, arrival.port, &header);
  }
}

void Bridge::handle_internal(sim::Simulation& simulation, const sim::Event& event, ArrivalArgument arrival) {
  if (event.kind() == stored_for_host)
    handle_stored_frame(simulation, arrival);
  else
    leave(simulation, event.kind(), arrival.port);
}

/// A frame is through the part of the bridge that takes a random time.
void Bridge::leave(sim::Simulation& simulation, sim::EventKind kind, std::uint16_t from) {
  TAKT_CHECK(kind == leaves_now, "an event of another component");
  jitter_->leave(from, [&](FrameIndex frame) { forward(simulation, frame, from, nullptr); });
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

/// A frame that has come, or its header.
void Bridge::accept(sim::Simulation& simulation, FrameIndex frame, std::uint16_t from, const Header* header) {
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
  } else if (simulation.is_last()) {
    pass_through(simulation, chain_->pass(simulation, {frame, from, simulation.now() - forwarding_delay_}), from,
                 header);
  } else {
    if (arrived_.empty()) simulation.decide_later(id_, sim::Decision::ingress);
    arrived_.push_back({frame, from, header != nullptr, header != nullptr ? *header : Header{}});
  }
}

void Bridge::decide(sim::Simulation& simulation) {
  sim::insertion_sort(arrived_, [](const Arrived& a, const Arrived& b) { return a.port < b.port; });
  for (const Arrived& arrived : arrived_)
    pass_through(simulation,
                 chain_->pass(simulation, {arrived.frame, arrived.port, simulation.now() - forwarding_delay_}),
                 arrived.port, arrived.only_header ? &arrived.header : nullptr);
  arrived_.clear();
}

/// What has come in by one arrival goes on, at once or when its random time is over.
void Bridge::pass_through(sim::Simulation& simulation, std::span<const FrameIndex> frames, std::uint16_t from,
                          const Header* header) {
  if (jitter_ == nullptr) {
    if (frames.size() == 1 && header == nullptr && !untags_ && !traffic_->frame(frames[0]).link_local) [[likely]] {
      route<false>(simulation, frames[0], traffic_->frame(frames[0]), from);
      return;
    }
    for (const FrameIndex frame : frames) forward(simulation, frame, from, header);
    return;
  }
  TAKT_CHECK(header == nullptr, "a bridge with jitter cuts nothing through");
  if (!frames.empty())
    simulation.schedule(source_, jitter_->enter(from, simulation.now(), frames), sim::Phase::arrival, id_, leaves_now,
                        ArrivalArgument::pack(frames[0], from));
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
    forward_to_many(simulation, frame, rank,
                    entry.is_one_port() ? std::span(&one, 1) : filtering_database_.ports_of(entry), header);
}

void Bridge::forward_to_many(sim::Simulation& simulation, FrameIndex frame, std::uint32_t rank,
                             std::span<const std::uint16_t> egress, const Header* header) {
  // The last port gets the frame itself, so that nobody looks at a record that has been released.
  std::uint16_t last = 0;
  bool found = false;
  for (const std::uint16_t port : egress) {
    TAKT_CHECK(port < port_count_ || (port == internal_port && host_ != nullptr),
               "a filtering entry names a port of its bridge");
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

void Bridge::hand_over(sim::Simulation& simulation, FrameIndex frame, std::uint32_t rank, std::uint16_t number,
                       const Header* header) {
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
  simulation.schedule(source_, header->stored, sim::Phase::arrival, id_, stored_for_host,
                      ArrivalArgument::pack(frame, from));
}

void Bridge::handle_stored_frame(sim::Simulation& simulation, ArrivalArgument arrival) {
  if (traffic_->frame(arrival.frame).bad_fcs)
    traffic_->drop(arrival.frame, DropReason::bad_fcs, id_, simulation);
  else
    host_->receive_internally(simulation, arrival.frame, arrival.port);
}

}  // namespace takt::models
