// SPDX-License-Identifier: Apache-2.0
#include "study/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "chart/page.hpp"
#include "chart/svg.hpp"
#include "study/effects.hpp"
#include "study/frontier.hpp"
#include "study/magnitude.hpp"
#include "study/report_answers.hpp"
#include "study/report_charts.hpp"
#include "verify/verification.hpp"

namespace takt::study {
namespace {

using chart::escaped;

constexpr std::size_t most_charts = 60;  // of one kind
constexpr std::size_t most_rows = 40;    // of a table
constexpr std::size_t best_and_worst = 5;

struct Counts {
  std::size_t done = 0;
  std::size_t passing = 0;
  std::map<Status, std::size_t> troubled;
};

Counts counts_of(const Content& content) {
  Counts counts;
  for (std::size_t row = 0; row < content.rows(); ++row) {
    if (content.status[row] == Status::done)
      ++counts.done;
    else
      ++counts.troubled[content.status[row]];
    counts.passing += content.passes[row] ? 1 : 0;
  }
  return counts;
}

/// The rows of points that came to their end and do not pass.
std::vector<std::size_t> failing_rows(const Content& content) {
  std::vector<std::size_t> rows;
  for (std::size_t row = 0; row < content.rows(); ++row)
    if (content.status[row] == Status::done && !content.passes[row]) rows.push_back(row);
  return rows;
}

class Page {
 public:
  explicit Page(const Content& content) : content_(content) {}

  std::string take() {
    head();
    answer();
    feasibility();
    main_effects();
    responses();
    heat_maps();
    best_and_worst_variants();
    fronts();
    where_limits_break();
    failing_points();
    troubles();
    return std::move(html_) + chart::page_end();
  }

 private:
  void add(const std::string& text) { html_ += text; }
  void section(const std::string& title, const std::string& note = "") { add(chart::section(title, note)); }
  void charts(const std::string& title, const std::string& note, const std::string& all) {
    if (all.empty()) return;
    section(title, note);
    add("<div class=\"charts\">\n" + all + "</div>\n");
  }

  void head() {
    const Counts counts = counts_of(content_);
    add(chart::page_head(content_.header.name));
    add("<table>\n");
    const auto row = [&](const std::string& name, const std::string& value) {
      add("<tr><th>" + escaped(name) + "</th><td>" + escaped(value) + "</td></tr>\n");
    };
    row("points", fmt::format("{} of {}: {} variants, {} replications", content_.rows(), content_.header.points(),
                              content_.variants.size(), content_.header.replications));
    std::string troubled;
    for (const auto& [status, count] : counts.troubled) troubled += fmt::format(", {} {}", count, name_of(status));
    row("results", fmt::format("{} pass, {} do not{}", counts.passing, counts.done - counts.passing, troubled));
    std::string limits;
    for (const PlannedLimit& limit : content_.limits) limits += (limits.empty() ? "" : ", ") + limit.text;
    row("limits", limits.empty() ? "those of the scenario" : limits);
    row("CPU time", with_unit(content_.cpu_seconds, "s"));
    row("configuration", content_.header.digest + ", " + results::name_of(content_.header.maker));
    add("</table>\n<table><thead><tr><th>factor</th><th>levels</th></tr></thead>\n");
    for (const ContentFactor& factor : content_.factors) {
      std::string levels;
      for (std::size_t i = 0; i < std::min<std::size_t>(factor.texts.size(), 12); ++i)
        levels += (i == 0 ? "" : ", ") + factor.texts[i];
      if (factor.texts.size() > 12) levels += fmt::format(" ... ({} in all)", factor.texts.size());
      add("<tr><td>" + escaped(factor.name) + "</td><td>" + escaped(levels) + "</td></tr>\n");
    }
    add("</table>\n" + figures_table(content_));
  }

  /// What holds up to where, and what matters: the questions that a study is run for.
  void answer() {
    if (content_.rows() < content_.header.points())
      add(
          fmt::format("<p class=\"verdict undecided\">{} of {} points have been run: all of this is about a sample. "
                      "takt study FILE --out STORE --resume runs the others.</p>\n",
                      content_.rows(), content_.header.points()));
    section("The answer");
    std::size_t known = 0;
    std::size_t good = 0;
    for (const std::optional<bool>& passes : variants_that_pass(content_)) {
      known += passes ? 1 : 0;
      good += passes.value_or(false) ? 1 : 0;
    }
    const char* const look = known == 0 ? "undecided" : good == known ? "pass" : "fail";
    add(fmt::format("<p class=\"verdict {}\">{}{}</p>\n", look,
                    known == 0      ? "no variant has a result"
                    : good == known ? fmt::format("all {} variants pass", known)
                                    : fmt::format("{} of {} variants pass", good, known),
                    known == 0 ? "" : how_they_pass()));
    add(level_tables(content_));
    holds_up_to();
    what_matters();
  }

