// SPDX-License-Identifier: Apache-2.0
// The second paper reproduced: DDS and OPC UA side by side on ordinary infrastructure, and the gateway between them.
// Start here.
//
//   Reproduction made = reproduce(options, diagnostics);   // runs everything
//   text_report(made), json_report(made)                   // report.hpp
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "json/diagnostics.hpp"
#include "papers/coexistence/calibration.hpp"
#include "papers/coexistence/measured.hpp"
#include "papers/coexistence/runs.hpp"
#include "papers/comparison.hpp"

namespace takt::papers::coexistence {

struct Options {
  std::string scenarios = "scenarios/papers/coexistence";  ///< the folder of the scenarios
  bool is_short = false;                             ///< fewer repetitions, and what TSN changes at 10 and 1 ms only
  std::function<void(const std::string&)> progress;  ///< told what is done next; may be empty
  std::optional<MeasuredCriteria> measured;  ///< on this machine, to stand beside what was published and simulated
};

/// Fig. 4: criterion 2 of a receiving node by column of the tables, beside criterion 1.
struct BufferingRow {
  std::string node;
  std::array<double, 4> success = {};
  std::array<double, 4> buffered = {};
  std::array<double, 4> without_load = {};  ///< criterion 2 with nothing else on the network
  std::array<std::optional<double>, 4> measured = {};
};

/// Fig. 5 to 9.
struct SignalRow {
  int interval = 0;  ///< ms
  SignalStatistics statistics;
};

/// What an improvement changes at an interval.
struct ImprovementRow {
  std::string variant;
  int interval = 0;          ///< ms
  double success = 0;        ///< criterion 1, mean of the eight tables
  double least_success = 0;  ///< the worst of them
  double buffered = 0;       ///< criterion 2, mean of the four receiving nodes
  double least_buffered = 0;
  SignalStatistics signal;
  ReactionTimes reaction;  ///< from the OPC UA control node's publication to the DDS control node's output
};

struct Speed {
  std::string scenario;
  double simulated_seconds = 0;
  double cpu_seconds = 0;
  std::uint64_t events = 0;
  std::uint64_t digest = 0;
};

struct Reproduction {
  bool is_short = false;
  int repetitions = 0;  ///< of which the cells are means
  std::string machine;  ///< on which criteria were measured too; empty: nothing was measured
  std::vector<LawErrors> laws;
  std::vector<Comparison> comparisons;
  std::vector<std::array<double, 4>> success;  ///< criterion 1 of Tables 1 to 8, by table and column
  std::vector<BufferingRow> buffering;
  std::vector<SignalRow> signals;
  std::vector<ImprovementRow> improvements;
  std::vector<Figure> figures;
  std::vector<std::pair<std::string, std::string>> scenarios;  ///< that were made: name and text
  std::vector<std::pair<std::string, std::string>> waves;      ///< VCD of the digital signal: file name and content
  std::vector<Speed> speed;
  bool holds() const;
};

/// How a cell of Tables 1 to 8 is called: "Table 3, DDS control, subscribe, 2 ms".
std::string cell_name(const PublishedTable& table, std::size_t column);

/// Runs everything. Nothing if a scenario cannot be read: the diagnostics say why.
std::optional<Reproduction> reproduce(const Options& options, json::Diagnostics& diagnostics);

}  // namespace takt::papers::coexistence
