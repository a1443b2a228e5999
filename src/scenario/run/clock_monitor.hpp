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

  // Of a divided run, in each part of which a grandmaster may be another part's: the looks are kept, and are put together when all is over.
  /// Events that other parts have handled, too.
  std::uint64_t looks() const { return count_; }
  /// `all`: the monitors of all parts, this one among them, which have looked equally often.
  void put_together(std::span<const ClockMonitor* const> all);
  /// Octets that a look at a node takes until then.
  static constexpr std::size_t octets_of_a_look = 24;

 private:
  struct Look {
    sim::LocalTime local;
    models::NodeIndex grandmaster;
    bool is_up = false;
    bool is_locked = false;
  };
  static_assert(sizeof(Look) <= octets_of_a_look);
  Look look_at(models::NodeIndex node) const;
  void take(ClockFigures& figures, sim::TrueTime now, const Look& look, sim::LocalTime grandmaster);

  sim::Simulation* simulation_;
  const models::Network* network_;
  sim::Duration every_;
  std::vector<ClockFigures> figures_;       // of the nodes with gPTP
  std::vector<std::uint32_t> own_;          // which of them act here: all but in a part of a divided run
  bool is_part_ = false;
  std::vector<Look> looks_;                 // of a part, at these, one after the other
  std::uint64_t count_ = 0;
  sim::EventSource source_;
  ClockSampleSink* sink_ = nullptr;
};

}  // namespace takt::scenario
