// SPDX-License-Identifier: Apache-2.0
// A bridge (users say switch): stores and forwards, or cuts through where its ports are configured to.
#pragma once

#include <span>
#include <vector>

#include "models/bridge/filtering_database.hpp"
#include "models/bridge/forwarding_jitter.hpp"
#include "models/bridge/internal_port.hpp"
#include "models/bridge/routes.hpp"
#include "models/egress/egress_port.hpp"
#include "models/ingress/ingress_chain.hpp"
#include "sim/simulation.hpp"

namespace takt::models {

/// Takes a frame when its last bit has come and the forwarding delay is over (both are in the event's time), looks its
/// address up and hands it to the egress ports. It never sends a frame back through the port by which it came.
/// In a station it shares the ports with a host, which sends through it and gets what is forwarded to the internal
/// port. A host with several interfaces chooses among them by such a bridge as well, by which nothing comes in.
class alignas(64) Bridge final : public sim::Component {
 public:
  Bridge(Traffic& traffic, std::span<EgressPort> ports, sim::Duration forwarding_delay)
      : traffic_(&traffic),
        ports_(ports.data()),
        port_count_(static_cast<std::uint32_t>(ports.size())),
        forwarding_delay_(forwarding_delay) {}

  void set_id(sim::ComponentId id) {
    id_ = id;
    source_ = sim::EventSource(id);
  }
  sim::ComponentId id() const { return id_; }
  ReceptionChecks& reception_checks() { return reception_checks_; }
  FilteringDatabase& filtering_database() { return filtering_database_; }
  const FilteringDatabase& filtering_database() const { return filtering_database_; }
  /// Every frame passes the chain, which outlives the bridge.
  void set_ingress_chain(IngressChain* chain) {
    chain_ = chain;
    reception_checks_.require_always();
    update_fast_path();
  }
  /// What is found in the filtering database is noted there; `first_port` is the number of the bridge's first port.
  /// `routes` outlives the bridge. Not for stations.
  void note_routes(Routes& routes, std::uint32_t first_port) {
    routes_ = &routes;
    first_port_ = first_port;
  }
  /// Takes the link-local frames.
  void set_link_local_receiver(LinkLocalReceiver* receiver) { link_local_ = receiver; }
  /// Frames take that much longer, besides the fixed delay. Nothing is cut through then. `jitter` outlives the bridge.
  void set_jitter(ForwardingJitter* jitter) {
    jitter_ = jitter;
    reception_checks_.require_always();
    update_fast_path();
  }
  /// Some port takes tags off.
  void set_untags() {
    untags_ = true;
    reception_checks_.require_always();
    update_fast_path();
  }
  /// Emits a trace record per arrival.
  void trace_arrivals() {
    tells_arrivals_ = true;
    reception_checks_.require_always();
    update_fast_path();
  }
  /// The host of the station; it outlives the bridge.
  void set_host(InternalReceiver& host) { host_ = &host; }

  /// A frame of the node itself, at the present instant: it leaves by the ports of its filtering entry, without a
  /// forwarding delay.
  void send(sim::Simulation& simulation, FrameIndex frame, std::uint32_t sender);
  /// The port by which such a frame leaves as it is, if that is one and can be said at once;
  /// FilteringDatabase::not_at_once otherwise.
  std::uint32_t port_of_own(const Frame& frame) const {
    const std::uint32_t port = filtering_database_.single_egress_port(frame.vlan, frame.destination);
    return port < port_count_ && !frame.link_local && !untags_ ? port : FilteringDatabase::not_at_once;
  }

  void handle(sim::Simulation& simulation, const sim::Event& event) override;
  /// What the chain does to frames of one instant depends on their order: it sees them by port number.
  void decide(sim::Simulation& simulation) override;
  void prefetch(const sim::Event& event, Ahead ahead) const override;

 private:
  /// What a frame still lacks when only its header has come.
  struct Header {
    sim::TrueTime stored;  ///< when it has wholly come and the forwarding delay is over
    Link* link = nullptr;  ///< by which it comes
  };
  struct Arrived {
    FrameIndex frame;
    std::uint16_t port = 0;
    bool only_header = false;
    Header header;
  };
  std::uint32_t look_up(Frame& frame);
  [[gnu::noinline]] void route_looked_up(sim::Simulation& simulation, FrameIndex index, Frame& frame,
                                         std::uint16_t from);
  /// `is_last`: Simulation::is_last() has said so.
  template <bool is_last>
  void route_to(sim::Simulation& simulation, FrameIndex index, const Frame& frame, std::uint16_t from,
                std::uint32_t port);
  template <bool is_last>
  void route(sim::Simulation& simulation, FrameIndex index, Frame& frame, std::uint16_t from);
  [[gnu::noinline]] void pass_chain(sim::Simulation& simulation, ArrivalArgument arrival);
  [[gnu::noinline]] void receive(sim::Simulation& simulation, ArrivalArgument arrival);
  [[gnu::noinline]] void leave(sim::Simulation& simulation, sim::EventKind kind, std::uint16_t from);
  [[gnu::noinline]] void handle_internal(sim::Simulation& simulation, const sim::Event& event, ArrivalArgument arrival);
  void accept(sim::Simulation& simulation, FrameIndex frame, std::uint16_t from, const Header* header);
  /// Precondition: the record is not shared.
  static void unmark(Frame& frame) {
    frame.marked = false;
    frame.queue_priority = frame.priority;
  }
  /// The frame without what an earlier node has marked.
  FrameIndex unmarked(FrameIndex index, Frame& frame) {
    if (frame.references != 1) [[unlikely]] {
      const FrameIndex own = traffic_->own(index, id_);
      return unmarked(own, traffic_->frame(own));
    }
    unmark(frame);
    return index;
  }
  void update_fast_path() { only_polices_ = chain_ != nullptr && jitter_ == nullptr && !untags_ && !tells_arrivals_; }
  void pass_through(sim::Simulation& simulation, std::span<const FrameIndex> frames, std::uint16_t from,
                    const Header* header);
  // `rank` is the number of the port by which the frame came, or greater than that of any port.
  [[gnu::noinline]] void forward(sim::Simulation& simulation, FrameIndex frame, std::uint32_t rank,
                                 const Header* header);
  void forward_to_many(sim::Simulation& simulation, FrameIndex frame, std::uint32_t rank,
                       std::span<const std::uint16_t> egress, const Header* header);
  void hand_over(sim::Simulation& simulation, FrameIndex frame, std::uint32_t rank, std::uint16_t port,
                 const Header* header);
  void hand_to_host(sim::Simulation& simulation, FrameIndex frame, std::uint16_t from, const Header* header);
  void handle_stored_frame(sim::Simulation& simulation, ArrivalArgument arrival);

  // What every frame touches lies in the first cache line.
  Traffic* traffic_;
  EgressPort* ports_;
  ReceptionChecks reception_checks_;
  std::uint32_t first_port_ = 0;
  bool only_polices_ = false;  // it looks closer because it has a chain, for no other reason
  Routes* routes_ = nullptr;   // null in stations and hosts
  std::uint32_t port_count_;
  FilteringDatabase filtering_database_;
  IngressChain* chain_ = nullptr;
  LinkLocalReceiver* link_local_ = nullptr;
  sim::Duration forwarding_delay_;
  sim::ComponentId id_;
  sim::EventSource source_;  // of its own events
  ForwardingJitter* jitter_ = nullptr;
  std::vector<Arrived> arrived_;      // at this instant; waits for the chain
  InternalReceiver* host_ = nullptr;  // of a station
  bool tells_arrivals_ = false;
  bool untags_ = false;
};

}  // namespace takt::models