  /// What passing means here: a few runs are no proof.
  std::string how_they_pass() const {
    if (content_.is_of_schedules) return {};
    if (std::none_of(content_.measures.begin(), content_.measures.end(),
                     [](const ContentMeasure& measure) { return measure.basis != Basis::run; }))
      return fmt::format(
          " in {} run{} each, which is no proof that they do in every run: measures bound.X, worst.X and verdict look "
          "for one",
          content_.header.replications, content_.header.replications == 1 ? "" : "s");
    std::size_t undecided = 0;
    for (std::size_t row = 0; row < content_.rows(); ++row)
      undecided +=
          content_.passes[row] && content_.verdict[row] == verify::name_of(verify::Conclusion::undecided) ? 1 : 0;
    return undecided == 0 ? std::string()
                          : fmt::format(
                                "; the requirements of {} point{} are undecided: no run that was found breaks them, "
                                "and no proof excludes one",
                                undecided, undecided == 1 ? "" : "s");
  }

  /// Of a study of schedules what it is about.
  void feasibility() {
    const auto frontier = frontier_of(content_);
    if (!frontier) return;
    charts("Feasibility frontier",
           fmt::format(
               "Shares of the draws of one number of streams. The frontier is the greatest number up to which at least "
               "{:.0f} % of them are scheduled, of it and of each smaller one. What is neither scheduled nor "
               "proved infeasible is undecided after so many attempts of the search.",
               100 * frontier_share),
           frontier_charts(content_, *frontier));
    add("<p class=\"note\">scheduled / infeasible (proved) / undecided, in % of the draws</p>\n" +
        frontier_table(content_, *frontier));
  }

  void holds_up_to() {
    chart::Table table(
        {"factor", "everything passes up to", "the first to break", "where", "combinations that never break"});
    for (std::size_t f = 0; f < content_.factors.size(); ++f) {
      const ContentFactor& factor = content_.factors[f];
      if (!factor.is_numeric() || factor.texts.size() < 2) continue;
      const std::vector<Break> breaks = breaks_along(content_, f);
      const Break* first = nullptr;
      std::size_t unbroken = 0;
      for (const Break& one : breaks) {
        if (!one.first_bad)
          ++unbroken;
        else if (first == nullptr || factor.numbers[*one.first_bad] < factor.numbers[*first->first_bad])
          first = &one;
      }
      if (breaks.empty()) continue;
      const std::string everywhere = first == nullptr   ? "the end"
                                     : first->last_good ? factor.texts[*first->last_good]
                                                        : "nothing";
      table.row({{factor.name},
                 {everywhere, true},
                 {first == nullptr ? "-" : factor.texts[*first->first_bad], true, first == nullptr ? "" : "fail"},
                 {first == nullptr ? std::string() : others_of(content_, first->variant, f)},
                 {fmt::format("{} of {}", unbroken, breaks.size()), true}});
    }
    add(table.take());
  }

  void what_matters() {
    std::vector<std::string> heads = {"measure"};
    for (std::size_t f = 0; f < content_.factors.size(); ++f) heads.push_back(fmt::format("{}.", f + 1));
    heads.emplace_back("together, or by chance");
    chart::Table table(heads);
    for (std::size_t m = 0; m < content_.measures.size(); ++m) {
      const std::vector<Influence> ranked = influences(content_, m);
      if (ranked.empty()) continue;
      std::vector<chart::Cell> cells = {{content_.measures[m].name}};
      double rest = 1;
      for (const Influence& each : ranked) {
        rest -= each.share;
        cells.push_back({fmt::format("{} {:.0f} %", content_.factors[each.factor].name, 100 * each.share)});
      }
      cells.push_back({fmt::format("{:.0f} %", 100 * std::max(rest, 0.0)), true});
      table.row(cells);
    }
    const std::string rows = table.take();
    if (!rows.empty())
      add("<h3>What matters</h3><p class=\"note\">Share of the variance between variants for which the levels of a "
          "factor account by themselves, ranked. Where a design does not have every "
          "combination equally often, factors share what they cannot be told apart by.</p>\n" +
          rows);
  }

  void main_effects() {
    std::string all;
    std::size_t count = 0;
    for (std::size_t m = 0; m < content_.measures.size(); ++m)
      for (std::size_t f = 0; f < content_.factors.size() && count < most_charts; ++f, ++count)
        all += main_effect_chart(content_, f, m);
    charts("Main effects",
           "Each level's mean over everything else. Whiskers: 95 % confidence intervals of the mean over the "
           "replications (Student).",
           all);
  }

