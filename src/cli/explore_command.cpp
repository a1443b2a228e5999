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
#include "cli/status_line.hpp"
#include "cli/terminal.hpp"
#include "output/result_folder.hpp"
#include "explore/model/recording.hpp"
#include "explore/report/replay.hpp"
#include "explore/report/report.hpp"
#include "explore/report/schedule.hpp"
#include "explore/search/search.hpp"
#include "json/record.hpp"
#include "scenario/resolve/resolve.hpp"
#include "scenario/run/run.hpp"
#include "verify/roles_query.hpp"

namespace takt::cli {
namespace {

struct ExploreOptions {
  std::string scenario;
  std::optional<unsigned> slaves;
  std::optional<std::string> variant;
  std::vector<std::string> faults;
  explore::Query query;
  std::optional<std::uint32_t> calls;
  std::optional<std::string> subscription;
  std::string network = "registers";
  std::string beginnings = "all";
  bool no_symmetry = false;
  bool no_finish = false;
  bool nested = false;
  std::optional<unsigned> inner_slaves;
  std::optional<unsigned> candidates;
  bool starts_again = false;
  bool is_signed = false;
  std::optional<unsigned> key_changes;
  bool quiet = false;
  bool explains = false;
  std::string out;
  std::string format = "text";
};

struct Subject {
  std::string name;
  explore::Query query;
};

/// Runs that end in a minute or so: fewer calls where there are more slaves.
std::uint32_t usual_calls(unsigned slaves) { return slaves == 1 ? 4 : slaves == 2 ? 2 : 1; }

double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// How far a search is. `spent` is CPU time in s.
std::string status_of(const explore::Progress& now, double spent) {
  const auto states = static_cast<double>(now.states);
  if (now.in_cycles) return fmt::format("cycles: {:.0f} % of {:.1f} M states", 100.0 * static_cast<double>(now.done) / states, states / 1e6);
  return fmt::format("depth {}: {:.1f} M states, {:.1f} M to go, {:.2f} M a second, {:.0f} MB", now.depth, states / 1e6, static_cast<double>(now.states - now.done) / 1e6,
                     states / 1e6 / std::max(spent, 0.001), static_cast<double>(now.octets) / 1e6);
}

/// "registers", "channels" or "channels=N"; says what is wrong.
std::string set_network(const std::string& text, explore::Query& query) {
  if (text == "registers") return {};
  constexpr std::string_view channels = "channels";
  if (!text.starts_with(channels)) return "expected registers or channels=N, found " + text;
  query.network = explore::Network::channels;
  if (text.size() == channels.size()) return {};
  const std::string capacity = text.substr(channels.size());
  if (capacity.size() != 2 || capacity[0] != '=' || capacity[1] < '1' || capacity[1] > '0' + explore::most_capacity)
    return "expected channels=1 to channels=" + std::to_string(explore::most_capacity) + ", found " + text;
  query.capacity = static_cast<std::uint8_t>(capacity[1] - '0');
  return {};
}

/// What is asked for with --nested or --joining and cannot be explored; empty if all can.
std::string not_in_trees(const explore::Query& query, const ExploreOptions& options) {
  std::string wrong;
  const auto refuse = [&wrong](bool is_wrong, const std::string& what) {
    if (is_wrong) wrong += (wrong.empty() ? "" : "; ") + what;
  };
  refuse(options.nested && !options.scenario.empty(), "--nested goes with --slaves N; of a scenario nested Programs are explored together by themselves");
  refuse(options.inner_slaves.has_value() && !options.nested, "--inner-slaves says the size of the inner group of --nested");
  if (!query.is_tree()) return wrong;
  refuse(query.variant != handshake::Variant::robust, "paper knows neither nested groups nor joining slaves");
  refuse(query.subscription != handshake::Subscription::star, "nested groups and joining slaves are explored in stars");
  refuse(query.network != explore::Network::registers, "nested groups and joining slaves are explored on registers");
  refuse(query.faults.contains(explore::Fault::duplicate) || query.faults.contains(explore::Fault::reorder),
         "nested groups and joining slaves are explored with loss, crash, restart, timeout and forge");
  refuse(query.nested() && query.slaves > explore::most_outer_slaves, "nested groups have at most " + std::to_string(explore::most_outer_slaves) + " outer slaves");
  refuse(!options.out.empty(), "findings with nested groups or joining slaves are drawn as charts, not written as scenarios (--out)");
  return wrong;
}

/// The same with roles.
std::string not_with_roles(const explore::Query& query, const ExploreOptions& options) {
  std::string wrong;
  const auto refuse = [&wrong](bool is_wrong, const std::string& what) {
    if (is_wrong) wrong += (wrong.empty() ? "" : "; ") + what;
  };
  refuse(options.starts_again && !query.has_roles(), "--starts-again says what happens when the node of a role was replaced: give --candidates, too");
  if (!query.has_roles()) return wrong;
  refuse(query.variant != handshake::Variant::robust, "paper knows no roles");
  refuse(query.joining, "candidates join by themselves, without --joining");
  refuse(query.nested() && query.slaves > explore::most_outer_slaves, "nested groups have at most " + std::to_string(explore::most_outer_slaves) + " outer slaves");
  refuse(query.nested() && query.candidates > explore::most_inner_candidates, "nested groups are explored with at most " + std::to_string(explore::most_inner_candidates) + " candidates");
  refuse(query.nested() && query.starts_again, "a nested group is started by the one outside, so --starts-again does not go with --nested");
  refuse(query.subscription != handshake::Subscription::star, "roles are explored in stars");
  refuse(query.network != explore::Network::registers, "roles are explored on registers");
  refuse(query.faults.contains(explore::Fault::duplicate) || query.faults.contains(explore::Fault::reorder) || query.faults.contains(explore::Fault::forge),
         "roles are explored with loss, crash, restart and timeout");
  refuse(query.roles() > explore::most_explored_roles, "at most " + std::to_string(explore::most_explored_roles) + " roles can be explored");
  refuse(!options.out.empty(), "findings with roles are drawn as charts, not written as scenarios (--out)");
  return wrong;
}

/// The same with a stranger who replays.
std::string not_with_recordings(const explore::Query& query, const ExploreOptions& options) {
  std::string wrong;
  const auto refuse = [&wrong](bool is_wrong, const std::string& what) {
    if (is_wrong) wrong += (wrong.empty() ? "" : "; ") + what;
  };
  refuse(options.is_signed && !query.has_recordings(), "--signed says what becomes of messages that are replayed: give --faults replay, too");
  refuse(options.key_changes.has_value() && !options.is_signed, "--key-changes are those of --signed");
  if (!query.has_recordings()) return wrong;
  refuse(query.variant != handshake::Variant::robust, "replay is explored with robust; paper cannot tell an old word from a new one");
  refuse(query.network != explore::Network::registers, "replay is explored on registers");
  refuse(query.is_tree() || query.has_roles(), "replay is explored in one group with fixed slaves");
  refuse(query.faults.contains(explore::Fault::duplicate) || query.faults.contains(explore::Fault::reorder), "a replay is a duplicate that comes at any time: leave duplicate and reorder out");
  refuse(query.faults.contains(explore::Fault::forge), options.is_signed ? "nobody without the key forges signed words: leave forge out" : "forge and replay are two questions: ask them one by one");
  refuse(!options.out.empty(), "findings with replays are drawn as charts, not written as scenarios (--out)");
  return wrong;
}

/// What is to be explored: the group of the options, or each Program of the scenario. Empty after a mistake.
std::vector<Subject> subjects_of(const ExploreOptions& options) {
  std::vector<Subject> subjects;
  explore::Query query = options.query;
  query.symmetry = !options.no_symmetry;
  query.finishes = !options.no_finish;
  for (std::size_t f = 0; f < explore::fault_count; ++f)
    for (const std::string& each : options.faults)
      if (each == explore::fault_names[f]) query.faults.insert(static_cast<explore::Fault>(f));
  const auto variant_of = [&](handshake::Variant otherwise) {
    if (!options.variant) return otherwise;
    return *options.variant == "paper" ? handshake::Variant::paper : handshake::Variant::robust;
  };
  set_network(options.network, query);
  if (options.beginnings == "switched-on") query.beginnings = explore::Beginnings::switched_on;
  const auto add = [&](std::string name, std::size_t slaves, handshake::Variant variant, bool all_to_all) {
    query.slaves = static_cast<std::uint8_t>(slaves);
    if (options.subscription) all_to_all = *options.subscription == "all-to-all";
    query.subscription = all_to_all ? handshake::Subscription::all_to_all : handshake::Subscription::star;
    const std::size_t most = all_to_all ? explore::most_slaves_all_to_all : explore::most_slaves;
    if (slaves > most) {
      std::fprintf(stderr, "takt: %s has %zu slaves%s; at most %zu can be explored: give --slaves N to explore a smaller group with its variant\n", name.c_str(), slaves,
                   all_to_all ? " with all-to-all subscription" : "", most);
      return false;
    }
    query.variant = variant_of(variant);
    if (options.nested) query.inner_slaves = static_cast<std::uint8_t>(options.inner_slaves.value_or(1));
    if (options.candidates) query.candidates = static_cast<std::uint8_t>(*options.candidates);
    if (options.starts_again) query.starts_again = true;
    const unsigned nodes = query.has_roles() ? query.slaves + query.inner_slaves + query.candidates - 1U : query.nested() ? query.slaves + query.inner_slaves : query.slaves;
    query.commands = options.calls.value_or(usual_calls(nodes));
    query.is_signed = options.is_signed;
    query.key_changes = options.is_signed ? static_cast<std::uint8_t>(options.key_changes.value_or(1)) : std::uint8_t{0};
    if (query.variant == handshake::Variant::paper && query.faults.contains(explore::Fault::forge)) {
      std::fprintf(stderr, "takt: %s: forge is explored with robust; a word of paper is a state and nothing more, and whoever forges it is believed\n", name.c_str());
      return false;
    }
    std::string wrong = not_in_trees(query, options);
    if (wrong.empty()) wrong = not_with_roles(query, options);
    if (wrong.empty()) wrong = not_with_recordings(query, options);
    if (!wrong.empty()) {
      std::fprintf(stderr, "takt: %s: %s\n", name.c_str(), wrong.c_str());
      return false;
    }
    subjects.push_back({std::move(name), query});
    return true;
  };
  if (options.scenario.empty()) {
    if (!options.slaves) {
      std::fputs("takt: explore needs a scenario or --slaves N\n", stderr);
      return {};
    }
    return add("group", *options.slaves, handshake::Variant::robust, false) ? subjects : std::vector<Subject>{};
  }
  json::Diagnostics diagnostics;
  const auto resolved = scenario::load_file(options.scenario, {}, diagnostics);
  tell(diagnostics);
  if (!resolved) return {};
  for (std::uint32_t number = 0; number < resolved->programs.size(); ++number) {
    const scenario::ResolvedProgram& each = resolved->programs[number];
    const scenario::Program& program = *each.description;
    query.inner_slaves = 0;
    if (const std::vector<std::uint32_t> tree = verify::tree_of(*resolved, number); tree.size() > 1 && !options.slaves) {
      const auto wrong = verify::set_tree(*resolved, tree, query);
      if (!wrong && tree[0] != number) continue;   // explored with the one outside
      if (!wrong) {
        if (!add(program.name + " and " + resolved->programs[tree[1]].name + " within", query.slaves, program.variant, false)) return {};
        continue;
      }
      if (tree[0] == number) std::fprintf(stderr, "takt: %s and what is within is explored one by one: %s\n", program.name.c_str(), wrong->c_str());
      query.inner_slaves = 0;
    }
    const std::size_t slaves = options.slaves.value_or(static_cast<unsigned>(program.slaves.size() + program.roles.size()));
    query.candidates = 0;
    if (each.has_roles() && options.slaves) {
      std::fprintf(stderr, "takt: %s has roles, so --slaves does not go with it\n", program.name.c_str());
      return {};
    }
    if (each.has_roles()) {
      if (const auto wrong = verify::set_roles(each, query)) {
        std::fprintf(stderr, "takt: %s: %s: give --slaves and --candidates instead of the scenario\n", program.name.c_str(), wrong->c_str());
        return {};
      }
    }
    if (!add(program.name, slaves, program.variant, program.subscription == scenario::Subscription::all_to_all)) return {};
  }
  if (subjects.empty()) std::fputs("takt: the scenario has no Programs to explore\n", stderr);
  return subjects;
}

/// Whether `takt run` does the same: the same invariant is violated; or, where the group does not settle, all end in the same
/// states, or still change at the end.
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
bool write_finding(const Subject& subject, const explore::SearchResult& result, explore::Property property, const explore::Trace& trace, output::WrittenFiles& folder) {
  const explore::Replay replayed = explore::replay(subject.query, result.beginnings[trace.beginning], trace);
  const std::string name = subject.name + (trace.cycle != 0 ? "-livelock-" : "-") + std::string(explore::name_of(property));
  const explore::ScenarioText text = explore::scenario_of(subject.query, replayed, property, name);
  const std::string path = folder.path_of(name + ".json");
  if (const std::string problem = output::write_file(path, text.json); !problem.empty()) {
    std::fprintf(stderr, "takt: cannot write: %s\n", problem.c_str());
    return false;
  }
  folder.add(name + ".json");
  std::fprintf(stderr, "%s: %s\n", path.c_str(), replays(text.json, replayed, property) ? "takt run does the same" : "takt run does not do the same");
  for (const std::string& each : text.missing) std::fprintf(stderr, "  no scenario can say: %s\n", each.c_str());
  return true;
}

/// One scenario for each violated property.
bool write_findings(const Subject& subject, const explore::SearchResult& result, output::WrittenFiles& folder) {
  for (std::size_t p = 0; p < explore::property_count; ++p) {
    const auto property = static_cast<explore::Property>(p);
    if (result[property] == explore::PropertyVerdict::violated && result.traces[p] && !write_finding(subject, result, property, *result.traces[p], folder)) return false;
  }
  return !result.livelock || write_finding(subject, result, explore::Property::L1, *result.livelock, folder);
}

ExitStatus run(const ExploreOptions& options) {
  const std::vector<Subject> subjects = subjects_of(options);
  if (subjects.empty()) return ExitStatus::bad_input;
  if (const std::string problem = options.out.empty() ? std::string() : output::prepare_folder(options.out); !problem.empty()) {
    std::fprintf(stderr, "takt: cannot write: %s\n", problem.c_str());
    return ExitStatus::internal_error;
  }
  std::optional<output::WrittenFiles> folder;
  if (!options.out.empty()) folder.emplace(options.out, "explore", options.scenario);
  const InterruptGuard interrupt;
  ExitStatus status = ExitStatus::pass;
  json::Node pages = json::Node::array();
  for (const Subject& subject : subjects) {
    const double began = cpu_seconds();
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
      pages.items.push_back(json::ShapeOf<explore::Exploration>::write({options.scenario.empty() ? "" : subject.name, subject.query, result, spent}));
    } else {
      if (subjects.size() > 1) std::printf("Program %s\n", subject.name.c_str());
      print(explore::text_report(subject.query, result, spent, options.explains ? explore::Detail::knowledge : explore::Detail::why));
    }
    if (folder && !write_findings(subject, result, *folder)) return ExitStatus::internal_error;
    if (!result.all_hold()) status = result.interrupted && !result.any_violated() && status == ExitStatus::pass ? ExitStatus::interrupted : ExitStatus::requirement_failed;
    if (result.interrupted) break;
  }
  if (folder) {
    if (const std::string problem = folder->end(std::filesystem::path(options.scenario).stem().string()); !problem.empty()) {
      std::fprintf(stderr, "takt: cannot write: %s\n", problem.c_str());
      return ExitStatus::internal_error;
    }
    if (!options.quiet && options.format != "json") tell_files(folder->summary(), "");
  }
  // One document: an object for one Program, an array of such objects for a scenario with several.
  if (!pages.items.empty()) std::fputs(json::pretty(subjects.size() > 1 ? pages : pages.items.front()).c_str(), stdout);
  return status;
}

}  // namespace

