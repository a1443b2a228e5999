// SPDX-License-Identifier: Apache-2.0
#include "emulate/emulation.hpp"

#include <fmt/format.h>
#include <signal.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <deque>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <optional>

#include "emulate/application_processes.hpp"
#include "emulate/child.hpp"
#include "emulate/expectation.hpp"
#include "emulate/log_reader.hpp"
#include "emulate/machine.hpp"
#include "emulate/node_status.hpp"
#include "emulate/pace.hpp"
#include "emulate/role_steps.hpp"
#include "json/document.hpp"
#include "node/control_socket.hpp"
#include "scenario/run/run.hpp"

namespace takt::emulate {
namespace {

namespace fs = std::filesystem;

constexpr int start_timeout_ms = 20'000;
constexpr int stop_timeout_ms = 5'000;
constexpr int steady_state_timeout_ms = 20'000;  // for a group with roles to come to where the simulated one was
constexpr std::int64_t slice_ns = 20'000'000;    // of waiting, between two looks at signals and nodes

std::int64_t now_ns() {
  timespec time = {};
  ::clock_gettime(CLOCK_MONOTONIC, &time);
  return static_cast<std::int64_t>(time.tv_sec) * 1'000'000'000 + time.tv_nsec;
}

void sleep_until(std::int64_t ns) {
  const timespec time = {static_cast<time_t>(ns / 1'000'000'000), static_cast<long>(ns % 1'000'000'000)};
  ::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &time, nullptr);
}

/// One node and what it does.
struct LiveNode {
  const PlannedNode* plan = nullptr;
  std::string name;  ///< of the participants
  std::string file;
  std::string log;
  std::string errors;
  std::string socket;
  bool is_absent = false;        ///< a candidate that will not announce itself when it starts
  std::unique_ptr<Child> child;  ///< null while its host is down
};

class Emulation {
 public:
  Emulation(const scenario::Resolved& resolved, const Plan& plan, const Settings& settings, Result& result,
            std::string& problem)
      : resolved_(resolved), plan_(plan), settings_(settings), result_(result), problem_(problem) {}

  bool run() {
    simulate();
    machine_ = Machine::lay(plan_, problem_);
    if (!machine_) return false;
    expectation_ = expectation_of(resolved_, plan_);
    has_roles_ = expectation_.has_value();
    name_files();
    for (LiveNode& node : nodes_)
      if (!joins_at_start(node)) start(node, false);
    const bool done = start_candidates() && wait_for_nodes() && start_applications() && run_script();
    stop();
    keep_files();
    return done && collect();
  }

 private:
  void simulate() {
    simulation_ = std::make_unique<scenario::Run>(resolved_);
    simulation_->advance();
    for (std::size_t p = 0; p < resolved_.programs.size(); ++p)
      simulated_.push_back(history_of(simulation_->monitor(p)));
    simulated_threads_ = threads_of(*simulation_);
    pace_.emplace(simulated_);
  }

  void name_files() {
    for (const PlannedNode& planned : plan_.nodes) {
      LiveNode& node = nodes_.emplace_back();
      const std::string path = machine_->folder() + "/" + planned.name;
      const PlannedNode::Part& part = planned.parts.front();
      const scenario::ResolvedProgram& program = resolved_.programs[part.program];
      node.plan = &planned;
      node.name =
          part.candidate ? resolved_.topology.nodes[planned.host].name : program.participant_names[part.participant];
      node.file = path + ".json";
      node.log = path + ".jsonl";
      node.errors = path + ".err";
      node.socket = path + ".sock";
      node.is_absent = planned.is_absent;
      write_file(node);
    }
  }

  bool start_applications() {
    applications_ = std::make_unique<ApplicationProcesses>(resolved_, plan_, *machine_);
    if (const std::string failed = applications_->start(); !failed.empty()) return fail(failed);
    const std::string last = applications_->not_started();
    return wait_for([this] { return applications_->not_started().empty(); },
                    "the applications of " + last + " do not start");
  }

  static void write_file(const LiveNode& node) {
    std::string config = node.plan->config;
    const auto put = [&config](std::string_view mark, const std::string& text) {
      if (const std::size_t at = config.find(mark); at != std::string::npos) config.replace(at, mark.size(), text);
    };
    put(control_mark, node.socket);
    put(absent_mark, node.is_absent ? "true" : "false");
    std::ofstream(node.file) << config;
  }

