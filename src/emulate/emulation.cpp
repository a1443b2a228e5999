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

#include "emulate/child.hpp"
#include "emulate/log_reader.hpp"
#include "emulate/machine.hpp"
#include "emulate/pace.hpp"
#include "node/control_socket.hpp"
#include "scenario/json/document.hpp"
#include "scenario/run/run.hpp"

namespace takt::emulate {
namespace {

namespace json = scenario::json;
namespace fs = std::filesystem;

constexpr int start_timeout_ms = 20'000;
constexpr int stop_timeout_ms = 5'000;
constexpr std::int64_t slice_ns = 20'000'000;  // of waiting, between two looks at signals and nodes

std::int64_t now_ns() {
  timespec time = {};
  ::clock_gettime(CLOCK_MONOTONIC, &time);
  return static_cast<std::int64_t>(time.tv_sec) * 1'000'000'000 + time.tv_nsec;
}

void sleep_until(std::int64_t ns) {
  const timespec time = {static_cast<time_t>(ns / 1'000'000'000), static_cast<long>(ns % 1'000'000'000)};
  ::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &time, nullptr);
}

std::string own_executable() {
  std::error_code error;
  return fs::read_symlink("/proc/self/exe", error).string();
}

std::string text_of(const json::Node& object, std::string_view key) {
  const json::Node* const node = object.find(key);
  return node == nullptr ? std::string() : node->text;
}

/// One node and what it does.
struct LiveNode {
  const PlannedNode* plan = nullptr;
  std::string name;  ///< of the participants
  std::string file;
  std::string log;
  std::string errors;
  std::string socket;
  std::unique_ptr<Child> child;  ///< null while its host is down
};

class Emulation {
 public:
  Emulation(const scenario::Resolved& resolved, const Plan& plan, const Settings& settings, Result& result, std::string& problem)
      : resolved_(resolved), plan_(plan), settings_(settings), result_(result), problem_(problem) {}

  bool run() {
    simulate();
    machine_ = Machine::lay(plan_, problem_);
    if (!machine_) return false;
    write_files();
    for (LiveNode& node : nodes_) start(node, false);
    const bool done = wait_for_nodes() && run_script();
    stop();
    keep_files();
    return done && collect();
  }

 private:
  void simulate() {
    scenario::Run simulation(resolved_);
    simulation.advance();
    for (std::size_t p = 0; p < resolved_.programs.size(); ++p) simulated_.push_back(history_of(simulation.monitor(p)));
    pace_.emplace(simulated_);
  }

  void write_files() {
    for (const PlannedNode& planned : plan_.nodes) {
      LiveNode& node = nodes_.emplace_back();
      const std::string path = machine_->folder() + "/" + planned.name;
      node.plan = &planned;
      node.name = resolved_.programs[planned.parts.front().program].participant_names[planned.parts.front().participant];
      node.file = path + ".json";
      node.log = path + ".jsonl";
      node.errors = path + ".err";
      node.socket = path + ".sock";
      std::string config = planned.config;
      config.replace(config.find(control_mark), std::string(control_mark).size(), node.socket);
      std::ofstream(node.file) << config;
    }
  }

  void start(LiveNode& node, bool again) {
    Child::Settings settings;
    settings.command = {own_executable(), "node", node.file};
    settings.network_namespace = machine_->namespace_of(node.plan->host);
    settings.output = node.log;
    settings.errors = node.errors;
    settings.append = again;
    node.child = std::make_unique<Child>(settings);
  }

  bool fail(std::string why) {
    if (problem_.empty()) problem_ = std::move(why);
    return false;
  }
  bool is_stopped() {
    result_.interrupted = result_.interrupted || (settings_.stop_requested != nullptr && settings_.stop_requested(settings_.context));
    return result_.interrupted;
  }

  bool check_nodes() {
    for (LiveNode& node : nodes_) {
      if (!node.child || node.child->is_running()) continue;
      std::ifstream errors(node.errors);
      std::string said((std::istreambuf_iterator<char>(errors)), {});
      return fail("node " + node.name + " has ended: " + said);
    }
    return true;
  }

