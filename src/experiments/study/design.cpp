// SPDX-License-Identifier: Apache-2.0
#include "study/design.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "json/suggest.hpp"
#include "scenario/topology/topology.hpp"
#include "sim/random.hpp"

namespace takt::study {
namespace {

bool is_random(DesignKind kind) { return kind == DesignKind::random || kind == DesignKind::latin_hypercube; }

class Expander {
 public:
  Expander(Plan& plan, json::Diagnostics& diagnostics) : plan_(plan), diagnostics_(diagnostics) {}

  void run() {
    parse_constraints();
    const Design& design = plan_.study.design;
    if (is_random(design.kind) && !design.points) {
      diagnostics_.error(design.where.is_known() ? design.where.place() : plan_.study.where.at("design"), "missing key",
                         {"a random design without it", "\"points\""});
      return;
    }
    if (!is_random(design.kind) && design.points) {
      diagnostics_.error(design.where.at("points"), "does not belong to this design",
                         {"\"points\"", "it with \"random\" or \"latin-hypercube\""});
      return;
    }
    if (diagnostics_.has_errors() || !check_levels()) return;
    switch (design.kind) {
      case DesignKind::grid:
        grid();
        break;
      case DesignKind::one_at_a_time:
        one_at_a_time();
        break;
      case DesignKind::random:
        random(*design.points);
        break;
      case DesignKind::latin_hypercube:
        latin_hypercube(*design.points);
        break;
    }
    if (plan_.variants.empty() && !diagnostics_.has_errors())
      diagnostics_.error(plan_.study.where.at("constraints"), "no combination of levels is left",
                         {"", "constraints that some combination keeps"});
  }

 private:
  bool varies(std::size_t factor) const { return !plan_.study.factors[factor].link_failures; }
  bool is_continuous(std::size_t factor) const {
    return varies(factor) && plan_.study.factors[factor].range && continuous_[factor];
  }

  void parse_constraints() {
    std::vector<std::string_view> names;
    for (const PlannedFactor& factor : plan_.factors) names.push_back(factor.name);
    const std::vector<std::string>& texts = plan_.study.constraints;
    for (std::size_t i = 0; i < texts.size(); ++i) {
      const json::Place place = plan_.study.where.at("constraints", i);
      std::string problem;
      auto expression = Expression::parse(texts[i], problem);
      if (!expression) {
        diagnostics_.error(place, "not a condition: " + problem,
                           {json::quote(texts[i]), "such as \"slaves <= 4 * hops\""});
        continue;
      }
      for (const std::string& name : expression->names()) {
        const auto found = std::find(names.begin(), names.end(), name);
        if (found == names.end()) {
          diagnostics_.error(place, "unknown factor",
                             {json::quote(name), "the name of a factor", json::suggest(name, names)});
        } else if (!varies(static_cast<std::size_t>(found - names.begin()))) {
          diagnostics_.error(place, "link failures cannot be part of a constraint",
                             {json::quote(name), "another factor"});
        }
      }
      constraints_.push_back(std::move(*expression));
    }
  }

  /// Every factor has levels, or a range from which a random design draws.
  bool check_levels() {
    bool is_sound = true;
    for (std::size_t f = 0; f < plan_.factors.size(); ++f) {
      continuous_.push_back(plan_.factors[f].levels.empty());
      if (!varies(f) || !plan_.factors[f].levels.empty() || is_random(plan_.study.design.kind)) continue;
      diagnostics_.error(plan_.study.factors[f].where.at("range"), "missing key",
                         {"a range of quantities without levels", "\"step\" or \"steps\""});
      is_sound = false;
    }
    return is_sound;
  }

  bool is_allowed(const Variant& variant) const {
    return std::all_of(constraints_.begin(), constraints_.end(), [&](const Expression& constraint) {
      return constraint.holds([&](const std::string& name) -> Operand {
        for (std::size_t f = 0; f < plan_.factors.size(); ++f) {
          if (plan_.factors[f].name != name) continue;
          const Level& level = plan_.level_of(variant, f);
          return level.number ? Operand(*level.number) : Operand(level.text);
        }
        return {};
      });
    });
  }

  void add(const Variant& variant) {
    if (is_allowed(variant)) plan_.variants.push_back(variant);
  }

  void grid() {
    std::uint64_t count = 1;
    for (std::size_t f = 0; f < plan_.factors.size(); ++f) {
      if (!varies(f)) continue;
      count *= plan_.factors[f].levels.size();
      if (count > 10 * most_variants) {
        diagnostics_.error(
            plan_.study.where.at("factors"), "too many combinations",
            {"more than " + std::to_string(count), fmt::format("at most {}; or a random design", 10 * most_variants)});
        return;
      }
    }
    // The last factor changes fastest, as digits do.
    Variant variant(plan_.factors.size(), 0);
    for (std::uint64_t i = 0; i < count; ++i) {
      add(variant);
      for (std::size_t f = plan_.factors.size(); f-- > 0;) {
        if (!varies(f)) continue;
        if (++variant[f] < plan_.factors[f].levels.size()) break;
        variant[f] = 0;
      }
    }
  }

  void one_at_a_time() {
    Variant base;
    for (const PlannedFactor& factor : plan_.factors) base.push_back(static_cast<std::uint32_t>(factor.baseline));
    add(base);
    for (std::size_t f = 0; f < plan_.factors.size(); ++f) {
      if (!varies(f)) continue;
      Variant variant = base;
      for (variant[f] = 0; variant[f] < plan_.factors[f].levels.size(); ++variant[f])
        if (variant[f] != base[f]) add(variant);
    }
  }

