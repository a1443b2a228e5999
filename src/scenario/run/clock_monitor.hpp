// Watches how far the nodes' clocks are from those of their grandmasters. Sees true time, which no node does.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "models/network.hpp"
#include "scenario/figures/accounts.hpp"
#include "sim/simulation.hpp"

namespace takt::scenario {

/// What one node's clock has shown, by the differences to its grandmaster's clock at the instants that were looked at.
struct ClockFigures {
  models::NodeIndex node;
  std::optional<sim::TrueTime> locked;      ///< first time that its servo was locked and within 1 us; never for who was always grandmaster
  /// Of the looks since then.
  struct Offsets {
    std::uint64_t samples = 0;
    sim::Duration least;
    sim::Duration greatest;
    sim::int128 sum = 0;                    ///< ps
    sim::int128 sum_of_squares = 0;         ///< ps^2
    void add(sim::Duration offset);
  };
  Accounts<Offsets> offsets;
  /// Of all looks, without sign.
  struct Distances {
    std::uint64_t samples = 0;
    sim::Duration greatest;
  };
  Accounts<Distances> distances;
};

/// Takes the series of offsets, one call for each look and node.
class ClockSampleSink {
 public:
  virtual ~ClockSampleSink() = default;
  virtual void sample(sim::TrueTime time, models::NodeIndex node, models::NodeIndex grandmaster, sim::Duration offset) = 0;
};

/// Looks every so often, at instants of true time. It changes nothing in the network.
class ClockMonitor final : public sim::Component {
 public:
  /// Figures are kept from each of the instants on.
  ClockMonitor(sim::Simulation& simulation, const models::Network& network, sim::Duration every, std::span<const sim::Duration> instants);

  void start() { simulation_->schedule(source_, simulation_->now() + every_, sim::Phase::control, source_.id(), 0, 0); }
  void handle(sim::Simulation& simulation, const sim::Event& event) override;
  void set_sink(ClockSampleSink* sink) { sink_ = sink; }

  const std::vector<ClockFigures>& figures() const { return figures_; }

 private:
  void look_at(const models::gptp::Station& station, ClockFigures& figures);

  sim::Simulation* simulation_;
  const models::Network* network_;
  sim::Duration every_;
  std::vector<ClockFigures> figures_;       // of the nodes with gPTP
  sim::EventSource source_;
  ClockSampleSink* sink_ = nullptr;
};

}  // namespace takt::scenario
