#include "node/program_check.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "json/suggest.hpp"
#include "plant/program_check.hpp"

namespace takt::node {
namespace {

constexpr Duration shortest_cycle = Duration::from_ps(10'000'000);
constexpr std::uint32_t most_octets = 1472;  // what UDP over IPv4 leaves of an Ethernet frame

void check_participants(const Program& program, json::Diagnostics& diagnostics) {
  std::set<std::string_view> seen = {program.master};
  for (std::size_t i = 0; i < program.slaves.size(); ++i)
    if (!seen.insert(program.slaves[i]).second)
      diagnostics.error(program.where.at("slaves", i), "a participant twice", {json::quote(program.slaves[i]), "a name of its own for each"});
}

/// What only a simulator does, or takes finer than a thread of an operating system can.
void check_hosting(const Program& program, json::Diagnostics& diagnostics) {
  if (program.cycle < shortest_cycle) diagnostics.error(program.where.at("cycle"), "too short for a real node", {json::to_text(program.cycle), "at least " + json::to_text(shortest_cycle)});
  if (!program.replies.empty()) diagnostics.error(program.where.at("replies"), "not on a real node", {"process data that answers other process data", "data that is published every cycle"});
  const std::vector<std::string> participants = participants_of(program);
  const std::vector<std::string_view> names(participants.begin(), participants.end());
  for (const auto& phase : program.phases)
    if (std::ranges::find(names, phase.first) == names.end())
      diagnostics.error(program.where.at("phases"), "not a participant of the program", {json::quote(phase.first), "the master or a slave", json::suggest(phase.first, names)});
}

/// The participant that publishes a data set; 0 after a mistake.
std::uint8_t sender_of(const ProcessData& data, const std::vector<std::string>& participants, bool has_roles, json::Diagnostics& diagnostics) {
  const auto found = std::find(participants.begin(), participants.end(), data.from);
  if (found != participants.end()) return static_cast<std::uint8_t>(found - participants.begin());
  const std::vector<std::string_view> names(participants.begin(), participants.end());
  const std::string sender = has_roles ? "the master or a role" : "the master or a slave";
  diagnostics.error(data.where.at("from"), "not a participant of the program", {json::quote(data.from), sender, json::suggest(data.from, names)});
  return 0;
}

class NestingChecker {
 public:
  NestingChecker(std::span<const Program> programs, json::Diagnostics& diagnostics) : programs_(programs), diagnostics_(diagnostics) {}

  void run() {
    for (const Program& program : programs_)
      if (program.within) check(program);
  }

 private:
  void check(const Program& program) {
    const json::Place place = program.where.at("within");
    const Program* const outer = find(*program.within);
    if (outer == nullptr) {
      std::vector<std::string_view> names;
      for (const Program& each : programs_) names.push_back(each.name);
      diagnostics_.error(place, "unknown program", {json::quote(*program.within), "the name of a program of this file", json::suggest(*program.within, names)});
      return;
    }
    if (is_in_a_circle(program)) {
      diagnostics_.error(place, "programs nested in a circle", {json::quote(program.name) + " within itself, by way of " + json::quote(*program.within), "a tree of programs"});
      return;
    }
    if (!program.roles.empty() || !outer->roles.empty()) {
      const Program& which = program.roles.empty() ? *outer : program;
      diagnostics_.error(place, "a program with roles is nested", {json::quote(which.name) + ", which has \"roles\"", "programs with \"slaves\""});
      return;
    }
    const std::vector<std::string_view> slaves(outer->slaves.begin(), outer->slaves.end());
    if (std::find(slaves.begin(), slaves.end(), program.master) == slaves.end())
      diagnostics_.error(program.where.at("master"), "the master of a nested program is no slave of the outer one",
                         {json::quote(program.master), "a slave of " + json::quote(outer->name), json::suggest(program.master, slaves)});
    for (const Program& other : programs_) {
      if (&other == &program) break;
      if (other.within == program.within && other.master == program.master)
        diagnostics_.error(place, "two programs nested at one slave", {json::quote(program.name) + " and " + json::quote(other.name) + " at " + json::quote(program.master), "one"});
    }
    for (const Program* each : {&program, outer})
      if (each->variant == Variant::paper && refused_.insert(each).second)
        diagnostics_.error(each->where.at("variant"), "nesting with the handshake of the paper", {"\"paper\", whose states alone do not tell one run from the next", "\"robust\" for both programs"});
  }

