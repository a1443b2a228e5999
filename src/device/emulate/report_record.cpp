// SPDX-License-Identifier: Apache-2.0
#include "emulate/emulation.hpp"
#include "json/document.hpp"
#include "json/record.hpp"
#include "node/node_status.hpp"

namespace takt::emulate {
namespace {

std::vector<std::string_view> names_of_states(const std::vector<handshake::StateChange>& changes) {
  std::vector<std::string_view> states;
  for (const handshake::StateChange& change : changes) states.push_back(name_of(change.to));
  return states;
}
std::vector<std::string_view> simulated(const ParticipantComparison& participant) {
  return names_of_states(participant.simulated);
}
std::vector<std::string_view> emulated(const ParticipantComparison& participant) {
  return names_of_states(participant.emulated);
}

const std::vector<ParticipantComparison>& participants_of(const ProgramResult& program) {
  return program.comparison.participants;
}
std::size_t orders_of(const ProgramResult& program) { return program.comparison.orders; }
const std::vector<std::string>& violated_of(const ProgramResult& program) { return program.comparison.violated; }

/// What the node has said of itself.
json::Node status_of(const void* node) {
  const auto& result = *static_cast<const NodeResult*>(node);
  json::Diagnostics diagnostics;
  const auto status = json::parse(result.status, result.name, diagnostics);
  return status ? status->root() : json::Node();
}
constexpr json::Shape status_shape = json::ShapeOf<std::optional<node::NodeStatus>>::shape;

bool is_same(const Report& report) { return report.result.is_same(); }
bool was_interrupted(const Report& report) { return report.result.interrupted; }
const std::vector<ProgramResult>& programs_compared(const Report& report) { return report.result.programs; }
const InvariantCheck& invariants_checked(const Report& report) { return report.result.invariants; }
const std::vector<ApplicationComparison>& applications_compared(const Report& report) {
  return report.result.applications;
}
const std::vector<NodeResult>& nodes_asked(const Report& report) { return report.result.nodes; }
const std::vector<std::string>& notes_taken(const Report& report) { return report.result.notes; }

}  // namespace

const json::Record& describe(json::Type<ParticipantComparison>) {
  static constexpr json::Output outputs[] = {
      json::output<&ParticipantComparison::name>("name", "The participant."),
      json::output<&ParticipantComparison::same>("same", "The real node went through the states of the simulated one."),
      json::output<&simulated>("simulated", "The states, one after the other."),
      json::output<&emulated>("emulated", "Those of the real node."),
  };
  static constexpr json::Record record{"participant", "A participant in both worlds.", outputs};
  return record;
}

const json::Record& describe(json::Type<RoleResult>) {
  static constexpr json::Output outputs[] = {
      json::output<&RoleResult::name>("name", "The role."),
      json::output<&RoleResult::simulated>("simulated", "Who had it, one after the other; an empty name is nobody."),
      json::output<&RoleResult::emulated>("emulated", "The real nodes that had it."),
  };
  static constexpr json::Record record{"role_history", "A role in both worlds.", outputs};
  return record;
}

const json::Record& describe(json::Type<ProgramResult>) {
  static constexpr json::Output outputs[] = {
      json::output<&ProgramResult::name>("program", "Its name."),
      json::output<&ProgramResult::is_same>("same", "States, orders and roles are those of the simulated run."),
      json::output<&participants_of>("participants", "Each of them, the master first."),
      json::output_if_any<&ProgramResult::roles>("roles", "Who had which.", "with roles"),
      json::output<&orders_of>("orders", "Pairs of changes of different participants that must come in this order."),
      json::output<&violated_of>("violated", "Those that did not."),
  };
  static constexpr json::Record record{"program", "A Program in both worlds.", outputs};
  return record;
}

const json::Record& describe(json::Type<Times>) {
  static constexpr json::Output outputs[] = {
      json::output<&Times::count>("count", "How many."),
      json::output<&Times::min_ns>("min_ns", "The least; 0 of none.", {.unit = "ns"}),
      json::output<&Times::mean_ns>("mean_ns", "The mean; 0 of none.", {.unit = "ns"}),
      json::output<&Times::max_ns>("max_ns", "The greatest; 0 of none.", {.unit = "ns"}),
  };
  static constexpr json::Record record{"times", "Times of one kind. They are not compared.", outputs};
  return record;
}

const json::Record& describe(json::Type<SignalCounts>) {
  static constexpr json::Output outputs[] = {
      json::output<&SignalCounts::edges>("edges", "Changes of its level."),
      json::output<&SignalCounts::irregular_pulses>("irregular_pulses", "Pulses that are more than 10 % off."),
      json::output<&SignalCounts::latency>(
          "latency", "Of each edge: from the activation whose call made it, on the clock of the node."),
      json::output<&SignalCounts::pulses>("pulses",
                                          "Whole pulses: simulated in true time, real by the clock of the node."),
  };
  static constexpr json::Record record{"signal", "A digital output.", outputs};
  return record;
}

const json::Record& describe(json::Type<ThreadCounts>) {
  static constexpr json::Output outputs[] = {
      json::output<&ThreadCounts::activations>("activations", "Those that it answered and those that it missed."),
      json::output<&ThreadCounts::missed>("missed", "Those that it missed."),
      json::output<&ThreadCounts::published>("published", "Values that its protocol took."),
      json::output<&ThreadCounts::received>("received", "Values that came."),
      json::output<&ThreadCounts::lost>("lost",
                                        "Numbers of messages that were jumped over; of real nodes with OPC UA only."),
      json::output<&ThreadCounts::response>("response", "From an activation to the call that answers it."),
      json::output_if_any<&ThreadCounts::signal>("signal", "The digital output that it drives.",
                                                 "of a thread with one"),
  };
  static constexpr json::Record record{"counts", "What a thread did.", outputs};
  return record;
}

const json::Record& describe(json::Type<ThreadComparison>) {
  static constexpr json::Output outputs[] = {
      json::output<&ThreadComparison::name>("name", "The thread."),
      json::output<&ThreadComparison::topic>("topic", "What it publishes or takes."),
      json::output<&ThreadComparison::publishes>("publishes", "It publishes; else it takes."),
      json::output<&ThreadComparison::is_same>(
          "same",
          "It is activated as often as the simulated one, but for a quarter, publishes or gets values if that does, "
          "gets no more than were published, and its digital output changes if that does often, and no more often than "
          "values came."),
      json::output<&ThreadComparison::simulated>("simulated", "What the simulated one did."),
      json::output<&ThreadComparison::emulated>("emulated", "What the real one did."),
      json::output<&ThreadComparison::differs>("differs", "What is not as simulated."),
  };
  static constexpr json::Record record{"thread", "A thread in both worlds.", outputs};
  return record;
}

const json::Record& describe(json::Type<ApplicationComparison>) {
  static constexpr json::Output outputs[] = {
      json::output<&ApplicationComparison::name>("application", "Its name."),
      json::output<&ApplicationComparison::node>("node", "The node that it is on."),
      json::output<&ApplicationComparison::is_whole>(
          "whole", "Its node was never killed; else the counts are those of its last life, and not compared."),
      json::output<&ApplicationComparison::is_same>("same", "All of its threads are."),
      json::output<&ApplicationComparison::threads>("threads", "Each of them."),
  };
  static constexpr json::Record record{"application", "An application or gateway in both worlds.", outputs};
  return record;
}

const json::Record& describe(json::Type<InvariantCheck>) {
  static constexpr json::Output outputs[] = {
      json::output<&InvariantCheck::steps>("steps", "Of the real nodes."),
      json::output<&InvariantCheck::violated>("violated", "Steps that broke one."),
  };
  static constexpr json::Record record{"invariants", "S1, S2, S4 and S5 over the steps of the real nodes.", outputs};
  return record;
}

const json::Record& describe(json::Type<NodeResult>) {
  static constexpr json::Output outputs[] = {
      json::output<&NodeResult::name>("name", "The participant."),
      {"status",
       "What it said of itself at its end; null: it was killed.",
       {},
       &status_shape,
       status_of,
       nullptr,
       {},
       false},
  };
  static constexpr json::Record record{"node", "A real node.", outputs};
  return record;
}

const json::Record& describe(json::Type<Report>) {
  static constexpr json::Output outputs[] = {
      json::output<&Report::scenario>("scenario", "Its name."),
      json::output<&is_same>("same", "The real nodes did what the simulated ones did, in the same order."),
      json::output<&was_interrupted>("interrupted", "It was stopped before its end."),
      json::output<&programs_compared>("programs", "Each of them."),
      json::output_if_any<&applications_compared>("applications", "Each of them, and of the gateways.",
                                                  "with applications"),
      json::output<&invariants_checked>("invariants", "What always holds."),
      json::output<&nodes_asked>("nodes", "Each of them."),
      json::output<&notes_taken>("notes", "What was left out, and calls that were not Good."),
  };
  static constexpr json::Record record{"emulation", "A scenario on real nodes, beside its simulated run.", outputs};
  return record;
}

std::string to_json(const Report& report) { return json::write(report); }

}  // namespace takt::emulate
