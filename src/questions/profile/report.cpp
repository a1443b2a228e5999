// SPDX-License-Identifier: Apache-2.0
// What `takt check --profile` writes.
#include <fmt/format.h>

#include <algorithm>

#include "profile/profile.hpp"

namespace takt::profile {
namespace {

std::string verdict_of_finding(const Finding& finding) { return std::string(name_of(finding.verdict)); }
std::string verdict_of_report(const Report& report) { return std::string(name_of(report.verdict)); }

}  // namespace

const json::Record& describe(json::Type<Finding>) {
  static constexpr json::Output outputs[] = {
      json::output<&Finding::clause>("clause", "The clause of the standard."),
      json::output<&Finding::rule>("rule", "What it is about."),
      json::output<verdict_of_finding>("verdict", "met, missed, or unknown: the scenario does not say it."),
      json::output<&Finding::found>("found", "What the scenario has."),
      json::output<&Finding::expected>("expected", "What the profile wants."),
      json::output<&Finding::pointer>("pointer", "Where it stands in the scenario; empty if it stands nowhere."),
  };
  static constexpr json::Record record{"profile_finding", "One thing that a rule of the profile looked at.", outputs};
  return record;
}

const json::Record& describe(json::Type<Report>) {
  static constexpr json::Output outputs[] = {
      json::output<&Report::profile>("profile", "The profile."),
      json::output<&Report::title>("title", "What it is."),
      json::output<&Report::scenario>("scenario", "The scenario."),
      json::output<verdict_of_report>("verdict", "missed if a rule is, else unknown if one is, else met."),
      json::output<&Report::findings>("findings", "What each rule found, in their order."),
  };
  static constexpr json::Record record{"profile_report", "A scenario beside a profile.", outputs};
  return record;
}

std::string text_of(const Report& report) {
  std::string text = fmt::format("{}: {}\n", report.scenario, report.title);
  std::size_t counts[3] = {};
  for (const Finding& finding : report.findings) {
    ++counts[static_cast<std::size_t>(finding.verdict)];
    text += fmt::format("  {:<8} {:<28} {}\n", name_of(finding.verdict), finding.clause, finding.rule);
    text += fmt::format("           found {}; expected {}{}\n", finding.found, finding.expected,
                        finding.pointer.empty() ? "" : " (" + finding.pointer + ")");
  }
  return text +
         fmt::format("{}: {} met, {} missed, {} unknown\n", name_of(report.verdict), counts[0], counts[1], counts[2]);
}

}  // namespace takt::profile
