// SPDX-License-Identifier: Apache-2.0
// takt explore: every order of messages, calls and faults of a small group.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <memory>
#include <optional>

#include "cli/commands.hpp"
#include "cli/interrupt.hpp"
#include "cli/places.hpp"
#include "cli/status_line.hpp"
#include "cli/terminal.hpp"
#include "explore/model/recording.hpp"
#include "explore/parts/views.hpp"
#include "explore/report/replay.hpp"
#include "explore/report/report.hpp"
#include "explore/report/schedule.hpp"
#include "explore/search/search.hpp"
#include "json/record.hpp"
#include "output/result_folder.hpp"
#include "scenario/resolve.hpp"
#include "scenario/run/run.hpp"
#include "verify/group_question.hpp"

namespace takt::cli {
namespace {

struct ExploreOptions {
  std::string scenario;
  verify::GroupQuestion question;
  bool quiet = false;
  bool explains = false;
  std::string out;
  std::string format = "text";
};

double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// How far a search is. `spent` is CPU time in s.
std::string status_of(const explore::Progress& now, double spent) {
  const auto states = static_cast<double>(now.states);
  if (now.in_cycles)
    return fmt::format("cycles: {:.0f} % of {:.1f} M states", 100.0 * static_cast<double>(now.done) / states,
                       states / 1e6);
  return fmt::format("depth {}: {:.1f} M states, {:.1f} M to go, {:.2f} M a second, {:.0f} MB", now.depth, states / 1e6,
                     static_cast<double>(now.states - now.done) / 1e6, states / 1e6 / std::max(spent, 0.001),
                     static_cast<double>(now.octets) / 1e6);
}

/// What is to be explored. Empty after a mistake.
std::vector<verify::Group> groups_of(const ExploreOptions& options) {
  json::Diagnostics diagnostics;
  std::unique_ptr<scenario::Resolved> resolved;
  if (!options.scenario.empty()) {
    resolved = scenario::load_file(options.scenario, {}, diagnostics);
    tell(diagnostics);
    if (!resolved) return {};
  }
  verify::GroupQuestion question = options.question;
  question.writes_scenarios = !options.out.empty();
  verify::Groups groups = verify::groups_of(question, resolved.get());
  for (const std::string& note : groups.notes) std::fprintf(stderr, "takt: %s\n", note.c_str());
  if (!groups.mistake.empty()) std::fprintf(stderr, "takt: %s\n", groups.mistake.c_str());
  return std::move(groups.groups);
}

/// Whether `takt run` does the same: the same invariant is violated; or, where the group does not settle, all end in
/// the same states, or still change at the end.
bool replays(const std::string& text, const explore::Replay& replayed, explore::Property property) {
  json::Diagnostics diagnostics;
  const auto resolved = scenario::load_text(text, "finding", {}, diagnostics);
  tell(diagnostics);
  if (!resolved) return false;
  scenario::Run run(*resolved);
  constexpr auto last_moments = sim::Duration::from_ps(10'000'000'000);
  if (replayed.cycle != 0) run.simulation().run(run.end() + -last_moments);
  const std::uint64_t changes = run.monitor(0).changes();
  run.advance();
  for (const scenario::ViolationRecord& each : run.monitor(0).violations())
    if (handshake::name_of(each.violation.invariant) == explore::name_of(property)) return true;
  if (property != explore::Property::L1 && property != explore::Property::F1) return false;
  if (replayed.cycle != 0) return run.monitor(0).changes() > changes;
  const explore::ReplayStep& last = replayed.steps.back();
  for (std::size_t i = 0; i < last.states.size(); ++i)
    if (!last.down[i] && run.state(0, i) != last.states[i]) return false;
  return true;
}

/// Writes the scenario of one counter-example and says whether it does the same. False if the file cannot be written.
bool write_finding(const verify::Group& subject, const explore::SearchResult& result, explore::Property property,
                   const explore::Trace& trace, output::WrittenFiles& folder) {
  const explore::Replay replayed = explore::replay(subject.query, result.beginnings[trace.beginning], trace);
  const std::string name =
      subject.name + (trace.cycle != 0 ? "-livelock-" : "-") + std::string(explore::name_of(property));
  const explore::ScenarioText text = explore::scenario_of(subject.query, replayed, property, name);
  const std::string path = folder.path_of(name + ".json");
  if (const std::string problem = output::write_file(path, text.json); !problem.empty()) {
    std::fprintf(stderr, "takt: cannot write: %s\n", problem.c_str());
    return false;
  }
  folder.add(name + ".json");
  std::fprintf(stderr, "%s: %s\n", path.c_str(),
               replays(text.json, replayed, property) ? "takt run does the same" : "takt run does not do the same");
  for (const std::string& each : text.missing) std::fprintf(stderr, "  no scenario can say: %s\n", each.c_str());
  return true;
}

/// One scenario for each violated property.
bool write_findings(const verify::Group& subject, const explore::SearchResult& result, output::WrittenFiles& folder) {
  for (std::size_t p = 0; p < explore::property_count; ++p) {
    const auto property = static_cast<explore::Property>(p);
    if (result[property] == explore::PropertyVerdict::violated && result.traces[p] &&
        !write_finding(subject, result, property, *result.traces[p], folder))
      return false;
  }
  return !result.livelock || write_finding(subject, result, explore::Property::L1, *result.livelock, folder);
}

ExitStatus run(const ExploreOptions& options) {
  if (!can_write({{"--out", options.out, Place::Kind::folder}}, options.format == "json")) return ExitStatus::bad_input;
  const std::vector<verify::Group> subjects = groups_of(options);
  if (subjects.empty()) return ExitStatus::bad_input;
  if (options.question.any_number && (options.format == "json" || !options.out.empty())) {
    std::fprintf(stderr, "takt: --any-number prints text: found --format json or --out, expected neither\n");
    return ExitStatus::bad_input;
  }
  std::optional<output::WrittenFiles> folder;
  if (!options.out.empty()) folder.emplace(options.out, "explore", options.scenario);
  const InterruptGuard interrupt;
  ExitStatus status = ExitStatus::pass;
  json::Node pages = json::Node::array();
  for (const verify::Group& subject : subjects) {
    const double began = cpu_seconds();
    if (options.question.any_number) {
      const explore::AnyNumber proof =
          explore::prove_for_any_number(subject.query, [&](const auto&...) { return !interrupt.requested(); });
      if (subjects.size() > 1) std::printf("Program %s\n", subject.name.c_str());
      print(explore::text_report(subject.query, proof, cpu_seconds() - began));
      if (!proof.is_proved()) status = proof.interrupted ? ExitStatus::interrupted : ExitStatus::requirement_failed;
      if (proof.interrupted) break;
      continue;
    }
    explore::SearchResult result;
    {
      StatusLine line(!options.quiet);
      result = explore::explore(subject.query, [&](const explore::Progress& progress) {
        if (line.is_due()) line.show(status_of(progress, cpu_seconds() - began));
        return !interrupt.requested();
      });
    }
    const double spent = cpu_seconds() - began;
    if (options.format == "json") {
      pages.items.push_back(json::ShapeOf<explore::Exploration>::write(
          {options.scenario.empty() ? "" : subject.name, subject.query, result, spent}));
    } else {
      if (subjects.size() > 1) std::printf("Program %s\n", subject.name.c_str());
      print(explore::text_report(subject.query, result, spent,
                                 options.explains ? explore::Detail::knowledge : explore::Detail::why));
    }
    if (folder && !write_findings(subject, result, *folder)) return ExitStatus::internal_error;
    if (!result.all_hold())
      status = result.interrupted && !result.any_violated() && status == ExitStatus::pass
                   ? ExitStatus::interrupted
                   : ExitStatus::requirement_failed;
    if (result.interrupted) break;
  }
  if (folder) {
    if (const std::string problem = folder->end(std::filesystem::path(options.scenario).stem().string());
        !problem.empty()) {
      std::fprintf(stderr, "takt: cannot write: %s\n", problem.c_str());
      return ExitStatus::internal_error;
    }
    if (!options.quiet && options.format != "json") print_files(folder->summary(), "");
  }
  // One document: an object for one Program, an array of such objects for a scenario with several.
  if (!pages.items.empty()) std::fputs(json::pretty(subjects.size() > 1 ? pages : pages.items.front()).c_str(), stdout);
  return status;
}

}  // namespace

void add_explore_command(Command app, ExitStatus& status) {
  const Command command =
      app.add_subcommand("explore", "Search every order of messages, calls and faults of a small group");
  const auto options = std::make_shared<ExploreOptions>();
  command.add_option("scenario", options->scenario, "Take variant and slaves from its Programs").type_name("SCENARIO");
  command.add_option("--slaves", options->question.slaves, "Slaves of the group")
      .between(1U, static_cast<unsigned>(explore::most_equal_slaves))
      .type_name("N")
      .default_text("1, or the scenario's");
  command.add_flag("--any-number", options->question.any_number,
                   "Prove it for every number of slaves at once (robust, star, registers; without forge and replay)");
  command.add_option("--variant", options->question.variant, "The handshake")
      .one_of({"paper", "robust"})
      .default_text("robust, or the scenario's");
  command.add_option("--faults", options->question.faults, "Classes of faults, with commas between")
      .delimiter(',')
      .default_text("none")
      .one_of(std::vector<std::string>(explore::fault_names.begin(), explore::fault_names.end()));
  command.add_option("--fault-budget", options->question.query.fault_budget, "Faults in a run, of all classes together")
      .between(0U, explore::most_faults);
  command.add_option("--calls", options->question.calls, "Method calls and ends of the Program in a run")
      .between(0U, explore::most_commands)
      .default_text("4 for 1 slave, 2 for 2, else 1");
  command.add_option("--depth", options->question.query.depth, "Steps of a run").type_name("D").default_text("any");
  command.add_option("--budget", options->question.query.states, "States to store at most")
      .between(std::uint64_t{1}, explore::most_states)
      .type_name("STATES");
  command
      .add_option("--network", options->question.network,
                  "How words travel: registers (the last word, as cyclic publishing gives) or channels=N (N messages "
                  "in flight, default 2)")
      .check([](const std::string& text) {
        explore::Query unused;
        return verify::set_network(text, unused);
      });
  command.add_option("--subscription", options->question.subscription, "Who hears whom")
      .one_of({"star", "all-to-all"})
      .default_text("star, or the scenario's");
  command
      .add_option("--beginnings", options->question.beginnings,
                  "Where runs begin: all (wherever a group can rest) or switched-on")
      .one_of({"all", "switched-on"});
  command.add_flag("--nested", options->question.nested,
                   "The last slave is the master of an inner group, too (robust, star, registers; loss, crash, "
                   "restart, timeout, forge)");
  command.add_option("--inner-slaves", options->question.inner_slaves, "Slaves of the inner group")
      .between(1U, static_cast<unsigned>(explore::most_inner_slaves))
      .default_text("1")
      .type_name("N");
  command.add_flag(
      "--joining", options->question.query.joining,
      "The last slave is down at the beginning and comes up at any time, or never (where --nested can be explored)");
  command
      .add_option("--candidates", options->question.candidates,
                  "Nodes that may have the slaves' places, which are roles then (up to 2 roles; where --nested can be "
                  "explored, without forge)")
      .between(1U, static_cast<unsigned>(explore::most_explored_candidates))
      .type_name("N")
      .default_text("none: slaves have their places");
  command.add_flag(
      "--starts-again", options->question.starts_again,
      "With roles: the master starts the group again when a node that was lost in a run has been replaced");
  command.add_flag("--signed", options->question.is_signed,
                   "With --faults replay: messages are signed, so none is taken twice, nor behind a newer one");
  command
      .add_option("--key-changes", options->question.key_changes,
                  "With --signed: how often the key of each participant may change in a run")
      .between(0U, static_cast<unsigned>(explore::most_key_changes))
      .default_text("1")
      .type_name("N");
  command.add_flag("--no-finish", options->question.no_finish, "No Program ends by itself");
  command.add_flag("--no-symmetry", options->question.no_symmetry, "Tell equal slaves apart");
  command.add_flag("--explain", options->explains,
                   "Below each step of a chart, what each participant knows of the others from then on (--format json "
                   "always says it)");
  command.add_option("--out", options->out, "Write a scenario for each violation into this folder").type_name("DIR");
  command.add_option("--format", options->format, "text or json").one_of({"text", "json"});
  command.add_flag("--quiet", options->quiet, "No progress line");
  command.footer(
      "Examples:\n"
      "  takt explore --slaves 2 --variant robust --faults loss,crash\n"
      "  takt explore --slaves 1 --variant paper --out findings\n"
      "  takt explore --slaves 1 --variant paper --no-finish --explain\n"
      "  takt explore scenarios/robot-arm.json --faults restart,timeout --format json\n"
      "  takt explore --slaves 6 --faults crash\n"
      "  takt explore --any-number --faults loss,crash\n"
      "  takt explore --slaves 2 --faults loss,reorder --network channels=2\n"
      "  takt explore --slaves 1 --nested --faults crash --calls 2\n"
      "  takt explore --slaves 1 --calls 1 --faults forge\n"
      "  takt explore --slaves 1 --calls 2 --faults replay --signed\n"
      "  takt explore --slaves 1 --candidates 2 --faults crash\n"
      "Ctrl-C ends the search and prints what was found until then.\n"
      "Exit status: 0 all hold, 1 violated, not reached or not decided, 2 bad input, 130 interrupted before a "
      "violation was found.");
  command.callback([options, &status] { status = run(*options); });
}

}  // namespace takt::cli
