#include "scenario/run.hpp"

#include <utility>

#include "scenario/program_shape.hpp"
#include "vocabulary/protocol.hpp"

namespace takt::scenario {

/// Calls the methods that the scenario's script asks for, before anything else of their instant.
class Run::Script final : public sim::Component {
 public:
  Script(Run& run, sim::Simulation& simulation) : run_(&run), source_(simulation.add(*this)) {
    const std::vector<ResolvedAction>& actions = run.resolved_->script;
    for (std::size_t i = 0; i < actions.size(); ++i)
      simulation.schedule(source_, actions[i].at, sim::Phase::control, source_.id(), 0, i);
  }

  void handle(sim::Simulation&, const sim::Event& event) override {
    std::visit([this](const auto& action) { act(action); }, run_->resolved_->script[event.argument].what);
  }

 private:
  void act(const ResolvedCall& call) {
    models::Process& process = *run_->programs_[call.program]->processes[call.participant];
    process.call([&](models::Application& application, models::HostServices& host) {
      static_cast<ProgramApplication&>(application).call(host, method_of(call.method));
    });
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
    : resolved_(&resolved), simulation_(resolved.scenario.seed), network_(simulation_, resolved.plan) {
  simulation_.set_tie_shuffle(tie_shuffle);
  for (std::uint32_t i = 0; i < resolved.programs.size(); ++i) add_program(i, resolved.programs[i]);
  script_ = std::make_unique<Script>(*this, simulation_);
  watch_clocks();
  network_.start();
}

void Run::watch_clocks() {
  if (!resolved_->scenario.clocks.gptp) return;
  std::vector<ClockMonitor::Limit> limits;
  for (const Requirement& requirement : resolved_->scenario.require) {
    if (!requirement.sync) continue;
    ClockMonitor::Limit limit;
    limit.after = sim::TrueTime() + requirement.after;
    if (requirement.node) limit.node = models::NodeIndex{*resolved_->topology.find(*requirement.node)};
    limits.push_back(limit);
  }
  clock_monitor_ = std::make_unique<ClockMonitor>(simulation_, network_, resolved_->scenario.clocks.gptp->report_every, std::move(limits));
  clock_monitor_->start();
}

Run::~Run() = default;

/// What the participant answers at once, instead of publishing it every cycle.
void Run::add_replies(const ResolvedProgram& program, std::size_t participant, ProgramApplication::Settings& settings) const {
  const std::string path = resolved_->topology.nodes[program.participants[participant].value].name + "/" + program.name;
  settings.replies.emplace(program, static_cast<std::uint8_t>(participant), resolved_->scenario.seed, path);
  settings.endpoint.on_demand.assign(program.process_data.size(), false);
  for (const ResolvedReply& reply : program.replies) settings.endpoint.on_demand[reply.with] = true;
}

void Run::add_program(std::uint32_t number, const ResolvedProgram& program) {
  const Program& description = *program.description;
  auto live = std::make_unique<LiveProgram>();
  const auto format = std::make_shared<const wire::ProgramFormat>(shape_of(program));
  const handshake::Variant variant = format->shape().variant;
  live->monitor = std::make_unique<ProgramMonitor>(simulation_, number, variant, program.participants.size());
  for (std::size_t p = 0; p < program.participants.size(); ++p) {
    ProgramApplication::Settings settings;
    wire::EndpointSettings& endpoint = settings.endpoint;
    endpoint.handshake.variant = variant;
    endpoint.handshake.role = p == 0 ? handshake::Role::Master : handshake::Role::Slave;
    endpoint.handshake.index = static_cast<std::uint8_t>(p);
    endpoint.handshake.slaves = static_cast<std::uint8_t>(program.participants.size() - 1);
    endpoint.handshake.incarnation = 1;
    endpoint.handshake.subscription = subscription_of(description.subscription);
    endpoint.format = format;
    endpoint.cycle = description.cycle;
    endpoint.offset = program.phases[p];
    endpoint.receive_timeout = program.receive_timeout;
    endpoint.initialisation = description.initialisation;
    endpoint.publish_on_change = description.publish == Publish::on_change;
    endpoint.priority = description.pcp;
    settings.state_stream = program.state_streams[p];
    for (const ResolvedProcessData& data : program.process_data) settings.data_streams.push_back(data.stream);
    if (!program.replies.empty()) add_replies(program, p, settings);
    auto application = std::make_unique<ProgramApplication>(std::move(settings), *live->monitor);
    live->applications.push_back(application.get());
    live->processes.push_back(&network_.add_process(program.participants[p], program.name, std::move(application)));
  }
  if (!program.replies.empty()) live->monitor->set_round_trips(program);
  connect_streams(program, *live);
  programs_.push_back(std::move(live));
}

void Run::crash_programs(models::NodeIndex node) {
  for (std::size_t i = 0; i < programs_.size(); ++i) {
    const std::vector<models::NodeIndex>& participants = resolved_->programs[i].participants;
    for (std::size_t p = 0; p < participants.size(); ++p)
      if (participants[p] == node) programs_[i]->applications[p]->crash();
  }
}

/// Hands the streams of the program to the processes of those that subscribe to them.
void Run::connect_streams(const ResolvedProgram& program, const LiveProgram& live) {
  const auto connect = [&](std::size_t from, models::StreamIndex stream) {
    if (from != 0) network_.listen(program.participants[0], stream, live.processes[0]);
    if (from != 0 && program.description->subscription == Subscription::star) return;
    for (std::size_t slave = 1; slave < program.participants.size(); ++slave)
      if (slave != from) network_.listen(program.participants[slave], stream, live.processes[slave]);
  };
  for (std::size_t p = 0; p < program.participants.size(); ++p) connect(p, program.state_streams[p]);
  for (const ResolvedProcessData& data : program.process_data) connect(data.from, data.stream);
}

}  // namespace takt::scenario
