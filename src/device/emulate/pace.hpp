// SPDX-License-Identifier: Apache-2.0
// How far a simulated run is at an instant: an emulation waits until it is as far, so that a slow machine delays the
// script and changes nothing.
#pragma once

#include <cstdint>
#include <vector>

#include "emulate/comparison.hpp"
#include "emulate/plan.hpp"

namespace takt::emulate {

class Pace {
 public:
  /// By program, of the simulated run; times in picoseconds from its start.
  explicit Pace(std::vector<History> simulated) : simulated_(std::move(simulated)) {}

  /// Whether each participant has made as many changes as in the simulated run before `at`. Crashes do not count, since
  /// a dead node logs nothing.
  bool is_reached(const std::vector<History>& emulated, sim::Duration at) const;
  /// Whether the simulated run has a call there that was Good.
  bool is_good(std::uint32_t program, std::uint8_t participant, program::Method method, sim::Duration at) const;

 private:
  std::vector<History> simulated_;
};

}  // namespace takt::emulate
