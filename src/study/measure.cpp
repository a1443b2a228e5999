#include "study/measure.hpp"

#include <algorithm>
#include <array>

#include "scenario/json/suggest.hpp"
#include "study/magnitude.hpp"

namespace takt::study {
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
    {"dropped", "/dropped/*", Take::sum},           {"delivered", "/streams/*/delivered", Take::sum},
    {"violations", "/programs/*/violations/*/at_ps", Take::count}, {"events", "/events", Take::max},
    {"verdict", "/verdict", Take::max},             {"utilisation", "/ports/*/utilisation", Take::max},
    {"queue", "/ports/*/queue_peak", Take::max},    {"sync", "/clocks/*/offset/max_ps", Take::max},
};
constexpr std::string_view reaction_kinds[] = {"start", "halt", "suspend", "resume", "reset"};
constexpr std::string_view latency_figures[] = {"max", "p99", "p50", "mean", "min", "stddev"};
constexpr std::string_view topology_figures[] = {"switches", "links", "diameter", "bridges", "disjoint_paths"};

template <class Names>
bool contains(const Names& names, std::string_view name) {
  return std::find(std::begin(names), std::end(names), name) != std::end(names);
}

std::optional<Take> take_named(std::string_view text) {
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

std::string unescaped(std::string_view step) {
  std::string text;
  for (std::size_t i = 0; i < step.size(); ++i) {
    const bool is_escape = step[i] == '~' && i + 1 < step.size() && (step[i + 1] == '0' || step[i + 1] == '1');
    text += !is_escape ? step[i] : step[++i] == '0' ? '~' : '/';
  }
  return text;
}

/// Fills in what a short form stands for; false if the text is none.
bool expand_short_form(const std::string& text, PlannedMeasure& planned) {
  const std::vector<std::string> parts = split(text, '.');
  for (const ShortForm& form : short_forms) {
    if (text != form.name) continue;
    planned.steps = split(form.pointer.substr(1), '/');
    planned.take = form.take;
    return true;
  }
  if (parts.size() == 3 && parts[0] == "reaction" && contains(reaction_kinds, parts[1]) && take_named(parts[2])) {
    planned.steps = {"programs", "*", "reactions", "*", "duration_ps"};
    planned.only = {{"kind", json::Node::of_string(parts[1])}, {"superseded", json::Node::of_bool(false)}};
    planned.take = *take_named(parts[2]);
    return true;
  }
  if (parts.size() == 2 && parts[0] == "topology" && contains(topology_figures, parts[1])) {
    planned.steps = {"topology", parts[1]};
    return true;
  }
  if (parts.size() >= 2 && parts[0] == "latency" && contains(latency_figures, parts.back())) {
    const std::size_t name = std::string_view("latency.").size();
    const std::string stream = parts.size() == 2 ? "*" : text.substr(name, text.size() - name - parts.back().size() - 1);
    planned.steps = {"streams", stream, "latency_ps", parts.back()};
    return true;
  }
  return false;
}

struct Found {
  std::vector<double> values;
  bool is_incomplete = false;   // one of them is null
};

void collect(const json::Node& node, const PlannedMeasure& measure, std::size_t step, Found& found) {
  if (step == measure.steps.size()) {
    if (node.kind == json::Kind::number) found.values.push_back(json::double_of(node));
    else if (node.kind == json::Kind::boolean) found.values.push_back(node.boolean ? 1 : 0);
    else if (node.kind == json::Kind::string) found.values.push_back(node.text == "pass" ? 1 : 0);
    else found.is_incomplete = true;
    return;
  }
  if (step + 1 == measure.steps.size())
    for (const auto& [key, value] : measure.only) {
      const json::Node* const member = node.find(key);
      if (member == nullptr || !json::equal(*member, value)) return;
    }
  const std::string& name = measure.steps[step];
  if (node.kind == json::Kind::object) {
    for (const json::Member& member : node.members)
      if (name == "*" || name == member.key) collect(member.value, measure, step + 1, found);
  } else if (node.kind == json::Kind::array) {
    for (std::size_t i = 0; i < node.items.size(); ++i)
      if (name == "*" || name == std::to_string(i)) collect(node.items[i], measure, step + 1, found);
  } else if (node.kind == json::Kind::null && name != "*") {
    found.is_incomplete = true;   // "latency_ps": null of a stream that delivered nothing
  }
}

double sum_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum;
}

bool is_name(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_'; }) &&
         !(text.front() >= '0' && text.front() <= '9');
}

}  // namespace