void add_explore_command(Command app, ExitStatus& status) {
  const Command command = app.add_subcommand("explore", "Search every order of messages, calls and faults of a small group");
  const auto options = std::make_shared<ExploreOptions>();
  command.add_option("scenario", options->scenario, "Take variant and slaves from its Programs").type_name("SCENARIO");
  command.add_option("--slaves", options->slaves, "Slaves of the group").between(1U, static_cast<unsigned>(explore::most_slaves)).type_name("N");
  command.add_option("--variant", options->variant, "The handshake (default: robust, or the scenario's)").one_of({"paper", "robust"});
  command.add_option("--faults", options->faults, "Classes of faults, with commas between")
      .delimiter(',')
      .one_of(std::vector<std::string>(explore::fault_names.begin(), explore::fault_names.end()));
  command.add_option("--fault-budget", options->query.fault_budget, "Faults in a run, of all classes together")
      .between(0U, explore::most_faults)
      .default_in_help();
  command.add_option("--calls", options->calls, "Method calls and ends of the Program in a run (default: 4, 2, 1, 1 for 1 to 4 slaves)")
      .between(0U, explore::most_commands);
  command.add_option("--depth", options->query.depth, "Steps of a run").type_name("D");
  command.add_option("--budget", options->query.states, "States to store at most")
      .between(std::uint64_t{1}, explore::most_states)
      .type_name("STATES")
      .default_in_help();
  command.add_option("--network", options->network, "How words travel: registers (the last word, as cyclic publishing gives) or channels=N (N messages in flight, default 2)")
      .check([](const std::string& text) {
        explore::Query unused;
        return set_network(text, unused);
      })
      .default_in_help();
  command.add_option("--subscription", options->subscription, "Who hears whom (default: star, or the scenario's)").one_of({"star", "all-to-all"});
  command.add_option("--beginnings", options->beginnings, "Where runs begin: all (wherever a group can rest) or switched-on")
      .one_of({"all", "switched-on"})
      .default_in_help();
  command.add_flag("--nested", options->nested, "The last slave is the master of an inner group, too (robust, star, registers; loss, crash, restart, timeout, forge)");
  command.add_option("--inner-slaves", options->inner_slaves, "Slaves of the inner group (default 1)")
      .between(1U, static_cast<unsigned>(explore::most_inner_slaves))
      .type_name("N");
  command.add_flag("--joining", options->query.joining, "The last slave is down at the beginning and comes up at any time, or never (where --nested can be explored)");
  command.add_option("--candidates", options->candidates, "Nodes that may have the slaves' places, which are roles then (up to 2 roles; where --nested can be explored, without forge)")
      .between(1U, static_cast<unsigned>(explore::most_explored_candidates))
      .type_name("N");
  command.add_flag("--starts-again", options->starts_again, "With roles: the master starts the group again when a node that was lost in a run has been replaced");
  command.add_flag("--signed", options->is_signed, "With --faults replay: messages are signed, so none is taken twice, nor behind a newer one");
  command.add_option("--key-changes", options->key_changes, "With --signed: how often the key of each participant may change in a run (default 1)")
      .between(0U, static_cast<unsigned>(explore::most_key_changes))
      .type_name("N");
  command.add_flag("--no-finish", options->no_finish, "No Program ends by itself");
  command.add_flag("--no-symmetry", options->no_symmetry, "Tell equal slaves apart");
  command.add_flag("--explain", options->explains, "Below each step of a chart, what each participant knows of the others from then on (--format json always says it)");
  command.add_option("--out", options->out, "Write a scenario for each violation into this folder").type_name("DIR");
  command.add_option("--format", options->format, "text or json").one_of({"text", "json"});
  command.add_flag("--quiet", options->quiet, "No progress line");
  command.footer(
      "Examples:\n"
      "  takt explore --slaves 2 --variant robust --faults loss,crash\n"
      "  takt explore --slaves 1 --variant paper --out findings\n"
      "  takt explore --slaves 1 --variant paper --no-finish --explain\n"
      "  takt explore scenarios/robot-arm.json --faults restart,timeout --format json\n"
      "  takt explore --slaves 2 --faults loss,reorder --network channels=2\n"
      "  takt explore --slaves 1 --nested --faults crash --calls 2\n"
      "  takt explore --slaves 1 --calls 1 --faults forge\n"
      "  takt explore --slaves 1 --calls 2 --faults replay --signed\n"
      "  takt explore --slaves 1 --candidates 2 --faults crash\n"
      "Ctrl-C ends the search and prints what was found until then.\n"
      "Exit status: 0 all hold, 1 violated, not reached or not decided, 2 bad input, 130 interrupted before a violation was found.");
  command.callback([options, &status] { status = run(*options); });
}

}  // namespace takt::cli
