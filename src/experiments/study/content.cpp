// SPDX-License-Identifier: Apache-2.0
#include "study/content.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "json/document.hpp"
#include "study/sql.hpp"

namespace takt::study {
namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

void read_factors(sqlite3* database, Content& content) {
  Statement factors(database, "SELECT name, unit, logarithmic FROM factor ORDER BY id");
  while (factors.step()) content.factors.push_back({factors.text(0), factors.text(1), factors.integer(2) != 0, {}, {}});
  Statement levels(database, "SELECT factor, text, number FROM level ORDER BY factor, id");
  while (levels.step()) {
    const auto f = static_cast<std::size_t>(levels.integer(0));
    if (f >= content.factors.size()) continue;
    content.factors[f].texts.push_back(levels.text(1));
    content.factors[f].numbers.push_back(levels.real(2).value_or(nothing));
  }
}

void read_measures(sqlite3* database, Content& content) {
  Statement measures(database, "SELECT name, unit FROM measure ORDER BY id");
  while (measures.step()) content.measures.push_back({measures.text(0), measures.text(1), true, {}, false});
  Statement bases(database, "SELECT measure, name FROM basis");  // older stores have none, and figures of runs alone
  while (bases.step())
    if (const auto m = static_cast<std::size_t>(bases.integer(0)); m < content.measures.size())
      content.measures[m].basis = basis_named(bases.text(1)).value_or(Basis::run);
  Statement limits(database, "SELECT measure, is_upper, value, text FROM limits ORDER BY id");
  while (limits.step()) {
    PlannedLimit limit{{limits.integer(1) != 0 ? scenario::Relation::at_most : scenario::Relation::at_least,
                        limits.real(2).value_or(0), limits.text(3)},
                       static_cast<std::size_t>(limits.integer(0))};
    if (limit.measure >= content.measures.size()) continue;
    if (!limit.is_upper()) content.measures[limit.measure].lower_is_better = false;
    content.measures[limit.measure].is_limited = true;
    content.limits.push_back(std::move(limit));
  }
}

/// What the configuration says of phases and of the search for worst runs.
void read_manner(Content& content) {
  json::Diagnostics ignored;
  const auto document = json::parse(content.header.configuration, "configuration", ignored);
  if (!document || document->root().kind != json::Kind::object) return;
  const json::Node* const verify = document->root().find("verify");
  const json::Node* const budget = verify != nullptr ? verify->find("budget") : nullptr;
  if (budget != nullptr) content.budget = json::double_of(*budget);
  content.is_of_schedules = document->root().find("schedule") != nullptr;
}

bool read_variants(sqlite3* database, Content& content) {
  Statement variants(database, "SELECT * FROM variant ORDER BY id");
  while (variants.step()) {
    Variant variant;
    for (std::size_t f = 0; f < content.factors.size(); ++f) {
      variant.push_back(static_cast<std::uint32_t>(variants.integer(static_cast<int>(f) + 1)));
      if (variant.back() >= content.factors[f].texts.size()) return false;
    }
    content.variants.push_back(std::move(variant));
  }
  return content.variants.size() == content.header.variants;
}

bool read_points(sqlite3* database, Content& content) {
  std::string columns = "id, variant, replication, status, pass, cpu_us, error, verdict";
  for (std::size_t m = 0; m < content.measures.size(); ++m) columns += fmt::format(", m{}", m);
  Statement points(database, "SELECT " + columns + " FROM point ORDER BY id");
  std::int64_t cpu_us = 0;
  while (points.step()) {
    content.variant.push_back(static_cast<std::uint32_t>(points.integer(1)));
    if (content.variant.back() >= content.variants.size()) return false;
    content.replication.push_back(static_cast<std::uint32_t>(points.integer(2)));
    content.status.push_back(status_named(points.text(3)).value_or(Status::failed));
    content.passes.push_back(points.integer(4) != 0);
    content.verdict.push_back(points.text(7));
    cpu_us += points.integer(5);
    if (content.status.back() != Status::done)
      content.troubles.push_back(
          {static_cast<std::uint64_t>(points.integer(0)), content.status.back(), points.text(6)});
    for (std::size_t m = 0; m < content.measures.size(); ++m)
      content.measures[m].values.push_back(points.real(8 + static_cast<int>(m)).value_or(nothing));
  }
  content.cpu_seconds = static_cast<double>(cpu_us) * 1e-6;
  return !points.failed();
}

}  // namespace

bool ContentFactor::is_numeric() const {
  return std::none_of(numbers.begin(), numbers.end(), [](double number) { return std::isnan(number); });
}

std::string Content::name_of(std::uint32_t v) const {
  std::string name;
  for (std::size_t f = 0; f < factors.size(); ++f)
    name += fmt::format("{}{} = {}", f == 0 ? "" : ", ", factors[f].name, level_text(v, f));
  return name;
}

std::unique_ptr<Content> read_store(const std::string& path, std::string& problem) {
  const auto store = Store::open(path, problem);
  if (!store) return nullptr;
  auto content = std::make_unique<Content>();
  content->header = store->header();
  read_manner(*content);
  read_factors(store->handle(), *content);
  read_measures(store->handle(), *content);
  if (read_variants(store->handle(), *content) && read_points(store->handle(), *content)) return content;
  problem = path + ": its tables contradict each other";
  return nullptr;
}

}  // namespace takt::study
