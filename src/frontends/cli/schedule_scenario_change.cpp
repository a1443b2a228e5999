// SPDX-License-Identifier: Apache-2.0
#include "cli/schedule_scenario_change.hpp"

#include <algorithm>
#include <cstdio>
#include <optional>

#include "cli/terminal.hpp"
#include "json/document.hpp"
#include "json/fields.hpp"
#include "json/quantity.hpp"
#include "output/result_folder.hpp"
#include "synthesis/change_report.hpp"

namespace takt::cli {
namespace {

using synthesis::AskedChanges;
using synthesis::ScenarioChange;

ExitStatus print_all_diagnostics(const json::Diagnostics& diagnostics, bool as_json) {
  if (as_json)
    std::fputs(json::pretty(diagnostics.to_json()).c_str(), stdout);
  else
    std::fputs(diagnostics.to_text().c_str(), stderr);
  return ExitStatus::bad_input;
}

template <class T>
std::optional<T> read(const std::string& path, json::Diagnostics& diagnostics) {
  T value;
  const auto document = json::parse_file(path, diagnostics);
  if (!document || !json::decode(*document, value, diagnostics)) return std::nullopt;
  return value;
}

std::optional<sim::Duration> time_of(const char* option, const std::string& text, json::Diagnostics& diagnostics) {
  const auto time = json::parse_duration(text);
  constexpr sim::Duration longest = sim::Duration::from_ps(3'600'000'000'000'000);
  if (time && *time > sim::Duration() && *time <= longest) return *time;
  diagnostics.error({option, 0, 0, ""}, "not a time for a change",
                    {json::quote(text), "a duration such as \"10ms\", at most 1h"});
  return std::nullopt;
}

std::optional<ScenarioChange> answer_to(const ScenarioChangeOptions& options, std::string& name,
                                        json::Diagnostics& diagnostics) {
  const auto running = read<scenario::Scenario>(options.running, diagnostics);
  std::optional<scenario::Scenario> plant;
  if (options.wanted) plant = read<scenario::Scenario>(*options.wanted, diagnostics);
  AskedChanges asked;
  asked.remove = options.remove;
  asked.fail = options.fail;
  asked.entries = std::min<std::uint32_t>(options.entries, scenario::most_gate_entries);
  if (options.at) asked.at = time_of("--at", *options.at, diagnostics);
  asked.lead = synthesis::usual_lead;
  if (options.lead)
    if (const auto lead = time_of("--lead", *options.lead, diagnostics)) asked.lead = *lead;
  if (options.add)
    if (const auto coming = read<synthesis::ComingStreams>(*options.add, diagnostics)) {
      asked.add = coming->streams;
      asked.require = coming->require;
    }
  if (!options.add && options.remove.empty() && options.fail.empty())
    diagnostics.error({"command line", 0, 0, ""}, "a change that changes nothing",
                      {"--to alone", "--add, --remove or --fail as well"});
  if (options.plant && !options.wanted)
    diagnostics.error({"--plant", 0, 0, ""}, "no plant that could be written",
                      {"no SCENARIO", "the scenario that the schedule was made of"});
  if (diagnostics.has_errors() || !running) return std::nullopt;
  name = running->name;
  return synthesis::change_scenario(*running, plant, asked, diagnostics);
}

bool write(const std::optional<std::string>& path, const scenario::Scenario& scenario) {
  if (!path) return true;
  const std::string problem = output::write_file(*path, json::encode(scenario));
  if (!problem.empty()) std::fprintf(stderr, "takt: cannot write: %s\n", problem.c_str());
  return problem.empty();
}

}  // namespace

ExitStatus change_scheduled_scenario(const ScenarioChangeOptions& options) {
  json::Diagnostics diagnostics;
  std::string name;
  const auto answer = answer_to(options, name, diagnostics);
  if (!answer) return print_all_diagnostics(diagnostics, options.is_json);
  for (const std::string& each : answer->wrong)
    std::fprintf(stderr, "takt: the change of %s is wrong: %s\n", name.c_str(), each.c_str());
  if (!answer->wrong.empty()) return ExitStatus::internal_error;
  const synthesis::ChangeSummary summary = synthesis::summary_of(name, *answer);
  if (options.is_json)
    std::fputs(json::write(summary).c_str(), stdout);
  else
    print(synthesis::text_of(summary));
  if (answer->after && (!write(options.out, answer->after->scenario) || !write(options.plant, answer->plant) ||
                        !write(options.transition, answer->simulated.scenario)))
    return ExitStatus::internal_error;
  return answer->is_done ? ExitStatus::pass : ExitStatus::undecided;
}

}  // namespace takt::cli
