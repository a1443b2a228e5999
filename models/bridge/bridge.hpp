// A store-and-forward bridge (the users' word: switch).
#pragma once

#include <span>

#include "models/bridge/filtering_database.hpp"
#include "models/egress/egress_port.hpp"
#include "models/ingress/ingress_chain.hpp"
#include "sim/simulation.hpp"

namespace takt::models {

/// Takes a frame when its last bit has come and the forwarding delay is over (both are in the event's time), looks its
/// address up and hands it to the egress ports. It never sends a frame back through the port by which it came.
class alignas(64) Bridge final : public sim::Component {
 public:
  Bridge(Traffic& traffic, std::span<EgressPort> ports) : traffic_(&traffic), ports_(ports.data()), port_count_(ports.size()) {}

  void set_id(sim::ComponentId id) { id_ = id; }
  sim::ComponentId id() const { return id_; }
  FilteringDatabase& filtering_database() { return filtering_database_; }
  const FilteringDatabase& filtering_database() const { return filtering_database_; }
  void set_ingress_chain(IngressChain* chain) { chain_ = chain; }

  void handle(sim::Simulation& simulation, const sim::Event& event) override;
  void prefetch(const sim::Event& event, Ahead ahead) const override;

 private:
  void forward_to_many(sim::Simulation& simulation, ArrivalArgument arrival, std::span<const std::uint16_t> egress);

  // What every frame touches lies in the first cache line.
  Traffic* traffic_;
  EgressPort* ports_;
  IngressChain* chain_ = nullptr;
  FilteringDatabase filtering_database_;
  std::size_t port_count_;
  sim::ComponentId id_;
};

}  // namespace takt::models
