// SPDX-License-Identifier: Apache-2.0
// takt compare: is B better than A, by how much, and where do they part?

#include <cstdio>
#include <memory>
#include <thread>

#include "cli/commands.hpp"
#include "cli/companion.hpp"
#include "cli/interrupt.hpp"
#include "cli/load.hpp"
#include "cli/study_progress.hpp"
#include "cli/terminal.hpp"
#include "json/record.hpp"
#include "scenario/resolve.hpp"
#include "study/compare.hpp"

namespace takt::cli {
namespace {

struct CompareOptions {
  std::string a;
  std::string b;
  std::vector<std::string> overrides_of_a;
  std::vector<std::string> overrides_of_b;
  std::uint32_t pairs = 10;
  std::uint64_t first_seed = 1;
  unsigned jobs = std::max(1u, std::thread::hardware_concurrency());
  std::string format = "text";
  bool quiet = false;
};

/// The scenario with its overrides; it is resolved once, so that mistakes are told before anything runs.
std::optional<json::Document> load(const std::string& file, const std::vector<std::string>& overrides,
                                   json::Diagnostics& diagnostics) {
  auto document = json::parse_file(file, diagnostics);
  if (!document) return std::nullopt;
  for (const std::string& option : overrides) json::apply(*document, option, diagnostics);
  scenario::load_file(file, overrides, diagnostics);
  return document;
}

ExitStatus run(const CompareOptions& options) {
  json::Diagnostics diagnostics;
  const auto a = load(options.a, options.overrides_of_a, diagnostics);
  // The mistakes of one file are told once.
  if (options.a == options.b && diagnostics.has_errors()) {
    tell(diagnostics);
    return ExitStatus::bad_input;
  }
  const auto b = load(options.b, options.overrides_of_b, diagnostics);
  tell(diagnostics);
  if (!a || !b || diagnostics.has_errors()) return ExitStatus::bad_input;
  warn_of_another_maker(options.a);
  if (options.b != options.a) warn_of_another_maker(options.b);
  const InterruptGuard interrupt;
  StudyProgress progress(!options.quiet);
  study::RunOptions how;
  how.jobs = options.jobs;
  how.interrupted = [&] { return interrupt.requested(); };
  how.progress = [&](const char* what, std::uint64_t done, std::uint64_t of) { progress.update(what, done, of); };
  study::Comparison comparison = study::compare(study::plain_plan(*a, options.pairs, options.first_seed),
                                                study::plain_plan(*b, options.pairs, options.first_seed), how);
  progress.clear();
  if (!comparison.problem.empty()) {
    std::fprintf(stderr, "takt: %s\n", comparison.problem.c_str());
    return ExitStatus::internal_error;
  }
  if (comparison.interrupted) return ExitStatus::interrupted;
  comparison.a = options.a;
  comparison.b = options.b;
  for (const std::string& option : options.overrides_of_a) comparison.a += " " + option;
  for (const std::string& option : options.overrides_of_b) comparison.b += " " + option;
  if (options.format == "json")
    std::fputs(json::write(comparison).c_str(), stdout);
  else
    print(study::text_of(comparison));
  return comparison.troubles.empty() ? ExitStatus::pass : ExitStatus::undecided;
}

}  // namespace

void add_compare_command(Command app, ExitStatus& status) {
  const Command command = app.add_subcommand("compare", companion_help("compare"));
  const auto options = std::make_shared<CompareOptions>();
  command.add_option("A", options->a, "A scenario file").required();
  command.add_option("B", options->b, "Another one, or the same with --set-b").required();
  command
      .add_option("--set-a", options->overrides_of_a, "Another value in A: network.links.0.rate=100Mbps (repeatable)")
      .type_name("POINTER=VALUE")
      .one_value_each();
  command.add_option("--set-b", options->overrides_of_b, "Another value in B (repeatable)")
      .type_name("POINTER=VALUE")
      .one_value_each();
  command.add_option("--pairs", options->pairs, "Pairs of runs, each with one seed for both")
      .between(1u, 100'000u)
      .type_name("N");
  command.add_option("--seed", options->first_seed, "The first seed").type_name("N");
  command.add_option("--jobs", options->jobs, "Processes; the result is the same for any number")
      .between(1u, 1024u)
      .type_name("N")
      .default_text("one for each processor");
  command.add_option("--format", options->format, "text or json").one_of({"text", "json"}).type_name("FORMAT");
  command.add_flag("--quiet", options->quiet, "No progress");
  command.footer(
      "Examples:\n"
      "  takt compare scenarios/robot-arm.json scenarios/robot-arm.json --set-b programs.0.cycle=400us\n"
      "  takt compare line.json ring.json --pairs 30 --format json\n"
      "Exit status: 0 compared, 2 bad input, 3 internal error, 4 a run has no result, 130 interrupted.");
  command.callback([options, &status] { status = run(*options); });
}

}  // namespace takt::cli
