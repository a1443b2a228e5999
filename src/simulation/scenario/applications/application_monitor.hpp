// SPDX-License-Identifier: Apache-2.0
// What a run learns about the threads of applications: in true time. No application asks them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scenario/applications/digital_output.hpp"
#include "scenario/resolved/resolved_applications.hpp"
#include "sim/simulation.hpp"

namespace takt::scenario {

class ApplicationMonitor {
 public:
  /// Simulation and signals outlive it. Figures are kept from each of the instants on.
  ApplicationMonitor(sim::Simulation& simulation, const std::vector<ResolvedSignal>& signals,
                     std::span<const sim::Duration> instants);

  /// A call of a thread took place.
  void on_call(std::uint32_t application, std::uint32_t thread, std::uint64_t number);
  /// A call took so many values into the buffer of its thread.
  void on_values(std::uint32_t application, std::uint32_t thread, std::uint64_t count);
  void on_crash(std::uint32_t application);
  /// By a call whose activation was due so long ago, on the clock of its host.
  void set_signal(std::uint32_t signal, bool high, sim::Duration latency);

  const DigitalOutput& signal(std::size_t number) const { return signals_[number]; }

 private:
  static std::uint64_t who(std::uint32_t application, std::uint32_t thread) {
    return static_cast<std::uint64_t>(application) << 32 | thread;
  }

  sim::Simulation* simulation_;
  std::vector<DigitalOutput> signals_;
};

}  // namespace takt::scenario