  void responses() {
    std::string all;
    std::size_t count = 0;
    for (std::size_t m = 0; m < content_.measures.size(); ++m)
      for (std::size_t x = 0; x < content_.factors.size(); ++x)
        for (std::size_t c = 0; c < content_.factors.size() && count < most_charts; ++c) {
          if (c == x) continue;
          const std::string one = response_chart(content_, x, c, m);
          count += one.empty() ? 0 : 1;
          all += one;
        }
    charts("Response curves", "Means over the factors that are not named, with 95 % confidence intervals (Student).",
           all);
  }

  void heat_maps() {
    std::string all;
    std::size_t count = 0;
    for (std::size_t m = 0; m < content_.measures.size(); ++m)
      for (std::size_t a = 0; a < content_.factors.size(); ++a)
        for (std::size_t b = a + 1; b < content_.factors.size() && count < most_charts; ++b, ++count)
          all += heat_map_chart(content_, a, b, m);
    charts("Heat maps",
           "Means over the factors that are not named. Red frame: some point in there does not pass; the cell tells "
           "which, and the command that makes a scenario of it. Factors that the design does not cross have no map.",
           all);
  }

  void best_and_worst_variants() {
    section("Best and worst variants",
            "By the mean over the replications; the least and the greatest of them in brackets. Of a measure without a "
            "limit: the least and the greatest.");
    for (std::size_t m = 0; m < content_.measures.size(); ++m) {
      const ContentMeasure& measure = content_.measures[m];
      const std::vector<Summary> summaries = by_variant(content_, m);
      std::vector<std::uint32_t> order;
      for (std::uint32_t v = 0; v < summaries.size(); ++v)
        if (summaries[v].count > 0) order.push_back(v);
      const auto is_better = [&](std::uint32_t a, std::uint32_t b) {
        if (summaries[a].mean == summaries[b].mean) return a < b;
        return measure.lower_is_better ? summaries[a].mean < summaries[b].mean : summaries[a].mean > summaries[b].mean;
      };
      // What is better, only a limit says.
      const char* const first = measure.is_limited ? "best" : "least";
      const char* const last = measure.is_limited ? "worst" : "greatest";
      const std::size_t shown = std::min(order.size(), 2 * best_and_worst);
      const std::size_t best = std::min(best_and_worst, shown);
      std::partial_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(best), order.end(), is_better);
      const auto worst_first = [&](std::uint32_t a, std::uint32_t b) { return is_better(b, a); };
      std::partial_sort(order.begin() + static_cast<std::ptrdiff_t>(best),
                        order.begin() + static_cast<std::ptrdiff_t>(shown), order.end(), worst_first);
      add("<table><thead><tr><th>" + escaped(label_of(measure)) + "</th><th></th><th>variant</th></tr></thead>\n");
      for (std::size_t i = 0; i < shown; ++i) {
        const Summary& summary = summaries[order[i]];
        add(fmt::format("<tr><td class=\"n\">{} ({} to {})</td><td>{}</td><td>{}</td></tr>\n",
                        short_number(summary.mean), short_number(summary.min), short_number(summary.max),
                        i < best ? first : last, escaped(content_.name_of(order[i]))));
      }
      add("</table>\n");
    }
  }

  void fronts() {
    std::string all;
    std::size_t count = 0;
    for (std::size_t a = 0; a < content_.measures.size(); ++a)
      for (std::size_t b = a + 1; b < content_.measures.size() && count < 6; ++b) {
        if (!content_.measures[a].is_limited || !content_.measures[b].is_limited)
          continue;  // nobody has said what is better
        all += pareto_chart(content_, a, b);
        ++count;
      }
    charts("Pareto fronts",
           "Variants that no other one beats in both measures, of measures whose limits say what is better.", all);
  }

