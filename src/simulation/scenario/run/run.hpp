// SPDX-License-Identifier: Apache-2.0
// A live run of a resolved scenario: network, Programs, script. One object; several can live side by side.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "models/network.hpp"
#include "scenario/applications/topic_application.hpp"
#include "scenario/programs/observations.hpp"
#include "scenario/programs/program_application.hpp"
#include "scenario/programs/program_monitor.hpp"
#include "scenario/resolved/resolved.hpp"
#include "scenario/run/clock_monitor.hpp"
#include "scenario/run/cpu_monitor.hpp"
#include "sim/simulation.hpp"

namespace takt::scenario {

class Run {
 public:
  /// Everything is built and scheduled; nothing has happened yet. `resolved` outlives the run. Of a share only its
  /// nodes act (DividedRun); Programs and applications act in part 0, and there is no gPTP.
  explicit Run(const Resolved& resolved, std::uint64_t tie_shuffle = 0, models::Share share = {});
  ~Run();
  Run(const Run&) = delete;
  Run& operator=(const Run&) = delete;

  const Resolved& resolved() const { return *resolved_; }
  /// From which figures are kept: see account_instants().
  const std::vector<Duration>& instants() const { return instants_; }
  sim::Simulation& simulation() { return simulation_; }
  const sim::Simulation& simulation() const { return simulation_; }
  const models::Network& network() const { return network_; }
  models::Network& network() { return network_; }
  /// At the end of a divided run, once: what has happened in the other parts, which stay as they are and outlive this
  /// one, has happened here. Precondition: this is part 0.
  void adopt(std::span<const Run* const> others);
  /// Hands all that happens from now on to the sink: also the ways of frames, so that explanations can be made of it.
  /// Null: to nobody.
  void explain_to(sim::TraceSink* sink) {
    simulation_.set_trace(sink);
    if (sink != nullptr) network_.trace_paths();
  }
  /// Of trees of nested programs.
  const std::vector<std::unique_ptr<TreeMonitor>>& trees() const { return trees_; }
  const ProgramMonitor& monitor(std::size_t program) const { return *programs_[program]->monitor; }
  /// Null where nothing takes time of a processor.
  const CpuMonitor* cpu_monitor(models::NodeIndex node) const {
    for (const Run* const other : adopted_)
      if (other->network_.has(node)) return other->cpu_monitors_[node.value].get();
    return cpu_monitors_[node.value].get();
  }
  /// Null where nobody looks at clocks: see look_every().
  const ClockMonitor* clocks() const { return clock_monitor_.get(); }
  /// Takes the series of clock offsets from now on. Precondition: there is gPTP.
  void set_clock_sink(ClockSampleSink* sink) { clock_monitor_->set_sink(sink); }
  handshake::PublishedState state(std::size_t program, std::size_t participant) const {
    const LiveProgram& live = *programs_[program];
    return live.roles && participant != 0 ? live.roles->state(participant - 1)
                                          : live.members[participant].application->node().state();
  }
  /// What a thread of an application has done so far.
  ThreadFigures thread(std::size_t application, std::size_t thread, sim::Duration from) const;
  const TopicApplication& application(std::size_t number) const { return *applications_[number]; }
  const DigitalOutput& signal(std::size_t number) const { return application_monitor_->signal(number); }
  /// Null for a program without roles.
  const RoleMonitor* roles(std::size_t program) const { return programs_[program]->roles.get(); }
  /// Of the master of a program with roles.
  const handshake::Binder& binder(std::size_t program) const {
    return *programs_[program]->members[0].application->node().binder();
  }

  sim::TrueTime end() const { return sim::TrueTime() + resolved_->scenario.duration; }
  /// Goes on for at most about `max_events` events. True when the scenario's duration is over.
  bool advance(std::uint64_t max_events = ~0ULL) { return simulation_.run(end(), max_events); }

 private:
  /// A node that is, or may be, a participant.
  struct LiveMember {
    models::Process* process = nullptr;
    ProgramApplication* application = nullptr;
  };
  struct LiveProgram {
    std::unique_ptr<ProgramMonitor> monitor;
    std::unique_ptr<RoleMonitor> roles;  // only with roles
    std::vector<LiveMember> members;     // by participant; with roles the master and the candidates
    /// Who is that participant now; null if nobody.
    const LiveMember* who_is(std::size_t participant) const;
  };
  class Script;

  void add_program(std::uint32_t number, const ResolvedProgram& program);
  void nest_programs();
  void add_ports(std::uint32_t number, const ResolvedApplication& application,
                 TopicApplication::Settings& settings) const;
  void add_application(std::uint32_t number, const ResolvedApplication& application);
  void crash_programs(models::NodeIndex node);
  void connect_streams(const ResolvedProgram& program, const LiveProgram& live);

  const Resolved* resolved_;
  std::vector<Duration> instants_;  // from which accounts are kept
  sim::Simulation simulation_;
  models::Network network_;
  Observations observations_;
  std::vector<std::unique_ptr<LiveProgram>> programs_;
  std::unique_ptr<ApplicationMonitor> application_monitor_;
  std::vector<TopicApplication*> applications_;
  std::vector<std::unique_ptr<wire::Nesting>> nestings_;
  std::vector<std::unique_ptr<TreeMonitor>> trees_;
  std::unique_ptr<Script> script_;
  std::unique_ptr<ClockMonitor> clock_monitor_;
  std::vector<std::unique_ptr<CpuMonitor>> cpu_monitors_;  // by node; null where there is no processor
  std::vector<const Run*> adopted_;
};

}  // namespace takt::scenario