  /// The level at a share of what the factor has.
  std::uint32_t level_at(std::size_t f, double share) {
    PlannedFactor& factor = plan_.factors[f];
    if (!is_continuous(f))
      return static_cast<std::uint32_t>(
          std::min(share * static_cast<double>(factor.levels.size()), static_cast<double>(factor.levels.size() - 1)));
    factor.levels.push_back(level_between(plan_.study.factors[f], share, diagnostics_));
    return static_cast<std::uint32_t>(factor.levels.size() - 1);
  }

  sim::RandomStream chance(std::size_t f) const { return {plan_.study.design.seed, plan_.factors[f].name, "design"}; }

  void random(std::uint32_t points) {
    std::vector<sim::RandomStream> streams;
    for (std::size_t f = 0; f < plan_.factors.size(); ++f) streams.push_back(chance(f));
    std::set<Variant> seen;
    for (std::uint64_t tries = 0; plan_.variants.size() < points && tries < 100 * std::uint64_t{points}; ++tries) {
      Variant variant(plan_.factors.size(), 0);
      for (std::size_t f = 0; f < plan_.factors.size(); ++f)
        if (varies(f)) variant[f] = level_at(f, streams[f].unit());
      if (seen.insert(variant).second) add(variant);
    }
  }

  void latin_hypercube(std::uint32_t points) {
    std::vector<Variant> variants(points, Variant(plan_.factors.size(), 0));
    for (std::size_t f = 0; f < plan_.factors.size(); ++f) {
      if (!varies(f)) continue;
      sim::RandomStream stream = chance(f);
      std::vector<std::uint32_t> strata(points);
      for (std::uint32_t i = 0; i < points; ++i) strata[i] = i;
      for (std::uint32_t i = points; i > 1; --i) std::swap(strata[i - 1], strata[stream.below(i)]);
      for (std::uint32_t i = 0; i < points; ++i) variants[i][f] = level_at(f, (strata[i] + stream.unit()) / points);
    }
    std::set<Variant> seen;
    for (const Variant& variant : variants)
      if (seen.insert(variant).second) add(variant);
  }

  Plan& plan_;
  json::Diagnostics& diagnostics_;
  std::vector<Expression> constraints_;
  std::vector<bool> continuous_;
};

/// "sw1-sw2" for each link between two switches, once, in the order of the topology.
std::vector<std::pair<std::string, std::string>> switch_links(const scenario::NetworkSection& network) {
  json::Diagnostics ignored;  // reported when the variant is resolved
  const scenario::Topology topology = scenario::build_topology(network, ignored);
  std::vector<std::pair<std::string, std::string>> links;
  std::set<std::pair<std::string, std::string>> seen;
  for (std::uint32_t node = 0; node < topology.nodes.size(); ++node)
    for (const scenario::Neighbour& neighbour : topology.neighbours[node]) {
      if (neighbour.node < node || !topology.nodes[node].forwards() || !topology.nodes[neighbour.node].forwards())
        continue;
      std::pair<std::string, std::string> link(topology.nodes[node].name, topology.nodes[neighbour.node].name);
      if (seen.insert(link).second) links.push_back(std::move(link));
    }
  return links;
}

json::Replacement failure_of(const std::pair<std::string, std::string>& link, const LinkFailures& failures,
                             const std::string& origin) {
  json::Node fault = json::Node::object();
  fault.add("kind", json::Node::of_string("link-down"));
  json::Node ends = json::Node::array();
  ends.items = {json::Node::of_string(link.first), json::Node::of_string(link.second)};
  fault.add("link", std::move(ends));
  fault.add("at", json::Node::of_string(json::to_text(failures.at)));
  if (failures.lasts) fault.add("for", json::Node::of_string(json::to_text(*failures.lasts)));
  return {"/faults/-", std::move(fault), origin, failures.where.place()};
}

}  // namespace

void expand(Plan& plan, json::Diagnostics& diagnostics) { Expander(plan, diagnostics).run(); }

void expand_link_failures(Plan& plan, std::size_t factor, json::Diagnostics& diagnostics) {
  PlannedFactor& planned = plan.factors[factor];
  const LinkFailures& failures = *plan.study.factors[factor].link_failures;
  planned.levels = {{"none", std::nullopt, {}}};
  std::map<std::string, std::uint32_t> known = {{"none", 0}};
  std::vector<Variant> variants;
  for (const Variant& variant : plan.variants) {
    variants.push_back(variant);
    variants.back()[factor] = 0;
    json::Diagnostics ignored;  // a variant that is no scenario is reported by the validation
    const auto scenario = scenario_of(plan, variant, 1, ignored);
    if (!scenario) continue;
    const auto links = switch_links(scenario->network);
    const auto name = [](const auto& link) { return link.first + "-" + link.second; };
    const auto add = [&](const std::string& text, std::initializer_list<std::size_t> which) {
      const auto [found, is_new] = known.emplace(text, static_cast<std::uint32_t>(planned.levels.size()));
      if (is_new) {
        Level level{text, std::nullopt, {}};
        for (const std::size_t i : which)
          level.replacements.push_back(failure_of(links[i], failures, "factor " + planned.name + " = " + text));
        planned.levels.push_back(std::move(level));
      }
      variants.push_back(variant);
      variants.back()[factor] = found->second;
    };
    for (std::size_t i = 0; i < links.size(); ++i) add(name(links[i]), {i});
    for (std::size_t i = 0; failures.at_once == 2 && i < links.size(); ++i)
      for (std::size_t j = i + 1; j < links.size(); ++j) add(name(links[i]) + " + " + name(links[j]), {i, j});
    if (variants.size() > most_variants) {
      diagnostics.error(plan.study.factors[factor].where.at("link_failures"), "too many combinations",
                        {"more than " + std::to_string(most_variants), "fewer links or single failures"});
      break;
    }
  }
  plan.variants = std::move(variants);
}

}  // namespace takt::study
