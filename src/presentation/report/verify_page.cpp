// SPDX-License-Identifier: Apache-2.0
#include "report/verify_page.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "chart/page.hpp"
#include "output/text_report.hpp"
#include "report/network_figure.hpp"
#include "report/page_parts.hpp"

namespace takt::report {
namespace {

using output::readable;

std::string time_text(const std::optional<sim::Duration>& time) { return time ? readable(*time) : "-"; }

std::string sentence(const scenario::Resolved& resolved, const verify::Verification& verification) {
  const std::string& name = resolved.scenario.name;
  if (verification.contradiction)
    return name + ": contradiction. This is a mistake of takt; nothing here is to be trusted: " +
           verification.contradiction->text;
  if (verification.lines.empty()) return name + ": " + results::nothing_was_required;
  const auto count = [&](verify::Conclusion conclusion) {
    return std::count_if(verification.lines.begin(), verification.lines.end(),
                         [&](const verify::Line& line) { return line.verdict == conclusion; });
  };
  const auto reported = count(verify::Conclusion::reported);
  return fmt::format("{}: {}. Of {} requirements {} are proved, {} refuted and {} undecided{}, after {} runs{}", name,
                     verification.verdict_text(), verification.lines.size(), count(verify::Conclusion::pass),
                     count(verify::Conclusion::refuted), count(verify::Conclusion::undecided),
                     reported > 0 ? fmt::format(", {} reported only", reported) : "", verification.runs,
                     verification.partial ? "; interrupted" : "");
}

/// As a part of the limit.
std::optional<double> share(const std::optional<sim::Duration>& time, const results::RequirementResult& requirement) {
  if (!time || !requirement.limit || requirement.limit->ps() == 0) return std::nullopt;
  return static_cast<double>(time->ps()) / static_cast<double>(requirement.limit->ps());
}

std::string requirements(const verify::Verification& verification, const std::vector<std::string>& files) {
  chart::LimitBars bars{"Simulated, worst found and bound, as parts of the limit", {}};
  chart::Table table(
      {"verdict", "requirement", "simulated", "worst found", "at most", "limit", "why, and what replays the worst"});
  for (std::size_t i = 0; i < verification.lines.size(); ++i) {
    const verify::Line& line = verification.lines[i];
    const char* const verdict = verify::name_of(line.verdict);
    chart::LimitBar bar = limit_bar(line.requirement, verdict);
    bar.simulated = share(line.simulated, line.requirement);
    bar.worst = share(line.adversarial, line.requirement);
    bar.bound = share(line.bound, line.requirement);
    bar.title = fmt::format("simulated {}, worst found {}, at most {}, limit {}", time_text(line.simulated),
                            time_text(line.adversarial), time_text(line.bound), time_text(line.requirement.limit));
    if (bar.simulated || bar.worst || bar.bound) bars.bars.push_back(bar);
    std::string why = line.verdict == verify::Conclusion::pass ? line.remark : line.reason;
    if (!line.provided.empty()) why = "if " + line.provided + (why.empty() ? "" : "; ") + why;
    if (line.verdict == verify::Conclusion::given) why = "a data sheet promises it";
    if (line.verdict == verify::Conclusion::reported)
      why = fmt::format("up to {} violation{} in a run", *line.violations, *line.violations == 1 ? "" : "s");
    if (line.runs > 0)
      why += fmt::format("{}{} runs: {}", why.empty() ? "" : "; ", line.runs, verify::words_of(line.ended));
    if (!files[i].empty()) why += (why.empty() ? "" : "; ") + ("takt run " + files[i]);
    table.row({{verdict, false, look_of(verdict)},
               {results::titled(line.requirement)},
               {time_text(line.simulated), true},
               {time_text(line.adversarial), true},
               {time_text(line.bound), true},
               {time_text(line.requirement.limit), true},
               {why}});
  }
  std::string text = chart::section("Requirements",
                                    "Simulated: the scenario as it is. Worst found: by searching phases, latencies and "
                                    "faults that the scenario leaves open. At most: what is proved.");
  if (!bars.bars.empty()) text += chart::charts({draw(bars)});
  return text + table.take();
}

/// Where a bound is not tight, the parts of it, the one that gives most away first.
std::string slack(const verify::Verification& verification) {
  constexpr std::size_t most_parts = 6;
  std::string text;
  for (const verify::Line& line : verification.lines) {
    if (line.slack.empty()) continue;
    chart::Table table({"where", "what", "in the worst run", "in the bound", "given away"}, most_parts);
    for (const verify::SlackPart& part : line.slack)
      table.row({{part.where},
                 {part.what},
                 {readable(part.run), true},
                 {readable(part.bound), true},
                 {readable(part.given_away()), true}});
    text += chart::section(results::titled(line.requirement), "Where the bound and the worst run part.") + table.take();
  }
  return text.empty() ? text : "<details><summary>What bounds give away</summary>" + text + "</details>\n";
}

std::string assumptions(const verify::Verification& verification) {
  analysis::Assumptions needed;
  for (const verify::Line& line : verification.lines) needed.add(line.assumptions);
  chart::Table table({"", "assumption", "why"});
  for (const analysis::Assumption assumption : needed.list()) {
    const analysis::AssessedAssumption& each = verification.ledger[assumption];
    const bool is_bad = each.standing == analysis::Standing::open || each.standing == analysis::Standing::violated;
    table.row({{std::string(analysis::name_of(each.standing)), false, is_bad ? "undecided" : ""},
               {each.text},
               {each.why, false, "note"}});
  }
  const std::string rows = table.take();
  return rows.empty()
             ? rows
             : chart::section(
                   "What this rests on",
                   "Conditions are for the plant to keep; nothing is proved that rests on what is open or violated.") +
                   rows;
}

}  // namespace

std::string verify_page(const scenario::Resolved& resolved, const verify::Verification& verification,
                        const std::vector<std::string>& files) {
  const std::string verdict =
      verification.lines.empty() && !verification.contradiction ? "pass" : verify::name_of(verification.verdict());
  std::string page = chart::page_head(resolved.scenario.name + ": verification");
  page += verdict_line(verdict, sentence(resolved, verification)) + requirements(verification, files) +
          assumptions(verification) + slack(verification);
  page += chart::section("The network", "Loads: what the streams ask for on average.") +
          chart::charts({draw(network_figure(resolved, nullptr))});
  return page + chart::page_end();
}

}  // namespace takt::report
