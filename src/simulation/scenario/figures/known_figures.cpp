// SPDX-License-Identifier: Apache-2.0
#include "scenario/figures/known_figures.hpp"

#include <algorithm>
#include <cstdint>

#include "json/record.hpp"
#include "results/run_result.hpp"
#include "scenario/figures/graph_figures.hpp"

namespace takt::scenario {
namespace {

bool is_index(std::string_view step) {
  return !step.empty() && std::all_of(step.begin(), step.end(), [](char c) { return c >= '0' && c <= '9'; });
}

bool matches(std::string_view pattern, std::string_view step) {
  if (step == "*" || pattern.starts_with('<')) return true;
  return pattern == "[]" ? is_index(step) : pattern == step;
}

/// What a scenario has names of; other names are of what a run makes.
constexpr std::string_view scenario_names[] = {"stream", "program", "application", "signal", "node", "reason"};

std::string key_step(std::string_view keys) {
  const bool is_known = std::ranges::find(scenario_names, keys) != std::end(scenario_names);
  return is_known ? "/<" + std::string(keys) + ">" : "/<>";
}

class FigureWalk {
 public:
  explicit FigureWalk(std::vector<KnownFigure>& figures) : figures_(figures) {}

  void record(const json::Record& record, const std::string& path, const json::Meaning& outer) {
    for (const json::Output& output : record.outputs) {
      json::Meaning meaning = output.meaning;
      meaning.counts_from_start = meaning.counts_from_start || outer.counts_from_start;
      meaning.is_judgement = meaning.is_judgement || outer.is_judgement;
      shape(*output.shape,
            output.is_spread ? path
            : record.is_row  ? path + "/[]"
                             : path + "/" + std::string(output.name),
            meaning);
    }
  }

 private:
  void shape(const json::Shape& what, const std::string& path, const json::Meaning& meaning) {
    using Kind = json::Shape::Kind;
    if (what.kind == Kind::record) return record(what.record(), path, meaning);
    if (what.kind == Kind::list) return shape(*what.item, path + "/[]", meaning);
    if (what.kind == Kind::map) return shape(*what.item, path + key_step(meaning.keys), meaning);
    using enum FigureKind;
    const FigureKind kind = meaning.is_judgement        ? verdict
                            : what.kind == Kind::text   ? text
                            : meaning.is_zero_if_absent ? counter
                                                        : number;
    if (figures_.empty() || figures_.back().pattern != path)
      figures_.push_back({kind, path, steps_of(path), meaning.counts_from_start});
  }

  std::vector<KnownFigure>& figures_;
};

}  // namespace

const std::vector<KnownFigure>& known_figures() {
  static const std::vector<KnownFigure> all = [] {
    std::vector<KnownFigure> figures;
    FigureWalk walk(figures);
    walk.record(describe(json::Type<results::RunResult>{}), "", {});
    walk.record(describe(json::Type<GraphFigures>{}), "/topology", {});
    return figures;
  }();
  return all;
}

std::vector<std::string> steps_of(std::string_view pointer) {
  std::vector<std::string> steps;
  for (std::string_view rest = pointer; rest.starts_with('/');) {
    rest.remove_prefix(1);
    const std::size_t end = std::min(rest.find('/'), rest.size());
    std::string step;
    for (std::size_t i = 0; i < end; ++i) {
      const bool is_escape = rest[i] == '~' && i + 1 < end && (rest[i + 1] == '0' || rest[i + 1] == '1');
      step += !is_escape ? rest[i] : rest[++i] == '0' ? '~' : '/';
    }
    steps.push_back(std::move(step));
    rest.remove_prefix(end);
  }
  return steps;
}

std::string_view placeholder_of(std::string_view step) {
  return step.starts_with('<') ? step.substr(1, step.size() - 2) : std::string_view();
}

Lookup look_up(const std::vector<std::string>& steps) {
  std::vector<const KnownFigure*> candidates;
  for (const KnownFigure& figure : known_figures()) candidates.push_back(&figure);
  Lookup lookup;
  for (std::size_t i = 0; i <= steps.size(); ++i) {
    std::vector<const KnownFigure*> left;
    for (const KnownFigure* const candidate : candidates)
      if (i == steps.size() ? candidate->steps.size() == i
                            : candidate->steps.size() > i && matches(candidate->steps[i], steps[i]))
        left.push_back(candidate);
    if (left.empty()) {
      lookup.wrong_step = i;
      for (const KnownFigure* const candidate : candidates) {
        if (candidate->steps.size() <= i) continue;
        std::string text = candidate->steps[i] == "[]" ? "an index or *" : candidate->steps[i];
        if (std::find(lookup.expected.begin(), lookup.expected.end(), text) == lookup.expected.end())
          lookup.expected.push_back(std::move(text));
      }
      return lookup;
    }
    candidates = std::move(left);
  }
  lookup.figures = std::move(candidates);
  return lookup;
}

}  // namespace takt::scenario
