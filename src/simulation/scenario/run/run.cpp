// SPDX-License-Identifier: Apache-2.0
#include "scenario/run/run.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "plant/protocol.hpp"
#include "scenario/applications/dds_port.hpp"
#include "scenario/applications/gateway_bridge.hpp"
#include "scenario/applications/opc_ua_port.hpp"
#include "scenario/programs/program_shape.hpp"
#include "scenario/resolve/nesting.hpp"
#include "scenario/run/accounts.hpp"
#include "scenario/run/action_content.hpp"

namespace takt::scenario {
namespace {

constexpr std::uint32_t script_action = 120;  // kind of digest record

/// What is no participant from the beginning gets index and incarnation with its role.
wire::NodeSettings node_settings(const ResolvedProgram& program, std::size_t m, const ProgramFormats& formats) {
  const ResolvedMember& member = program.members[m];
  const bool is_candidate = m >= program.participants().size();
  const auto participant = static_cast<std::uint8_t>(is_candidate ? 1 : m);
  wire::NodeSettings node{plant::endpoint_settings(*program.description, participant)};
  node.endpoint.format = formats.program;
  node.endpoint.handshake.incarnation = 1;
  node.endpoint.handshake.nested = program.nested.contains(participant);
  if (!program.replies.empty()) {  // what it answers at once, instead of publishing it every cycle
    node.endpoint.on_demand.assign(program.process_data.size(), false);
    for (const ResolvedReply& reply : program.replies) node.endpoint.on_demand[reply.with] = true;
  }
  if (!program.has_roles()) return node;
  node.roles = wire::RoleSettings{
      formats.roles, program.announce_every, program.description->on_replacement == OnReplacement::restart, {}};
  if (is_candidate)
    node.roles->offer =
        wire::Offer{static_cast<std::uint8_t>(m - 1), 1, plant::skill_ids_of(member.skills), !member.is_absent};
  return node;
}

}  // namespace

/// Calls the methods that the scenario's script asks for, before anything else of their instant. Of a divided run part
/// 0 says that it has happened, and that part does it where the node acts.
class Run::Script final : public sim::Component {
 public:
  Script(Run& run, sim::Simulation& simulation, bool is_first_part)
      : run_(&run), source_(simulation.add(*this)), is_first_part_(is_first_part) {
    const std::vector<ResolvedAction>& actions = run.resolved_->script;
    for (std::size_t i = 0; i < actions.size(); ++i)
      if (is_first_part_ || is_here(actions[i]))
        simulation.schedule(source_, actions[i].at, sim::Phase::control, source_.id(), 0, i);
  }

  void handle(sim::Simulation& simulation, const sim::Event& event) override {
    const ResolvedAction& action = run_->resolved_->script[event.argument];
    if (is_first_part_)
      simulation.digest().add(script_action, action.what.index(), simulation.now(), content_of(action));
    else
      ++repeated_;
    if (is_here(action)) std::visit([this](const auto& what) { act(what); }, action.what);
  }

  /// Events that part 0 has handled, too.
  std::uint64_t repeated() const { return repeated_; }

 private:
  bool is_here(const ResolvedAction& action) const {
    return std::visit([this](const auto& what) { return is_here(what); }, action.what);
  }
  bool is_here(const ResolvedCall&) const { return is_first_part_; }
  bool is_here(const ResolvedMembership&) const { return is_first_part_; }
  bool is_here(const ResolvedLink& change) const {
    return run_->network_.has(run_->resolved_->plan.links[change.link].a.node);
  }
  bool is_here(const ResolvedRoutes&) const { return true; }
  template <class OfNode>
  bool is_here(const OfNode& change) const {
    return run_->network_.has(change.node);
  }

