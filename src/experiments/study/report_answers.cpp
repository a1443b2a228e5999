// SPDX-License-Identifier: Apache-2.0
#include "study/report_answers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "chart/page.hpp"
#include "study/effects.hpp"

namespace takt::study {
namespace {

constexpr std::size_t most_levels_in_a_table = 40;
constexpr std::size_t most_levels_in_text = 12;

std::size_t missing_values(const ContentMeasure& measure) {
  return static_cast<std::size_t>(
      std::count_if(measure.values.begin(), measure.values.end(), [](double value) { return std::isnan(value); }));
}

/// The figure of a limited measure that is nearest to breaking its limit, or breaks it most, over the points of a
/// level; "none" if one has none.
std::string worst_at(const Content& content, std::size_t factor, std::uint32_t level, std::size_t m) {
  const ContentMeasure& measure = content.measures[m];
  std::optional<double> worst;
  for (std::size_t row = 0; row < content.rows(); ++row) {
    if (content.variants[content.variant[row]][factor] != level) continue;
    const double value = measure.values[row];
    if (std::isnan(value)) return "none in some point";
    if (!worst || (measure.lower_is_better ? value > *worst : value < *worst)) worst = value;
  }
  return worst ? scenario::text_of(*worst, measure.unit) : "";
}

std::string share_text(const LevelScore& score) { return fmt::format("{} of {}", score.passing, score.known); }

std::string break_text(const Content& content, std::size_t factor, const LevelScore& score) {
  if (!score.first_break) return {};
  const std::string others = others_of(content, content.variant[*score.first_break], factor);
  return (others.empty() ? "" : others + ": ") + broken_by(content, *score.first_break);
}

}  // namespace

bool has_named_levels(const ContentFactor& factor) { return factor.texts.size() >= 2 && !factor.is_numeric(); }

std::vector<LevelScore> level_scores(const Content& content, std::size_t factor) {
  std::vector<LevelScore> scores(content.factors[factor].texts.size());
  for (std::uint32_t level = 0; level < scores.size(); ++level) scores[level].level = level;
  const std::vector<std::optional<bool>> passes = variants_that_pass(content);
  for (std::size_t v = 0; v < passes.size(); ++v) {
    if (!passes[v]) continue;
    LevelScore& score = scores[content.variants[v][factor]];
    ++score.known;
    score.passing += *passes[v] ? 1 : 0;
  }
  for (std::size_t row = 0; row < content.rows(); ++row) {
    LevelScore& score = scores[content.variants[content.variant[row]][factor]];
    if (!content.passes[row] && !score.first_break) score.first_break = row;
  }
  std::erase_if(scores, [](const LevelScore& score) { return score.known == 0; });
  std::stable_sort(scores.begin(), scores.end(),
                   [](const LevelScore& a, const LevelScore& b) { return a.passing * b.known > b.passing * a.known; });
  return scores;
}

std::string others_of(const Content& content, std::uint32_t variant, std::size_t factor) {
  std::string text;
  for (std::size_t g = 0; g < content.factors.size(); ++g)
    if (g != factor)
      text += (text.empty() ? "" : ", ") + content.factors[g].name + " = " + content.level_text(variant, g);
  return text;
}

std::string broken_by(const Content& content, std::size_t row) {
  if (content.status[row] != Status::done) return "no result: " + std::string(name_of(content.status[row]));
  std::string text;
  for (const PlannedLimit& limit : content.limits) {
    const ContentMeasure& measure = content.measures[limit.measure];
    const double value = measure.values[row];
    const bool is_missing = std::isnan(value);
    if (limit.holds(is_missing ? std::nullopt : std::optional(value))) continue;
    text += (text.empty() ? "" : "; ") + limit.text + ": " +
            (is_missing ? std::string("none") : scenario::text_of(value, measure.unit));
  }
  return text.empty() ? "requirements of the scenario" : text;
}

std::string meaning_of(const Content& content, std::size_t m) {
  const ContentMeasure& measure = content.measures[m];
  const std::size_t missing = missing_values(measure);
  const std::string where =
      missing == 0 ? std::string() : fmt::format("; missing in {} of {} points", missing, content.rows());
  const std::uint64_t runs = content.header.replications;
  switch (measure.basis) {
    case Basis::run:
      break;
    case Basis::worst:
      return fmt::format("worst found: the greatest of any run that a search of {:g} million events a point found{}",
                         content.budget, missing == 0 ? "" : where + ", where some run has no such figure");
    case Basis::bound:
      return "bound: no run exceeds it, whatever phases and chance bring" +
             (missing == 0 ? "" : where + ", where nothing bounds it");
    case Basis::verdict:
      return "verdict of the verification: 1 proved, 0 refuted" + (missing == 0 ? "" : where + ", which are undecided");
  }
  if (content.is_of_schedules) return "of a schedule" + where;
  return fmt::format(
      "of runs: {} of each variant, phases that nobody gave drawn by the seed; another run may exceed it{}", runs,
      where);
}

std::string figures_table(const Content& content) {
  chart::Table table({"figure", "what it is"});
  for (std::size_t m = 0; m < content.measures.size(); ++m)
    table.row({{content.measures[m].name}, {meaning_of(content, m)}});
  return table.take();
}

std::string level_tables(const Content& content) {
  std::string html;
  for (std::size_t f = 0; f < content.factors.size(); ++f) {
    if (!has_named_levels(content.factors[f])) continue;
    const std::vector<LevelScore> scores = level_scores(content, f);
    std::vector<std::string> heads = {content.factors[f].name, "variants that pass"};
    std::vector<std::size_t> limited;
    for (std::size_t m = 0; m < content.measures.size(); ++m)
      if (content.measures[m].is_limited) limited.push_back(m);
    for (const std::size_t m : limited)
      heads.push_back((content.measures[m].lower_is_better ? "greatest " : "least ") + content.measures[m].name);
    heads.emplace_back("the first to break");
    chart::Table table(heads);
    for (std::size_t i = 0; i < std::min(scores.size(), most_levels_in_a_table); ++i) {
      const LevelScore& score = scores[i];
      std::vector<chart::Cell> cells = {{content.factors[f].texts[score.level]},
                                        {share_text(score), true, score.passing == score.known ? "pass" : "fail"}};
      for (const std::size_t m : limited) cells.push_back({worst_at(content, f, score.level, m), true});
      cells.push_back({break_text(content, f, score)});
      table.row(cells);
    }
    if (scores.size() > most_levels_in_a_table)
      table.row({{fmt::format("and {} more", scores.size() - most_levels_in_a_table)}});
    html += table.take();
  }
  return html;
}

std::string level_text(const Content& content) {
  std::string text;
  for (std::size_t f = 0; f < content.factors.size(); ++f) {
    if (!has_named_levels(content.factors[f])) continue;
    const std::vector<LevelScore> scores = level_scores(content, f);
    const std::size_t shown = std::min(scores.size(), most_levels_in_text);
    std::size_t width = 0;
    for (std::size_t i = 0; i < shown; ++i) width = std::max(width, content.factors[f].texts[scores[i].level].size());
    text += fmt::format("{}: variants that pass\n", content.factors[f].name);
    for (std::size_t i = 0; i < shown; ++i) {
      const std::string first = break_text(content, f, scores[i]);
      text += fmt::format("  {:<{}}  {}{}\n", content.factors[f].texts[scores[i].level], width, share_text(scores[i]),
                          first.empty() ? "" : ", the first to break: " + first);
    }
    if (scores.size() > shown) text += fmt::format("  and {} more\n", scores.size() - shown);
  }
  return text;
}

}  // namespace takt::study
