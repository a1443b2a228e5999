// SPDX-License-Identifier: Apache-2.0
// Watches how far the nodes' clocks are from those of their grandmasters and from each other, and who follows whom.
// Sees true time, which no node does.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "models/network.hpp"
#include "scenario/figures/accounts.hpp"
#include "scenario/resolve/clock_groups.hpp"
#include "sim/simulation.hpp"

namespace takt::scenario {

/// A stretch of looks at which two nodes did not take their time from one grandmaster.
struct Parting {
  sim::TrueTime from;
  std::optional<sim::TrueTime> until;            ///< the first look at which it was over; nothing: it lasted to the end
  models::NodeIndex node;                        ///< one that went its own way, at the first of them
  std::optional<models::NodeIndex> grandmaster;  ///< whom it followed; nothing: nobody gives it time
  std::optional<models::NodeIndex> leader;       ///< whom most others followed; nothing: no node could be grandmaster
};

/// What one node's clock has shown, by the differences to its grandmaster's clock at the instants that were looked at.
struct ClockFigures {
  models::NodeIndex node;
  std::optional<sim::TrueTime>
      locked;            ///< first time that its servo was locked and within 1 us; never for who was always grandmaster
  bool has_led = false;  ///< another node followed it at some look
  /// Of the looks since then.
  struct Offsets {
    std::uint64_t samples = 0;
    sim::Duration least;
    sim::Duration greatest;
    sim::TrueTime greatest_at;       ///< of the greatest either way
    sim::int128 sum = 0;             ///< ps
    sim::int128 sum_of_squares = 0;  ///< ps^2
    void add(sim::TrueTime at, sim::Duration offset);
  };
  Accounts<Offsets> offsets;
  /// Of all looks, without sign.
  struct Distances {
    std::uint64_t samples = 0;
    sim::Duration greatest;
    sim::TrueTime at;
  };
  Accounts<Distances> distances;
  std::vector<Parting> alone = {};  ///< while it followed nobody and was followed by nobody, and another node was
                                    ///< grandmaster; without those that an election explains
};

/// Of all nodes with gPTP together: how far a clock was from that of any grandmaster that somebody followed then.
struct GrandmasterDistances {
  std::uint64_t samples = 0;
  sim::Duration greatest;
  sim::TrueTime at;
  models::NodeIndex node;
  models::NodeIndex grandmaster;
};

/// Of a group: the greatest difference between two of its clocks at one look.
struct ClockDifferences {
  std::uint64_t samples = 0;
  sim::Duration greatest;
  sim::TrueTime at;
  models::NodeIndex behind;
  models::NodeIndex ahead;
};

/// A clock at a look.
struct ClockSample {
  sim::TrueTime time;
  models::NodeIndex node;
  models::NodeIndex grandmaster;
  sim::Duration offset;       ///< of its clock from the grandmaster's
  sim::Duration true_offset;  ///< and from true time
};

/// Takes the series of offsets, one call for each look and node.
class ClockSampleSink {
 public:
  virtual ~ClockSampleSink() = default;
  virtual void sample(const ClockSample& sample) = 0;
};

/// Looks every so often, at instants of true time. It changes nothing in the network.
class ClockMonitor final : public sim::Component {
 public:
  struct Settings {
    sim::Duration every;
    std::vector<ClockGroup> groups = {};
    sim::Duration election_time = {};  ///< a parting that takes no longer, and is over, is none
  };
  /// Figures are kept from each of the instants on.
  ClockMonitor(sim::Simulation& simulation, const models::Network& network, Settings settings,
               std::span<const sim::Duration> instants);

  void start() {
    simulation_->schedule(source_, simulation_->now() + settings_.every, sim::Phase::control, source_.id(), 0, 0);
  }
  void handle(sim::Simulation& simulation, const sim::Event& event) override;
  void set_sink(ClockSampleSink* sink) { sink_ = sink; }

  const std::vector<ClockFigures>& figures() const { return figures_; }
  const Accounts<GrandmasterDistances>& distances() const { return distances_; }
  const std::vector<ClockGroup>& groups() const { return settings_.groups; }
  const Accounts<ClockDifferences>& differences(std::size_t group) const { return differences_[group]; }
  /// While some nodes followed one grandmaster and some another or none; without those that an election explains.
  const std::vector<Parting>& partings() const { return partings_; }

  // Of a divided run, in each part of which a grandmaster may be another part's: the looks are kept, and are put
  // together when all is over.
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
    bool is_up = true;
    bool is_locked = false;
    bool speaks_gptp = false;
    bool has_grandmaster = false;
  };
  static_assert(sizeof(Look) <= octets_of_a_look);
  /// Whose clocks are farthest back and ahead of those of some nodes.
  struct Span {
    models::NodeIndex behind;
    models::NodeIndex ahead;
  };
  Look look_at(models::NodeIndex node) const;
  void judge(sim::TrueTime now, const std::vector<Look>& looks);
  void judge_leaders(sim::TrueTime now, const std::vector<Look>& looks);
  void judge_groups(sim::TrueTime now, const std::vector<Look>& looks);
  std::optional<Span> grandmasters_in(const std::vector<Look>& looks, bool give_time) const;
  void take(ClockFigures& figures, sim::TrueTime now, const Look& look, sim::LocalTime grandmaster);
  void note(std::vector<Parting>& partings, sim::TrueTime now, const std::optional<Parting>& seen) const;
  static models::NodeIndex source_of(const std::vector<Look>& looks, models::NodeIndex node);

  sim::Simulation* simulation_;
  const models::Network* network_;
  Settings settings_;
  std::vector<ClockFigures> figures_;  // of the nodes with gPTP
  Accounts<GrandmasterDistances> distances_;
  std::vector<Accounts<ClockDifferences>> differences_;  // by group
  std::vector<Parting> partings_;
  std::vector<models::NodeIndex> own_;  // nodes that act here: all but in a part of a divided run
  bool is_part_ = false;
  std::vector<Look> now_;                     // by node, of the present look
  std::vector<models::NodeIndex> source_of_;  // by node, likewise
  std::vector<std::uint32_t> followers_;      // by node, likewise
  std::vector<Look> looks_;                   // of a part, at its own nodes, one look after the other
  std::uint64_t count_ = 0;
  sim::EventSource source_;
  ClockSampleSink* sink_ = nullptr;
};

}  // namespace takt::scenario
