// A bridge (the users' word: switch): stores and forwards, or cuts through where its ports are told to.
#pragma once

#include <span>
#include <vector>

#include "models/bridge/filtering_database.hpp"
#include "models/bridge/forwarding_jitter.hpp"
#include "models/egress/egress_port.hpp"
#include "models/ingress/ingress_chain.hpp"
#include "sim/simulation.hpp"

namespace takt::models {

/// Takes a frame when its last bit has come and the forwarding delay is over (both are in the event's time), looks its
/// address up and hands it to the egress ports. It never sends a frame back through the port by which it came.
class alignas(64) Bridge final : public sim::Component {
 public:
  Bridge(Traffic& traffic, std::span<EgressPort> ports, sim::Duration forwarding_delay)
      : traffic_(&traffic), ports_(ports.data()), port_count_(ports.size()), forwarding_delay_(forwarding_delay) {}

  void set_id(sim::ComponentId id) {
    id_ = id;
    source_ = sim::EventSource(id);
  }
  sim::ComponentId id() const { return id_; }
  FilteringDatabase& filtering_database() { return filtering_database_; }
  const FilteringDatabase& filtering_database() const { return filtering_database_; }
  /// Every frame passes the chain, which outlives the bridge.
  void set_ingress_chain(IngressChain* chain) {
    chain_ = chain;
    looks_closer_ = true;
  }
  /// Takes the link-local frames.
  void set_link_local_receiver(LinkLocalReceiver* receiver) { link_local_ = receiver; }
  /// Frames take that much longer, besides the fixed delay. Nothing is cut through then. `jitter` outlives the bridge.
  void set_jitter(ForwardingJitter* jitter) {
    jitter_ = jitter;
    looks_closer_ = true;
  }
  /// Some port takes tags off.
  void set_untags() { looks_closer_ = true; }

  void handle(sim::Simulation& simulation, const sim::Event& event) override;
  /// What the chain does to frames of one instant depends on their order: it sees them by port number.
  void settle(sim::Simulation& simulation) override;
  void prefetch(const sim::Event& event, Ahead ahead) const override;

 private:
  /// What a frame still lacks when only its header has come.
  struct Header {
    sim::TrueTime stored;                 ///< when it has wholly come and the forwarding delay is over
    Link* link = nullptr;                 ///< by which it comes
  };
  struct Arrived {
    FrameIndex frame;
    std::uint16_t port = 0;
    bool only_header = false;
    Header header;
  };
  void pass_on(sim::Simulation& simulation, ArrivalArgument arrival);
  [[gnu::noinline]] void leave(sim::Simulation& simulation, sim::EventKind kind, std::uint16_t from);
  [[gnu::noinline]] void receive_flagged(sim::Simulation& simulation, ArrivalArgument arrival);
  void look_closer(sim::Simulation& simulation, ArrivalArgument arrival);
  void pass_through(sim::Simulation& simulation, std::span<const FrameIndex> frames, std::uint16_t from, const Header* header);
  void forward(sim::Simulation& simulation, FrameIndex frame, std::uint16_t from, const Header* header);
  void forward_to_many(sim::Simulation& simulation, FrameIndex frame, std::uint16_t from, std::span<const std::uint16_t> egress, const Header* header);
  void hand_over(sim::Simulation& simulation, FrameIndex frame, std::uint16_t from, EgressPort& port, const Header* header);

  // What every frame touches lies in the first cache line.
  Traffic* traffic_;
  EgressPort* ports_;
  bool looks_closer_ = false;
  FilteringDatabase filtering_database_;
  std::size_t port_count_;
  IngressChain* chain_ = nullptr;
  LinkLocalReceiver* link_local_ = nullptr;
  sim::Duration forwarding_delay_;
  sim::ComponentId id_;
  sim::EventSource source_;               // of its own events
  ForwardingJitter* jitter_ = nullptr;
  std::vector<Arrived> arrived_;          // at this instant; waits for the chain
};

}  // namespace takt::models
