// SPDX-License-Identifier: Apache-2.0
// The levels of one factor.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "study/design.hpp"
#include "study/magnitude.hpp"
#include "study/topologies.hpp"

namespace takt::study {
namespace {

constexpr std::uint32_t most_names = 10'000;  // of one "each"

std::string text_of(const json::Node& value) {
  if (value.kind == json::Kind::string || value.kind == json::Kind::number) return value.text;
  std::string text = json::compact(value);
  if (text.size() > 60) text = text.substr(0, 57) + "...";
  return text;
}

std::string filled(const std::string& pattern, std::string_view word) {
  std::string text;
  for (std::size_t begin = 0;;) {
    const std::size_t hole = pattern.find("{}", begin);
    text += pattern.substr(begin, hole - begin);
    if (hole == std::string::npos) return text;
    text += word;
    begin = hole + 2;
  }
}

class FactorPlanner {
 public:
  FactorPlanner(const Factor& factor, const std::string& folder, json::Diagnostics& diagnostics)
      : factor_(factor), folder_(folder), diagnostics_(diagnostics) {}

  PlannedFactor plan() {
    planned_.name = factor_.name;
    check_name();
    check_settings();
    if (factor_.values)
      for (const Value& value : *factor_.values) add(value.node, value.where.place());
    if (factor_.range) add_range(*factor_.range);
    if (factor_.patches)
      for (const auto& [name, patch] : *factor_.patches) add_patch(name, patch);
    if (factor_.topologies)
      for (const auto& [name, topology] : *factor_.topologies)
        planned_.levels.push_back(
            {name,
             std::nullopt,
             {{"/network", network_of(topology, folder_, diagnostics_),
               fmt::format("factor {} = {}", factor_.name, name), factor_.where.at("topologies")}}});
    for (std::size_t i = 0; i < planned_.levels.size(); ++i)
      for (std::size_t j = 0; j < i && planned_.levels.size() <= 1000; ++j)
        if (planned_.levels[i].text == planned_.levels[j].text)
          diagnostics_.error(factor_.where.place(), "a level occurs twice",
                             {json::quote(planned_.levels[i].text), "levels that differ"});
    find_unit();
    find_baseline();
    return std::move(planned_);
  }

  /// A level made of a value.
  Level level_of(const json::Node& value, const json::Place& place) {
    Level level;
    level.text = text_of(value);
    if (const auto magnitude = magnitude_of(value)) level.number = magnitude->number;
    const std::string origin = fmt::format("factor {} = {}", factor_.name, level.text);
    for (const Setting& setting : factor_.set)
      level.replacements.push_back({setting.at, content_of(setting, value, place), origin, place});
    return level;
  }

 private:
  void check_name() {
    const std::string& name = factor_.name;
    const bool is_sound =
        !name.empty() && std::isdigit(static_cast<unsigned char>(name.front())) == 0 &&
        std::all_of(name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; });
    if (!name.empty() && !is_sound)
      diagnostics_.error(factor_.where.at("name"), "not a name for a factor",
                         {json::quote(name), "letters, digits and _, a letter first"});
  }

  void check_settings() {
    const bool sets = factor_.values || factor_.range;
    if (sets && factor_.set.empty())
      diagnostics_.error(factor_.where.place(), "missing key", {"levels that set nothing", "\"set\""});
    if (!sets && !factor_.set.empty())
      diagnostics_.error(factor_.where.at("set"), "does not belong to this factor",
                         {"\"set\"", "it beside \"values\" or \"range\" only"});
    for (const Setting& setting : factor_.set) {
      if (setting.at == "/seed" || setting.at == "seed")
        diagnostics_.error(setting.where.place(), "the seed cannot be a factor",
                           {json::quote(setting.at), "\"replications\""});
      for (const auto& [pattern, key] : {std::pair(setting.as, "as"), std::pair(setting.each, "each")})
        if (pattern && pattern->find("{}") == std::string::npos)
          diagnostics_.error(setting.where.at(key), "no place for the level",
                             {json::quote(*pattern), "a text with {}"});
    }
  }

  json::Node content_of(const Setting& setting, const json::Node& value, const json::Place& place) {
    if (setting.as) return json::Node::of_string(filled(*setting.as, text_of(value)));
    if (!setting.each) return value;
    json::Node names = json::Node::array();
    const auto count = json::integer_of(value);
    if (!count || *count < 0 || *count > static_cast<sim::int128>(most_names)) {
      diagnostics_.error(place, "not a count",
                         {json::excerpt(value), fmt::format("an integer from 0 to {}, for \"each\"", most_names)});
      return names;
    }
    for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(*count); ++i)
      names.items.push_back(
          json::Node::of_string(filled(*setting.each, std::to_string(std::uint64_t{setting.first} + i))));
    return names;
  }

  void add(const json::Node& value, const json::Place& place) { planned_.levels.push_back(level_of(value, place)); }

