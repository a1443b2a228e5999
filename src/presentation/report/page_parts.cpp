// SPDX-License-Identifier: Apache-2.0
#include "report/page_parts.hpp"

#include <fmt/format.h>

#include "chart/svg.hpp"
#include "output/text_report.hpp"

namespace takt::report {

std::string_view look_of(std::string_view verdict) {
  if (verdict == "pass") return "pass";
  return verdict == "undecided" || verdict == "reported" || verdict == "given" ? "undecided" : "fail";
}

std::string verdict_line(std::string_view verdict, std::string_view sentence) {
  return fmt::format("<p class=\"verdict {}\">{}</p>\n", look_of(verdict), chart::escaped(sentence));
}

std::string figures_of(const results::RequirementResult& requirement) {
  if (requirement.measured && requirement.limit)
    return output::readable(*requirement.measured) + " of " + output::readable(*requirement.limit);
  if (requirement.figure && requirement.figure->found)
    return fmt::format("{:.6g} of {:.6g}{}{}", *requirement.figure->found, requirement.figure->asked,
                       requirement.figure->unit.empty() ? "" : " ", requirement.figure->unit);
  return requirement.remark;
}

chart::LimitBar limit_bar(const results::RequirementResult& requirement, std::string_view verdict) {
  chart::LimitBar bar;
  bar.name = results::titled(requirement);
  bar.verdict = verdict;
  bar.look = look_of(verdict);
  bar.title = figures_of(requirement);
  if (requirement.measured && requirement.limit && requirement.limit->ps() != 0)
    bar.simulated = static_cast<double>(requirement.measured->ps()) / static_cast<double>(requirement.limit->ps());
  else if (requirement.figure && requirement.figure->found && requirement.figure->asked != 0)
    bar.simulated = *requirement.figure->found / requirement.figure->asked;
  return bar;
}

}  // namespace takt::report
