// SPDX-License-Identifier: Apache-2.0
// The vocabulary of tables of published figures.
#include "papers/validation/table.hpp"

namespace takt::papers::validation {

using json::name;
using json::optional;
using json::required;

const json::Enumeration& describe(json::Type<Rule>) {
  static constexpr json::EnumName names[] = {
      name(Rule::equal, "equal", "both are the same"),
      name(Rule::at_least, "at_least", "takt's is not less"),
      name(Rule::at_most, "at_most", "takt's is not more"),
  };
  static constexpr json::Enumeration table = json::enumeration<Rule>("how it is judged", names);
  return table;
}

const json::Enumeration& describe(json::Type<Analysis>) {
  static constexpr json::EnumName names[] = {
      name(Analysis::tfa, "TFA", "total-flow analysis"),
      name(Analysis::sfa, "SFA", "separated-flow analysis"),
  };
  static constexpr json::Enumeration table = json::enumeration<Analysis>("an analysis", names);
  return table;
}

const json::Enumeration& describe(json::Type<Bound>) {
  static constexpr json::EnumName names[] = {
      name(Bound::delay, "delay", "from end to end"),
      name(Bound::backlog, "backlog", "what waits at most"),
  };
  static constexpr json::Enumeration table = json::enumeration<Bound>("a bound", names);
  return table;
}

const json::Object& describe(json::Type<FigureText>) {
  static constexpr json::Field fields[] = {
      required<&FigureText::what>("what", "What the figure is.", {.min_length = 1}),
      optional<&FigureText::row>("row", "What figures that belong together are about."),
      optional<&FigureText::kind>("kind", "Which of them it is."),
      required<&FigureText::scenario>("scenario", "A template of the table, or a file beside it.", {.min_length = 1}),
      optional<&FigureText::set>("set", "JSON pointers into the scenario, and what is put there."),
      optional<&FigureText::by>("by", "By column and its value: what is put into the scenario."),
      optional<&FigureText::figure>("figure", "A figure of a run, as \"require\" takes it."),
      optional<&FigureText::only>("only", "Members that the object with the figure must have."),
      optional<&FigureText::less>("less", "Another figure of the same run, taken off it."),
      optional<&FigureText::times>(
          "times", "What the difference or the figure is multiplied with, where the source's links have another rate.",
          {.min = 0}),
      optional<&FigureText::bound>("bound", "The stream whose longest latency by analysis it is."),
      optional<&FigureText::fastest>("fastest", "The stream whose shortest latency by analysis it is."),
      optional<&FigureText::worst>("worst", "The stream whose longest latency is searched for."),
      optional<&FigureText::flow>("flow", "The flow of a network of servers."),
      optional<&FigureText::analysis>("analysis", "Of the flow."),
      optional<&FigureText::of>("of", "Of the flow."),
      optional<&FigureText::unit>("unit", "Of all numbers."),
      required<&FigureText::published>(
          "published", "A number, an exact fraction or \"unbounded\" as text, or a list of alternatives."),
      optional<&FigureText::shift>("shift", "What takt counts and the source does not."),
      optional<&FigureText::must_be>("must_be", "How it is judged."),
      optional<&FigureText::within>("within", "How far takt's may be off.", {.min = 0}),
      optional<&FigureText::percent>("percent", "The same, in per cent of the published figure.", {.min = 0}),
      optional<&FigureText::may_be_unbounded>("may_be_unbounded", "No bound is an answer, too."),
      optional<&FigureText::is_calibrated>("is_calibrated", "The scenario was fitted to this figure."),
      optional<&FigureText::why>("why", "Of the difference."),
      optional<&FigureText::differs>("differs", "takt's is another, and why; empty: it is not."),
  };
  static constexpr std::string_view kinds[] = {"figure", "bound", "fastest", "worst", "flow"};
  static constexpr json::Group groups[] = {json::exactly_one_of(kinds)};
  static constexpr json::Object table =
      json::object<FigureText>("figure", "A published or measured figure.", fields, {.groups = groups});
  return table;
}

const json::Object& describe(json::Type<Family>) {
  static constexpr json::Field fields[] = {
      required<&Family::columns>("columns", "Names of what stands in a row.", {.min_items = 1}),
      required<&Family::rows>("rows", "A value for each column.", {.min_items = 1}),
      optional<&Family::factors>("factors", "By column and its value: what is put into the scenario."),
      required<&Family::figures>("figures", "Of each row; {column} stands for its value.", {.min_items = 1}),
      optional<&Family::when>("when", "By figure: only of rows with these values."),
      optional<&Family::short_every>("short_every", "The short form takes each so many rows.", {.min = 1, .max = 1000}),
  };
  static constexpr json::Object table = json::object<Family>("family", "Many figures of one kind.", fields);
  return table;
}

const json::Object& describe(json::Type<Table>) {
  static constexpr json::Field fields[] = {
      required<&Table::source>("source", "Whose figures these are.", {.min_length = 1}),
      required<&Table::reference>("reference", "Where they are published.", {.min_length = 1}),
      optional<&Table::about>("about", "What is compared, and by which conventions."),
      optional<&Table::budget>("budget", "Millions of events for the search for a worst run.", {.min = 0}),
      optional<&Table::templates>("templates", "Scenarios, and networks of servers."),
      optional<&Table::figures>("figures", "One after the other."),
      optional<&Table::families>("families", "Many of one kind."),
  };
  static constexpr json::Object table = json::object<Table>("table", "Published figures of one source.", fields);
  return table;
}

}  // namespace takt::papers::validation
