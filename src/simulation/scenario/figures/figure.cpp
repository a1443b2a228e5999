// SPDX-License-Identifier: Apache-2.0
#include "scenario/figures/figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "json/quantity.hpp"
#include "json/suggest.hpp"
#include "scenario/figures/known_figures.hpp"

namespace takt::scenario {
namespace {

struct TimeUnit {
  std::string_view name;
  double picoseconds;
};
constexpr std::array<TimeUnit, 5> time_units = {{{"ps", 1}, {"ns", 1e3}, {"us", 1e6}, {"ms", 1e9}, {"s", 1e12}}};

struct ShortForm {
  std::string_view name;
  std::string_view pointer;
  Take take;
};
constexpr ShortForm short_forms[] = {
    {"dropped", "/dropped/*", Take::sum},
    {"lost", "/streams/*/lost", Take::sum},
    {"delivered", "/streams/*/delivered", Take::sum},
    {"violations", "/programs/*/violations/*/at_ps", Take::count},
    {"events", "/events", Take::max},
    {"verdict", "/verdict", Take::max},
    {"utilisation", "/ports/*/utilisation", Take::max},
    {"queue", "/ports/*/queue_peak", Take::max},
    {"sync", "/clocks/*/offset/abs_max_ps", Take::max},
    {"clocks", "/clock_differences/all/greatest_ps", Take::max},
};
constexpr std::string_view reaction_kinds[] = {"start", "halt", "suspend", "resume", "reset"};
constexpr std::string_view latency_figures[] = {"max", "p99", "p50", "mean", "min", "stddev"};
constexpr std::string_view topology_figures[] = {"switches", "links", "diameter", "bridges", "disjoint_paths"};

template <class Names>
bool contains(const Names& names, std::string_view name) {
  return std::find(std::begin(names), std::end(names), name) != std::end(names);
}

std::optional<Take> find_named(std::string_view text) {
  for (const json::EnumName& name : describe(json::Type<Take>{}).names)
    if (name.name == text) return static_cast<Take>(name.value);
  return std::nullopt;
}

std::vector<std::string> split(std::string_view text, char separator) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0;;) {
    const std::size_t end = text.find(separator, begin);
    parts.emplace_back(text.substr(begin, end - begin));
    if (end == std::string_view::npos) return parts;
    begin = end + 1;
  }
}

/// Fills in what a short form stands for; false if the text is none.
bool expand_short_form(std::string_view text, Figure& planned) {
  const std::vector<std::string> parts = split(text, '.');
  for (const ShortForm& form : short_forms) {
    if (text != form.name) continue;
    planned.steps = steps_of(form.pointer);
    planned.take = form.take;
    return true;
  }
  if (parts.size() == 3 && parts[0] == "reaction" && contains(reaction_kinds, parts[1]) && find_named(parts[2])) {
    planned.steps = {"programs", "*", "reactions", "*", "duration_ps"};
    planned.only = {{"kind", json::Node::of_string(parts[1])}, {"superseded", json::Node::of_bool(false)}};
    planned.take = *find_named(parts[2]);
    return true;
  }
  if (parts.size() == 2 && parts[0] == "topology" && contains(topology_figures, parts[1])) {
    planned.steps = {"topology", parts[1]};
    return true;
  }
  if (parts.size() >= 2 && parts[0] == "latency" && contains(latency_figures, parts.back())) {
    const std::size_t name = std::string_view("latency.").size();
    const std::string stream =
        parts.size() == 2 ? "*" : std::string(text.substr(name, text.size() - name - parts.back().size() - 1));
    planned.steps = {"streams", stream, "latency_ps", parts.back()};
    return true;
  }
  return false;
}

struct Found {
  std::vector<double> values;
  bool is_incomplete = false;  // one of them is null
};

void collect(const json::Node& node, const Figure& figure, std::size_t step, Found& found) {
  if (step == figure.steps.size()) {
    if (node.kind == json::Kind::number)
      found.values.push_back(json::double_of(node));
    else if (node.kind == json::Kind::boolean)
      found.values.push_back(node.boolean ? 1 : 0);
    else if (node.kind == json::Kind::string)
      found.values.push_back(node.text == "pass" || node.text == "nothing was required" ? 1 : 0);
    else
      found.is_incomplete = true;
    return;
  }
  if (step + 1 == figure.steps.size())
    for (const auto& [key, value] : figure.only) {
      const json::Node* const member = node.find(key);
      if (member == nullptr || !json::equal(*member, value)) return;
    }
  const std::string& name = figure.steps[step];
  if (node.kind == json::Kind::object) {
    for (const json::Member& member : node.members)
      if (name == "*" || name == member.key) collect(member.value, figure, step + 1, found);
  } else if (node.kind == json::Kind::array) {
    for (std::size_t i = 0; i < node.items.size(); ++i)
      if (name == "*" || name == std::to_string(i)) collect(node.items[i], figure, step + 1, found);
  } else if (node.kind == json::Kind::null && name != "*") {
    found.is_incomplete = true;  // "latency_ps": null of a stream that delivered nothing
  }
}

