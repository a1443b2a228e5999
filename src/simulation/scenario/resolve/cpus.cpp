// SPDX-License-Identifier: Apache-2.0
#include "scenario/resolve/cpus.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "json/suggest.hpp"
#include "scenario/resolve/known_names.hpp"
#include "scenario/resolve/os_profiles.hpp"

namespace takt::scenario {
namespace {

/// The processor of one host.
class CpuResolver {
 public:
  CpuResolver(Resolved& resolved, std::uint32_t node, const Cpu& cpu, json::Diagnostics& diagnostics)
      : r_(resolved), node_(node), cpu_(cpu), diagnostics_(diagnostics) {}

  void run() {
    const std::size_t errors_before = diagnostics_.errors();
    plan_.cores = cpu_.cores;
    plan_.switching = cpu_.switching;
    plan_.slice = cpu_.slice;
    if (r_.topology.neighbours[node_].empty())
      diagnostics_.error_unless(diagnostics_.has_errors(), cpu_.where.place(), "the processor of a host without a link",
                                {json::quote(r_.topology.nodes[node_].name) + " alone", "a link"});
    collect();
    for (std::uint32_t t = 0; t < cpu_.threads.size(); ++t) add(t);
    if (diagnostics_.errors() != errors_before || diagnostics_.is_refused(cpu_.where.at("threads"))) return;
    enter();
    r_.plan.nodes[node_].cpu = std::make_shared<const models::CpuPlan>(std::move(plan_));
  }

 private:
  /// What can run here, by the name that files give it.
  struct Runnable {
    std::optional<std::uint32_t> thread = {};  ///< on which it runs
    ResolvedMember* member = nullptr;
    ResolvedApplication* application = nullptr;
    ResolvedThread* one_thread = nullptr;  ///< of an application
  };

  void collect() {
    for (ResolvedProgram& program : r_.programs)
      for (ResolvedMember& member : program.members)
        if (member.node.value == node_) offer(program.name).member = &member;
    for (ResolvedApplication& application : r_.applications) {
      if (application.node.value != node_) continue;
      offer(application.name).application = &application;
      for (ResolvedThread& thread : application.threads)
        offer(application.name + "/" + thread.name).one_thread = &thread;
    }
  }
  Runnable& offer(const std::string& name) {
    if (runnables_.contains(name)) ambiguous_.insert(name);
    return runnables_[name];
  }

  void add(std::uint32_t number) {
    const CpuThread& said = cpu_.threads[number];
    models::CpuThreadPlan thread;
    thread.name = said.name;
    thread.policy = static_cast<models::SchedulingPolicy>(said.policy);
    thread.priority = said.priority.value_or(1);
    thread.deadline = said.deadline;
    thread.weight = said.weight.value_or(1024);
    thread.core = said.core;
    thread.execution = distribution_of(said.execution, diagnostics_);
    thread.non_preemptive = said.non_preemptive;
    if (said.wake_up) thread.wake_up = distribution_of(*said.wake_up, diagnostics_);
    if (said.every) thread.load = models::CpuThreadPlan::Load{*said.every, said.offset.value_or(Duration())};
    check(said, thread);
    for (std::size_t i = 0; i < said.runs.size(); ++i) run_on(number, said.runs[i], said.where.at("runs", i));
    for (std::size_t i = 0; i < said.stack.size(); ++i) stack_on(number, said.stack[i], said.where.at("stack", i));
    plan_.threads.push_back(std::move(thread));
  }

  void check(const CpuThread& said, const models::CpuThreadPlan& thread) {
    const auto error = [&](std::string_view key, const char* what, json::Details details) {
      diagnostics_.error(said.where.at(key), what, std::move(details));
    };
    if (!said.name.empty() && !names_.insert(said.name).second)
      error("name", "duplicate name",
            {json::quote(said.name) + " a second time", "a name of its own for each thread of a host"});
    if (said.name.find('/') != std::string::npos)
      error("name", "not a name for a thread", {json::quote(said.name), "no '/'"});
    if (!diagnostics_.is_refused(said.where.at("policy"))) {
      if (said.policy == SchedulingPolicy::deadline && !said.deadline)
        diagnostics_.error(said.where.place(), "missing key", {"policy \"deadline\" alone", "\"deadline\""});
      if (said.policy != SchedulingPolicy::fifo && said.priority)
        error("priority", "does not belong to this policy", {"\"priority\"", "\"policy\": \"fifo\""});
      if (said.policy != SchedulingPolicy::fair && said.weight)
        error("weight", "does not belong to this policy", {"\"weight\"", "\"policy\": \"fair\""});
    }
    if (said.core && *said.core >= cpu_.cores)
      error("core", "no such core", {std::to_string(*said.core), "0 to " + std::to_string(cpu_.cores - 1)});
    if (!diagnostics_.is_refused(said.where.at("execution")) && thread.execution.greatest() == Duration())
      error("execution", "work that takes no time",
            {json::to_text(thread.execution.greatest()), "more than 0s; what takes no time needs no thread"});
    if (said.offset && !said.every)
      error("offset", "does not belong to this thread",
            {"\"offset\" without \"every\"", "\"every\", the interval of a load"});
    if (said.offset && said.every && *said.offset >= *said.every)
      error("offset", "an offset beyond the interval",
            {json::to_text(*said.offset), "less than " + json::to_text(*said.every)});
    if (said.runs.empty() && said.stack.empty() && !said.every && !diagnostics_.is_refused(said.where.at("runs")) &&
        !diagnostics_.is_refused(said.where.at("stack")) && !diagnostics_.is_refused(said.where.at("every")))
      diagnostics_.error(said.where.place(), "a thread that does nothing",
                         {json::quote(said.name), "\"runs\", \"stack\" or \"every\""});
  }

