// SPDX-License-Identifier: Apache-2.0
#include "papers/validation/judge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "analysis/rational.hpp"

namespace takt::papers::validation {
namespace {

/// Times are compared as whole picoseconds are written: what is left of binary fractions is no difference.
constexpr double rounding = 1e-7;

/// One of the figures that the source allows.
struct Alternative {
  std::string text;
  std::optional<double> value;  ///< none: unbounded
};

Alternative alternative_of(const json::Node& node) {
  if (node.text == "unbounded") return {node.text, std::nullopt};
  const auto exact = analysis::Rational::parse(node.text);
  return {node.text, exact ? exact->to_double() : json::double_of(node)};
}

std::vector<Alternative> alternatives_of(const json::Node& published) {
  std::vector<Alternative> made;
  for (const json::Node& item : published.items) made.push_back(alternative_of(item));
  if (published.kind != json::Kind::array) made.push_back(alternative_of(published));
  return made;
}

double slack_of(const FigureText& text, double published) {
  return text.within + std::abs(published) * text.percent / 100 + rounding;
}

bool meets(const FigureText& text, const Alternative& published, double takt, const std::string& exact) {
  if (!exact.empty() && text.must_be == Rule::equal && text.within == 0 && text.percent == 0)
    return exact == published.text;
  if (!published.value) return false;
  const double slack = slack_of(text, *published.value);
  switch (text.must_be) {
    case Rule::equal:
      return std::abs(takt - *published.value) <= slack;
    case Rule::at_least:
      return takt >= *published.value - slack;
    case Rule::at_most:
      return takt <= *published.value + slack;
  }
  return false;
}

std::string rule_of(const FigureText& text) {
  const std::string slack =
      text.percent != 0 ? fmt::format("{:g} %", text.percent) : fmt::format("{:g} {}", text.within, text.unit);
  const bool is_exact = text.percent == 0 && text.within == 0;
  switch (text.must_be) {
    case Rule::equal:
      return is_exact ? "equal" : "within " + slack;
    case Rule::at_least:
      return is_exact ? "at least" : "at least, less " + slack;
    case Rule::at_most:
      return is_exact ? "at most" : "at most, plus " + slack;
  }
  return {};
}

std::string number(double value) {
  std::string text = fmt::format("{:.6f}", value);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.ends_with('.')) text.pop_back();
  return text == "-0" ? "0" : text;
}

std::string difference_of(double takt, double published) {
  if (std::abs(takt - published) <= rounding) return "0";
  return published == 0 ? fmt::format("{:+g}", takt) : fmt::format("{:+.3g} %", 100 * (takt - published) / published);
}

Agreement verdict_of(const FigureText& text, bool is_met) {
  if (!text.differs.empty()) return is_met ? Agreement::met_after_all : Agreement::differs;
  return !is_met ? Agreement::missed : text.is_calibrated ? Agreement::calibrated : Agreement::met;
}

Judged judge(const Entry& entry, const Measured& measured) {
  const FigureText& text = entry.text;
  const std::vector<Alternative> alternatives = alternatives_of(text.published.node);
  Judged made;
  made.source = entry.source;
  made.what = text.what;
  made.row = text.row.value_or("");
  made.kind = text.kind.value_or("");
  made.unit = text.unit;
  made.rule = rule_of(text);
  made.why = text.differs.empty() ? text.why : text.differs;
  for (const Alternative& each : alternatives) made.published += (made.published.empty() ? "" : " or ") + each.text;
  made.published_value = alternatives.front().value;
  if (!measured.value) {
    made.takt = measured.reason.empty() ? "none" : "none: " + measured.reason;
    const bool is_unbounded =
        std::any_of(alternatives.begin(), alternatives.end(), [](const Alternative& each) { return !each.value; });
    made.verdict = verdict_of(text, (text.may_be_unbounded || is_unbounded) && (text.bound || text.flow));
    return made;
  }
  made.takt_value = *measured.value - text.shift;
  const auto met = std::find_if(alternatives.begin(), alternatives.end(), [&](const Alternative& each) {
    return meets(text, each, *made.takt_value, measured.exact);
  });
  if (met != alternatives.end()) made.published_value = met->value;
  made.takt = measured.exact.empty() ? number(*made.takt_value) : measured.exact;
  if (made.published_value) made.difference = difference_of(*made.takt_value, *made.published_value);
  made.verdict = verdict_of(text, met != alternatives.end());
  return made;
}

}  // namespace

std::string_view name_of(Agreement verdict) {
  constexpr std::array<std::string_view, 5> names = {"met", "calibrated", "differs", "met after all", "MISSED"};
  return names[static_cast<std::size_t>(verdict)];
}

std::vector<Judged> judge(const Entries& entries, const std::vector<Measured>& measured) {
  std::vector<Judged> made;
  for (std::size_t f = 0; f < entries.figures.size(); ++f) made.push_back(judge(entries.figures[f], measured[f]));
  return made;
}

}  // namespace takt::papers::validation