  void start(LiveNode& node, bool again) {
    write_file(node);
    Child::Settings settings;
    settings.command = {node_program(), "node", node.file};
    settings.network_namespace = machine_->namespace_of(node.plan->host);
    settings.output = node.log;
    settings.errors = node.errors;
    settings.append = again;
    node.child = std::make_unique<Child>(settings);
  }

  static bool joins_at_start(const LiveNode& node) { return node.plan->parts.front().candidate && !node.is_absent; }

  /// One after the other, as they got their roles in the simulated run: who is there first gets the first role.
  bool start_candidates() {
    for (std::uint32_t p = 0; expectation_ && p < expectation_->order.size(); ++p)
      for (const std::uint8_t c : expectation_->order[p]) {
        LiveNode& node = node_of(p, c);
        if (!joins_at_start(node)) continue;
        start(node, false);
        const auto is_present = [&] {
          const auto state = group_state(p, true);
          return state && state->present[c];
        };
        if (!wait_for(is_present, "node " + node.name + " does not reach the master of " + resolved_.programs[p].name))
          return false;
      }
    return true;
  }

  template <class Done>
  bool wait_for(const Done& done, const std::string& problem) {
    for (const std::int64_t until = now_ns() + std::int64_t{start_timeout_ms} * 1'000'000; !done();
         sleep_until(now_ns() + slice_ns)) {
      if (is_stopped() || !check_nodes()) return false;
      if (now_ns() > until) return fail(problem);
    }
    return true;
  }

  LiveNode& node_of(std::uint32_t program, std::optional<std::uint8_t> candidate) {
    return *std::find_if(nodes_.begin(), nodes_.end(), [&](const LiveNode& each) {
      return std::ranges::any_of(each.plan->parts, [&](const PlannedNode::Part& part) {
        return part.program == program && part.candidate == candidate && (part.candidate || part.participant == 0);
      });
    });
  }
  LiveNode* node_called(std::uint32_t program, const std::string& candidate) {
    const auto found = std::find_if(nodes_.begin(), nodes_.end(), [&](const LiveNode& each) {
      return each.plan->parts.front().program == program && each.plan->parts.front().candidate &&
             each.name == candidate;
    });
    return found == nodes_.end() ? nullptr : &*found;
  }

  /// Of a group with roles, as its master has it, and its nodes their states; nothing if somebody does not answer.
  std::optional<GroupState> group_state(std::uint32_t program, bool of_master_alone = false) {
    std::string problem;
    const auto status = node::ask_node(node_of(program, std::nullopt).socket, "status", problem);
    auto group = status ? group_of_status(*status, resolved_.programs[program]) : std::nullopt;
    for (std::size_t role = 0; group && !of_master_alone && role < group->nodes.size(); ++role) {
      const LiveNode* const node = node_called(program, group->nodes[role]);
      if (node == nullptr || !node->child) continue;  // its participant is gone
      const auto answer = node::ask_node(node->socket, "status", problem);
      const auto state = answer ? state_of_status(*answer) : std::nullopt;
      if (!state) return std::nullopt;
      group->states[role + 1] = *state;
    }
    return group;
  }

  /// Until groups with roles are where the simulated ones were before this action. If they do not come there, the
  /// others show it: once is enough to wait for it.
  bool settle(std::size_t action) {
    for (std::uint32_t p = 0; expectation_ && p < resolved_.programs.size(); ++p) {
      const auto& expected = expectation_->before[action][p];
      if (!expected || !node_of(p, std::nullopt).child) continue;  // a master that is down says nothing
      std::string differs;
      for (const std::int64_t until = now_ns() + std::int64_t{steady_state_timeout_ms} * 1'000'000;;) {
        const auto found = group_state(p);
        differs = found ? difference(*expected, *found, resolved_, p) : "a node does not answer";
        if (differs.empty()) break;
        if (is_stopped() || !check_nodes()) return false;
        if (now_ns() > until) {
          note("no longer as simulated from " +
               (action < plan_.actions.size() ? json::to_text(plan_.actions[action].at) : std::string("the end")) +
               " on: " + differs);
          expectation_.reset();
          return true;
        }
        sleep_until(now_ns() + slice_ns);
      }
    }
    return true;
  }

