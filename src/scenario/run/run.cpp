#include "scenario/run/run.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "scenario/applications/dds_port.hpp"
#include "scenario/applications/gateway_bridge.hpp"
#include "scenario/applications/opc_ua_port.hpp"
#include "scenario/programs/program_shape.hpp"
#include "scenario/resolve/nesting.hpp"
#include "scenario/run/accounts.hpp"
#include "scenario/run/action_content.hpp"
#include "vocabulary/protocol.hpp"

namespace takt::scenario {
namespace {
constexpr std::uint32_t script_action = 120;  // kind of digest record
}

/// Calls the methods that the scenario's script asks for, before anything else of their instant.
class Run::Script final : public sim::Component {
 public:
  Script(Run& run, sim::Simulation& simulation) : run_(&run), source_(simulation.add(*this)) {
    const std::vector<ResolvedAction>& actions = run.resolved_->script;
    for (std::size_t i = 0; i < actions.size(); ++i)
      simulation.schedule(source_, actions[i].at, sim::Phase::control, source_.id(), 0, i);
  }

  void handle(sim::Simulation& simulation, const sim::Event& event) override {
    const ResolvedAction& action = run_->resolved_->script[event.argument];
    simulation.digest().add(script_action, action.what.index(), simulation.now(), content_of(action));
    std::visit([this](const auto& what) { act(what); }, action.what);
  }

 private:
  /// Nobody has the role: refused.
  void act(const ResolvedCall& call) {
    const LiveProgram& live = *run_->programs_[call.program];
    const program::Method method = vocabulary::method_of(call.method);
    if (const LiveMember* const member = live.who_is(call.participant))
      member->process->call([&](models::Application&, models::HostServices& host) { member->application->call(host, method); });
    else
      live.monitor->on_call(call.participant, method, program::StatusCode::BadInvalidState);
  }
  void act(const ResolvedPlug& change) {
    const LiveProgram& live = *run_->programs_[change.program];
    if (!change.joins && live.roles->has_role(change.candidate)) live.monitor->on_leave();
    const LiveMember& member = live.members[change.candidate + std::size_t{1}];
    member.process->call([&](models::Application&, models::HostServices& host) { change.joins ? member.application->join(host) : member.application->leave(host); });
  }
  void act(const ResolvedGates& change) { run_->network_.request_gates(change.node, change.port, change.gates); }
  void act(const ResolvedLink& change) { run_->network_.set_link(change.link, change.up); }
  void act(const ResolvedNode& change) {
    if (!change.up) run_->crash_programs(change.node);
    run_->network_.set_node(change.node, change.up);
  }
  void act(const ResolvedStuckGate& change) { run_->network_.force_gate(change.node, change.port, change.traffic_class, change.open); }
  void act(const ResolvedClockFault& fault) {
    if (fault.step) run_->network_.step_clock(fault.node, *fault.step);
    if (fault.offset) run_->network_.set_frequency_offset(fault.node, *fault.offset);
  }
  void act(const ResolvedRoutes& change) {
    for (const ResolvedRoutes::Entry& entry : change.entries) run_->network_.reroute(entry.bridge, entry.vlan, entry.address, entry.ports);
  }

