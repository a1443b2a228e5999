// What is proved about each requirement, before anything is run: bounds of times and counts, invariants by exploration.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "results/run_result.hpp"
#include "scenario/resolve/resolved.hpp"

namespace takt::verify {

/// What no run that the scenario allows exceeds.
struct Proved {
  std::optional<sim::Duration> time;        ///< of requirements about times
  bool holds = false;                       ///< of the others: they are always met
  std::string reason;                       ///< why nothing is proved, else empty
  std::vector<std::string> assumptions;     ///< what the proof rests on
};

struct ProofOptions {
  std::uint64_t states = 3'000'000;         ///< to explore at most, for the invariants of all Programs
  std::function<bool()> interrupted;
};

/// By requirement.
std::vector<Proved> prove(const scenario::Resolved& resolved, const std::vector<results::RequirementResult>& requirements, const ProofOptions& options);

}  // namespace takt::verify