  bool fail(std::string why) {
    if (problem_.empty()) problem_ = std::move(why);
    return false;
  }
  bool is_stopped() {
    result_.interrupted =
        result_.interrupted || (settings_.stop_requested != nullptr && settings_.stop_requested(settings_.context));
    return result_.interrupted;
  }

  bool check_nodes() {
    for (LiveNode& node : nodes_) {
      if (!node.child || node.child->is_running()) continue;
      std::ifstream errors(node.errors);
      std::string said((std::istreambuf_iterator<char>(errors)), {});
      return fail("node " + node.name + " has ended: " + said);
    }
    const std::string failed = applications_ ? applications_->failure() : "";
    return failed.empty() || fail(failed);
  }

  /// Until each node has heard its peers: a bridge takes a second before it forwards.
  bool wait_for_nodes() {
    const std::int64_t until = now_ns() + std::int64_t{start_timeout_ms} * 1'000'000;
    for (LiveNode& node : nodes_) {
      std::string not_yet;
      while (!has_heard_all(node.socket, not_yet)) {
        if (is_stopped() || !check_nodes()) return false;
        if (now_ns() > until) return fail("node " + node.name + " does not start: " + not_yet);
        sleep_until(now_ns() + slice_ns);
      }
    }
    return true;
  }

  /// Until `ns`, unless something happens.
  bool wait_until(std::int64_t ns) {
    while (now_ns() < ns) {
      sleep_until(std::min(ns, now_ns() + slice_ns));
      if (is_stopped() || !check_nodes()) return false;
    }
    return true;
  }

