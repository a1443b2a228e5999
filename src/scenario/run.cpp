#include "scenario/run.hpp"

#include <array>
#include <utility>

namespace takt::scenario {
namespace {

constexpr std::array<program::Method, 5> method_of = {program::Method::Start, program::Method::Suspend, program::Method::Resume,
                                                      program::Method::Halt, program::Method::Reset};

}  // namespace

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
      static_cast<ProgramApplication&>(application).call(host, method_of[static_cast<std::size_t>(call.method)]);
    });
  }
  void act(const ResolvedGates& change) { run_->network_.request_gates(change.node, change.port, change.gates); }
  void act(const ResolvedLink& change) { run_->network_.set_link(change.link, change.up); }
  void act(const ResolvedNode& change) { run_->network_.set_node(change.node, change.up); }
  void act(const ResolvedStuckGate& change) { run_->network_.force_gate(change.node, change.port, change.traffic_class, change.open); }
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
  network_.start();
}

Run::~Run() = default;

void Run::add_program(std::uint32_t number, const ResolvedProgram& program) {
  const Program& description = *program.description;
  auto live = std::make_unique<LiveProgram>();
  const handshake::Variant variant = description.variant == Variant::robust ? handshake::Variant::Robust : handshake::Variant::Paper;
  live->monitor = std::make_unique<ProgramMonitor>(simulation_, number, variant, program.participants.size());
  for (std::size_t p = 0; p < program.participants.size(); ++p) {
    ProgramApplication::Settings settings;
    settings.handshake.variant = variant;
    settings.handshake.role = p == 0 ? handshake::Role::Master : handshake::Role::Slave;
    settings.handshake.index = static_cast<std::uint8_t>(p);
    settings.handshake.slaves = static_cast<std::uint8_t>(program.participants.size() - 1);
    settings.handshake.incarnation = 1;
    settings.cycle = description.cycle;
    settings.offset = description.offset;
    settings.receive_timeout = program.receive_timeout;
    settings.initialisation = description.initialisation;
    settings.publish_on_change = description.publish == Publish::on_change;
    settings.state_stream = program.state_streams[p];
    for (std::size_t d = 0; d < program.process_data.size(); ++d) {
      const ResolvedProcessData& data = program.process_data[d];
      if (data.from == p) settings.data_sets.push_back({static_cast<std::uint8_t>(d), data.field_octets, data.stream, 0});
    }
    auto application = std::make_unique<ProgramApplication>(std::move(settings), *live->monitor);
    live->applications.push_back(application.get());
    live->processes.push_back(&network_.add_process(program.participants[p], program.name, std::move(application)));
  }
  connect_streams(program, *live);
  programs_.push_back(std::move(live));
}

/// Hands the streams of the program to its processes: the master's to every slave, a slave's to the master.
void Run::connect_streams(const ResolvedProgram& program, const LiveProgram& live) {
  const auto connect = [&](std::size_t from, models::StreamIndex stream) {
    if (from != 0) {
      network_.listen(program.participants[0], stream, live.processes[0]);
      return;
    }
    for (std::size_t slave = 1; slave < program.participants.size(); ++slave)
      network_.listen(program.participants[slave], stream, live.processes[slave]);
  };
  for (std::size_t p = 0; p < program.participants.size(); ++p) connect(p, program.state_streams[p]);
  for (const ResolvedProcessData& data : program.process_data) connect(data.from, data.stream);
}

}  // namespace takt::scenario
