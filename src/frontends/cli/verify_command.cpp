// SPDX-License-Identifier: Apache-2.0
// takt verify: does it meet its requirements, whatever phases and chance bring?
#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>

#include "cli/batch_run.hpp"
#include "cli/commands.hpp"
#include "cli/interrupt.hpp"
#include "cli/places.hpp"
#include "cli/status_line.hpp"
#include "cli/terminal.hpp"
#include "json/printable.hpp"
#include "output/result_folder.hpp"
#include "report/verify_page.hpp"
#include "verify/report.hpp"

namespace takt::cli {
namespace {

struct VerifyOptions {
  BatchOptions batch;
  verify::SearchOptions search;
  double budget = static_cast<double>(verify::default_events) / 1e6;  // millions of events
};

constexpr const char* run_of_contradiction = "contradiction-run.json";
constexpr const char* bound_of_contradiction = "contradiction-bound.json";

/// "3-reaction-start.json": the number of the requirement, and what it is about.
std::string file_name(std::size_t number, const results::RequirementResult& requirement) {
  std::string name = std::to_string(number + 1);
  for (const char c : "-" + requirement.text)
    name += (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ? c : '-';
  return name.substr(0, 60) + ".json";
}

/// Writes the run that replays the worst of each requirement that has one; the names, or a problem.
std::string write_worst(output::WrittenFiles& folder, const verify::Verification& verification,
                        std::vector<std::string>& files) {
  std::error_code error;
  std::filesystem::create_directories(folder.folder(), error);
  if (error) return folder.folder() + ": " + error.message();
  for (std::size_t i = 0; i < verification.lines.size(); ++i) {
    const verify::Line& line = verification.lines[i];
    if (!line.worst) continue;
    const std::string name = file_name(i, line.requirement);
    files[i] = folder.path_of(name);
    if (const std::string problem = output::write_file(files[i], json::encode(line.worst.scenario())); !problem.empty())
      return problem;
    folder.add(name);
  }
  return {};
}

/// A contradiction is worth sending in: both scenarios, beside the others or in a folder of their own. A problem, or
/// empty.
std::string write_witnesses(const std::string& folder, const scenario::Resolved& resolved,
                            const verify::Contradiction& contradiction, verify::Witnesses& files) {
  const std::filesystem::path path =
      folder.empty() ? std::filesystem::path(json::file_name(resolved.scenario.name + ".contradiction"))
                     : std::filesystem::path(folder);
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (error) return path.string() + ": " + error.message();
  files = {(path / run_of_contradiction).string(), (path / bound_of_contradiction).string()};
  if (std::string problem = output::write_file(files.run, json::encode(contradiction.run)); !problem.empty())
    return problem;
  return output::write_file(files.bound, json::encode(resolved.scenario));
}

ExitStatus status_of(const verify::Verification& verification) {
  switch (verification.verdict()) {
    case verify::Conclusion::pass:
    case verify::Conclusion::reported:
    case verify::Conclusion::given:
      return ExitStatus::pass;
    case verify::Conclusion::refuted:
      return ExitStatus::requirement_failed;
    case verify::Conclusion::contradiction:
      return ExitStatus::internal_error;
    case verify::Conclusion::undecided:
      break;
  }
  return verification.partial ? ExitStatus::interrupted : ExitStatus::undecided;
}

verify::Verification verified(const VerifyOptions& options, const LoadedScenario& loaded) {
  const InterruptGuard interrupt;
  StatusLine line(!options.batch.quiet && !options.batch.scenario.is_json());
  verify::Options what;
  what.search = options.search;
  what.search.asked = loaded.asked;
  what.search.events = static_cast<std::uint64_t>(options.budget * 1e6);
  what.search.interrupted = [&] { return interrupt.requested(); };
  what.search.progress = [&](std::uint64_t events, std::uint64_t of) {
    if (line.is_due())
      line.show(fmt::format("searching for the worst: {:.0f} %",
                            100.0 * static_cast<double>(events) / static_cast<double>(of)));
  };
  what.helps = true;
  what.proof.interrupted = what.search.interrupted;
  verify::Verification verification = verify::verify(*loaded.resolved, what);
  line.clear();
  return verification;
}

ScenarioDone conclude(const VerifyOptions& options, const LoadedScenario& loaded) {
  const BatchOptions& batch = options.batch;
  const verify::Verification verification = verified(options, loaded);
  std::vector<std::string> files(verification.lines.size());
  std::optional<output::WrittenFiles> folder;
  if (!loaded.out.empty()) {
    folder.emplace(loaded.out, "verify", loaded.file);
    if (const std::string problem = write_worst(*folder, verification, files); !problem.empty())
      return {cannot_write(problem)};
  }
  if (!batch.report.empty())
    if (const std::string problem =
            output::write_file(batch.report, report::verify_page(*loaded.resolved, verification, files));
        !problem.empty())
      return {cannot_write(problem)};
  verify::Witnesses witnesses;
  if (verification.contradiction)
    if (const std::string problem =
            write_witnesses(loaded.out, *loaded.resolved, *verification.contradiction, witnesses);
        !problem.empty())
      cannot_write(problem);
  const bool report_is_inside = folder && !batch.report.empty() && folder->add_if_inside(batch.report);
  if (folder) {
    if (!batch.junit.empty()) folder->add_if_inside(batch.junit);
    if (verification.contradiction)
      for (const char* const name : {run_of_contradiction, bound_of_contradiction}) folder->add(name);
    if (const std::string problem = folder->end(loaded.resolved->scenario.name); !problem.empty())
      cannot_write(problem);
  }
  const std::string& name = loaded.resolved->scenario.name;
  ScenarioDone done{status_of(verification)};
  done.page = batch.scenario.is_json() ? verify::json_report(name, verification, files, witnesses)
              : batch.quiet            ? name + ": " + verification.verdict_text() + "\n"
                                       : verify::text_report(name, verification, files, witnesses);
  done.told = folder ? folder->summary() : "";
  done.report = report_is_inside ? "" : batch.report;
  done.suite = verification.partial && verification.lines.empty()
                   ? report::suite_of_interrupted(loaded.file, *loaded.resolved, loaded.asked)
                   : report::suite_of(loaded.file, name, verification, files);
  return done;
}

}  // namespace

void add_verify_command(Command app, ExitStatus& status) {
  const Command command =
      app.add_subcommand("verify", "Prove or refute each requirement: simulated, adversarial, bounded");
  const auto options = std::make_shared<VerifyOptions>();
  add_batch_options(command, options->batch);
  command
      .add_option("--seeds", options->search.seeds,
                  "Runs of the scenario as it is, with its seed and those after it; two where chance has no say")
      .between(1u, 100'000u)
      .type_name("N");
  command.add_option("--jobs", options->search.jobs, "Threads; the result is the same for any number")
      .between(1u, 256u)
      .type_name("N");
  command
      .add_option("--budget", options->budget,
                  "What all may cost besides one run of the scenario as it is, in millions of events: runs for the "
                  "worst, states of the handshake, what would help")
      .between(0.0, 1e6)
      .type_name("M");
  command
      .add_option("--out", options->batch.out,
                  "Write into this folder, for each requirement, the scenario that replays its worst run; of several "
                  "scenarios into DIR/NAME of each file")
      .type_name("DIR");
  command
      .add_option("--report", options->batch.report,
                  "Write a page with pictures into this file: simulated, worst found and bound of each requirement, "
                  "and what they rest on")
      .type_name("FILE.html");
  command.add_flag("--quiet", options->batch.quiet, "Print one line");
  command.footer(
      "Examples:\n"
      "  takt verify scenarios/robot-arm.json --out out/worst\n"
      "  takt verify scenarios/robot-arm.json --report out/proof.html\n"
      "  takt verify scenarios/robot-arm.json scenarios/first-cell.json --junit out/verify.xml\n"
      "  takt verify scenarios/robot-arm.json --only 'reaction halt*'\n"
      "  takt verify scenarios/robot-arm.json --seeds 20 --jobs 2 --format json | jq '.requirements[].verdict'\n"
      "Exit status: 0 all proved, 1 one refuted, 2 bad input, 3 a contradiction (a mistake of takt), 4 one undecided, "
      "130 "
      "interrupted; of several scenarios the gravest.");
  command.callback([options, &status] {
    status =
        run_batch(options->batch, "takt verify", [&](const LoadedScenario& each) { return conclude(*options, each); });
  });
}

}  // namespace takt::cli