  const Program* find(const std::string& name) const {
    const auto found = std::find_if(programs_.begin(), programs_.end(), [&](const Program& each) { return each.name == name; });
    return found == programs_.end() ? nullptr : &*found;
  }

  bool is_in_a_circle(const Program& program) const {
    const Program* outer = &program;
    for (std::size_t steps = 0; outer != nullptr && outer->within && steps <= programs_.size(); ++steps) {
      outer = find(*outer->within);
      if (outer == &program) return true;
    }
    return false;
  }

  std::span<const Program> programs_;
  json::Diagnostics& diagnostics_;
  std::set<const Program*> refused_;  // whose variant has been reported
};

}  // namespace

std::vector<std::string> nodes_of(const Program& program) {
  std::vector<std::string> names = {program.master};
  const std::vector<std::string>& others = program.roles.empty() ? program.slaves : program.candidates;
  names.insert(names.end(), others.begin(), others.end());
  return names;
}

wire::ProgramShape checked_shape(const Program& program, std::uint16_t first_publisher_id, json::Diagnostics& diagnostics) {
  check_participants(program, diagnostics);
  plant::check_program(program, diagnostics);
  check_hosting(program, diagnostics);
  wire::ProgramShape shape;
  shape.name = program.name;
  shape.variant = program.variant;
  shape.participants = participants_of(program);
  shape.first_publisher_id = first_publisher_id;
  std::set<std::string_view> names = {"state"};
  if (!program.roles.empty()) names.insert({"bindings", "announce"});
  for (const ProcessData& data : program.process_data) {
    wire::DataSetShape data_set = data_set_shape_of(data, sender_of(data, shape.participants, !program.roles.empty(), diagnostics));
    if (!names.insert(data.name).second)
      diagnostics.error(data.where.at("name"), "duplicate name", {json::quote(data.name), program.roles.empty() ? "a name of its own for each data set (\"state\" is taken)" : "a name of its own for each data set (\"state\", \"bindings\" and \"announce\" are taken)"});
    const std::uint32_t octets = wire::process_data_octets(wire::octets_of(data_set));
    if (octets > most_octets)
      diagnostics.error(data.where.at("fields"), "more than one frame", {std::to_string(octets) + " octets", "at most " + std::to_string(most_octets)});
    shape.data_sets.push_back(std::move(data_set));
  }
  return shape;
}

wire::EndpointSettings endpoint_settings(const Program& program, std::uint8_t index, const std::string& node, std::uint8_t priority) {
  wire::EndpointSettings settings;
  settings.handshake.variant = program.variant;
  settings.handshake.index = index;
  settings.handshake.role = index == 0 ? handshake::Role::master : handshake::Role::slave;
  settings.handshake.slaves = static_cast<std::uint8_t>(program.slaves.size() + program.roles.size());
  settings.handshake.subscription = program.subscription;
  settings.cycle = program.cycle;
  settings.offset = phase_of(program, node);
  settings.receive_timeout = program.receive_timeout.value_or(program.cycle * 10);
  settings.initialisation = program.initialisation;
  settings.publish_on_change = program.publish == Publish::on_change;
  settings.priority = priority;
  return settings;
}

void check_nesting(std::span<const Program> programs, json::Diagnostics& diagnostics) { NestingChecker(programs, diagnostics).run(); }

}  // namespace takt::node
