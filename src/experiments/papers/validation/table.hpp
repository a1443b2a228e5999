// SPDX-License-Identifier: Apache-2.0
// Tables of published figures, as their files say it: plain structs, one for each JSON object. Each file of validation/
// is one source.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "json/any.hpp"
#include "json/fields.hpp"

namespace takt::papers::validation {

/// Places of a scenario and what is put there.
using Patch = json::NameMap<json::Any>;
/// By column of a family, then by value of the column: what the value changes in the scenario.
using Factors = json::NameMap<json::NameMap<Patch>>;

/// What takt's figure must be, beside the published one.
enum class Rule : std::uint8_t { equal, at_least, at_most };
enum class Analysis : std::uint8_t { tfa, sfa };
enum class Bound : std::uint8_t { delay, backlog };

/// A published or measured figure, and where takt's is found. Texts of a family's figures may name columns:
/// "{setting}".
struct FigureText {
  json::Source where;
  std::string what;
  std::optional<std::string> row;   ///< what figures that belong together are about: "S31"
  std::optional<std::string> kind;  ///< which of them it is: "bound"
  std::string scenario;             ///< a template of the table, or a file beside it
  Patch set;
  Factors by;
  std::optional<std::string> figure;  ///< of a run, as in "require"
  json::NameMap<json::Any> only;
  std::optional<std::string> less;  ///< another figure of the same run, taken off it
  double times = 1;  ///< what takt's figure is multiplied with: its links have another rate than the source's
  std::optional<std::string> bound;    ///< of this stream: the longest latency by analysis
  std::optional<std::string> fastest;  ///< of this stream: the shortest latency by analysis
  std::optional<std::string> worst;    ///< of this stream: the longest latency that the search finds
  std::optional<std::string> flow;     ///< of a network of servers
  Analysis analysis = Analysis::tfa;
  Bound of = Bound::delay;
  std::string unit = "us";
  json::Any published;  ///< a number, an exact fraction or "unbounded" as text, or a list of alternatives
  double shift = 0;     ///< what takt counts and the source does not, in the unit
  Rule must_be = Rule::equal;
  double within = 0;              ///< either way, or the wrong way, in the unit
  double percent = 0;             ///< the same in per cent of the published figure
  bool may_be_unbounded = false;  ///< the source says that it is overloaded: no bound is an answer
  bool is_calibrated = false;     ///< takt's scenario was fitted to this figure: it says nothing
  std::string why;                ///< of the difference
  std::string differs;            ///< takt does not meet it, and why; empty: it must
  bool operator==(const FigureText&) const = default;
};

/// Many figures of one kind: each row is put into each of `figures`.
struct Family {
  json::Source where;
  std::vector<std::string> columns;
  std::vector<std::vector<json::Any>> rows;
  Factors factors;
  std::vector<json::Any> figures;              ///< FigureText, once {column} stands for a value
  std::vector<json::NameMap<json::Any>> when;  ///< by figure: only of rows with these values
  std::uint32_t short_every = 1;               ///< the short form takes each so many rows
  bool operator==(const Family&) const = default;
};

struct Table {
  json::Source where;
  std::string source;
  std::string reference;               ///< where it is published
  std::string about;                   ///< what is compared, and by which conventions
  double budget = 8;                   ///< millions of events for the search for a worst run
  json::NameMap<json::Any> templates;  ///< scenarios, and networks of servers
  std::vector<FigureText> figures;
  std::vector<Family> families;
  bool operator==(const Table&) const = default;
};

const json::Enumeration& describe(json::Type<Rule>);
const json::Enumeration& describe(json::Type<Analysis>);
const json::Enumeration& describe(json::Type<Bound>);
const json::Object& describe(json::Type<FigureText>);
const json::Object& describe(json::Type<Family>);
const json::Object& describe(json::Type<Table>);

}  // namespace takt::papers::validation
