// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <utility>

#include "measure.hpp"
#include "models/ethernet/sizes.hpp"
#include "models/network.hpp"
#include "workloads.hpp"

namespace takt::benchmark {
namespace {

using namespace models;         // NOLINT
using namespace sim::literals;  // NOLINT

NetworkPlan line_plan() {
  constexpr std::uint32_t switches = 5;
  constexpr std::uint32_t last = switches + 1;
  NetworkPlan plan;
  for (std::uint32_t n = 0; n <= last; ++n) {
    NodePlan node;
    node.name = "n" + std::to_string(n);
    node.kind = n == 0 || n == last ? NodeKind::host : NodeKind::bridge;
    plan.nodes.push_back(node);
  }
  for (std::uint32_t n = 0; n < last; ++n)
    plan.links.push_back({{NodeIndex{n}, static_cast<std::uint16_t>(n == 0 ? 0 : 1)},
                          {NodeIndex{n + 1}, 0},
                          sim::DataRate{1'000'000'000},
                          50_ns});
  for (std::uint32_t n = 1; n < last; ++n) plan.filtering.push_back({NodeIndex{n}, 0, AddressIndex{last}, 1});
  const auto add_stream = [&](const char* name, Octets payload, sim::Duration period) {
    StreamPlan stream;
    stream.name = name;
    stream.talker = NodeIndex{0};
    stream.destination = AddressIndex{last};
    stream.headers = ipv4_and_udp_headers;
    stream.listeners = {NodeIndex{last}};
    const StreamIndex index{static_cast<std::uint32_t>(plan.streams.size())};
    plan.streams.push_back(stream);
    plan.talkers.push_back({index, payload, PeriodicSchedule{{}, period, {}}});
  };
  add_stream("small", Octets{100}, 200_us);
  add_stream("large", Octets{1000}, 20_us);
  return plan;
}

}  // namespace

LineFigures run_line(double simulated_seconds, LineVariant variant) {
  sim::Simulation simulation(1);
  NetworkPlan plan = line_plan();
  if (variant == LineVariant::gates || variant == LineVariant::short_gates) {
    GateConfig gates;
    const sim::Duration entry_time = variant == LineVariant::gates ? 31'250_ns : 2'500_ns;
    gates.admin_cycle_time = entry_time * 8;
    // The frames are of class 1 (priority 0); the other gates take turns.
    for (int entry = 0; entry < 8; ++entry)
      gates.admin_control_list.push_back({GateOperation::set_gate_states,
                                          static_cast<GateStates>(entry == 7 ? 0xFC : 0x02 | 1u << entry), entry_time});
    plan.port_configs[0].shaping.gates = gates;
  }
  if (variant == LineVariant::gptp) {
    plan.gptp_stations.emplace_back();
    for (std::uint32_t n = 0; n < plan.nodes.size(); ++n) {
      plan.nodes[n].clock.emplace();
      plan.nodes[n].clock->oscillator.offset =
          sim::FrequencyOffset{(static_cast<std::int64_t>(n * 37 % 100) - 50) * 1'000'000};
      plan.nodes[n].clock->timestamps.granularity = 8_ns;
      plan.gptp.push_back(0u);
    }
  }
  if (variant == LineVariant::preemption) {
    plan.port_configs[0].preemption = PreemptionConfig{0x03, AddFragSize(0), std::nullopt, {}};
    plan.streams[0].priority = 7;
    std::get<PeriodicSchedule>(plan.talkers[0].schedule).offset = 3_us;
  }
  Network network(simulation, std::move(plan));
  network.start();
  LineFigures figures;
  const double before = cpu_seconds();
  simulation.run(sim::TrueTime() + sim::Duration::from_ps(static_cast<std::int64_t>(simulated_seconds * 1e12)));
  figures.cpu_seconds = cpu_seconds() - before;
  figures.events = simulation.event_count();
  figures.population = simulation.pending_peak();
  for (std::uint32_t n = 0; n < network.plan().nodes.size(); ++n)
    for (const EgressPort& port : network.ports(NodeIndex{n})) figures.frame_hops += port.frames_sent();
  return figures;
}

PairFigures run_gptp_line(double simulated_seconds) {
  sim::Simulation simulation(1);
  NetworkPlan plan;
  constexpr std::uint32_t hops = 100;
  plan.gptp_stations.emplace_back();
  for (std::uint32_t n = 0; n <= hops; ++n) {
    NodePlan node;
    node.name = "n" + std::to_string(n);
    node.kind = n == 0 || n == hops ? NodeKind::host : NodeKind::bridge;
    node.clock.emplace();
    node.clock->oscillator.offset = sim::FrequencyOffset{(static_cast<std::int64_t>(n * 37 % 100) - 50) * 1'000'000};
    node.clock->oscillator.drift_ppt_per_second = n % 5 == 0 ? 0 : n % 2 == 0 ? 1'500'000 : -1'500'000;
    node.clock->timestamps.granularity = 8_ns;
    node.clock->timestamps.jitter = 4_ns;
    plan.nodes.push_back(std::move(node));
    plan.gptp.push_back(0u);
  }
  for (std::uint32_t n = 0; n < hops; ++n)
    plan.links.push_back({{NodeIndex{n}, static_cast<std::uint16_t>(n == 0 ? 0 : 1)},
                          {NodeIndex{n + 1}, 0},
                          sim::DataRate{1'000'000'000},
                          100_ns});
  Network network(simulation, std::move(plan));
  network.start();
  PairFigures figures;
  const double before = cpu_seconds();
  simulation.run(sim::TrueTime() + sim::Duration::from_ps(static_cast<std::int64_t>(simulated_seconds * 1e12)));
  figures.cpu_seconds = cpu_seconds() - before;
  figures.simulated_seconds = simulated_seconds;
  return figures;
}

}  // namespace takt::benchmark