  void run_on(std::uint32_t thread, const std::string& name, const json::Place& place) {
    const auto found = runnables_.find(name);
    if (found == runnables_.end()) {
      std::vector<std::string_view> known;
      for (const auto& [each, runnable] : runnables_) known.push_back(each);
      // An empty name was refused by the table.
      if (!name.empty())
        diagnostics_.error_unless(may_be_refused(), place, "unknown program",
                                  {json::quote(name),
                                   "a Program, an application, a gateway or an \"APPLICATION/THREAD\" of " +
                                       json::quote(r_.topology.nodes[node_].name),
                                   json::suggest(name, known)});
      return;
    }
    if (ambiguous_.contains(name))
      diagnostics_.error(place, "two of one name",
                         {json::quote(name) + " is a Program and an application of this host", "names that differ"});
    if (found->second.thread)
      diagnostics_.error(place, "on two threads", {json::quote(name) + " a second time", "one thread for it"});
    found->second.thread = thread;
  }

  /// Whether a name may be that of something that was refused.
  bool may_be_refused() const {
    constexpr std::string_view lists[] = {"applications", "gateways", "persistence"};
    return may_be_unread_program(r_.scenario, diagnostics_) || r_.programs.size() < r_.scenario.programs.size() ||
           std::any_of(std::begin(lists), std::end(lists),
                       [&](std::string_view list) { return diagnostics_.is_refused(r_.scenario.where.at(list)); });
  }

  void stack_on(std::uint32_t thread, StackPart part, const json::Place& place) {
    std::optional<std::uint32_t>& of = part == StackPart::receive    ? plan_.receive
                                       : part == StackPart::transmit ? plan_.transmit
                                                                     : plan_.gptp;
    const std::string name(spelling(part));
    if (of) diagnostics_.error(place, "on two threads", {json::quote(name) + " a second time", "one thread for it"});
    if (part == StackPart::gptp && !r_.scenario.clocks.gptp)
      diagnostics_.error_unless(diagnostics_.is_refused(r_.scenario.where.at("clocks")), place,
                                "a part of what is not there", {"\"gptp\"", "\"gptp\" in \"clocks\""});
    of = thread;
  }

  void enter() {
    for (auto& [name, runnable] : runnables_) {
      if (!runnable.thread) continue;
      if (runnable.member != nullptr) runnable.member->cpu_thread = runnable.thread;
      if (runnable.application == nullptr) continue;
      runnable.application->cpu_thread = runnable.thread;
      for (ResolvedThread& thread : runnable.application->threads) thread.cpu_thread = runnable.thread;
    }
    // Threads that are named apart.
    for (auto& [name, runnable] : runnables_)
      if (runnable.thread && runnable.one_thread != nullptr) runnable.one_thread->cpu_thread = runnable.thread;
    for (std::size_t a = 0; a < r_.applications.size(); ++a)
      for (std::size_t t = 0; r_.applications[a].node.value == node_ && t < r_.applications[a].threads.size(); ++t) {
        ResolvedThread& thread = r_.applications[a].threads[t];
        if (thread.cpu_thread && plan_.threads[*thread.cpu_thread].wake_up && !has_response(a, t))
          thread.response = *plan_.threads[*thread.cpu_thread].wake_up;
      }
  }

  /// Whether the file says how a thread of an application responds.
  bool has_response(std::size_t application, std::size_t thread) const {
    const Scenario& scenario = r_.scenario;
    if (application < scenario.applications.size())
      return scenario.applications[application].threads[thread].response.has_value();
    application -= scenario.applications.size();
    if (application >= scenario.gateways.size()) return true;
    return (thread == 0 ? scenario.gateways[application].receive_response
                        : scenario.gateways[application].send_response)
        .has_value();
  }

  Resolved& r_;
  std::uint32_t node_;
  const Cpu& cpu_;
  json::Diagnostics& diagnostics_;
  models::CpuPlan plan_;
  std::map<std::string, Runnable, std::less<>> runnables_;
  std::set<std::string, std::less<>> ambiguous_;
  std::set<std::string, std::less<>> names_;
};

}  // namespace

void resolve_cpus(Resolved& resolved, json::Diagnostics& diagnostics) {
  for (std::uint32_t n = 0; n < resolved.topology.nodes.size(); ++n) {
    const EndStation* const host = end_station_of(resolved.topology.nodes[n].description);
    if (host != nullptr && host->cpu) CpuResolver(resolved, n, *host->cpu, diagnostics).run();
  }
}

}  // namespace takt::scenario
