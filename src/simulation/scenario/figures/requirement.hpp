// SPDX-License-Identifier: Apache-2.0
// What a scenario requires: limits on figures. Scenario files may spell them in several ways, which
// resolve/requirements.cpp translates; whoever judges, bounds or searches sees these alone.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scenario/figures/figure.hpp"

namespace takt::results {
enum class RequirementKind : std::uint8_t;
}

namespace takt::scenario {

struct Resolved;

/// A limit on a figure.
struct RequiredFigure {
  results::RequirementKind kind{};      ///< how it is judged
  results::RequirementKind taken_as{};  ///< the same; of a limit on the figure of a stream's greatest latency, or of
                                        ///< the longest reaction, that of these
  std::string
      subject;  ///< stream, Program, node, signal or "application/thread"; "*": every stream; empty: all of them
  Figure figure;
  FigureLimit limit;
  std::optional<Duration> longest = {};   ///< the limit of a time
  std::optional<Duration> shortest = {};  ///< of one that must be equal to something
  Duration from = {};                     ///< what begins then or later counts; since the start
  std::string name = {};                  ///< that the file gives it: "REQ-12"; may be empty
  std::string figure_name = {};  ///< as the file says it: "reaction.start.max", "/streams/*/latency_ps/max (mean)"
  std::string text = {};         ///< "stream camera latency at most 7ms after 1s"
  bool given = false;            ///< a data sheet promises it
  std::optional<Duration> deadline =
      {};                 ///< of limits on how many are late: what takes longer; else only what is lost counts
  std::uint64_t of = 0;   ///< of how many one after another so many must be met
  bool has_unit = false;  ///< the file says in which unit a time is reported
  std::size_t entry = 0;  ///< of scenario.require: which asks for it
  std::size_t part = 0;   ///< of that entry, which may ask for several
};

/// What reports say of a requirement, or of a Program's invariants.
struct RequirementLine {
  std::string name;  ///< may be empty
  std::string text;
};
/// All lines of a report, in its order, before anything has run.
std::vector<RequirementLine> requirement_lines(const Resolved& resolved);
/// "program line keeps S1 to S5".
std::string invariants_text(const std::string& program, bool violations_are_allowed);

/// "late in a row", "met of any 10": the figure of a limit on misses one after another.
std::string misses_name(const RequiredFigure& required);

/// The reactions whose durations a figure is taken of.
struct AskedReaction {
  Reaction kind{};
  std::optional<handshake::Cause> cause = {};  ///< whatever it is if absent
  bool of_tree = false;
  std::optional<std::string> program = {};  ///< of all if absent
};
/// Nothing if the figure is of something else.
std::optional<AskedReaction> reaction_of(const Figure& figure);
/// The stream whose latencies the figure is taken of ("*": all); nothing if it is no such figure.
std::optional<std::string> latency_of(const Figure& figure);

/// Whether a requirement says how many frames of the stream may be lost, or must come: of its own or of all streams. If
/// none does, a lost frame breaks a latency or jitter requirement of the stream: it never arrives. `from`: only those
/// that count from then or earlier, so that no loss after it is left unjudged; any if absent.
bool requires_losses_separately(const Resolved& resolved, const std::string& stream, std::optional<Duration> from = {});

/// A name in a figure's pointer that nothing in the scenario has.
struct UnknownName {
  std::string kind;  ///< "stream", "program" ...
  std::string name;
  std::string suggestion;  ///< may be empty
};
std::optional<UnknownName> unknown_name(const Figure& figure, const Resolved& resolved);

}  // namespace takt::scenario
