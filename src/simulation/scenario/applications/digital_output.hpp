// SPDX-License-Identifier: Apache-2.0
// A digital output as an oscilloscope sees it: edges in true time, pulses and periods. Nobody asks it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "application/output_level.hpp"
#include "scenario/figures/accounts.hpp"
#include "sim/time.hpp"

namespace takt::scenario {

using application::DurationFigures;

class DigitalOutput {
 public:
  struct Edge {
    sim::TrueTime at;
    bool high = false;
  };

  /// Of pulses and periods that began with a rise at an instant or later, and edges since then.
  using Figures = application::PulseFigures;

  /// A pulse is nominally so long, a period twice that. Figures are kept from each of the instants on.
  DigitalOutput(sim::Duration pulse, std::span<const sim::Duration> instants) : pulse_(pulse), figures_(instants) {}

  /// It is low at the beginning. True if the level has changed. `latency`: since the activation was due whose call sets
  /// it.
  bool set(bool high, sim::TrueTime now, sim::Duration latency);

  bool is_high() const { return level_.is_high(); }
  sim::Duration pulse() const { return pulse_; }
  const Figures& figures(sim::Duration from) const { return figures_.from(from); }
  /// The first ones.
  const std::vector<Edge>& edges() const { return edges_; }
  static constexpr std::size_t most_edges = 10'000;

 private:
  sim::Duration pulse_;
  application::OutputLevel<sim::TrueTime> level_;
  Accounts<Figures> figures_;
  std::vector<Edge> edges_;
};

}  // namespace takt::scenario
