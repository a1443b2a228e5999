// SPDX-License-Identifier: Apache-2.0
// A figure of a result: which values of result.json, what is taken of them, and in which unit. Requirements and the
// measures and limits of studies are read here, so that both judge alike.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "json/any.hpp"
#include "json/diagnostics.hpp"
#include "json/document.hpp"
#include "json/node.hpp"
#include "scenario/description/description.hpp"

namespace takt::scenario {

/// A figure that can be read off a result.
struct Figure {
  std::vector<std::string> steps;                        ///< of the pointer; "*": every member or item
  std::vector<std::pair<std::string, json::Node>> only;  ///< members of the object that holds the value
  Take take = Take::max;
  std::string unit;
  double divisor = 1;       ///< from the result's number to the unit
  double in_base_unit = 1;  ///< units in the base unit: 1e6 for "us"
  bool is_time = false;
  bool is_zero_if_absent = false;  ///< a counter that result.json has only if it counted something
};

/// What a file says of a figure.
struct FigureText {
  const json::Source& where;
  std::string_view key;  ///< of the member with the pointer or the short form
  std::string_view of;   ///< what it says
  const json::NameMap<json::Any>& only;
  std::optional<Take> take = {};
  std::string_view unit = {};
  bool may_be_verdict = true;  ///< requirements cannot judge their own verdict
};

/// Checks a figure; mistakes are diagnostics, and then there is none. A pointer must lead to a number or a truth value
/// of some run's result.json (known_figures.hpp). A short form stands for a pointer:
///   reaction.KIND.TAKE   durations of reactions that nothing superseded; TAKE is max, min, mean, sum or count
///   latency.STREAM.FIGURE and latency.FIGURE (of all streams); FIGURE is max, p99, p50, mean, min or stddev
///   dropped  lost  delivered  violations  events  verdict (1: pass)  utilisation  queue  sync
///   topology.FIGURE      switches, links, diameter, bridges, disjoint_paths (figures/graph_figures.hpp)
/// The unit of a time is us if none is said; that of a share may be %; all else is a label.
std::optional<Figure> read_figure(const FigureText& text, json::Diagnostics& diagnostics);

/// The figure in its unit, of a result as result.json has it (with "topology", if that is asked for). Nothing if the
/// result has none, or if one of several is null (a reaction that was never complete has no greatest duration); sums
/// and counts of nothing are 0.
std::optional<double> value_of(const Figure& figure, const json::Node& result);

/// How a figure stands to its limit.
enum class Relation : std::uint8_t { at_most, at_least, equal };
/// "at most", "at least", "equal to"
const char* text_of(Relation relation);

/// What a figure may be, in its unit.
struct FigureLimit {
  Relation relation = Relation::at_most;
  double value = 0;
  std::string text;   ///< "7ms", "12 frames", "11.62us within 1ns"
  double within = 0;  ///< how far it may be from what it must equal
  double least = 0;   ///< the ends of that
  double greatest = 0;
  bool is_upper() const { return relation == Relation::at_most; }
  /// A figure that is missing does not keep a limit.
  bool holds(const std::optional<double>& figure) const {
    if (!figure) return false;
    if (relation == Relation::equal) return *figure >= least && *figure <= greatest;
    return is_upper() ? *figure <= value : *figure >= value;
  }
};

/// A number in the figure's unit or, of times, a duration. Nothing after a diagnostic at `place`.
std::optional<FigureLimit> read_limit(const Figure& figure, Relation relation, const json::Node& bound,
                                      const json::Place& place, json::Diagnostics& diagnostics);
/// How far the figure may be from the limit, which it must equal. False after a diagnostic at `place`.
bool read_tolerance(const Figure& figure, const Tolerance& within, FigureLimit& limit, const json::Place& place,
                    json::Diagnostics& diagnostics);

/// "8.125 ms", "12 frames", "0.5"
std::string text_of(double value, const std::string& unit);

}  // namespace takt::scenario