std::optional<PlannedMeasure> plan_measure(const Measure& measure, json::Diagnostics& diagnostics) {
  const std::size_t errors_before = diagnostics.errors();
  PlannedMeasure planned;
  planned.name = measure.name;
  planned.take = measure.take;
  if (!is_name(measure.name))
    diagnostics.error(measure.where.at("name"), "not a name for a measure", {json::quote(measure.name), "letters, digits and _, a letter first"});
  if (measure.of.starts_with('/')) {
    for (const std::string& step : split(std::string_view(measure.of).substr(1), '/')) planned.steps.push_back(unescaped(step));
    for (const auto& [key, value] : measure.only) planned.only.emplace_back(key, value.node);
  } else if (!expand_short_form(measure.of, planned)) {
    std::vector<std::string_view> names;
    for (const ShortForm& form : short_forms) names.push_back(form.name);
    diagnostics.error(measure.where.at("of"), "unknown figure",
                      {json::quote(measure.of), "a JSON pointer into result.json, or a short form such as reaction.start.max, latency.STREAM.p99, dropped",
                       json::suggest(measure.of, names)});
  } else {
    if (measure.where.has("take") && measure.take != planned.take)
      diagnostics.error(measure.where.at("take"), "does not belong to a short form", {"\"take\"", "it in the short form, such as reaction.start.mean"});
    if (!measure.only.empty()) diagnostics.error(measure.where.at("only"), "does not belong to a short form", {"\"only\"", "a JSON pointer in \"of\""});
  }
  planned.is_time = planned.take != Take::count && std::any_of(planned.steps.begin(), planned.steps.end(), [](const std::string& step) { return step.ends_with("_ps"); });
  planned.unit = measure.unit;
  const auto unit = std::find_if(time_units.begin(), time_units.end(), [&](const TimeUnit& u) { return u.name == measure.unit; });
  if (planned.is_time) {
    if (measure.unit.empty()) planned.unit = "us";
    else if (unit == time_units.end())
      diagnostics.error(measure.where.at("unit"), "not a unit of time", {json::quote(measure.unit), "ps, ns, us, ms or s"});
    planned.divisor = unit == time_units.end() ? 1e6 : unit->picoseconds;
    planned.in_base_unit = 1e12 / planned.divisor;
  } else if (unit != time_units.end()) {
    diagnostics.error(measure.where.at("unit"), "a unit of time for what is no time", {json::quote(measure.unit), "no unit, %, or a label such as frames"});
  } else if (measure.unit == "%") {
    planned.divisor = 0.01;
  }
  return diagnostics.errors() == errors_before ? std::optional(planned) : std::nullopt;
}

std::optional<double> value_of(const PlannedMeasure& measure, const json::Node& result) {
  Found found;
  collect(result, measure, 0, found);
  const std::vector<double>& values = found.values;
  if (measure.take == Take::count) return static_cast<double>(values.size());
  if (found.is_incomplete) return std::nullopt;
  if (values.empty()) return measure.take == Take::sum ? std::optional(0.0) : std::nullopt;
  double value = 0;
  switch (measure.take) {
    case Take::max: value = *std::max_element(values.begin(), values.end()); break;
    case Take::min: value = *std::min_element(values.begin(), values.end()); break;
    case Take::mean: value = sum_of(values) / static_cast<double>(values.size()); break;
    case Take::sum: case Take::count: value = sum_of(values); break;
  }
  return value / measure.divisor;
}

std::optional<PlannedLimit> plan_limit(const Limit& limit, const std::vector<PlannedMeasure>& measures, json::Diagnostics& diagnostics) {
  PlannedLimit planned;
  planned.is_upper = limit.at_most.has_value();
  const char* const key = planned.is_upper ? "at_most" : "at_least";
  const std::optional<Value>& bound = planned.is_upper ? limit.at_most : limit.at_least;
  const auto found = std::find_if(measures.begin(), measures.end(), [&](const PlannedMeasure& m) { return m.name == limit.measure; });
  if (found == measures.end()) {
    std::vector<std::string_view> names;
    for (const PlannedMeasure& m : measures) names.push_back(m.name);
    diagnostics.error(limit.where.at("measure"), "unknown measure", {json::quote(limit.measure), "the name of a measure", json::suggest(limit.measure, names)});
    return std::nullopt;
  }
  if (!bound) return std::nullopt;   // reported by the table
  planned.measure = static_cast<std::size_t>(found - measures.begin());
  const auto magnitude = magnitude_of(bound->node);
  const bool is_time = magnitude && magnitude->dimension == &json::duration_dimension;
  if (!magnitude || (magnitude->dimension != nullptr && !(is_time && found->is_time))) {
    diagnostics.error(limit.where.at(key), "not a limit of this measure",
                      {json::excerpt(bound->node), found->is_time ? "a duration, or a number in " + found->unit : std::string("a number")});
    return std::nullopt;
  }
  planned.value = is_time ? static_cast<double>(magnitude->raw) / found->divisor : magnitude->number;
  planned.text = found->name + (planned.is_upper ? " <= " : " >= ") + (is_time ? bound->node.text : short_number(planned.value) + (found->unit.empty() ? "" : " " + found->unit));
  return planned;
}

}  // namespace takt::study
