// SPDX-License-Identifier: Apache-2.0
// Runs of the scenarios, brought down to what the paper looks at.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "papers/coexistence/signal.hpp"
#include "scenario/resolved/resolved.hpp"

namespace takt::papers::coexistence {

/// What a scheduler has counted of a thread, in per cent of what was expected.
struct ThreadFigures {
  std::string application;
  std::string thread;
  std::uint64_t tests = 0;
  std::uint64_t activations = 0;  ///< that were due in the tests
  double success = 0;             ///< criterion 1: calls that took place
  double buffered = 0;            ///< criterion 2: values that were taken; of subscribing threads
};

struct RunFigures {
  std::string scenario;
  std::vector<ThreadFigures> threads;
  std::vector<SignalEdge> edges;        ///< of the digital output, if there is one
  std::vector<sim::TrueTime> commands;  ///< when the application that was asked for published
  sim::TrueTime begin;                  ///< of what is looked at
  sim::TrueTime end;
  bool passed = false;  ///< what the scenario requires
  double simulated_seconds = 0;
  double cpu_seconds = 0;
  std::uint64_t events = 0;
  std::uint64_t digest = 0;

  /// Null if there is no such thread.
  const ThreadFigures* find(std::string_view application, std::string_view thread) const;
};

/// `commands_of`: the application whose publications are noted.
RunFigures run(const scenario::Resolved& resolved, std::string_view commands_of = {});

}  // namespace takt::papers::coexistence
