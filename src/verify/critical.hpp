// Values of a variable at which something changes for a requirement: critical instants, instead of all instants.
#pragma once

#include <span>
#include <vector>

#include "results/run_result.hpp"
#include "verify/free_variable.hpp"

namespace takt::verify {

class CriticalInstants {
 public:
  /// `resolved` outlives it.
  CriticalInstants(const scenario::Resolved& resolved, std::span<const FreeVariable> variables);

  /// For the variable and what `requirement` is about, all else being as in `choice`: ascending, without doubles, never empty.
  ///
  /// A talker or publisher meets each stream of the requirement at each port that both use: its frame comes at the same instant, or just
  /// before. Phases and calls are tried all over their range too: a call just behind the publishing instant of its participant waits longest.
  std::vector<sim::Duration> of(std::size_t variable, const results::RequirementResult& requirement, const Choice& choice) const;

 private:
  struct Timing {                   // of a stream
    sim::Duration phase;            // as the scenario has it
    sim::Duration period;
    std::vector<std::size_t> variables;   // that move its phase: one or none
  };
  struct Visit {                    // to a port
    std::uint64_t port = 0;
    sim::Duration after;            // from the talker's instant, without waiting
  };
  sim::Duration phase_of(std::size_t stream, const Choice& choice) const;
  std::vector<std::size_t> streams_of(const results::RequirementResult& requirement) const;
  bool matters(const FreeVariable& latency, const results::RequirementResult& requirement) const;
  std::vector<std::size_t> streams_moved_by(std::size_t variable) const;
  std::vector<Visit> visits_of(std::size_t stream) const;

  const scenario::Resolved* resolved_;
  std::vector<FreeVariable> variables_;
  std::vector<Timing> timings_;     // by stream index
  std::vector<std::vector<Visit>> visits_;
};

}  // namespace takt::verify
