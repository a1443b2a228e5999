// SPDX-License-Identifier: Apache-2.0
// Who knew what when: a found run step by step, with what each participant knows of the others, and why it ends as it
// does. Of the participants themselves (moment.hpp), never guessed. Of a group with roles, what is known by words; what
// announcements and the table of bindings tell is left out.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "explore/properties/property.hpp"
#include "explore/report/chart.hpp"
#include "json/node.hpp"
#include "json/type.hpp"

namespace takt::explore {

/// What one participant knows of another one. Steps count from 1; 0 is before the first one.
struct Belief {
  std::string who;
  std::string of;
  std::optional<std::string> heard;  ///< the state that the last word said; nothing: never heard
  std::optional<std::string> word;   ///< all of it
  std::optional<std::size_t> said_in;
  std::optional<std::size_t> heard_in;
  std::optional<std::size_t> age;  ///< steps since it was said
  bool by_stranger = false;        ///< nobody of the group has said it
  bool is_replayed = false;        ///< the other one has said it, but a stranger has handed it over
  std::optional<bool> is_true;     ///< the other one would say the same now
  std::string now;                 ///< what that one would say; "down", "without a role (joins)"
  std::size_t now_since = 0;       ///< step in which it began to
  bool is_new = false;             ///< another word than before the step, or no more as true as before
  bool is_cause = false;           ///< of the participant whose step violates: what it knew in it
};

struct ExplainedStep {
  std::size_t number = 0;
  std::string sentence;
  std::string kind;                ///< "receive", ...
  std::string who;                 ///< who steps, or whose message it is
  std::vector<std::string> arrow;  ///< from, to; empty if nothing is heard
  std::vector<std::pair<std::string, std::string>> states;
  std::vector<Belief> knowledge;
  std::vector<std::string> findings;
};

struct Explanation {
  std::string property;
  std::string text;  ///< what it demands
  std::string ends;  ///< "violation", "standstill" or "cycle"
  std::string beginning;
  std::vector<std::string> participants;
  std::vector<std::pair<std::string, std::string>> states;
  std::vector<Belief> knowledge;  ///< at the beginning
  std::vector<ExplainedStep> steps;
  std::size_t cycle = 0;         ///< the last so many steps repeat for ever
  std::vector<std::string> why;  ///< sentences
};
const json::Record& describe(json::Type<Explanation>);
const json::Record& describe(json::Type<ExplainedStep>);
const json::Record& describe(json::Type<Belief>);

/// Of a run that violates (or reaches) the property; `chart` is that run's.
Explanation explanation(const Chart& chart, Property property);
/// One for each violation, in the order of the report.
std::vector<Explanation> explanations(const Query& query, const SearchResult& result);
/// The same as JSON: an array. What `takt explore --format json` holds as `violations`.
json::Node explanations_json(const Query& query, const SearchResult& result);

/// The chart with what is known below each step in which it changes, or which it causes.
Chart with_knowledge(Chart chart, const Explanation& explanation);
/// The passage below a chart.
std::string why_text(const Explanation& explanation);

}  // namespace takt::explore
