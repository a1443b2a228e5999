// SPDX-License-Identifier: Apache-2.0
#include "verify/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "json/record.hpp"
#include "verify/report_record.hpp"

namespace takt::verify {
namespace {

using sim::Duration;

/// Six digits are enough for people; the JSON has them all.
std::string figure(const std::optional<Duration>& time) {
  if (!time) return "-";
  const auto ps = static_cast<double>(time->ps());
  constexpr std::pair<double, const char*> units[] = {{1e12, "s"}, {1e9, "ms"}, {1e6, "us"}, {1e3, "ns"}};
  for (const auto& [unit, name] : units)
    if (ps >= unit) return fmt::format("{:.6g} {}", ps / unit, name);
  return fmt::format("{} ps", time->ps());
}

/// "the bound gives away 12.4 us of 30 us: 12 us at sw0:1 (blocking and other frames), 0.4 us at ...": the largest
/// parts, what is alike in one.
std::string slack_text(const Line& line) {
  if (line.slack.empty()) return {};
  std::vector<std::pair<std::string, Duration>> places;
  for (const SlackPart& part : line.slack) {
    const std::string place = part.where + " (" + part.what + ")";
    const auto known =
        std::find_if(places.begin(), places.end(), [&](const auto& each) { return each.first == place; });
    if (known == places.end())
      places.emplace_back(place, part.given_away());
    else
      known->second += part.given_away();
  }
  std::stable_sort(places.begin(), places.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
  const Duration all = *line.bound - *line.adversarial;
  std::string out = fmt::format("             the bound gives away {} of {}:", figure(all), figure(line.bound));
  constexpr std::size_t most = 4;
  Duration told;
  for (std::size_t i = 0; i < std::min(most, places.size()) && places[i].second > Duration() && told < all; ++i) {
    out += fmt::format("{} {} at {}", i == 0 ? "" : ",", figure(places[i].second), places[i].first);
    told += places[i].second;
  }
  return out + "\n";
}

/// "; not proved any more: stream camera latency at most 1ms".
std::string cost_text(const Remedy& remedy) {
  std::string text;
  for (const std::string& each : remedy.breaks) text += (text.empty() ? "; not proved any more: " : ", ") + each;
  return text;
}

/// What took most of the worst run, and what would help.
std::string help_text(const Line& line) {
  std::string out;
  for (const WeightyPart& part : line.weighty)
    out += fmt::format("{} {} at {} ({})", out.empty() ? "             most of the worst run:" : ",",
                       figure(part.takes), part.where, part.what);
  if (!out.empty()) out += "\n";
  for (const Remedy& remedy : line.remedies)
    out += fmt::format("             would be proved with: {} {} (bound {}){}\n", remedy.what, remedy.value,
                       figure(remedy.bound), cost_text(remedy));
  return out;
}

/// Eight columns would not fit, so each requirement has several lines.
std::string line_text(const Line& line, const std::string& file) {
  const std::string verdict = name_of(line.verdict) + (line.provided.empty() ? std::string() : ", if " + line.provided);
  std::string out = fmt::format("  {:<9}  {}\n", verdict, results::titled(line.requirement));
  if (line.requirement.limit)
    out += fmt::format("             simulated {} <= adversarial {} <= bound {}; limit {}{}\n", figure(line.simulated),
                       figure(line.adversarial), figure(line.bound), figure(line.requirement.limit),
                       line.tightness() ? fmt::format("; tightness {:.0f} %", 100 * *line.tightness()) : "");
  if (line.verdict == Conclusion::given)
    out += "             a data sheet promises it: nothing is proved of it, and no run that was found shows more\n";
  if (line.verdict == Conclusion::reported)
    out += fmt::format("             reported only: up to {} violation{} in a run\n", *line.violations,
                       *line.violations == 1 ? "" : "s");
  if (!line.reason.empty() && line.verdict != Conclusion::pass) out += fmt::format("             {}\n", line.reason);
  if (!line.remark.empty() && line.verdict == Conclusion::pass) out += fmt::format("             {}\n", line.remark);
  if (line.runs > 0 || line.ended == Ended::budget)
    out += fmt::format("             {} run{} to find the worst: {}\n", line.runs, line.runs == 1 ? "" : "s",
                       words_of(line.ended));
  out += slack_text(line);
  out += help_text(line);
  if (!file.empty()) out += fmt::format("             replay: takt run {}\n", file);
  return out;
}

/// Where nothing is required, nothing is proved.
std::string verdict_text(const Verification& verification) {
  return verification.lines.empty() && !verification.partial && !verification.contradiction
             ? results::nothing_was_required
             : verification.verdict_text();
}

/// What only the plant can keep, of all that is proved.
std::string conditions_text(const Verification& verification) {
  analysis::Assumptions needed;
  for (const Line& line : verification.lines)
    if (line.verdict == Conclusion::pass) needed.add(line.assumptions);
  std::string out;
  for (const analysis::Assumption assumption : needed.list())
    if (verification.ledger[assumption].standing == analysis::Standing::condition)
      out += "  - " + verification.ledger[assumption].text + "\n";
  return out.empty() ? out : "\nConditions of what is proved, which only the plant can keep:\n" + out;
}

std::string contradiction_text(const Contradiction& contradiction, const Witnesses& witnesses) {
  std::string out =
      "\nCONTRADICTION: " + contradiction.text + ".\nThis is a mistake of takt; nothing above is to be trusted.\n";
  if (!witnesses.run.empty())
    out += "Please send in " + witnesses.run + ", which replays the run, and " + witnesses.bound +
           ", whose bound it is.\n";
  return out;
}

std::string variable_text(const FreeVariable& variable) {
  if (variable.is_latency())
    return fmt::format("  {} from {} to {}\n", variable.name, figure(variable.least), figure(variable.greatest));
  if (variable.kind == FreeVariable::Kind::frequency) return "  " + variable.name + "\n";
  return fmt::format("  {} within {}\n", variable.name, figure(variable.range));
}

}  // namespace

std::string text_report(const std::string& scenario, const Verification& verification,
                        const std::vector<std::string>& files, const Witnesses& witnesses) {
  const auto count = [&](Conclusion verdict) {
    return std::ranges::count(verification.lines, verdict, &Line::verdict);
  };
  const auto reported = count(Conclusion::reported);
  const auto given = count(Conclusion::given);
  std::string out =
      fmt::format("{}: {} of {} requirements proved{}{}, {} runs{}\n\n", scenario, count(Conclusion::pass),
                  verification.lines.size() - static_cast<std::size_t>(reported + given),
                  reported > 0 ? fmt::format(", {} reported only", reported) : "",
                  given > 0 ? fmt::format(", {} given", given) : "", verification.runs,
                  verification.partial ? ", interrupted" : "");
  for (std::size_t i = 0; i < verification.lines.size(); ++i) out += line_text(verification.lines[i], files[i]);
  if (!verification.variables.empty()) {
    out += fmt::format("\nFree, hence searched for the worst ({}):\n", verification.variables.size());
    constexpr std::size_t most = 12;
    for (std::size_t i = 0; i < std::min(most, verification.variables.size()); ++i)
      out += variable_text(verification.variables[i]);
    if (verification.variables.size() > most)
      out += fmt::format("  and {} more\n", verification.variables.size() - most);
  }
  out += conditions_text(verification);
  if (verification.contradiction) out += contradiction_text(*verification.contradiction, witnesses);
  return out + fmt::format("\n{}: {}\n", scenario, verdict_text(verification));
}

std::string json_report(const std::string& scenario, const Verification& verification,
                        const std::vector<std::string>& files, const Witnesses& witnesses) {
  Report report{scenario,
                verification.lines.empty() ? verdict_text(verification) : name_of(verification.verdict()),
                verification.runs,
                verification.partial,
                {},
                {},
                {},
                {}};
  for (const FreeVariable& variable : verification.variables) {
    const Duration range = variable.is_latency() ? variable.greatest - variable.least : variable.range;
    report.free.push_back(
        {variable.name, variable.kind == FreeVariable::Kind::frequency ? std::nullopt : std::optional(range)});
  }
  analysis::Assumptions needed;
  for (std::size_t i = 0; i < verification.lines.size(); ++i) {
    report.requirements.push_back({&verification.lines[i], files[i].empty() ? std::nullopt : std::optional(files[i])});
    needed.add(verification.lines[i].assumptions);
  }
  for (const analysis::Assumption assumption : needed.list())
    report.assumptions.push_back({std::string(analysis::name_of(assumption)), verification.ledger[assumption]});
  if (verification.contradiction)
    report.contradiction = ReportedContradiction{verification.contradiction->text, witnesses};
  return json::write(report);
}

}  // namespace takt::verify