double sum_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum;
}

std::string joined(const std::vector<std::string>& names) {
  constexpr std::size_t most = 16;
  std::string text;
  for (std::size_t i = 0; i < std::min(most, names.size()); ++i) text += (i == 0 ? "" : ", ") + names[i];
  return names.size() > most ? text + " ..." : text;
}

/// "/streams/camera", of the first `count` steps.
std::string pointer_of(const std::vector<std::string>& steps, std::size_t count) {
  std::string text;
  for (std::size_t i = 0; i < count; ++i) text += json::pointer_step(steps[i]);
  return text;
}

std::string suggestion(const std::string& found, const std::vector<std::string>& expected) {
  const std::vector<std::string_view> names(expected.begin(), expected.end());
  return json::suggest(found, names);
}

/// Whether the pointer leads to a value of that kind, and the members that "only" names are beside it.
void check_pointer(const FigureText& text, Figure& figure, json::Diagnostics& diagnostics) {
  const Lookup lookup = look_up(figure.steps);
  const json::Place place = text.where.at(text.key);
  if (lookup.figures.empty()) {
    const std::string before = pointer_of(figure.steps, lookup.wrong_step);
    if (lookup.wrong_step == figure.steps.size())
      diagnostics.error(place, "not a single figure",
                        {json::quote(text.of), "one step more: " + joined(lookup.expected)});
    else if (lookup.expected.empty())
      diagnostics.error(place, "unknown figure", {json::quote(text.of), before + ", which has no members"});
    else
      diagnostics.error(
          place, "unknown figure",
          {json::quote(figure.steps[lookup.wrong_step]) + (before.empty() ? "" : " in " + before),
           "one of " + joined(lookup.expected), suggestion(figure.steps[lookup.wrong_step], lookup.expected)});
    return;
  }
  const auto all_are = [&](auto... kinds) {
    return std::all_of(lookup.figures.begin(), lookup.figures.end(),
                       [&](const KnownFigure* f) { return ((f->kind == kinds) || ...); });
  };
  const auto any_is = [&](FigureKind kind) {
    return std::any_of(lookup.figures.begin(), lookup.figures.end(),
                       [&](const KnownFigure* f) { return f->kind == kind; });
  };
  figure.is_zero_if_absent = all_are(FigureKind::counter);
  if (any_is(FigureKind::verdict) && !text.may_be_verdict)
    diagnostics.error(place, "a requirement on what the requirements come to",
                      {json::quote(text.of), "a figure of the run"});
  else if (figure.take != Take::count && any_is(FigureKind::text))
    diagnostics.error(place, "a figure that is no number", {json::quote(text.of), "a number, or \"take\": \"count\""});
  std::vector<std::string> beside = figure.steps;
  for (const auto& [key, value] : figure.only) {
    beside.back() = key;
    const Lookup member = look_up(beside);
    if (member.figures.empty())
      diagnostics.error(text.where.at("only"), "no member beside the figure",
                        {json::quote(key), "one of " + joined(member.expected), suggestion(key, member.expected)});
  }
}

void read_unit(const FigureText& text, Figure& figure, json::Diagnostics& diagnostics) {
  figure.is_time = figure.take != Take::count &&
                   std::any_of(figure.steps.begin(), figure.steps.end(),
                               [](const std::string& step) { return step.ends_with("_ps"); }) &&
                   figure.steps.back() != "count";
  figure.unit = text.unit;
  const auto unit =
      std::find_if(time_units.begin(), time_units.end(), [&](const TimeUnit& u) { return u.name == text.unit; });
  if (figure.is_time) {
    if (text.unit.empty())
      figure.unit = "us";
    else if (unit == time_units.end())
      diagnostics.error(text.where.at("unit"), "not a unit of time", {json::quote(text.unit), "ps, ns, us, ms or s"});
    figure.divisor = unit == time_units.end() ? 1e6 : unit->picoseconds;
    figure.in_base_unit = 1e12 / figure.divisor;
  } else if (unit != time_units.end()) {
    diagnostics.error(text.where.at("unit"), "a unit of time for what is no time",
                      {json::quote(text.unit), "no unit, %, or a label such as frames"});
  } else if (text.unit == "%" && !figure.steps.back().ends_with("percent")) {
    figure.divisor = 0.01;
  }
}

}  // namespace