  /// Until the nodes are as far as the simulated run before `at`. When they have not come there for so long they will
  /// not, and the comparison says so.
  bool wait_for_pace(sim::Duration at) {
    const std::int64_t until = now_ns() + settings_.patience_ns;
    for (;; sleep_until(now_ns() + slice_ns)) {
      if (is_stopped() || !check_nodes()) return false;
      std::vector<LoggedStep> steps;
      for (const LiveNode& node : nodes_)
        if (!is_apart_ && !read_log(node, steps)) return false;
      if (is_apart_ || (pace_->is_reached(histories_of(steps, resolved_.programs.size()), at) &&
                        (!has_restarted_ || is_everybody_known()))) {
        has_restarted_ = false;
        return true;
      }
      if (now_ns() < until) continue;
      is_apart_ = true;
      return note(fmt::format(
          "not all nodes are where they were in the simulated run at {} ms; they are not waited for any more",
          at.ps() / 1'000'000'000));
    }
  }

  /// Whether nodes have heard the present lives of each other. A start that comes before is halted by a restart that is
  /// heard after it.
  bool is_everybody_known() {
    std::map<std::pair<std::string, std::string>, std::string> incarnations;  // by Program and participant
    std::vector<json::Document> answers;
    for (const LiveNode& node : nodes_) {
      if (!node.child) continue;
      std::string problem;
      json::Diagnostics diagnostics;
      const auto status = node::ask_node(node.socket, "status", problem);
      auto document = status ? json::parse(*status, "status", diagnostics) : std::nullopt;
      if (!document) return false;
      for_each_program(document->root(), [&](const json::Node& program) {
        incarnations[{text_of(program, "program"), node.name}] = text_of(program, "incarnation");
      });
      answers.push_back(std::move(*document));
    }
    bool are_known = true;
    for (const json::Document& answer : answers)
      for_each_program(answer.root(), [&](const json::Node& program) {
        const json::Node* const peers = program.find("peers");
        for (std::size_t p = 0; peers != nullptr && p < peers->items.size(); ++p) {
          const auto living = incarnations.find({text_of(program, "program"), text_of(peers->items[p], "name")});
          are_known =
              are_known && (living == incarnations.end() || living->second == text_of(peers->items[p], "incarnation"));
        }
      });
    return are_known;
  }

  bool run_script() {
    std::int64_t begin = now_ns();
    for (std::size_t a = 0; a < plan_.actions.size(); ++a) {
      const sim::Duration at = plan_.actions[a].at;
      if (!wait_for_time(begin, at, a)) return false;
      if (!std::visit([&](const auto& what) { return act(what, at); }, plan_.actions[a].what)) return false;
    }
    return wait_for_time(begin, resolved_.scenario.duration, plan_.actions.size());
  }

  /// Not before the time of an action, and not before the nodes are where the simulated run was. With roles, what had
  /// to be waited for puts off all that follows.
  bool wait_for_time(std::int64_t& begin, sim::Duration at, std::size_t action) {
    const std::int64_t due = begin + at.ps() / 1000;
    if (!wait_until(due)) return false;
    if (!has_roles_) return wait_for_pace(at);
    if (!settle(action)) return false;
    begin += std::max<std::int64_t>(0, now_ns() - due);
    return true;
  }

  /// What was Good in the simulated run may be refused here at first: a slave suspends only when it has heard that its
  /// master runs.
  bool act(const CallAction& call, sim::Duration at) {
    const std::string method(program::name_of(call.method));
    if (call.role) return act_on_role(call, method);
    const PlannedNode::Part& part = nodes_[call.node].plan->parts[call.part];
    const bool is_expected =
        !has_roles_ && !is_apart_ && pace_->is_good(part.program, part.participant, call.method, at);
    const std::int64_t until = now_ns() + settings_.patience_ns;
    for (bool is_last = !is_expected;; is_last = now_ns() >= until) {
      std::string refusal;
      if (!ask(nodes_[call.node], method, call.part, refusal)) return false;
      if (refusal.empty()) return true;
      if (is_last) return note(refusal);
      sleep_until(now_ns() + slice_ns);
      if (is_stopped() || !check_nodes()) return false;
    }
  }

  /// At whoever has the role by the master's word.
  bool act_on_role(const CallAction& call, const std::string& method) {
    const std::uint32_t program = plan_.nodes[call.node].parts[call.part].program;
    const auto group = group_state(program, true);
    LiveNode* const node = group ? node_called(program, group->nodes[*call.role]) : nullptr;
    if (node == nullptr)
      return note(method + " on " + resolved_.programs[program].participant_names[*call.role + std::size_t{1}] +
                  ": nobody has the role");
    return ask_once(*node, method);
  }

  bool ask_once(LiveNode& node, const std::string& method) {
    std::string refusal;
    if (!ask(node, method, 0, refusal)) return false;
    return refusal.empty() || note(refusal);
  }

  /// False if the node does not answer. What it says if that is not Good, or that it is dead, is `refusal`.
  bool ask(LiveNode& node, const std::string& method, std::uint32_t part, std::string& refusal) {
    if (!node.child) {
      refusal = method + " on " + node.name + " falls into its crash";
      return true;
    }
    std::string request = method;
    std::transform(request.begin(), request.end(), request.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (node.plan->parts.size() > 1) request += ' ' + resolved_.programs[node.plan->parts[part].program].name;
    std::string problem;
    const auto answer = node::ask_node(node.socket, request, problem);
    if (!answer) return fail(method + " on " + node.name + ": " + problem);
    json::Diagnostics diagnostics;
    const auto document = json::parse(*answer, "answer", diagnostics);
    const std::string status = document ? text_of(document->root(), "status") : *answer;
    if (status != "Good") refusal = method + " on " + node.name + ": " + status;
    return true;
  }
  bool act(const MembershipAction& change, sim::Duration) {
    LiveNode& node = nodes_[change.node];
    node.is_absent = !change.joins;
    return ask_once(node, change.joins ? "Join" : "Leave");
  }
  bool act(const LinkAction& change, sim::Duration) {
    const std::string failed = machine_->set_cable(change.cable, change.up);
    return failed.empty() || fail(failed);
  }
  bool act(const HostAction& change, sim::Duration) {
    for (LiveNode& node : nodes_) {
      if (node.plan->host != change.host) continue;
      if (change.up) {
        start(node, true);
        has_restarted_ = true;
      }
      if (!change.up) node.child.reset();
    }
    if (applications_) applications_->set_host(change.host, change.up);
    return true;
  }
  bool note(std::string text) {
    result_.notes.push_back(std::move(text));
    return true;
  }

  void stop() {
    if (applications_) applications_->stop(result_.interrupted || !problem_.empty());
    for (LiveNode& node : nodes_)
      if (node.child) node.child->send(SIGTERM);
    for (LiveNode& node : nodes_)
      if (node.child) node.child->wait(stop_timeout_ms);
    if (applications_) applications_->wait();
  }

  void keep_files() {
    if (settings_.keep.empty()) return;
    std::error_code error;
    fs::create_directories(settings_.keep, error);
    std::vector<std::string> files = applications_ ? applications_->files() : std::vector<std::string>();
    for (const LiveNode& node : nodes_) files.insert(files.end(), {node.file, node.log, node.errors});
    for (const std::string& file : files)
      fs::copy_file(file, fs::path(settings_.keep) / fs::path(file).filename(), fs::copy_options::overwrite_existing,
                    error);
    if (error) note(settings_.keep + ": " + error.message());
  }

  bool collect() {
    for (const LiveNode& node : nodes_)
      if (!collect_log(node)) return false;
    RoleSteps roles = steps_of_roles(resolved_, std::move(steps_));
    const std::vector<History> emulated = histories_of(roles.steps, resolved_.programs.size());
    result_.invariants = check_invariants(resolved_, std::move(roles.steps));
    for (std::size_t p = 0; p < resolved_.programs.size(); ++p) {
      const scenario::ResolvedProgram& program = resolved_.programs[p];
      result_.programs.push_back({program.name, compare(simulated_[p], emulated[p], program.participant_names)});
      for (std::size_t role = 0; role < program.description->roles.size(); ++role)
        result_.programs.back().roles.push_back(
            {program.participant_names[role + 1], nodes_with(p, role), roles.histories[p][role].nodes});
    }
    return collect_applications();
  }

  bool collect_applications() {
    EmulatedThreads emulated;
    std::vector<bool> is_whole;
    if (const std::string failed = applications_->collect(emulated, is_whole); !failed.empty()) return fail(failed);
    result_.applications = compare_applications(resolved_, simulated_threads_, emulated, is_whole);
    return true;
  }

  std::vector<std::string> nodes_with(std::size_t program, std::size_t role) const {
    std::vector<std::string> names;
    for (const scenario::BindingRecord& record : simulation_->roles(program)->history())
      if (record.role == role)
        names.push_back(
            record.candidate
                ? resolved_.topology.nodes[resolved_.programs[program].candidates()[*record.candidate].node.value].name
                : std::string());
    return names;
  }

  /// Appends what the node has logged so far; a line that it has not written to its end yet comes later. Its status is
  /// returned in `end`, if it is asked for.
  bool read_log(const LiveNode& node, std::vector<LoggedStep>& steps, std::string* end = nullptr) {
    std::ifstream log(node.log);
    LogReader reader(resolved_, *node.plan);
    for (std::string line; std::getline(log, line) && !log.eof();)
      if (!reader.take(line)) return fail("the log of " + node.name + " cannot be read: " + line);
    for (LoggedStep& step : reader.finish()) steps.push_back(step);
    if (end != nullptr) *end = reader.status();
    return true;
  }
  bool collect_log(const LiveNode& node) {
    std::string status;
    if (!read_log(node, steps_, &status)) return false;
    result_.nodes.push_back({node.name, std::move(status)});
    return true;
  }

  const scenario::Resolved& resolved_;
  const Plan& plan_;
  const Settings& settings_;
  Result& result_;
  std::string& problem_;
  std::unique_ptr<Machine> machine_;
  std::unique_ptr<scenario::Run> simulation_;
  std::vector<History> simulated_;  // by program
  std::optional<Pace> pace_;
  bool has_restarted_ = false;              // and it is not sure that all have heard of it
  bool is_apart_ = false;                   // the nodes went another way than the simulated run
  std::optional<Expectation> expectation_;  // nothing without roles, or once it has been missed
  bool has_roles_ = false;
  std::vector<LoggedStep> steps_;
  std::vector<std::vector<ThreadCounts>> simulated_threads_;  // by application
  std::deque<LiveNode> nodes_;                                // behind machine_, so that they end before it goes
  std::unique_ptr<ApplicationProcesses> applications_;
};

}  // namespace

bool ProgramResult::is_same() const {
  return comparison.is_same() && std::all_of(roles.begin(), roles.end(),
                                             [](const RoleResult& each) { return each.simulated == each.emulated; });
}

bool Result::is_same() const {
  return std::all_of(programs.begin(), programs.end(), [](const ProgramResult& each) { return each.is_same(); }) &&
         invariants.violated.empty() &&
         std::ranges::all_of(applications, [](const ApplicationComparison& each) { return each.is_same(); });
}

bool emulate(const scenario::Resolved& resolved, const Plan& plan, const Settings& settings, Result& result,
             std::string& problem) {
  result.notes = plan.notes;
  return Emulation(resolved, plan, settings, result, problem).run();
}

}  // namespace takt::emulate