  Run* run_;
  sim::EventSource source_;
};

Run::Run(const Resolved& resolved, std::uint64_t tie_shuffle)
    : resolved_(&resolved), instants_(account_instants(resolved)), simulation_(resolved.scenario.seed), network_(simulation_, resolved.plan) {
  simulation_.set_tie_shuffle(tie_shuffle);
  for (std::uint32_t i = 0; i < resolved.programs.size(); ++i) add_program(i, resolved.programs[i]);
  nest_programs();
  application_monitor_ = std::make_unique<ApplicationMonitor>(simulation_, resolved.signals, instants_);
  for (std::uint32_t i = 0; i < resolved.applications.size(); ++i) add_application(i, resolved.applications[i]);
  script_ = std::make_unique<Script>(*this, simulation_);
  if (resolved.scenario.clocks.gptp) {
    clock_monitor_ = std::make_unique<ClockMonitor>(simulation_, network_, resolved.scenario.clocks.gptp->report_every, instants_);
    clock_monitor_->start();
  }
  keep_accounts(resolved, network_);
  network_.start();
}

Run::~Run() = default;

auto Run::LiveProgram::who_is(std::size_t participant) const -> const LiveMember* {
  if (!roles || participant == 0) return &members[participant];
  const handshake::Binding& binding = roles->binding(participant - 1);
  return binding.bound() ? &members[binding.candidate + std::size_t{1}] : nullptr;
}

auto Run::add_member(const ResolvedProgram& program, models::NodeIndex node, ProgramApplication::Settings settings, const LiveProgram& live) -> LiveMember {
  auto application = std::make_unique<ProgramApplication>(std::move(settings), *live.monitor, live.roles.get(), node);
  ProgramApplication* const raw = application.get();
  return {&network_.add_process(node, program.name, std::move(application)), raw};
}

/// What the participant answers at once, instead of publishing it every cycle.
void Run::add_replies(const ResolvedProgram& program, std::size_t participant, ProgramApplication::Settings& settings) const {
  const std::string path = resolved_->topology.nodes[program.participants[participant].value].name + "/" + program.name;
  settings.replies.emplace(program, static_cast<std::uint8_t>(participant), resolved_->scenario.seed, path);
  settings.node.endpoint.on_demand.assign(program.process_data.size(), false);
  for (const ResolvedReply& reply : program.replies) settings.node.endpoint.on_demand[reply.with] = true;
}

wire::EndpointSettings Run::endpoint_settings(const ResolvedProgram& program, std::size_t participant, std::shared_ptr<const wire::ProgramFormat> format) const {
  const Program& description = *program.description;
  wire::EndpointSettings endpoint;
  endpoint.handshake.variant = format->shape().variant;
  endpoint.handshake.role = participant == 0 ? handshake::Role::Master : handshake::Role::Slave;
  endpoint.handshake.index = static_cast<std::uint8_t>(participant);
  endpoint.handshake.slaves = static_cast<std::uint8_t>(program.participant_names.size() - 1);
  endpoint.handshake.incarnation = 1;
  endpoint.handshake.subscription = description.subscription == Subscription::star ? handshake::Subscription::Star : handshake::Subscription::AllToAll;
  endpoint.handshake.nested = program.nested.contains(static_cast<std::uint8_t>(participant));
  endpoint.format = std::move(format);
  endpoint.cycle = description.cycle;
  endpoint.offset = program.phases[participant];
  endpoint.receive_timeout = program.receive_timeout;
  endpoint.initialisation = description.initialisation;
  endpoint.publish_on_change = description.publish == Publish::on_change;
  endpoint.priority = description.pcp;
  return endpoint;
}

void Run::add_program(std::uint32_t number, const ResolvedProgram& program) {
  if (program.has_roles()) {
    add_program_with_roles(number, program);
    return;
  }
  auto live = std::make_unique<LiveProgram>();
  const auto format = std::make_shared<const wire::ProgramFormat>(shape_of(program));
  live->monitor = std::make_unique<ProgramMonitor>(simulation_, number, format->shape().variant, program.participants.size(), instants_);
  for (std::size_t p = 0; p < program.participants.size(); ++p) {
    ProgramApplication::Settings settings;
    settings.node.endpoint = endpoint_settings(program, p, format);
    settings.state_stream = program.state_streams[p];
    for (const ResolvedProcessData& data : program.process_data) settings.data_streams.push_back(data.stream);
    if (!program.replies.empty()) add_replies(program, p, settings);
    live->members.push_back(add_member(program, program.participants[p], std::move(settings), *live));
  }
  std::vector<std::uint32_t> nodes;
  for (const models::NodeIndex node : program.participants) nodes.push_back(node.value);
  live->monitor->set_nodes(std::move(nodes));
  live->monitor->set_faults(faults_of(*resolved_, program));
  if (!program.replies.empty()) live->monitor->set_round_trips(program);
  connect_streams(program, *live);
  programs_.push_back(std::move(live));
}

void Run::add_program_with_roles(std::uint32_t number, const ResolvedProgram& program) {
  auto live = std::make_unique<LiveProgram>();
  std::vector<std::string> names;
  for (const ResolvedCandidate& each : program.candidates) names.push_back(resolved_->topology.nodes[each.node.value].name);
  const auto format = std::make_shared<const wire::PlugFormat>(vocabulary::plug_shape_of(shape_of(program), program.description->roles, std::move(names)));
  const auto program_format = std::make_shared<const wire::ProgramFormat>(format->shape().program);
  live->monitor = std::make_unique<ProgramMonitor>(simulation_, number, handshake::Variant::Robust, program.participant_names.size(), instants_);
  std::vector<std::uint32_t> nodes;
  for (const ResolvedCandidate& each : program.candidates) nodes.push_back(each.node.value);
  LiveProgram* const raw = live.get();
  const auto state_of = [raw](const handshake::Binding& binding) { return binding.bound() ? raw->members[binding.candidate + std::size_t{1}].application->state_of(binding.life) : std::nullopt; };
  live->roles = std::make_unique<PlugMonitor>(simulation_, number, *live->monitor, format->roles(), std::move(nodes), state_of);
  std::vector<std::uint32_t> at_first(program.participant_names.size());
  at_first[0] = program.participants[0].value;
  live->monitor->set_nodes(std::move(at_first));
  live->monitor->set_faults(faults_of(*resolved_, program));

  ProgramApplication::Settings settings;
  settings.node.endpoint = endpoint_settings(program, 0, program_format);
  settings.node.roles = wire::RoleSettings{format, program.announce_every, program.description->on_replacement == OnReplacement::restart, {}};
  settings.state_stream = program.state_streams[0];
  settings.role_stream = program.table_stream;
  for (const ResolvedProcessData& data : program.process_data) settings.data_streams.push_back(data.from == 0 ? std::optional(data.stream) : std::nullopt);
  live->members.push_back(add_member(program, program.participants[0], settings, *live));
  models::Process* const master = live->members[0].process;

  settings.node.endpoint = endpoint_settings(program, 1, program_format);  // the index follows with the role
  for (std::uint8_t c = 0; c < program.candidates.size(); ++c) {
    const ResolvedCandidate& each = program.candidates[c];
    settings.node.roles->offer = wire::Offer{c, 1, vocabulary::skill_ids_of(each.skills), !each.is_absent};
    settings.state_stream = each.state;
    settings.role_stream = each.announcements;
    settings.data_streams = each.data;
    live->members.push_back(add_member(program, each.node, settings, *live));
    models::Process* const process = live->members.back().process;
    network_.listen(each.node, program.state_streams[0], process);
    network_.listen(each.node, program.table_stream, process);
    for (const ResolvedProcessData& data : program.process_data)
      if (data.from == 0) network_.listen(each.node, data.stream, process);
    for (const models::StreamIndex stream : {each.state, each.announcements}) network_.listen(program.participants[0], stream, master);
    for (const auto& stream : each.data)
      if (stream) network_.listen(program.participants[0], *stream, master);
  }
  programs_.push_back(std::move(live));
}

/// What each thread publishes by, or takes from.
void Run::add_ports(std::uint32_t number, const ResolvedApplication& application, TopicApplication::Settings& settings) const {
  const auto address = [&](std::uint32_t of, std::uint32_t thread) {
    const ResolvedThread& publication = resolved_->applications[of].threads[thread];
    return address_of(resolved_->topics[publication.topic], publication);
  };
  std::map<std::uint32_t, DdsNode*> nodes;
  for (std::uint32_t p = 0; p < resolved_->dds->participants.size(); ++p) {
    if (resolved_->dds->participants[p].application != number) continue;
    std::vector<dds::DurableTopic> keeps;
    for (const ResolvedService::Kept& kept : application.service ? application.service->topics : std::vector<ResolvedService::Kept>())
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
      settings.writers.back() = std::make_unique<OpcUaWriter>(topic.layout, address(number, t), thread.stream);
      continue;
    }
    std::vector<OpcUaAddress> heard;
    for (const ResolvedInput& input : thread.inputs) heard.push_back(address(input.application, input.thread));
    settings.readers.back() = std::make_unique<OpcUaReader>(topic.layout, std::move(heard));
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
    settings.bridge = std::make_unique<GatewayBridge>(*application.gateway, resolved_->topics[application.threads[0].topic], resolved_->topics[application.threads[1].topic]);
  auto live = std::make_unique<TopicApplication>(std::move(settings), *application_monitor_);
  applications_.push_back(live.get());
  models::Process& process = network_.add_process(application.node, application.name, std::move(live));
  for (const ResolvedThread& thread : application.threads)
    for (const ResolvedInput& input : thread.inputs)
      if (!input.stream.is_none()) network_.listen(application.node, input.stream, &process);
  for (const auto& node : applications_.back()->nodes())
    for (const ResolvedParticipant::Heard& heard : node->settings().hears) network_.listen(application.node, heard.stream, &process);
}

ThreadFigures Run::thread(std::size_t application, std::size_t thread, sim::Duration from) const {
  const sim::LocalTime now = network_.clock(resolved_->applications[application].node).local_at(simulation_.now());
  return applications_[application]->figures(thread, now, from);
}

void Run::nest_programs() {
  for (std::size_t i = 0; i < programs_.size(); ++i) {
    if (!resolved_->programs[i].outer) continue;
    const LiveMember& outer = programs_[resolved_->programs[i].outer->program]->members[resolved_->programs[i].outer->participant];
    const LiveMember& inner = programs_[i]->members[0];
    nestings_.push_back(ProgramApplication::nest(*outer.application, *outer.process, *inner.application, *inner.process));
  }
  for (const std::vector<std::uint32_t>& tree : trees_of(*resolved_)) {
    std::vector<handshake::TreeGroup> groups;
    for (const std::uint32_t number : tree) {
      handshake::TreeGroup group{resolved_->programs[number].participants.size(), 0, 0};
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

/// Hands the streams of the program to the processes of those that subscribe to them.
void Run::connect_streams(const ResolvedProgram& program, const LiveProgram& live) {
  const auto connect = [&](std::size_t from, models::StreamIndex stream) {
    if (from != 0) network_.listen(program.participants[0], stream, live.members[0].process);
    if (from != 0 && program.description->subscription == Subscription::star) return;
    for (std::size_t slave = 1; slave < program.participants.size(); ++slave)
      if (slave != from) network_.listen(program.participants[slave], stream, live.members[slave].process);
  };
  for (std::size_t p = 0; p < program.participants.size(); ++p) connect(p, program.state_streams[p]);
  for (const ResolvedProcessData& data : program.process_data) connect(data.from, data.stream);
}

}  // namespace takt::scenario
