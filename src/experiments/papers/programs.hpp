// SPDX-License-Identifier: Apache-2.0
// The first paper reproduced: distributed OPC UA Programs over TSN. Start here.
//
//   Reproduction made = reproduce_programs(options, diagnostics);   // runs everything
//   text_report(made), json_report(made)                            // report.hpp
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "json/diagnostics.hpp"
#include "json/override.hpp"
#include "papers/comparison.hpp"
#include "sim/time.hpp"

namespace takt::papers {

inline double milliseconds(sim::Duration d) { return static_cast<double>(d.ps()) * 1e-9; }

struct ProgramsOptions {
  std::string scenarios = "scenarios/papers/programs";  ///< the folder of the scenarios
  bool is_short = false;  ///< three minutes of simulated time instead of an hour, and fewer rounds
  bool beyond = true;     ///< the open questions too
  std::function<void(const std::string&)> progress;  ///< told what is done next; may be empty
};

/// A reaction in a variant of the plant.
struct ReactionCell {
  std::uint64_t reactions = 0;
  std::optional<sim::Duration> simulated;  ///< the longest
  std::optional<sim::Duration> bound;
};

/// start, halt, suspend, resume.
inline constexpr std::size_t reaction_kinds = 4;
inline constexpr std::array<const char*, reaction_kinds> reaction_names = {"start", "halt", "suspend", "resume"};

struct BeyondRow {
  std::string variant;
  std::array<ReactionCell, reaction_kinds> reactions;
};

/// An open question of the paper, answered with figures.
struct BeyondTable {
  std::string name;  ///< of files
  std::string question;
  std::string column;  ///< heading of the variants
  std::vector<BeyondRow> rows;
};

struct Speed {
  int values = 0;
  double simulated_seconds = 0;
  double wall_seconds = 0;
  std::uint64_t events = 0;
  std::uint64_t digest = 0;
  std::uint64_t round_trips = 0;
};

struct Reproduction {
  bool is_short = false;
  std::vector<Comparison> comparisons;
  std::vector<BeyondTable> beyond;
  std::vector<Figure> figures;
  std::vector<Speed> speed;
  std::vector<std::pair<std::string, std::string>> scenarios;  ///< that were made for `beyond`: name and text
  bool holds() const;
};

/// Runs everything. Nothing if a scenario cannot be read: the diagnostics say why.
std::optional<Reproduction> reproduce_programs(const ProgramsOptions& options, json::Diagnostics& diagnostics);

}  // namespace takt::papers