  void where_limits_break() {
    section("Where limits break", content_.limits.empty()
                                      ? "A variant passes if all its points meet the requirements of the scenario."
                                      : "A variant passes if all its points keep all limits.");
    std::string all;
    for (std::size_t f = 0; f < content_.factors.size(); ++f) all += pass_chart(content_, f);
    if (!all.empty()) add("<div class=\"charts\">\n" + all + "</div>\n");
    for (std::size_t f = 0; f < content_.factors.size(); ++f) {
      const ContentFactor& factor = content_.factors[f];
      if (!factor.is_numeric() || factor.texts.size() < 2 || factor.texts.size() > most_levels_shown) continue;
      const std::vector<Break> breaks = breaks_along(content_, f);
      add("<table><thead><tr><th>" + escaped(factor.name) +
          " passes up to</th><th>and breaks at</th><th>where</th></tr></thead>\n");
      for (std::size_t i = 0; i < std::min(breaks.size(), most_rows); ++i) {
        const Break& one = breaks[i];
        add("<tr><td>" + escaped(one.last_good ? factor.texts[*one.last_good] : "-") + "</td><td class=\"fail\">" +
            escaped(one.first_bad ? factor.texts[*one.first_bad] : "") + "</td><td>" +
            escaped(others_of(content_, one.variant, f)) + "</td></tr>\n");
      }
      if (breaks.size() > most_rows)
        add(fmt::format("<tr><td></td><td></td><td>and {} more combinations</td></tr>\n", breaks.size() - most_rows));
      add("</table>\n");
    }
  }

  void failing_points() {
    const std::vector<std::size_t> rows = failing_rows(content_);
    if (rows.empty() || frontier_of(content_)) return;  // a draw that has no schedule is an answer, too
    section("Points that do not pass",
            "By their numbers: takt study shrink FILE POINT finds the least of its faults with which a point still "
            "fails, and writes it as a scenario.");
    add("<table><thead><tr><th>point</th><th>variant</th><th>replication</th><th>what it breaks</th></tr></thead>\n");
    for (std::size_t i = 0; i < std::min(rows.size(), most_rows); ++i)
      add(fmt::format("<tr><td class=\"n\">{}</td><td>{}</td><td class=\"n\">{}</td><td class=\"fail\">{}</td></tr>\n",
                      content_.point_of(rows[i]), escaped(content_.name_of(content_.variant[rows[i]])),
                      content_.replication[rows[i]], escaped(broken_by(content_, rows[i]))));
    if (rows.size() > most_rows)
      add(fmt::format("<tr><td></td><td>and {} more</td><td></td><td></td></tr>\n", rows.size() - most_rows));
    add("</table>\n");
  }

  void troubles() {
    if (content_.troubles.empty()) return;
    section("Points without a result");
    add("<table><thead><tr><th>point</th><th></th><th>why</th></tr></thead>\n");
    for (std::size_t i = 0; i < std::min(content_.troubles.size(), most_rows); ++i) {
      const Trouble& trouble = content_.troubles[i];
      add(fmt::format("<tr><td class=\"n\">{}</td><td>{}</td><td><pre>{}</pre></td></tr>\n", trouble.point,
                      name_of(trouble.status), escaped(trouble.error.substr(0, 600))));
    }
    if (content_.troubles.size() > most_rows)
      add(fmt::format("<tr><td></td><td></td><td>and {} more</td></tr>\n", content_.troubles.size() - most_rows));
    add("</table>\n");
  }

  const Content& content_;
  std::string html_;
};

}  // namespace

std::string html_report(const Content& content) { return Page(content).take(); }

std::string text_summary(const Content& content) {
  const Counts counts = counts_of(content);
  std::string text = fmt::format("{}: {} of {} points, {} pass, {} do not", content.header.name, content.rows(),
                                 content.header.points(), counts.passing, counts.done - counts.passing);
  for (const auto& [status, count] : counts.troubled) text += fmt::format(", {} {}", count, name_of(status));
  text += "\n" + level_text(content);
  for (std::size_t m = 0; m < content.measures.size(); ++m) {
    std::vector<double> all;
    for (const double value : content.measures[m].values)
      if (value == value) all.push_back(value);
    const Summary summary = summary_of(all, 0);
    text +=
        fmt::format("  {:<24} {} to {}, mean {}{}{}, {} missing{}\n", content.measures[m].name,
                    short_number(summary.min), short_number(summary.max), short_number(summary.mean),
                    content.measures[m].unit.empty() ? "" : " ", content.measures[m].unit, content.rows() - all.size(),
                    content.measures[m].basis == Basis::worst   ? " (worst found)"
                    : content.measures[m].basis == Basis::bound ? " (bound)"
                                                                : "");
  }
  if (const auto frontier = frontier_of(content)) return text + frontier_text(content, *frontier);
  const std::vector<std::size_t> failing = failing_rows(content);
  constexpr std::size_t most_named = 10;
  for (std::size_t i = 0; i < std::min(failing.size(), most_named); ++i)
    text += fmt::format("{}{}", i == 0 ? "  points that do not pass: " : ", ", content.point_of(failing[i]));
  if (!failing.empty()) text += failing.size() > most_named ? " ...\n" : "\n";
  return text;
}

}  // namespace takt::study
