// Runs of the scenarios, brought down to what the paper looks at.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "papers/coexistence/signal.hpp"
#include "results/run_result.hpp"
#include "scenario/resolved.hpp"

namespace takt::papers::coexistence {

/// What a scheduler has counted of a thread, in per cent of what was expected.
struct ThreadFigures {
  std::string application;
  std::string thread;
  bool subscribes = false;
  std::uint64_t tests = 0;
  std::uint64_t activations = 0;                ///< that were due in the tests
  double success = 0;                           ///< criterion 1: calls that took place
  double buffered = 0;                          ///< criterion 2: values that were taken; of subscribing threads
  /// From the publication of a sample until this thread has taken it; of subscribing threads that took any.
  std::optional<results::LatencySummary> age = {};
};

struct RunFigures {
  std::string scenario;
  std::vector<ThreadFigures> threads;
  std::vector<SignalEdge> edges;                ///< of the digital output, if there is one
  sim::TrueTime begin;                          ///< of what is looked at
  sim::TrueTime end;
  bool passed = false;                          ///< what the scenario requires
  double simulated_seconds = 0;
  double cpu_seconds = 0;
  std::uint64_t events = 0;
  std::uint64_t digest = 0;

  /// Null if there is no such thread.
  const ThreadFigures* find(std::string_view application, std::string_view thread) const;
};

RunFigures run(const scenario::Resolved& resolved);

}  // namespace takt::papers::coexistence
