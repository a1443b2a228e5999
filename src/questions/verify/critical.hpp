// SPDX-License-Identifier: Apache-2.0
// Values of a variable at which something changes for a requirement: critical instants, instead of all instants.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <vector>

#include "results/run_result.hpp"
#include "verify/free_variable.hpp"
#include "verify/meeting_log.hpp"

namespace takt::verify {

class CriticalInstants {
 public:
  /// `resolved` outlives it.
  CriticalInstants(const scenario::Resolved& resolved, std::span<const FreeVariable> variables);

  /// For the variable and what `requirement` is about, all else being as in `choice`: ascending, without doubles, never
  /// empty.
  ///
  /// A talker or publisher meets each stream of the requirement at each port that both use: its frame comes at the same
  /// instant, or just
  /// before. Where `met` says which frames met in the run of `choice`, those that have waited count as well: a frame
  /// meets another one as that comes to a port, or as it starts there.
  /// A publisher publishes just before it hears a word. Phases and calls are tried all over their range too: a call
  /// just behind the publishing instant of its participant waits longest.
  /// Where more than `most` phases are known, those remain at which the slowest frame itself is met, then those of
  /// frames that have not waited.
  std::vector<sim::Duration> of(std::size_t variable, const results::RequirementResult& requirement,
                                const Choice& choice, std::span<const MeetingLog::Visit> met = {},
                                std::size_t most = ~std::size_t{0}) const;

  /// Phases of a talker at which one of its frames comes to a port just before or just behind an instant at which
  /// another one came or started there, in a run of `choice`.
  std::vector<sim::Duration> of_meetings(std::size_t variable, const Choice& choice,
                                         std::span<const MeetingLog::Visit> met) const;

  /// Each call that the requirement is about comes just behind a publication of its participant; `slowly`: whose timer
  /// was late.
  void put_calls_behind_publications(const results::RequirementResult& requirement, Choice& choice, bool slowly) const;
  /// Each participant of the Program publishes just before it hears what follows from a change of `first`: that of the
  /// master first, then, by it, those of all others.
  void put_publications_before_words(std::size_t program, std::size_t first, Choice& choice) const;

  /// The variables that can make a difference: whose streams share a port with those of the requirement, or with
  /// streams that do; whose host sends or hears them; calls that it is about; all others.
  std::vector<std::size_t> variables_for(const results::RequirementResult& requirement) const;
  /// So close are frames to each other that just miss each other.
  sim::Duration just() const { return just_; }

 private:
  struct Timing {         // of a stream
    sim::Duration phase;  // as the scenario has it
    sim::Duration period;
    std::vector<std::size_t> variables;  // that move its phase: one or none
  };
  struct Visit {  // to a port
    std::uint64_t port = 0;
    sim::Duration after;  // from the talker's instant, without waiting
  };
  /// Frames that a search looks at, by their stream and instants.
  struct Window {
    std::optional<std::uint32_t> stream;    // nothing: all frames
    std::optional<sim::TrueTime> produced;  // of one frame
    sim::TrueTime begin = sim::TrueTime::from_ps(0);
    sim::TrueTime end = sim::TrueTime::never();
  };
  /// What the slowest frame of that stream may have met.
  static Window around_slowest(std::uint32_t stream, std::span<const MeetingLog::Visit> met);
  std::vector<sim::Duration> meetings_in(const Window& window, std::size_t variable, const Choice& choice,
                                         std::span<const MeetingLog::Visit> met) const;
  sim::Duration phase_of(std::size_t stream, const Choice& choice) const;
  std::optional<std::size_t> phase_variable(std::size_t program, std::size_t participant) const;
  bool is_called(const scenario::ScriptEntry& entry, const results::RequirementResult& requirement) const;
  std::vector<std::size_t> streams_of(const results::RequirementResult& requirement) const;
  bool matters(const FreeVariable& latency, const results::RequirementResult& requirement) const;
  std::vector<std::size_t> streams_moved_by(std::size_t variable) const;
  std::vector<Visit> visits_of(std::size_t stream);
  /// From the publishing instant until the word is heard if nothing is in its way, with the greatest latencies of the
  /// hosts.
  sim::Duration time_to(std::size_t stream, models::NodeIndex listener) const;

  const scenario::Resolved* resolved_;
  std::vector<FreeVariable> variables_;
  sim::Duration just_;
  std::vector<Timing> timings_;  // by stream index
  std::vector<std::vector<Visit>> visits_;
  std::vector<std::map<std::uint32_t, sim::Duration>>
      arrivals_;  // by stream and listener: without waiting, to the network interface
};

}  // namespace takt::verify
