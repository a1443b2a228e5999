// takt paper: published evaluations, reproduced.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "cli/commands.hpp"
#include "cli/real_coexistence.hpp"
#include "papers/report.hpp"

namespace takt::cli {
namespace {

struct PaperOptions {
  papers::ProgramsOptions programs;
  std::string out;
  std::string format = "text";
  bool quiet = false;
  bool speed = false;
};

ExitStatus run(PaperOptions& options) {
  const bool is_json = options.format == "json";
  if (!options.quiet) options.programs.progress = [](const std::string& what) { std::fprintf(stderr, "%s\n", what.c_str()); };
  scenario::json::Diagnostics diagnostics;
  const auto made = papers::reproduce_programs(options.programs, diagnostics);
  if (!made) {
    if (is_json)
      std::fputs(scenario::json::pretty(diagnostics.to_json()).c_str(), stdout);
    else
      std::fputs(diagnostics.to_text().c_str(), stderr);
    return ExitStatus::bad_input;
  }
  if (!options.out.empty()) {
    if (const std::string problem = papers::write_folder(options.out, *made); !problem.empty()) {
      std::fprintf(stderr, "takt: cannot write results: %s\n", problem.c_str());
      return ExitStatus::internal_error;
    }
  }
  std::fputs((is_json ? papers::json_report(*made) : papers::text_report(*made)).c_str(), stdout);
  if (options.speed)
    for (const papers::Speed& speed : made->speed)
      std::fprintf(stderr, "%d values: %.1f s for %.0f s simulated, %.0f times as fast\n", speed.values, speed.wall_seconds, speed.simulated_seconds,
                   speed.simulated_seconds / speed.wall_seconds);
  return made->holds() ? ExitStatus::pass : ExitStatus::requirement_failed;
}

void add_coexistence(CLI::App& paper, ExitStatus& status) {
  CLI::App& command = *paper.add_subcommand("coexistence", "DDS and OPC UA protocol coexistence solution in real-time and Industry 4.0 context using non-ideal infrastructure");
  const auto options = std::make_shared<RealCoexistenceOptions>();
  const auto format = std::make_shared<std::string>("text");
  command.add_flag("--real", options->is_real, "Measure criteria 1 and 2 on this machine: six nodes, and the gateway, as processes")->required();
  command.add_flag("--short", options->is_short, "100 windows of 10 ms for each thread and interval instead of 700");
  command.add_option("--out", options->out, "Write the tables, and the files of the nodes, into this folder")->type_name("DIR");
  command.add_option("--format", *format, "text or json")->check(CLI::IsMember({"text", "json"}))->type_name("FORMAT");
  command.add_flag("--quiet", options->is_quiet, "Do not say what is being done");
  command.callback([options, format, &status] {
    options->is_json = *format == "json";
    status = run_real_coexistence(*options);
  });
}

}  // namespace

void add_paper_command(CLI::App& app, ExitStatus& status) {
  CLI::App& command = *app.add_subcommand("paper", "Reproduce a published evaluation");
  command.require_subcommand(1);
  CLI::App& programs = *command.add_subcommand("programs", "Real-time capable OPC-UA Programs over TSN for distributed industrial control");
  const auto options = std::make_shared<PaperOptions>();
  programs.add_flag("--short", options->programs.is_short, "Three minutes of simulated time for each row instead of an hour");
  programs.add_option("--out", options->out, "Write report, figures (SVG) and scenarios into this folder")->type_name("DIR");
  programs.add_option("--scenarios", options->programs.scenarios, "Where its scenarios are (scenarios/papers/programs)")->type_name("DIR");
  programs.add_option("--format", options->format, "text or json")->check(CLI::IsMember({"text", "json"}))->type_name("FORMAT");
  programs.add_flag("--speed", options->speed, "Say how long the runs of Table I took");
  programs.add_flag("--quiet", options->quiet, "Do not say what is being done");
  programs.footer(
      "Examples:\n"
      "  takt paper programs --short                    tolerances checked, figures made, in about a minute\n"
      "  takt paper programs --out out/paper            an hour of simulated time for each row of Table I\n"
      "Exit status: 0 reproduced, 1 something is out of its tolerance, 2 bad input.");
  programs.callback([options, &status] { status = run(*options); });
  add_coexistence(command, status);
}

}  // namespace takt::cli
