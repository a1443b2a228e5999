// SPDX-License-Identifier: Apache-2.0
#include "study/frontier.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>

#include "chart/chart.hpp"
#include "chart/page.hpp"
#include "json/document.hpp"

namespace takt::study {
namespace {

constexpr std::string_view count_of_streams = "/schedule/streams/count";

/// Whether a factor of the configuration sets that place; settings may be written short.
bool sets(const json::Node& factor, std::string_view place) {
  const json::Node* const set = factor.find("set");
  if (set == nullptr) return false;
  return std::ranges::any_of(set->items, [&](const json::Node& each) {
    const json::Node* const at = each.kind == json::Kind::object ? each.find("at") : &each;
    return at != nullptr && at->text == place;
  });
}

bool has_topologies(const json::Node& factor) { return factor.find("topologies") != nullptr; }

double percent(std::size_t part, const Draws& draws) {
  return draws.all() == 0 ? 0 : 100 * static_cast<double>(part) / static_cast<double>(draws.all());
}

std::string label_of_method(const Frontier& frontier, std::size_t method) {
  return frontier.methods[method].empty() ? "scheduled" : frontier.methods[method];
}

std::string streams_of(const Content& content, const Frontier& frontier, std::optional<std::size_t> level) {
  return level ? content.factors[frontier.factor].texts[frontier.levels[*level]] : "none";
}

chart::LineChart shares_chart(const Content& content, const Frontier& frontier, std::size_t topology, const char* what,
                              std::size_t Draws::*part) {
  chart::LineChart line;
  line.title = what + (frontier.topologies[topology].empty() ? std::string() : ", " + frontier.topologies[topology]);
  line.x = {content.factors[frontier.factor].name, chart::Scale::linear, {0}};
  line.y = {"% of the draws", chart::Scale::linear, {0, 100}};
  line.width = 420;
  line.height = 240;
  for (std::size_t m = 0; m < frontier.methods.size(); ++m) {
    chart::Series series;
    series.name = frontier.methods[m];
    for (std::size_t i = 0; i < frontier.levels.size(); ++i) {
      const Draws& draws = frontier.draws[topology][m][i];
      if (draws.all() > 0)
        series.samples.push_back({content.factors[frontier.factor].numbers[frontier.levels[i]],
                                  percent(draws.*part, draws), std::nullopt, std::nullopt});
    }
    if (!series.samples.empty()) line.series.push_back(std::move(series));
  }
  return line;
}

chart::BarChart reach_chart(const Content& content, const Frontier& frontier) {
  chart::BarChart bars;
  bars.title = fmt::format("feasibility frontier: {} of which {:.0f} % and more are scheduled",
                           content.factors[frontier.factor].name, 100 * frontier_share);
  bars.y = {content.factors[frontier.factor].name, chart::Scale::linear, {0}};
  bars.names = frontier.methods;
  bars.width = 860;
  for (std::size_t t = 0; t < frontier.topologies.size(); ++t) {
    bars.categories.push_back(frontier.topologies[t]);
    bars.bars.emplace_back();
    for (std::size_t m = 0; m < frontier.methods.size(); ++m) {
      const auto level = frontier.reach(t, m, frontier_share);
      bars.bars.back().push_back(
          chart::Sample{0, level ? content.factors[frontier.factor].numbers[frontier.levels[*level]] : 0, std::nullopt,
                        std::nullopt});
    }
  }
  return bars;
}

}  // namespace

std::optional<std::size_t> Frontier::reach(std::size_t topology, std::size_t method, double share) const {
  std::optional<std::size_t> last;
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const Draws& here = draws[topology][method][i];
    if (here.all() == 0 || static_cast<double>(here.scheduled) < share * static_cast<double>(here.all())) break;
    last = i;
  }
  return last;
}