  /// Nobody has the role: refused.
  void act(const ResolvedCall& call) {
    const LiveProgram& live = *run_->programs_[call.program];
    if (const LiveMember* const member = live.who_is(call.participant))
      member->process->call(
          [&](models::Application&, models::HostServices& host) { member->application->call(host, call.method); });
    else
      live.monitor->on_call(call.participant, call.method, program::StatusCode::BadInvalidState);
  }
  void act(const ResolvedMembership& change) {
    const LiveProgram& live = *run_->programs_[change.program];
    if (!change.joins && live.roles->has_role(change.candidate)) live.monitor->on_leave();
    const LiveMember& member = live.members[change.candidate + std::size_t{1}];
    member.process->call([&](models::Application&, models::HostServices& host) {
      change.joins ? member.application->join(host) : member.application->leave(host);
    });
  }
  void act(const ResolvedGates& change) { run_->network_.request_gates(change.node, change.port, change.gates); }
  void act(const ResolvedLink& change) { run_->network_.set_link(change.link, change.up); }
  void act(const ResolvedNode& change) {
    if (!change.up) run_->crash_programs(change.node);
    run_->network_.set_node(change.node, change.up);
  }
  void act(const ResolvedBypass& change) { run_->network_.set_bypass(change.node, change.joins); }
  void act(const ResolvedStuckGate& change) {
    run_->network_.force_gate(change.node, change.port, change.traffic_class, change.open);
  }
  void act(const ResolvedClockFault& fault) {
    if (fault.step) run_->network_.step_clock(fault.node, *fault.step);
    if (fault.offset) run_->network_.set_frequency_offset(fault.node, *fault.offset);
  }
  void act(const ResolvedRoutes& change) {
    for (const ResolvedRoutes::Entry& entry : change.entries)
      run_->network_.reroute(entry.node, entry.vlan, entry.address, entry.ports);
  }

