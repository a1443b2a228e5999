// SPDX-License-Identifier: Apache-2.0
// takt paper: published evaluations, reproduced.
#include <cstdio>
#include <memory>

#include "cli/commands.hpp"
#include "cli/companion.hpp"
#include "cli/places.hpp"
#include "cli/real_coexistence.hpp"
#include "cli/terminal.hpp"
#include "papers/coexistence/report.hpp"
#include "papers/report.hpp"
#include "papers/validation/report.hpp"

namespace takt::cli {
namespace {

struct PaperOptions {
  papers::ProgramsOptions programs;
  papers::coexistence::Options coexistence;
  papers::validation::Options validation;
  bool is_real = false;
  std::string out;
  std::string format = "text";
  bool quiet = false;
  bool speed = false;
};

void say(const std::string& what) { std::fprintf(stderr, "%s\n", what.c_str()); }

bool can_write_into(const PaperOptions& options) {
  return can_write({{"--out", options.out, Place::Kind::folder}}, options.format == "json");
}

/// Shows and writes what was made, or why nothing was.
template <typename Reproduction>
ExitStatus hand_over(const PaperOptions& options, const std::optional<Reproduction>& made,
                     const json::Diagnostics& diagnostics) {
  const bool is_json = options.format == "json";
  if (!made) {
    if (is_json)
      std::fputs(json::pretty(diagnostics.to_json()).c_str(), stdout);
    else
      tell(diagnostics);
    return ExitStatus::bad_input;
  }
  if (!options.out.empty()) {
    if (const std::string problem = write_folder(options.out, *made); !problem.empty()) {
      std::fprintf(stderr, "takt: cannot write results: %s\n", problem.c_str());
      return ExitStatus::internal_error;
    }
  }
  std::fputs((is_json ? json_report(*made) : text_report(*made)).c_str(), stdout);
  return made->holds() ? ExitStatus::pass : ExitStatus::requirement_failed;
}

ExitStatus run_programs(PaperOptions& options) {
  if (!can_write_into(options)) return ExitStatus::bad_input;
  if (!options.quiet) options.programs.progress = say;
  json::Diagnostics diagnostics;
  const auto made = papers::reproduce_programs(options.programs, diagnostics);
  const ExitStatus status = hand_over(options, made, diagnostics);
  std::fflush(stdout);
  if (made && options.speed)
    for (const papers::Speed& speed : made->speed)
      std::fprintf(stderr, "%d values: %.1f s for %.0f s simulated, %.0f times as fast\n", speed.values,
                   speed.wall_seconds, speed.simulated_seconds, speed.simulated_seconds / speed.wall_seconds);
  return status;
}

ExitStatus run_coexistence(PaperOptions& options) {
  if (!can_write_into(options)) return ExitStatus::bad_input;
  if (!options.quiet) options.coexistence.progress = say;
  std::string measured_text;
  if (options.is_real) {
    ExitStatus failure = ExitStatus::pass;
    const auto measured = measure_coexistence({options.coexistence.is_short, options.quiet, options.out}, failure);
    if (!measured) return failure;
    options.coexistence.measured = criteria_of(*measured);
    measured_text = "\n" + emulate::to_text(*measured);
  }
  json::Diagnostics diagnostics;
  const auto made = papers::coexistence::reproduce(options.coexistence, diagnostics);
  const ExitStatus status = hand_over(options, made, diagnostics);
  if (options.format == "text") std::fputs(measured_text.c_str(), stdout);
  std::fflush(stdout);  // before what goes to standard error, should both be one file
  if (made && options.speed)
    for (const papers::coexistence::Speed& speed : made->speed)
      std::fprintf(stderr, "%s: %.3f s of CPU time for %.0f s simulated, %.0f times as fast\n", speed.scenario.c_str(),
                   speed.cpu_seconds, speed.simulated_seconds, speed.simulated_seconds / speed.cpu_seconds);
  return status;
}

ExitStatus run_validation(PaperOptions& options) {
  if (!can_write_into(options)) return ExitStatus::bad_input;
  if (!options.quiet) options.validation.progress = say;
  json::Diagnostics diagnostics;
  const auto made = papers::validation::validate(options.validation, diagnostics);
  return hand_over(options, made, diagnostics);
}

void add_output_options(Command command, PaperOptions& options, const char* written) {
  command.add_option("--out", options.out, written).type_name("DIR");
  command.add_option("--format", options.format, "text or json").one_of({"text", "json"}).type_name("FORMAT");
  command.add_flag("--quiet", options.quiet, "Do not say what is being done");
}

void add_common_options(Command command, PaperOptions& options) {
  add_output_options(command, options, "Write report, figures (SVG) and scenarios into this folder");
  command.add_flag("--speed", options.speed, "Say how long the runs took");
}

void add_programs(Command command, ExitStatus& status) {
  const Command programs = command.add_subcommand(
      "programs", "Real-time capable OPC-UA Programs over TSN for distributed industrial control");
  const auto options = std::make_shared<PaperOptions>();
  programs.add_flag("--short", options->programs.is_short,
                    "Three minutes of simulated time for each row instead of an hour");
  programs.add_option("--scenarios", options->programs.scenarios, "Where its scenarios are").type_name("DIR");
  add_common_options(programs, *options);
  programs.footer(
      "Examples:\n"
      "  takt paper programs --short                    tolerances checked, figures made, in about a minute\n"
      "  takt paper programs --out out/paper            an hour of simulated time for each row of Table I\n"
      "Exit status: 0 reproduced, 1 something is out of its tolerance, 2 bad input.");
  programs.callback([options, &status] { status = run_programs(*options); });
}

void add_coexistence(Command command, ExitStatus& status) {
  const Command coexistence = command.add_subcommand("coexistence",
                                                     "DDS and OPC UA protocol coexistence solution in real-time and "
                                                     "Industry 4.0 context using non-ideal infrastructure");
  const auto options = std::make_shared<PaperOptions>();
  coexistence.add_flag("--short", options->coexistence.is_short,
                       "Fewer repetitions, and what real-time Linux and TSN change at 10 and 1 ms only");
  coexistence.add_flag("--real", options->is_real,
                       "Measure criteria 1 and 2 on this machine too: six nodes, and the gateway, as processes");
  coexistence.add_option("--scenarios", options->coexistence.scenarios, "Where its scenarios are").type_name("DIR");
  add_common_options(coexistence, *options);
  coexistence.footer(
      "Examples:\n"
      "  takt paper coexistence                         Tables 1 to 8, Figures 4 to 9, and what TSN changes\n"
      "  takt paper coexistence --out out/paper         with figures, digital signals (VCD) and scenarios\n"
      "  sudo takt paper coexistence --real             beside them what this machine's operating system does\n"
      "Exit status: 0 reproduced, 1 something is out of its tolerance, 2 bad input, 3 cannot measure here.");
  coexistence.callback([options, &status] { status = run_coexistence(*options); });
}

void add_validation(Command command, ExitStatus& status) {
  const Command validation =
      command.add_subcommand("validation", "Every published or measured figure that takt was compared with");
  const auto options = std::make_shared<PaperOptions>();
  validation.add_flag("--short", options->validation.is_short, "Of large tables some rows only");
  validation.add_option("--tables", options->validation.tables, "Where the tables of published figures are")
      .type_name("DIR");
  validation.add_option("--jobs", options->validation.jobs, "Threads; the figures are the same for any number")
      .between(1u, 256u)
      .type_name("N")
      .default_text("one for each processor");
  add_output_options(validation, *options,
                     "Write report, pictures (SVG) and the page docs/validation.md into this folder");
  validation.footer(
      "Examples:\n"
      "  takt paper validation --short                  a few seconds\n"
      "  takt paper validation --out out/validation     all of it, with the page docs/validation.md and pictures\n"
      "Exit status: 0 every figure is met or differs as the tables say, 1 one is missed, 2 bad input.");
  validation.callback([options, &status] { status = run_validation(*options); });
}

}  // namespace

void add_paper_command(Command app, ExitStatus& status) {
  const Command command = app.add_subcommand("paper", companion_help("paper"));
  command.require_subcommand();
  add_programs(command, status);
  add_coexistence(command, status);
  add_validation(command, status);
}

}  // namespace takt::cli
