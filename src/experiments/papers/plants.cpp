// SPDX-License-Identifier: Apache-2.0
#include "papers/plants.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace takt::papers {
namespace {

using namespace sim::literals;  // NOLINT: units
using scenario::Scenario;
using sim::Duration;

scenario::HostNode participant_host() {
  scenario::HostNode host;
  host.os.profile = scenario::OsProfile::preempt_rt;
  return host;
}

scenario::SwitchNode plain_switch() {
  scenario::SwitchNode node;
  node.forwarding_delay = 1_us;
  return node;
}

/// The k-th of well spread parts of `whole`: multiples of the golden section.
Duration spread(std::uint64_t k, Duration whole) {
  constexpr std::uint64_t golden = 618'033'989;
  return Duration::from_ps(
      static_cast<std::int64_t>(static_cast<sim::int128>(k * golden % 1'000'000'000) * whole.ps() / 1'000'000'000));
}

class Builder {
 public:
  /// All participants publish at the beginning of the cycle, or spread over it.
  Builder(const std::string& name, Duration cycle, bool are_aligned = false) : are_aligned_(are_aligned) {
    scenario_.name = name;
    program_.name = "group";
    program_.cycle = cycle;
  }

  std::string add_switch() {
    const std::string name = fmt::format("sw{}", ++switches_);
    scenario_.network.nodes.emplace_back(name, plain_switch());
    return name;
  }
  void link(const std::string& a, const std::string& b) {
    scenario::Link made;
    made.ends = {a, b};
    made.length = sim::Length{10'000};
    scenario_.network.links.push_back(made);
  }
  /// The first participant is the master.
  void add_participant(const std::string& at) {
    const std::string name = program_.master.empty() ? "master" : fmt::format("slave{}", program_.slaves.size() + 1);
    scenario_.network.nodes.emplace_back(name, participant_host());
    link(name, at);
    program_.phases.emplace_back(name, are_aligned_ ? Duration() : spread(program_.phases.size() + 1, program_.cycle));
    (program_.master.empty() ? program_.master : program_.slaves.emplace_back()) = name;
  }
  std::string add_host(const std::string& name, const std::string& at) {
    scenario_.network.nodes.emplace_back(name, scenario::HostNode());
    link(name, at);
    return name;
  }
  Scenario& scenario() { return scenario_; }

  /// Start, suspend, resume and halt, so often; other than Start, the master and the last slave call by turns. Calls
  /// fall well spread over the cycle.
  Scenario finish(int rounds, const std::string& description) {
    scenario_.description = description;
    const Duration step = std::max(10_ms, program_.cycle * 20);
    Duration at = 20_ms;
    std::uint64_t calls = 0;
    const auto call = [&](scenario::Method method, bool at_slave) {
      scenario::ScriptEntry entry;
      entry.at = at + spread(++calls, program_.cycle);
      entry.program = program_.name;
      entry.call = method;
      if (at_slave) entry.on = program_.slaves.back();
      scenario_.script.push_back(entry);
      at += step;
    };
    for (int round = 0; round < rounds; ++round) {
      call(scenario::Method::Start, false);
      call(scenario::Method::Suspend, round % 2 == 1);
      call(scenario::Method::Resume, round % 4 >= 2);
      call(scenario::Method::Halt, round % 2 == 0);
    }
    scenario_.duration = at;
    scenario_.programs.push_back(program_);
    return scenario_;
  }

 private:
  Scenario scenario_;
  scenario::Program program_;
  bool are_aligned_;
  int switches_ = 0;
};

/// Participants at the ends and between: `places` are switches, the first that of the master, the last the farthest.
void populate(Builder& builder, const std::vector<std::string>& places) {
  builder.add_participant(places.front());
  const std::size_t last = places.size() - 1;
  builder.add_participant(places[last / 2]);
  builder.add_participant(places[last - last / 4]);
  builder.add_participant(places[last]);
}

Plant line_or_ring(bool is_ring, int hops, int rounds) {
  const char* const shape = is_ring ? "ring" : "line";
  Builder builder(fmt::format("programs-{}-{}", shape, hops), 200_us);
  std::vector<std::string> switches;
  const int count = is_ring ? 2 * (hops - 1) : hops;
  for (int i = 0; i < count; ++i) {
    switches.push_back(builder.add_switch());
    if (i > 0) builder.link(switches[switches.size() - 2], switches.back());
  }
  if (is_ring) builder.link(switches.back(), switches.front());
  switches.resize(static_cast<std::size_t>(hops));
  populate(builder, switches);
  return {fmt::format("{} {}", shape, hops),
          builder.finish(rounds, fmt::format("A {}; {} switches from the master to the farthest slave.", shape, hops))};
}

/// A binary tree of switches with the participants at its leaves.
Plant tree(int depth, int rounds) {
  const int hops = 2 * depth + 1;
  Builder builder(fmt::format("programs-tree-{}", hops), 200_us);
  std::vector<std::string> level = {builder.add_switch()};
  for (int d = 0; d < depth; ++d) {
    std::vector<std::string> below;
    for (const std::string& parent : level)
      for (int child = 0; child < 2; ++child) {
        below.push_back(builder.add_switch());
        builder.link(parent, below.back());
      }
    level = std::move(below);
  }
  populate(builder, level);
  return {
      fmt::format("tree {}", hops),
      builder.finish(rounds, fmt::format("A binary tree; {} switches from the master to the farthest slave.", hops))};
}

/// A switch in the middle and four around it, or that one alone.
Plant star(bool has_arms, int rounds) {
  const int hops = has_arms ? 3 : 1;
  Builder builder(fmt::format("programs-star-{}", hops), 200_us);
  const std::string middle = builder.add_switch();
  std::vector<std::string> places(4, middle);
  if (has_arms)
    for (std::string& place : places) {
      place = builder.add_switch();
      builder.link(middle, place);
    }
  for (const std::string& place : places) builder.add_participant(place);
  return {fmt::format("star {}", hops),
          builder.finish(rounds, fmt::format("A star; {} switches from the master to each slave.", hops))};
}

/// Three participants on one switch.
Scenario small_group(const std::string& name, Duration cycle, int rounds, const std::string& description) {
  Builder builder(name, cycle);
  const std::string middle = builder.add_switch();
  for (int p = 0; p < 3; ++p) builder.add_participant(middle);
  return builder.finish(rounds, description);
}

/// The first slave becomes the master of a group of two more, at 200 us; what the last slave did is done by the last
/// one of those.
Scenario nested_groups(int rounds) {
  Scenario scenario = small_group("programs-nested", 1_ms, rounds,
                                  "A group at 1 ms, one slave of which is the master of a group at 200 us.");
  scenario::Program inner;
  inner.name = "inner";
  inner.within = scenario.programs.front().name;
  inner.master = scenario.programs.front().slaves.front();
  inner.cycle = 200_us;
  for (const char* const name : {"inner1", "inner2"}) {
    scenario.network.nodes.emplace_back(name, participant_host());
    scenario::Link link;
    link.ends = {name, "sw1"};
    link.length = sim::Length{10'000};
    scenario.network.links.push_back(link);
    inner.slaves.emplace_back(name);
    inner.phases.emplace_back(name, spread(inner.phases.size() + 2, inner.cycle));
  }
  inner.phases.emplace_back(inner.master, spread(1, inner.cycle));
  for (scenario::ScriptEntry& entry : scenario.script) {
    if (!entry.on) continue;
    entry.program = inner.name;
    entry.on = inner.slaves.back();
  }
  scenario.programs.push_back(inner);
  return scenario;
}

enum class Mechanism { strict_priority, gates, gates_and_preemption };

scenario::Egress egress_of(Mechanism mechanism) {
  scenario::Egress egress;
  // Real time alone for a part of the cycle, then everybody by priority.
  scenario::Gates gates;
  scenario::GateEntry alone;
  alone.open = {6, 7};
  alone.interval = 40_us;
  scenario::GateEntry all;
  all.open = {0, 1, 2, 3, 4, 5, 6, 7};
  all.interval = 960_us;
  gates.entries = {alone, all};
  egress.gates = gates;
  if (mechanism == Mechanism::gates_and_preemption) {
    egress.preemption.emplace();
    egress.preemption->preemptable = {0, 1, 2, 3, 4, 5};
  }
  return egress;
}

Plant loaded(Mechanism mechanism, int percent, int rounds) {
  constexpr const char* names[] = {"priority", "gates", "preemption"};
  const char* const name = names[static_cast<std::size_t>(mechanism)];
  Builder builder(fmt::format("programs-{}-{}", name, percent), 1_ms, true);
  std::vector<std::string> switches;
  for (int i = 0; i < 3; ++i) {
    switches.push_back(builder.add_switch());
    if (i > 0) builder.link(switches[switches.size() - 2], switches.back());
  }
  populate(builder, switches);
  // Best effort both ways along the line, in the longest frames.
  const std::string near = builder.add_host("near", switches.front());
  const std::string far = builder.add_host("far", switches.back());
  Scenario& scenario = builder.scenario();
  for (const auto& [from, to] : {std::pair(near, far), std::pair(far, near)}) {
    if (percent == 0) break;
    scenario::Stream stream;
    stream.name = "best-effort-" + from;
    stream.from = from;
    stream.to.names = {to};
    stream.payload = sim::Octets{1472};
    stream.pcp = 0;
    // 1472 octets of payload are 1542 on the wire with headers, preamble and gap: 12.336 us at 1 Gb/s.
    stream.every = Duration::from_ps(12'336'000 * std::int64_t{100} / percent);
    scenario.streams.push_back(stream);
  }
  if (mechanism != Mechanism::strict_priority)
    for (auto& [node_name, node] : scenario.network.nodes)
      std::visit([&](auto& described) { described.egress.push_back(egress_of(mechanism)); }, node);
  return {fmt::format("{} {} %", name, percent),
          builder.finish(rounds,
                         fmt::format("A line of three switches, best-effort load {} % both ways, {}.", percent, name))};
}

}  // namespace

std::vector<Plant> plants_by_slaves(int rounds) {
  std::vector<Plant> plants;
  for (const int slaves : {1, 2, 4, 8, 16, 32}) {
    Builder builder(fmt::format("programs-slaves-{}", slaves), 200_us);
    const std::string middle = builder.add_switch();
    for (int p = 0; p <= slaves; ++p) builder.add_participant(middle);
    plants.push_back({std::to_string(slaves), builder.finish(rounds, fmt::format("One switch, {} slaves.", slaves))});
  }
  return plants;
}

std::vector<Plant> plants_by_topology(int rounds) {
  std::vector<Plant> plants = {star(false, rounds), star(true, rounds)};
  for (const int hops : {2, 4, 8, 16}) plants.push_back(line_or_ring(false, hops, rounds));
  for (const int depth : {1, 3, 7}) plants.push_back(tree(depth, rounds));
  for (const int hops : {4, 8, 16}) plants.push_back(line_or_ring(true, hops, rounds));
  return plants;
}

std::vector<Plant> plants_by_load(int rounds) {
  std::vector<Plant> plants;
  for (const Mechanism mechanism : {Mechanism::strict_priority, Mechanism::gates, Mechanism::gates_and_preemption})
    for (const int percent : {0, 50, 90}) plants.push_back(loaded(mechanism, percent, rounds));
  return plants;
}

std::vector<Plant> plants_by_nesting(int rounds) {
  return {{"1 ms alone", small_group("programs-outer", 1_ms, rounds, "The outer group alone.")},
          {"200 us alone", small_group("programs-inner", 200_us, rounds, "The inner group alone.")},
          {"200 us in 1 ms", nested_groups(rounds)}};
}

}  // namespace takt::papers
