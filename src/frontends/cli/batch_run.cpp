// SPDX-License-Identifier: Apache-2.0
#include "cli/batch_run.hpp"

#include <cstdio>

#include "cli/terminal.hpp"
#include "output/result_folder.hpp"

namespace takt::cli {

ExitStatus run_batch(const BatchOptions& options, const std::string& command,
                     const std::function<ScenarioDone(const LoadedScenario&)>& act) {
  const bool is_json = options.scenario.is_json();
  std::optional<std::vector<LoadedScenario>> all = load_all(options);
  if (!all) return ExitStatus::bad_input;
  ExitStatus status = ExitStatus::pass;
  std::vector<std::string> pages;
  std::vector<report::JunitSuite> suites;
  for (LoadedScenario& each : *all) {
    if (status == ExitStatus::interrupted) {
      suites.push_back(report::suite_of_interrupted(each.file, *each.resolved, each.asked));
      continue;
    }
    ScenarioDone done = act(each);
    if (!done.suite) return done.status;
    status = graver(status, done.status);
    suites.push_back(std::move(*done.suite));
    if (is_json) {
      pages.push_back(std::move(done.page));
    } else {
      print((&each != &all->front() && !options.quiet ? "\n" : "") + done.page);
      if (!options.quiet) print_files(done.told, done.report);
    }
    each.resolved.reset();
  }
  if (is_json) print(joined_json(pages, options.is_single()));
  if (options.junit.empty()) return status;
  const std::string problem = output::write_file(options.junit, report::junit_text(command, suites));
  return problem.empty() ? status : cannot_write(problem);
}

ExitStatus cannot_write(const std::string& problem) {
  std::fprintf(stderr, "takt: cannot write: %s\n", problem.c_str());
  return ExitStatus::internal_error;
}

}  // namespace takt::cli
