#include <fmt/format.h>

#include "emulate/emulation.hpp"
#include "json/document.hpp"

namespace takt::emulate {
namespace {

std::string sequence_of(const std::vector<handshake::StateChange>& changes) {
  std::string text = "Halted";
  for (const handshake::StateChange& change : changes) text += (change.transition == 0 && change.to == handshake::PublishedState::Halted ? " x " : " ") + std::string(name_of(change.to));
  return text;
}

json::Node list_of(const std::vector<std::string>& texts) {
  json::Node list = json::Node::array();
  for (const std::string& each : texts) list.items.push_back(json::Node::of_string(each));
  return list;
}

std::string nodes_of(const std::vector<std::string>& nodes) {
  std::string text;
  for (const std::string& each : nodes) text += (text.empty() ? "" : ", ") + (each.empty() ? "nobody" : each);
  return text.empty() ? "nobody" : text;
}

json::Node states_of(const std::vector<handshake::StateChange>& changes) {
  json::Node list = json::Node::array();
  for (const handshake::StateChange& change : changes) list.items.push_back(json::Node::of_string(name_of(change.to)));
  return list;
}

json::Node node_of(const ProgramResult& program) {
  json::Node node = json::Node::object();
  node.add("program", json::Node::of_string(program.name));
  node.add("same", json::Node::of_bool(program.is_same()));
  json::Node& participants = node.add("participants", json::Node::array());
  for (const ParticipantComparison& each : program.comparison.participants) {
    json::Node participant = json::Node::object();
    participant.add("name", json::Node::of_string(each.name));
    participant.add("same", json::Node::of_bool(each.same));
    participant.add("simulated", states_of(each.simulated));
    participant.add("emulated", states_of(each.emulated));
    participants.items.push_back(std::move(participant));
  }
  if (!program.roles.empty()) {
    json::Node& roles = node.add("roles", json::Node::array());
    for (const RoleResult& each : program.roles) {
      json::Node role = json::Node::object();
      role.add("name", json::Node::of_string(each.name));
      role.add("simulated", list_of(each.simulated));
      role.add("emulated", list_of(each.emulated));
      roles.items.push_back(std::move(role));
    }
  }
  node.add("orders", json::Node::of_integer(static_cast<sim::int128>(program.comparison.orders)));
  node.add("violated", list_of(program.comparison.violated));
  return node;
}

}  // namespace

std::string to_text(const Result& result, const std::string& scenario) {
  std::string out;
  for (const std::string& note : result.notes) out += fmt::format("note: {}\n", note);
  for (const ProgramResult& program : result.programs) {
    out += fmt::format("\nProgram {}\n", program.name);
    for (const ParticipantComparison& each : program.comparison.participants) {
      out += fmt::format("  {:<16} {}\n", each.name, each.same ? "as simulated" : "NOT as simulated");
      out += each.same ? fmt::format("    {}\n", sequence_of(each.emulated))
                       : fmt::format("    simulated: {}\n    emulated:  {}\n", sequence_of(each.simulated), sequence_of(each.emulated));
    }
    for (const RoleResult& each : program.roles)
      out += each.simulated == each.emulated ? fmt::format("  role {:<11} {}\n", each.name, nodes_of(each.emulated))
                                             : fmt::format("  role {:<11} NOT as simulated\n    simulated: {}\n    emulated:  {}\n", each.name, nodes_of(each.simulated), nodes_of(each.emulated));
    out += fmt::format("  {} orders between participants, {} violated\n", program.comparison.orders, program.comparison.violated.size());
    for (const std::string& each : program.comparison.violated) out += fmt::format("    {}\n", each);
  }
  out += fmt::format("\n{} steps of the nodes against S1, S2, S4 and S5: {} violated\n", result.invariants.steps, result.invariants.violated.size());
  for (const std::string& each : result.invariants.violated) out += fmt::format("  {}\n", each);
  if (result.interrupted) return out + fmt::format("\n{}: interrupted\n", scenario);
  return out + fmt::format("\n{}: {}\n", scenario, result.is_same() ? "the same transitions in the same order as simulated" : "differs from the simulated run");
}

std::string to_json(const Result& result, const std::string& scenario) {
  json::Node node = json::Node::object();
  node.add("scenario", json::Node::of_string(scenario));
  node.add("same", json::Node::of_bool(result.is_same()));
  node.add("interrupted", json::Node::of_bool(result.interrupted));
  json::Node& programs = node.add("programs", json::Node::array());
  for (const ProgramResult& each : result.programs) programs.items.push_back(node_of(each));
  json::Node& invariants = node.add("invariants", json::Node::object());
  invariants.add("steps", json::Node::of_integer(static_cast<sim::int128>(result.invariants.steps)));
  invariants.add("violated", list_of(result.invariants.violated));
  json::Node& nodes = node.add("nodes", json::Node::array());
  for (const NodeResult& each : result.nodes) {
    json::Diagnostics diagnostics;
    const auto status = json::parse(each.status, each.name, diagnostics);
    json::Node entry = json::Node::object();
    entry.add("name", json::Node::of_string(each.name));
    entry.add("status", status ? status->root() : json::Node());
    nodes.items.push_back(std::move(entry));
  }
  node.add("notes", list_of(result.notes));
  return json::pretty(node);
}

}  // namespace takt::emulate
