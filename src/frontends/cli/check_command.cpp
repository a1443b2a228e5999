// SPDX-License-Identifier: Apache-2.0
// takt check: is it sound; what does it resolve to.
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "cli/commands.hpp"
#include "cli/load.hpp"
#include "cli/terminal.hpp"
#include "cli/threads.hpp"
#include "output/division_report.hpp"
#include "output/text_report.hpp"
#include "profile/profile.hpp"
#include "schedule_check/check.hpp"

namespace takt::cli {

namespace {

std::vector<std::string> profile_names() {
  std::vector<std::string> names;
  for (const profile::Profile& each : profile::profiles()) names.emplace_back(each.name);
  return names;
}

/// A scenario beside a profile: 1 if a rule is missed.
ExitStatus judge(const std::string& name, const scenario::Resolved& resolved, bool as_json) {
  const profile::Report report = profile::judge(*profile::find_profile(name), resolved);
  print(as_json ? json::pretty(json::write_record(describe(json::Type<profile::Report>{}), &report))
                : profile::text_of(report));
  return report.verdict == profile::Verdict::missed ? ExitStatus::requirement_failed : ExitStatus::pass;
}

}  // namespace

void add_check_command(Command app, ExitStatus& status) {
  const Command command = app.add_subcommand("check", "Say whether a scenario is sound and what it resolves to");
  const auto options = std::make_shared<ScenarioOptions>();
  const auto threads = std::make_shared<std::uint32_t>(0);
  add_scenario_options(command, *options);
  command.add_option("--threads", *threads, "Say also how a run on so many threads is divided")
      .type_name("N")
      .between(std::uint32_t{1}, most_threads);
  const auto wanted = std::make_shared<std::string>();
  command.add_option("--profile", *wanted, "Judge it by the rules of a profile instead")
      .one_of(profile_names())
      .type_name("PROFILE");
  command.footer(
      "Examples:\n"
      "  takt check scenarios/robot-arm.json                 nodes, paths, load of links and queues\n"
      "  takt check scenarios/robot-arm.json --format json   the resolved scenario, all defaults filled in\n"
      "  takt check plant.json --profile 60802               each rule of IEC/IEEE 60802: met, missed, or unknown\n"
      "Exit status: 0 sound, 1 a rule of the profile is missed, 2 mistakes (all of them are listed).");
  command.callback([options, threads, wanted, &status] {
    const auto resolved = load(*options);
    if (!resolved) {
      status = ExitStatus::bad_input;
      return;
    }
    if (resolved->gates) {
      const std::vector<std::string> wrong = schedule_check::check(resolved->gates->problem, resolved->gates->schedule);
      for (const std::string& each : wrong)
        std::fprintf(stderr, "takt: the gates are laid out wrongly: %s\n", each.c_str());
      if (!wrong.empty()) {
        status = ExitStatus::internal_error;
        return;
      }
    }
    if (!wanted->empty()) {
      status = judge(*wanted, *resolved, options->is_json());
      return;
    }
    std::string page = options->is_json() ? json::encode(resolved->scenario) : output::check_report(*resolved);
    if (*threads > 0 && !options->is_json())
      page += "\n" + output::division_report(scenario::divide(*resolved, *threads));
    print(page);
    status = ExitStatus::pass;
  });
}

}  // namespace takt::cli