std::optional<Figure> read_figure(const FigureText& text, json::Diagnostics& diagnostics) {
  const std::size_t errors_before = diagnostics.errors();
  Figure figure;
  figure.take = text.take.value_or(Take::max);
  if (text.of.starts_with('/')) {
    figure.steps = steps_of(text.of);
    for (const auto& [key, value] : text.only) figure.only.emplace_back(key, value.node);
  } else if (!expand_short_form(text.of, figure)) {
    std::vector<std::string_view> names;
    for (const ShortForm& form : short_forms) names.push_back(form.name);
    diagnostics.error(
        text.where.at(text.key), "unknown figure",
        {json::quote(text.of),
         "a JSON pointer into result.json, or a short form such as reaction.start.max, latency.STREAM.p99, dropped",
         json::suggest(text.of, names)});
    return std::nullopt;
  } else {
    if (text.take && *text.take != figure.take)
      diagnostics.error(text.where.at("take"), "does not belong to a short form",
                        {"\"take\"", "it in the short form, such as reaction.start.mean"});
    if (!text.only.empty())
      diagnostics.error(text.where.at("only"), "does not belong to a short form",
                        {"\"only\"", "a JSON pointer in " + json::quote(text.key)});
  }
  check_pointer(text, figure, diagnostics);
  read_unit(text, figure, diagnostics);
  return diagnostics.errors() == errors_before ? std::optional(figure) : std::nullopt;
}

std::optional<double> value_of(const Figure& figure, const json::Node& result) {
  Found found;
  collect(result, figure, 0, found);
  const std::vector<double>& values = found.values;
  if (figure.take == Take::count) return static_cast<double>(values.size());
  if (found.is_incomplete) return std::nullopt;
  if (values.empty()) return figure.take == Take::sum || figure.is_zero_if_absent ? std::optional(0.0) : std::nullopt;
  double value = 0;
  switch (figure.take) {
    case Take::max:
      value = *std::max_element(values.begin(), values.end());
      break;
    case Take::min:
      value = *std::min_element(values.begin(), values.end());
      break;
    case Take::mean:
      value = sum_of(values) / static_cast<double>(values.size());
      break;
    case Take::sum:
    case Take::count:
      value = sum_of(values);
      break;
  }
  return value / figure.divisor;
}

const char* text_of(Relation relation) {
  constexpr const char* texts[] = {"at most", "at least", "equal to"};
  return texts[static_cast<std::size_t>(relation)];
}

std::optional<FigureLimit> read_limit(const Figure& figure, Relation relation, const json::Node& bound,
                                      const json::Place& place, json::Diagnostics& diagnostics) {
  if (bound.kind == json::Kind::number) {
    const double value = json::double_of(bound);
    if (std::isfinite(value)) return FigureLimit{relation, value, text_of(value, figure.unit), 0, value, value};
  }
  if (bound.kind == json::Kind::string && figure.is_time)
    if (const auto duration = json::parse_duration(bound.text)) {
      const double value = static_cast<double>((*duration).ps()) / figure.divisor;
      return FigureLimit{relation, value, bound.text, 0, value, value};
    }
  diagnostics.error(place, "not a limit of this figure",
                    {json::excerpt(bound), figure.is_time ? "a duration such as \"7ms\", or a number in " + figure.unit
                                                          : std::string("a number")});
  return std::nullopt;
}

bool read_tolerance(const Figure& figure, const Tolerance& within, FigureLimit& limit, const json::Place& place,
                    json::Diagnostics& diagnostics) {
  if (within.time && !figure.is_time) {
    diagnostics.error(place, "a time as the tolerance of what is no time", {json::to_text(*within.time), "a number"});
    return false;
  }
  limit.within = within.time ? static_cast<double>(within.time->ps()) / figure.divisor : within.number;
  limit.text += " within " + (within.time ? json::to_text(*within.time) : text_of(within.number, figure.unit));
  limit.least = limit.value - limit.within;
  limit.greatest = limit.value + limit.within;
  if (!figure.is_time) return true;
  // Whole picoseconds, as the result has them: 0.1 us and 0.2 us are 0.3 us.
  const auto whole = [&](double ends) { return std::round(ends * figure.divisor) / figure.divisor; };
  limit.least = whole(limit.least);
  limit.greatest = whole(limit.greatest);
  return true;
}

std::string text_of(double value, const std::string& unit) {
  return fmt::format("{:.6g}{}{}", value == 0 ? 0.0 : value, unit.empty() ? "" : " ", unit);
}

}  // namespace takt::scenario