std::optional<Frontier> frontier_of(const Content& content) {
  json::Diagnostics unheard;
  const auto configuration = json::parse(content.header.configuration, "configuration", unheard);
  const json::Node* const factors = configuration && configuration->root().find("schedule") != nullptr
                                        ? configuration->root().find("factors")
                                        : nullptr;
  if (factors == nullptr || factors->items.size() != content.factors.size()) return std::nullopt;
  const auto index_of = [&](const auto& is_it) {
    return static_cast<std::size_t>(std::ranges::find_if(factors->items, is_it) - factors->items.begin());
  };
  Frontier frontier;
  frontier.factor = index_of([](const json::Node& factor) { return sets(factor, count_of_streams); });
  if (frontier.factor == content.factors.size() || !content.factors[frontier.factor].is_numeric()) return std::nullopt;
  const ContentFactor& along = content.factors[frontier.factor];
  frontier.levels.resize(along.texts.size());
  std::iota(frontier.levels.begin(), frontier.levels.end(), 0u);
  std::ranges::stable_sort(frontier.levels, {}, [&](std::uint32_t level) { return along.numbers[level]; });
  std::vector<std::size_t> place(along.texts.size());  // by level
  for (std::size_t i = 0; i < frontier.levels.size(); ++i) place[frontier.levels[i]] = i;
  const std::size_t across = index_of(has_topologies);
  frontier.topologies = {""};
  if (across < content.factors.size()) {
    frontier.across = content.factors[across].name;
    frontier.topologies = content.factors[across].texts;
  }
  // Methods in the order in which variants have them.
  std::map<std::string, std::size_t> known;
  std::vector<std::size_t> method_of;  // by variant
  for (std::uint32_t v = 0; v < content.variants.size(); ++v) {
    std::string method;
    for (std::size_t f = 0; f < content.factors.size(); ++f)
      if (f != frontier.factor && f != across) method += (method.empty() ? "" : ", ") + content.level_text(v, f);
    const auto [at, is_new] = known.emplace(method, frontier.methods.size());
    if (is_new) frontier.methods.push_back(method);
    method_of.push_back(at->second);
  }
  frontier.draws.assign(frontier.topologies.size(),
                        std::vector(frontier.methods.size(), std::vector<Draws>(frontier.levels.size())));
  for (std::size_t row = 0; row < content.rows(); ++row) {
    const Variant& variant = content.variants[content.variant[row]];
    Draws& draws = frontier.draws[across < content.factors.size() ? variant[across] : 0]
                                 [method_of[content.variant[row]]][place[variant[frontier.factor]]];
    std::size_t& count = content.status[row] != Status::done    ? draws.without_result
                         : content.verdict[row] == "scheduled"  ? draws.scheduled
                         : content.verdict[row] == "infeasible" ? draws.infeasible
                                                                : draws.undecided;
    ++count;
  }
  return frontier;
}

std::string frontier_charts(const Content& content, const Frontier& frontier) {
  std::string all = draw(reach_chart(content, frontier));
  for (std::size_t t = 0; t < frontier.topologies.size(); ++t) {
    all += draw(shares_chart(content, frontier, t, "scheduled", &Draws::scheduled));
    all += draw(shares_chart(content, frontier, t, "infeasible (proved)", &Draws::infeasible));
  }
  return all;
}

std::string frontier_table(const Content& content, const Frontier& frontier) {
  std::vector<std::string> heads = {frontier.across, "method", fmt::format("{:.0f} % up to", 100 * frontier_share)};
  for (const std::uint32_t level : frontier.levels) heads.push_back(content.factors[frontier.factor].texts[level]);
  chart::Table table(heads);
  for (std::size_t t = 0; t < frontier.topologies.size(); ++t)
    for (std::size_t m = 0; m < frontier.methods.size(); ++m) {
      std::vector<chart::Cell> cells = {{frontier.topologies[t]},
                                        {label_of_method(frontier, m)},
                                        {streams_of(content, frontier, frontier.reach(t, m, frontier_share)), true}};
      for (std::size_t i = 0; i < frontier.levels.size(); ++i) {
        const Draws& draws = frontier.draws[t][m][i];
        std::string text = draws.all() == 0
                               ? "-"
                               : fmt::format("{:.0f} / {:.0f} / {:.0f}", percent(draws.scheduled, draws),
                                             percent(draws.infeasible, draws), percent(draws.undecided, draws));
        if (draws.without_result > 0) text += fmt::format(" ({} without a result)", draws.without_result);
        cells.push_back({text, true});
      }
      table.row(cells);
    }
  return table.take();
}

std::string frontier_text(const Content& content, const Frontier& frontier) {
  std::string text = fmt::format(
      "  {} of which {:.0f} % and more are scheduled, and of how many draws at all numbers together which became "
      "what\n",
      content.factors[frontier.factor].name, 100 * frontier_share);
  for (std::size_t t = 0; t < frontier.topologies.size(); ++t)
    for (std::size_t m = 0; m < frontier.methods.size(); ++m) {
      Draws sum;
      for (const Draws& each : frontier.draws[t][m]) {
        sum.scheduled += each.scheduled;
        sum.infeasible += each.infeasible;
        sum.undecided += each.undecided;
        sum.without_result += each.without_result;
      }
      if (sum.all() == 0) continue;
      text +=
          fmt::format("    {:<16} {:<28} {:>6}   {} scheduled, {} infeasible, {} undecided", frontier.topologies[t],
                      label_of_method(frontier, m), streams_of(content, frontier, frontier.reach(t, m, frontier_share)),
                      sum.scheduled, sum.infeasible, sum.undecided);
      text += sum.without_result > 0 ? fmt::format(", {} without a result\n", sum.without_result) : "\n";
    }
  return text;
}

}  // namespace takt::study