  void add_range(const Range& range) {
    planned_.is_logarithmic = range.scale == Scale::logarithmic;
    const auto from = magnitude_of(range.from.node);
    const auto to = magnitude_of(range.to.node);
    const auto refuse = [&](const Value& value, std::string_view expected) {
      diagnostics_.error(value.where.place(), "not an end of a range",
                         {json::excerpt(value.node), std::string(expected)});
    };
    if (!from || !from->is_integer) return refuse(range.from, "an integer or a quantity");
    if (!to || !to->is_integer || to->dimension != from->dimension)
      return refuse(range.to, "a value of the same kind as \"from\"");
    if (to->raw <= from->raw) return refuse(range.to, "more than \"from\"");
    if (planned_.is_logarithmic && from->raw <= 0) return refuse(range.from, "more than 0, for a logarithmic scale");
    if (range.steps) {
      for (std::uint32_t i = 0; i < *range.steps; ++i) add_level(range, *from, *to, i, *range.steps);
      return;
    }
    sim::int128 step = 1;
    if (range.step) {
      const auto written = magnitude_of(range.step->node);
      if (!written || !written->is_integer || written->dimension != from->dimension || written->raw <= 0)
        return refuse(*range.step, "more than 0, of the same kind as \"from\"");
      if (planned_.is_logarithmic) return refuse(*range.step, "\"steps\", for a logarithmic scale");
      step = written->raw;
    } else if (from->dimension != nullptr) {
      return;  // any value between the ends: for random designs only
    }
    if ((to->raw - from->raw) / step >= 100'000) return refuse(range.to, "fewer than 100000 levels");
    for (sim::int128 raw = from->raw; raw <= to->raw; raw += step)
      add(node_of(from->dimension, raw), range.where.place());
  }

  void add_level(const Range& range, const Magnitude& from, const Magnitude& to, std::uint32_t i, std::uint32_t steps) {
    const double share = static_cast<double>(i) / (steps - 1);
    json::Node node = value_between(range, from, to, share);
    // Integers that lie close together may round to the same one.
    if (!planned_.levels.empty() && planned_.levels.back().text == node.text) return;
    add(node, range.where.place());
  }

 public:
  /// The value at a share (0 to 1) of a range. Quantities between the ends have four significant digits.
  static json::Node value_between(const Range& range, const Magnitude& from, const Magnitude& to, double share) {
    if (share <= 0) return range.from.node;
    if (share >= 1) return range.to.node;
    const double low = static_cast<double>(from.raw);
    const double high = static_cast<double>(to.raw);
    const double exact =
        range.scale == Scale::logarithmic ? low * std::pow(high / low, share) : low + (high - low) * share;
    if (from.dimension == nullptr) return json::Node::of_integer(static_cast<sim::int128>(std::llround(exact)));
    const double grain = std::pow(10, std::max(0.0, std::floor(std::log10(std::max(1.0, std::abs(exact)))) - 3));
    return node_of(from.dimension,
                   static_cast<sim::int128>(std::round(exact / grain)) * static_cast<sim::int128>(grain));
  }

 private:
  void add_patch(const std::string& name, const Patch& patch) {
    Level level;
    level.text = name;
    for (const auto& [pointer, value] : patch)
      level.replacements.push_back(
          {pointer, value.node, fmt::format("factor {} = {}", factor_.name, name), value.where.place()});
    planned_.levels.push_back(std::move(level));
  }

  void find_unit() {
    const auto magnitude = factor_.range                                ? magnitude_of(factor_.range->from.node)
                           : factor_.values && !factor_.values->empty() ? magnitude_of(factor_.values->front().node)
                                                                        : std::nullopt;
    if (magnitude) planned_.unit = base_unit(magnitude->dimension);
    // Levels of different kinds have no common axis.
    if (factor_.values)
      for (const Value& value : *factor_.values) {
        const auto other = magnitude_of(value.node);
        if (magnitude && other && other->dimension == magnitude->dimension) continue;
        for (Level& level : planned_.levels) level.number.reset();
        planned_.unit.clear();
        return;
      }
  }

  void find_baseline() {
    if (!factor_.baseline) return;
    const std::string text = text_of(factor_.baseline->node);
    const auto found = std::find_if(planned_.levels.begin(), planned_.levels.end(),
                                    [&](const Level& level) { return level.text == text; });
    if (found == planned_.levels.end())
      diagnostics_.error(factor_.baseline->where.place(), "not a level of this factor",
                         {json::quote(text), "one of its levels"});
    else
      planned_.baseline = static_cast<std::size_t>(found - planned_.levels.begin());
  }

  const Factor& factor_;
  std::string folder_;  // in which files of the study lie
  json::Diagnostics& diagnostics_;
  PlannedFactor planned_;
};

}  // namespace

PlannedFactor plan_factor(const Factor& factor, const std::string& folder, json::Diagnostics& diagnostics) {
  return FactorPlanner(factor, folder, diagnostics).plan();
}

Level level_between(const Factor& factor, double share, json::Diagnostics& diagnostics) {
  const auto from = magnitude_of(factor.range->from.node);
  const auto to = magnitude_of(factor.range->to.node);
  return FactorPlanner(factor, {}, diagnostics)
      .level_of(FactorPlanner::value_between(*factor.range, *from, *to, share), factor.range->where.place());
}

}  // namespace takt::study