  /// Until each node has heard its peers: a bridge takes a second before it forwards.
  bool wait_for_nodes() {
    const std::int64_t until = now_ns() + std::int64_t{start_timeout_ms} * 1'000'000;
    for (LiveNode& node : nodes_) {
      std::string not_yet;
      while (!has_heard_all(node, not_yet)) {
        if (is_stopped() || !check_nodes()) return false;
        if (now_ns() > until) return fail("node " + node.name + " does not start: " + not_yet);
        sleep_until(now_ns() + slice_ns);
      }
    }
    return true;
  }

  static bool has_heard_all(const LiveNode& node, std::string& not_yet) {
    const auto status = node::ask_node(node.socket, "status", not_yet);
    if (!status) return false;
    json::Diagnostics diagnostics;
    const auto document = json::parse(*status, "status", diagnostics);
    if (!document) return false;
    const json::Node* const programs = document->root().find("programs");
    if (programs == nullptr) return has_heard_all_of(document->root(), not_yet);
    return std::all_of(programs->items.begin(), programs->items.end(), [&](const json::Node& program) { return has_heard_all_of(program, not_yet); });
  }

  static bool has_heard_all_of(const json::Node& program, std::string& not_yet) {
    const json::Node* const peers = program.find("peers");
    if (peers == nullptr) return false;
    for (const json::Node& peer : peers->items) {
      if (!text_of(peer, "state").empty()) continue;
      not_yet = "it does not hear " + text_of(peer, "name");
      return false;
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

  /// Until the nodes are as far as the simulated run before `at`. When they have not come there for so long they will not, and the comparison says so.
  bool wait_for_pace(sim::Duration at) {
    const std::int64_t until = now_ns() + settings_.patience_ns;
    for (;; sleep_until(now_ns() + slice_ns)) {
      if (is_stopped() || !check_nodes()) return false;
      std::vector<LoggedStep> steps;
      for (const LiveNode& node : nodes_)
        if (is_apart_ || !read_log(node, steps)) break;
      if (is_apart_ || (pace_->is_reached(histories_of(steps, resolved_.programs.size()), at) && (!has_restarted_ || is_everybody_known()))) {
        has_restarted_ = false;
        return true;
      }
      if (now_ns() < until) continue;
      is_apart_ = true;
      return note(fmt::format("not all nodes are where they were in the simulated run at {} ms; they are not waited for any more", at.ps() / 1'000'000'000));
    }
  }

  /// Whether nodes have heard the present lives of each other. A start that comes before is halted by a restart that is heard after it.
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
      for_each_program(document->root(), [&](const json::Node& program) { incarnations[{text_of(program, "program"), node.name}] = text_of(program, "incarnation"); });
      answers.push_back(std::move(*document));
    }
    bool are_known = true;
    for (const json::Document& answer : answers)
      for_each_program(answer.root(), [&](const json::Node& program) {
        const json::Node* const peers = program.find("peers");
        for (std::size_t p = 0; peers != nullptr && p < peers->items.size(); ++p) {
          const auto living = incarnations.find({text_of(program, "program"), text_of(peers->items[p], "name")});
          are_known = are_known && (living == incarnations.end() || living->second == text_of(peers->items[p], "incarnation"));
        }
      });
    return are_known;
  }
  template <class Visit>
  static void for_each_program(const json::Node& status, const Visit& visit) {
    const json::Node* const programs = status.find("programs");
    if (programs == nullptr) return visit(status);
    for (const json::Node& program : programs->items) visit(program);
  }

  bool run_script() {
    const std::int64_t begin = now_ns();
    for (const Action& action : plan_.actions) {
      if (!wait_until(begin + action.at.ps() / 1000) || !wait_for_pace(action.at)) return false;
      if (!std::visit([&](const auto& what) { return act(what, action.at); }, action.what)) return false;
    }
    const sim::Duration end = resolved_.scenario.duration;
    return wait_until(begin + end.ps() / 1000) && wait_for_pace(end);
  }

  /// What was Good in the simulated run may be refused here at first: a slave suspends only when it has heard that its master runs.
  bool act(const CallAction& call, sim::Duration at) {
    const PlannedNode::Part& part = nodes_[call.node].plan->parts[call.part];
    const bool is_expected = !is_apart_ && pace_->is_good(part.program, part.participant, call.method, at);
    const std::int64_t until = now_ns() + settings_.patience_ns;
    for (bool is_last = !is_expected;; is_last = now_ns() >= until) {
      std::string refusal;
      if (!ask(call, refusal)) return false;
      if (refusal.empty()) return true;
      if (is_last) return note(refusal);
      sleep_until(now_ns() + slice_ns);
      if (is_stopped() || !check_nodes()) return false;
    }
  }

  bool ask(const CallAction& call, std::string& refusal) {
    LiveNode& node = nodes_[call.node];
    std::string method(program::name_of(call.method));
    if (!node.child) {
      refusal = method + " on " + node.name + " falls into its crash";
      return true;
    }
    std::string request = method;
    std::transform(request.begin(), request.end(), request.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (node.plan->parts.size() > 1) request += ' ' + resolved_.programs[node.plan->parts[call.part].program].name;
    std::string problem;
    const auto answer = node::ask_node(node.socket, request, problem);
    if (!answer) return fail(method + " on " + node.name + ": " + problem);
    json::Diagnostics diagnostics;
    const auto document = json::parse(*answer, "answer", diagnostics);
    const std::string status = document ? text_of(document->root(), "status") : *answer;
    if (status != "Good") refusal = method + " on " + node.name + ": " + status;
    return true;
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
    return true;
  }
  bool note(std::string text) {
    result_.notes.push_back(std::move(text));
    return true;
  }

  void stop() {
    for (LiveNode& node : nodes_)
      if (node.child) node.child->send(SIGTERM);
    for (LiveNode& node : nodes_)
      if (node.child) node.child->wait(stop_timeout_ms);
  }

  void keep_files() {
    if (settings_.keep.empty()) return;
    std::error_code error;
    fs::create_directories(settings_.keep, error);
    for (const LiveNode& node : nodes_)
      for (const std::string& file : {node.file, node.log, node.errors})
        fs::copy_file(file, fs::path(settings_.keep) / fs::path(file).filename(), fs::copy_options::overwrite_existing, error);
    if (error) note(settings_.keep + ": " + error.message());
  }

  bool collect() {
    for (const LiveNode& node : nodes_)
      if (!collect_log(node)) return false;
    const std::vector<History> emulated = histories_of(steps_, resolved_.programs.size());
    result_.invariants = check_invariants(resolved_, steps_);
    for (std::size_t p = 0; p < resolved_.programs.size(); ++p) {
      const scenario::Program& program = *resolved_.programs[p].description;
      std::vector<std::string> names = {program.master};
      names.insert(names.end(), program.slaves.begin(), program.slaves.end());
      result_.programs.push_back({program.name, compare(simulated_[p], emulated[p], names)});
    }
    return true;
  }

  static History history_of(const scenario::ProgramMonitor& monitor) {
    History history;
    for (const scenario::StateRecord& record : monitor.history()) history.changes.push_back({record.time.ps(), record.participant, record.change});
    for (const scenario::CallRecord& call : monitor.calls())
      if (program::is_good(call.status)) history.calls.push_back({call.time.ps(), call.participant, call.method});
    return history;
  }

  /// Appends what the node has logged so far. Its status is returned in `end`, if it is asked for.
  bool read_log(const LiveNode& node, std::vector<LoggedStep>& steps, std::string* end = nullptr) {
    std::ifstream log(node.log);
    LogReader reader(resolved_, *node.plan);
    for (std::string line; std::getline(log, line);)
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
  std::vector<History> simulated_;  // by program
  std::optional<Pace> pace_;
  bool has_restarted_ = false;  // and it is not sure that all have heard of it
  bool is_apart_ = false;  // the nodes went another way than the simulated run
  std::vector<LoggedStep> steps_;
  std::deque<LiveNode> nodes_;  // behind machine_, so that they end before it goes
};

}  // namespace

bool Result::is_same() const {
  return std::all_of(programs.begin(), programs.end(), [](const ProgramResult& each) { return each.comparison.is_same(); }) && invariants.violated.empty();
}

bool emulate(const scenario::Resolved& resolved, const Plan& plan, const Settings& settings, Result& result, std::string& problem) {
  result.notes = plan.notes;
  return Emulation(resolved, plan, settings, result, problem).run();
}

}  // namespace takt::emulate
