// SPDX-License-Identifier: Apache-2.0
#include "study/effects.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace takt::study {
namespace {

struct Mean {
  double sum = 0;
  std::size_t count = 0;
};

/// Summaries of groups of rows: mean within each replication, then over replications. `group_of` says which group a
/// variant is in.
template <class GroupOf>
std::vector<Summary> grouped(const Content& content, std::size_t measure, std::size_t groups, const GroupOf& group_of,
                             double level = confidence) {
  const std::uint32_t replications =
      std::max<std::uint32_t>(1, static_cast<std::uint32_t>(content.header.replications));
  std::vector<Mean> means(groups * replications);
  const std::vector<double>& values = content.measures[measure].values;
  for (std::size_t row = 0; row < content.rows(); ++row) {
    if (std::isnan(values[row]) || content.replication[row] >= replications) continue;
    Mean& mean = means[group_of(content.variant[row]) * replications + content.replication[row]];
    mean.sum += values[row];
    ++mean.count;
  }
  std::vector<Summary> summaries;
  std::vector<double> of_group;
  for (std::size_t g = 0; g < groups; ++g) {
    of_group.clear();
    for (std::uint32_t r = 0; r < replications; ++r)
      if (const Mean& mean = means[g * replications + r]; mean.count > 0)
        of_group.push_back(mean.sum / static_cast<double>(mean.count));
    summaries.push_back(summary_of(of_group, level));
  }
  return summaries;
}

bool is_better(const ContentMeasure& measure, double a, double b) { return measure.lower_is_better ? a < b : a > b; }

}  // namespace

std::vector<Summary> main_effect(const Content& content, std::size_t factor, std::size_t measure) {
  return grouped(content, measure, content.factors[factor].texts.size(),
                 [&](std::uint32_t v) { return content.variants[v][factor]; });
}

std::vector<std::vector<Summary>> joint_effect(const Content& content, std::size_t a, std::size_t b,
                                               std::size_t measure) {
  const std::size_t width = content.factors[b].texts.size();
  const std::vector<Summary> flat =
      grouped(content, measure, content.factors[a].texts.size() * width,
              [&](std::uint32_t v) { return content.variants[v][a] * width + content.variants[v][b]; });
  std::vector<std::vector<Summary>> table;
  for (std::size_t i = 0; i < content.factors[a].texts.size(); ++i)
    table.emplace_back(flat.begin() + static_cast<std::ptrdiff_t>(i * width),
                       flat.begin() + static_cast<std::ptrdiff_t>((i + 1) * width));
  return table;
}

std::vector<Summary> by_variant(const Content& content, std::size_t measure) {
  return grouped(
      content, measure, content.variants.size(), [](std::uint32_t v) { return v; }, 0);
}

std::vector<std::optional<bool>> variants_that_pass(const Content& content) {
  std::vector<std::optional<bool>> passes(content.variants.size());
  for (std::size_t row = 0; row < content.rows(); ++row) {
    std::optional<bool>& all = passes[content.variant[row]];
    all = all.value_or(true) && content.passes[row];
  }
  return passes;
}

std::vector<std::uint32_t> pareto_front(const Content& content, std::size_t a, std::size_t b) {
  const std::vector<Summary> of_a = by_variant(content, a);
  const std::vector<Summary> of_b = by_variant(content, b);
  std::vector<std::uint32_t> order;
  for (std::uint32_t v = 0; v < content.variants.size(); ++v)
    if (of_a[v].count > 0 && of_b[v].count > 0) order.push_back(v);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t x, std::uint32_t y) {
    if (of_a[x].mean != of_a[y].mean) return is_better(content.measures[a], of_a[x].mean, of_a[y].mean);
    return is_better(content.measures[b], of_b[x].mean, of_b[y].mean);
  });
  std::vector<std::uint32_t> front;
  for (const std::uint32_t v : order)
    if (front.empty() || is_better(content.measures[b], of_b[v].mean, of_b[front.back()].mean)) front.push_back(v);
  return front;
}

std::vector<Influence> influences(const Content& content, std::size_t measure) {
  const std::vector<Summary> variants = by_variant(content, measure);
  Mean all;
  for (const Summary& each : variants)
    if (each.count > 0) all = {all.sum + each.mean, all.count + 1};
  if (all.count < 2) return {};
  const double centre = all.sum / static_cast<double>(all.count);
  double whole = 0;
  for (const Summary& each : variants)
    if (each.count > 0) whole += (each.mean - centre) * (each.mean - centre);
  if (!(whole > 0)) return {};
  std::vector<Influence> found;
  for (std::size_t f = 0; f < content.factors.size(); ++f) {
    std::vector<Mean> levels(content.factors[f].texts.size());
    for (std::size_t v = 0; v < variants.size(); ++v) {
      if (variants[v].count == 0) continue;
      Mean& level = levels[content.variants[v][f]];
      level = {level.sum + variants[v].mean, level.count + 1};
    }
    double part = 0;
    for (const Mean& level : levels)
      if (level.count > 0)
        part += static_cast<double>(level.count) * std::pow(level.sum / static_cast<double>(level.count) - centre, 2);
    found.push_back({f, std::min(1.0, part / whole)});
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const Influence& a, const Influence& b) { return a.share > b.share; });
  return found;
}

bool are_crossed(const Content& content, std::size_t a, std::size_t b) {
  const std::size_t width = content.factors[b].texts.size();
  std::vector<bool> met(content.factors[a].texts.size() * width);
  for (std::size_t row = 0; row < content.rows(); ++row) {
    const Variant& variant = content.variants[content.variant[row]];
    if (content.status[row] == Status::done) met[variant[a] * width + variant[b]] = true;
  }
  return 2 * static_cast<std::size_t>(std::count(met.begin(), met.end(), true)) >= met.size();
}

std::vector<Break> breaks_along(const Content& content, std::size_t factor) {
  const std::vector<double>& numbers = content.factors[factor].numbers;
  std::vector<std::uint32_t> order(numbers.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return numbers[a] < numbers[b]; });
  const auto passes = variants_that_pass(content);
  std::map<Variant, std::map<std::uint32_t, std::uint32_t>>
      lines;  // others' levels -> rank of this factor's level -> variant
  std::vector<std::uint32_t> rank(order.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) rank[order[i]] = i;
  for (std::uint32_t v = 0; v < content.variants.size(); ++v) {
    if (!passes[v]) continue;
    Variant others = content.variants[v];
    const std::uint32_t level = others[factor];
    others[factor] = 0;
    lines[others][rank[level]] = v;
  }
  std::vector<Break> breaks;
  for (const auto& [others, line] : lines) {
    Break one{line.begin()->second, std::nullopt, std::nullopt};
    for (const auto& [position, v] : line) {
      if (!*passes[v]) {
        one.first_bad = order[position];
        break;
      }
      one.last_good = order[position];
    }
    breaks.push_back(one);
  }
  std::stable_sort(breaks.begin(), breaks.end(),
                   [](const Break& a, const Break& b) { return a.first_bad.has_value() > b.first_bad.has_value(); });
  return breaks;
}

}  // namespace takt::study
