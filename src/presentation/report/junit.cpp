// SPDX-License-Identifier: Apache-2.0
#include "report/junit.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "chart/svg.hpp"
#include "json/printable.hpp"
#include "json/quantity.hpp"
#include "report/page_parts.hpp"
#include "results/behaviour.hpp"
#include "results/version.hpp"
#include "scenario/figures/figure.hpp"

namespace takt::report {
namespace {

using Outcome = JunitCase::Outcome;

void add_property(JunitCase& made, const char* name, const std::optional<sim::Duration>& time) {
  if (time) made.properties.emplace_back(name, json::to_text(*time));
}
void add_property(JunitCase& made, const char* name, const std::string& text) {
  if (!text.empty()) made.properties.emplace_back(name, text);
}

/// What was found, and what is asked.
void add_figures(JunitCase& made, const results::RequirementResult& requirement) {
  if (requirement.figure) {
    const results::FigureResult& figure = *requirement.figure;
    if (figure.found) add_property(made, "found", scenario::text_of(*figure.found, figure.unit));
    add_property(made,
                 figure.within     ? "equal"
                 : figure.is_upper ? "at_most"
                                   : "at_least",
                 scenario::text_of(figure.asked, figure.unit));
    return;
  }
  add_property(made, "measured", requirement.measured);
  add_property(made, "least_measured", requirement.least_measured);
  add_property(made, "limit", requirement.limit);
  add_property(made, "least_limit", requirement.least_limit);
}

Outcome outcome_of(results::Verdict verdict) {
  constexpr Outcome outcomes[] = {Outcome::passed, Outcome::failed, Outcome::skipped};
  return outcomes[static_cast<std::size_t>(verdict)];
}

JunitCase case_of(const results::RequirementResult& requirement) {
  JunitCase made{
      results::titled(requirement), outcome_of(requirement.verdict), results::name_of(requirement.verdict), {}};
  const std::string figures = figures_of(requirement);
  made.why =
      figures == requirement.remark || requirement.remark.empty() ? figures : figures + ", " + requirement.remark;
  add_figures(made, requirement);
  add_property(made, "remark", requirement.remark);
  return made;
}

Outcome outcome_of(verify::Conclusion verdict) {
  switch (verdict) {
    case verify::Conclusion::pass:
      return Outcome::passed;
    case verify::Conclusion::refuted:
      return Outcome::failed;
    case verify::Conclusion::contradiction:
      return Outcome::error;
    case verify::Conclusion::undecided:
    case verify::Conclusion::reported:
    case verify::Conclusion::given:
      return Outcome::skipped;
  }
  return Outcome::error;
}

JunitCase case_of(const verify::Line& line, const std::string& replay) {
  JunitCase made{results::titled(line.requirement), outcome_of(line.verdict), verify::name_of(line.verdict),
                 line.reason};
  if (line.verdict == verify::Conclusion::reported) made.why = "violations are reported only: nothing is proved";
  if (line.verdict == verify::Conclusion::given) made.why = "a data sheet promises it, and no run shows more";
  if (made.why.empty())
    made.why = line.verdict == verify::Conclusion::refuted ? "a run fails it" : "neither proved nor refuted";
  add_property(made, "simulated", line.simulated);
  add_property(made, "adversarial", line.adversarial);
  add_property(made, "bound", line.bound);
  add_property(made, "limit", line.requirement.limit);
  add_property(made, "if", line.provided);
  add_property(made, "remark", line.remark);
  add_property(made, "replay", replay);
  return made;
}

/// No control character and nothing else that XML refuses even where it is escaped.
std::string xml_text(std::string_view text) {
  std::string made = chart::escaped(json::printable(text));
  for (const auto& [octets, shown] : {std::pair("\xEF\xBF\xBE", "\\ufffe"), std::pair("\xEF\xBF\xBF", "\\uffff")})
    for (std::size_t at = made.find(octets); at != std::string::npos; at = made.find(octets, at))
      made.replace(at, 3, shown);
  return made;
}

std::string properties_text(const std::vector<std::pair<std::string, std::string>>& properties, const char* indent) {
  std::string text = fmt::format("{}<properties>\n", indent);
  for (const auto& [name, value] : properties)
    text += fmt::format("{}  <property name=\"{}\" value=\"{}\"/>\n", indent, xml_text(name), xml_text(value));
  return text + fmt::format("{}</properties>\n", indent);
}

std::string case_text(const JunitCase& each, const JunitSuite& suite) {
  std::string text = fmt::format("    <testcase classname=\"{}\" name=\"{}\" file=\"{}\">\n", xml_text(suite.name),
                                 xml_text(each.name), xml_text(suite.file));
  std::vector<std::pair<std::string, std::string>> properties = {{"verdict", each.verdict}};
  properties.insert(properties.end(), each.properties.begin(), each.properties.end());
  text += properties_text(properties, "      ");
  const std::string message = xml_text(each.verdict + ": " + each.why);
  if (each.outcome == Outcome::skipped) text += fmt::format("      <skipped message=\"{}\"/>\n", message);
  if (each.outcome == Outcome::failed || each.outcome == Outcome::error)
    text += fmt::format("      <{} type=\"{}\" message=\"{}\"/>\n",
                        each.outcome == Outcome::failed ? "failure" : "error", xml_text(each.verdict), message);
  return text + "    </testcase>\n";
}

std::string counts_text(const std::vector<const JunitSuite*>& suites) {
  const auto count = [&](Outcome outcome) {
    std::ptrdiff_t sum = 0;
    for (const JunitSuite* const suite : suites) sum += std::ranges::count(suite->cases, outcome, &JunitCase::outcome);
    return sum;
  };
  std::size_t tests = 0;
  for (const JunitSuite* const suite : suites) tests += suite->cases.size();
  return fmt::format("tests=\"{}\" failures=\"{}\" errors=\"{}\" skipped=\"{}\"", tests, count(Outcome::failed),
                     count(Outcome::error), count(Outcome::skipped));
}

std::pair<std::string, std::string> maker() {
  return {"takt", fmt::format("{}, behaviour {}", results::version, results::behaviour())};
}

}  // namespace

JunitSuite suite_of(const std::string& file, const results::RunResult& result) {
  JunitSuite suite{result.scenario, file};
  suite.properties = {
      maker(), {"seed", std::to_string(result.seed)}, {"digest", fmt::format("{:016x}", result.digest)}};
  for (const results::RequirementResult& each : result.requirements) suite.cases.push_back(case_of(each));
  return suite;
}

JunitSuite suite_of(const std::string& file, const std::string& scenario, const verify::Verification& verification,
                    const std::vector<std::string>& replays) {
  JunitSuite suite{scenario, file};
  suite.properties = {maker(), {"runs", std::to_string(verification.runs)}};
  for (std::size_t i = 0; i < verification.lines.size(); ++i)
    suite.cases.push_back(case_of(verification.lines[i], replays[i]));
  if (verification.contradiction)
    suite.cases.push_back({"no contradiction", Outcome::error, "contradiction", verification.contradiction->text});
  return suite;
}

JunitSuite suite_of_interrupted(const std::string& file, const scenario::Resolved& resolved,
                                const std::vector<bool>& asked) {
  JunitSuite suite{resolved.scenario.name, file, {maker()}};
  const std::vector<scenario::RequirementLine> lines = scenario::requirement_lines(resolved);
  for (std::size_t i = 0; i < lines.size(); ++i)
    if (asked[i])
      suite.cases.push_back(
          {results::titled(lines[i].name, lines[i].text), Outcome::skipped, "undecided", "it was interrupted"});
  return suite;
}

std::string junit_text(std::string_view command, const std::vector<JunitSuite>& suites) {
  std::vector<const JunitSuite*> all;
  for (const JunitSuite& suite : suites) all.push_back(&suite);
  std::string text = fmt::format("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"{}\" {}>\n",
                                 xml_text(command), counts_text(all));
  for (const JunitSuite& suite : suites) {
    text += fmt::format("  <testsuite name=\"{}\" {}>\n", xml_text(suite.name), counts_text({&suite}));
    text += properties_text(suite.properties, "    ");
    for (const JunitCase& each : suite.cases) text += case_text(each, suite);
    text += "  </testsuite>\n";
  }
  return text + "</testsuites>\n";
}

}  // namespace takt::report