  Run* run_;
  sim::EventSource source_;
  bool is_first_part_;
  std::uint64_t repeated_ = 0;
};

Run::Run(const Resolved& resolved, std::uint64_t tie_shuffle, models::Share share)
    : resolved_(&resolved),
      instants_(account_instants(resolved)),
      simulation_(resolved.scenario.seed),
      network_(simulation_, resolved.plan, share) {
  simulation_.set_tie_shuffle(tie_shuffle);
  for (std::uint32_t i = 0; i < resolved.programs.size(); ++i) add_program(i, resolved.programs[i]);
  nest_programs();
  application_monitor_ = std::make_unique<ApplicationMonitor>(simulation_, resolved.signals, instants_);
  for (std::uint32_t i = 0; i < resolved.applications.size(); ++i) add_application(i, resolved.applications[i]);
  script_ = std::make_unique<Script>(*this, simulation_, share.part == 0);
  if (const std::optional<Duration> every = look_every(resolved)) {
    const std::optional<Gptp>& gptp = resolved.scenario.clocks.gptp;
    clock_monitor_ = std::make_unique<ClockMonitor>(
        simulation_, network_,
        ClockMonitor::Settings{*every, clock_groups(resolved), gptp ? election_time(*gptp) : Duration()}, instants_);
    clock_monitor_->start();
  }
  for (std::uint32_t n = 0; n < resolved.plan.nodes.size(); ++n) {
    models::Cpu* const cpu = network_.cpu(models::NodeIndex{n});
    cpu_monitors_.push_back(cpu != nullptr ? std::make_unique<CpuMonitor>(*cpu, instants_) : nullptr);
  }
  keep_accounts(resolved, network_);
  observations_.watch(simulation_);
  network_.start();
}

Run::~Run() = default;

void Run::adopt(std::span<const Run* const> others) {
  std::vector<const ClockMonitor*> monitors{clock_monitor_.get()};
  for (const Run* const other : others) {
    simulation_.adopt(other->simulation_,
                      other->script_->repeated() + (other->clock_monitor_ ? other->clock_monitor_->looks() : 0));
    network_.adopt(other->network_);
    adopted_.push_back(other);
    monitors.push_back(other->clock_monitor_.get());
  }
  if (clock_monitor_) clock_monitor_->put_together(monitors);
}

auto Run::LiveProgram::who_is(std::size_t participant) const -> const LiveMember* {
  if (!roles || participant == 0) return &members[participant];
  const handshake::Binding& binding = roles->binding(participant - 1);
  return binding.bound() ? &members[binding.candidate + std::size_t{1}] : nullptr;
}

void Run::add_program(std::uint32_t number, const ResolvedProgram& program) {
  auto live = std::make_unique<LiveProgram>();
  const ProgramFormats formats = formats_of(program, resolved_->topology);
  live->monitor = std::make_unique<ProgramMonitor>(simulation_, observations_, number, formats.program->shape().variant,
                                                   program.participant_names.size(), instants_);
  std::vector<std::uint32_t> nodes(program.participant_names.size());
  for (std::size_t p = 0; p < program.participants().size(); ++p) nodes[p] = program.members[p].node.value;
  live->monitor->set_nodes(std::move(nodes));
  live->monitor->set_faults(faults_of(*resolved_, program));
  if (!program.replies.empty()) live->monitor->set_round_trips(program);
  if (program.has_roles()) {
    std::vector<std::uint32_t> candidates;
    for (const ResolvedMember& each : program.candidates()) candidates.push_back(each.node.value);
    const auto state_of = [raw = live.get()](const handshake::Binding& binding) {
      return binding.bound() ? raw->members[binding.candidate + std::size_t{1}].application->state_of(binding.life)
                             : std::nullopt;
    };
    live->roles = std::make_unique<RoleMonitor>(simulation_, observations_, number, *live->monitor,
                                                formats.roles->roles(), std::move(candidates), state_of);
  }
  for (std::size_t m = 0; m < program.members.size(); ++m) {
    const ResolvedMember& member = program.members[m];
    ProgramApplication::Settings settings{
        node_settings(program, m, formats), member.state, member.roles, member.data, {}, {}};
    const std::string path = resolved_->topology.nodes[member.node.value].name + "/" + program.name;
    if (const auto& security = program.description->security) {
      const std::size_t streams = program.members.size() * (2 + program.process_data.size());
      settings.sealed = std::make_unique<SealedMessages>(
          *security, program.name, static_cast<std::uint16_t>(formats.program->shape().first_publisher_id + m),
          streams);
    }
    if (!program.replies.empty())
      settings.replies.emplace(program, static_cast<std::uint8_t>(m), resolved_->scenario.seed, path);
    auto application =
        std::make_unique<ProgramApplication>(std::move(settings), *live->monitor, live->roles.get(), member.node);
    ProgramApplication* const raw = application.get();
    models::Process& process =
        network_.add_process(member.node, program.name, std::move(application), member.cpu_thread);
    process.secure(member.seal, member.open);
    live->members.push_back({&process, raw});
  }
  connect_streams(program, *live);
  programs_.push_back(std::move(live));
}

/// What each thread publishes by, or takes from.
void Run::add_ports(std::uint32_t number, const ResolvedApplication& application,
                    TopicApplication::Settings& settings) const {
  const auto address = [&](std::uint32_t of, std::uint32_t thread) {
    const ResolvedThread& publication = resolved_->applications[of].threads[thread];
    return address_of(resolved_->topics[publication.topic], publication);
  };
  std::map<std::uint32_t, DdsNode*> nodes;
  for (std::uint32_t p = 0; p < resolved_->dds->participants.size(); ++p) {
    if (resolved_->dds->participants[p].application != number) continue;
    std::vector<dds::DurableTopic> keeps;
    for (const ResolvedService::Kept& kept :
         application.service ? application.service->topics : std::vector<ResolvedService::Kept>())
      if (kept.participant == p) keeps.push_back(durable_topic(resolved_->topics[kept.topic], kept));
    settings.nodes.push_back(std::make_unique<DdsNode>(resolved_->dds->participants[p], p, std::move(keeps)));
    nodes[p] = settings.nodes.back().get();
  }
  for (std::uint32_t t = 0; t < application.threads.size(); ++t) {
    const ResolvedThread& thread = application.threads[t];
    const ResolvedTopic& topic = resolved_->topics[thread.topic];
    settings.writers.emplace_back();
    settings.readers.emplace_back();
    if (thread.participant) {
      DdsNode& node = *nodes.at(*thread.participant);
      if (thread.publishes)
        settings.writers.back() = std::make_unique<DdsWriter>(node, topic, thread, t);
      else
        settings.readers.back() = std::make_unique<DdsReader>(node, topic, thread, t);
      continue;
    }
    if (thread.publishes) {
      settings.writers.back() = std::make_unique<OpcUaWriter>(topic.shape, address(number, t), thread.stream);
      continue;
    }
    std::vector<application::OpcUaAddress> heard;
    for (const ResolvedInput& input : thread.inputs) heard.push_back(address(input.application, input.thread));
    settings.readers.back() = std::make_unique<OpcUaReader>(topic.shape, std::move(heard));
  }
}

void Run::add_application(std::uint32_t number, const ResolvedApplication& application) {
  TopicApplication::Settings settings;
  settings.number = number;
  settings.application = &application;
  settings.topics = &resolved_->topics;
  settings.path = resolved_->topology.nodes[application.node.value].name + "/" + application.name;
  settings.seed = resolved_->scenario.seed;
  settings.instants = instants_;
  add_ports(number, application, settings);
  if (application.gateway)
    settings.bridge =
        std::make_unique<GatewayBridge>(*application.gateway, resolved_->topics[application.threads[0].topic].shape,
                                        resolved_->topics[application.threads[1].topic].shape);
  auto live = std::make_unique<TopicApplication>(std::move(settings), *application_monitor_);
  applications_.push_back(live.get());
  std::vector<std::optional<std::uint32_t>> cpu_threads;
  for (const ResolvedThread& thread : application.threads) cpu_threads.push_back(thread.cpu_thread);
  models::Process& process = network_.add_process(application.node, application.name, std::move(live),
                                                  application.cpu_thread, std::move(cpu_threads));
  for (const ResolvedThread& thread : application.threads)
    for (const ResolvedInput& input : thread.inputs)
      if (!input.stream.is_none()) network_.listen(application.node, input.stream, &process);
  for (const auto& node : applications_.back()->nodes())
    for (const ResolvedParticipant::Heard& heard : node->settings().hears)
      network_.listen(application.node, heard.stream, &process);
}

ThreadFigures Run::thread(std::size_t application, std::size_t thread, sim::Duration from) const {
  const sim::LocalTime now = network_.clock(resolved_->applications[application].node).local_at(simulation_.now());
  return applications_[application]->figures(thread, now, from);
}

void Run::nest_programs() {
  for (std::size_t i = 0; i < programs_.size(); ++i) {
    if (!resolved_->programs[i].outer) continue;
    const LiveMember& outer =
        programs_[resolved_->programs[i].outer->program]->members[resolved_->programs[i].outer->participant];
    const LiveMember& inner = programs_[i]->members[0];
    nestings_.push_back(
        ProgramApplication::nest(*outer.application, *outer.process, *inner.application, *inner.process));
    models::Process::join(*outer.process, *inner.process);
  }
  for (const std::vector<std::uint32_t>& tree : trees_of(*resolved_)) {
    std::vector<handshake::TreeGroup> groups;
    for (const std::uint32_t number : tree) {
      handshake::TreeGroup group{resolved_->programs[number].participant_names.size(), 0, 0};
      if (const auto& outer = resolved_->programs[number].outer) {
        group.outer = static_cast<std::size_t>(std::find(tree.begin(), tree.end(), outer->program) - tree.begin());
        group.outer_index = outer->participant;
      }
      groups.push_back(group);
    }
    trees_.push_back(std::make_unique<TreeMonitor>(simulation_, tree, std::move(groups)));
    for (std::size_t g = 0; g < tree.size(); ++g) programs_[tree[g]]->monitor->set_tree(*trees_.back(), g);
  }
}

void Run::crash_programs(models::NodeIndex node) {
  for (const auto& program : programs_)
    for (const LiveMember& member : program->members)
      if (member.application->host() == node) member.application->crash();
  for (std::size_t a = 0; a < applications_.size(); ++a)
    if (resolved_->applications[a].node == node) applications_[a]->crash();
}

/// Hands the streams of the program to the processes of those that subscribe to them: all others, or in a star the
/// master, and all others to the master's.
void Run::connect_streams(const ResolvedProgram& program, const LiveProgram& live) {
  for (std::size_t from = 0; from < program.members.size(); ++from) {
    const ResolvedMember& sender = program.members[from];
    const bool is_heard_by_all = from == 0 || program.description->subscription == Subscription::all_to_all;
    for (std::size_t to = 0; to < (is_heard_by_all ? program.members.size() : 1); ++to) {
      if (to == from) continue;
      const auto connect = [&](models::StreamIndex stream) {
        network_.listen(program.members[to].node, stream, live.members[to].process);
      };
      connect(sender.state);
      if (sender.roles) connect(*sender.roles);
      for (const auto& data : sender.data)
        if (data) connect(*data);
    }
  }
}

}  // namespace takt::scenario
