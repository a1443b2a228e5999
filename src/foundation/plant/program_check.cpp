// SPDX-License-Identifier: Apache-2.0
#include "plant/program_check.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "handshake/binder.hpp"
#include "json/suggest.hpp"
#include "plant/protocol.hpp"
#include "wire/program_format.hpp"

namespace takt::plant {
namespace {

void check_times(const Program& program, json::Diagnostics& diagnostics) {
  if (program.receive_timeout && *program.receive_timeout <= program.cycle)
    diagnostics.error(
        program.where.at("receive_timeout"), "a time-out within one cycle",
        {json::to_text(*program.receive_timeout), "more than the cycle of " + json::to_text(program.cycle)});
  const auto check_phase = [&](Duration phase, const json::Place& place) {
    if (phase >= program.cycle && phase > Duration())
      diagnostics.error(place, "an offset beyond the cycle",
                        {json::to_text(phase), "less than " + json::to_text(program.cycle)});
  };
  if (program.offset) check_phase(*program.offset, program.where.at("offset"));
  for (const auto& phase : program.phases) check_phase(phase.second, program.where.at("phases"));
  if (program.announce_every && !program.roles.empty() && *program.announce_every < program.cycle)
    diagnostics.error(
        program.where.at("announce_every"), "announcements within one cycle",
        {json::to_text(*program.announce_every), "at least the cycle of " + json::to_text(program.cycle)});
}

void refuse_without_roles(const Program& program, json::Diagnostics& diagnostics) {
  const auto refuse = [&](bool is_there, std::string_view key) {
    if (is_there)
      diagnostics.error(program.where.at(key), "belongs to a program with roles",
                        {json::quote(key), "\"roles\" instead of \"slaves\""});
  };
  refuse(!program.candidates.empty(), "candidates");
  refuse(!program.absent.empty(), "absent");
  refuse(program.announce_every.has_value(), "announce_every");
  refuse(program.on_replacement != OnReplacement::stay_halted, "on_replacement");
}

void check_roles(const Program& program, json::Diagnostics& diagnostics) {
  if (program.variant == Variant::paper)
    diagnostics.error(program.where.at("variant"), "roles with the handshake of the paper",
                      {"\"paper\", which cannot tell one node from the next", "\"robust\""});
  if (program.subscription == Subscription::all_to_all)
    diagnostics.error(program.where.at("subscription"), "roles with all-to-all subscription",
                      {"\"all-to-all\"", "\"star\": who has a role hears the master"});
  if (!program.replies.empty())
    diagnostics.error(program.where.at("replies"), "replies in a program with roles",
                      {"\"replies\" beside \"roles\"", "\"slaves\", whose replies are measured"});
  if (!program.phases.empty())
    diagnostics.error(program.where.at("phases"), "phases in a program with roles",
                      {"\"phases\" beside \"roles\", whose participants come and go", "\"offset\""});
  std::set<std::string_view> names = {program.master};
  std::map<handshake::SkillId, std::string_view> skills;
  for (const Role& role : program.roles) {
    if (!names.insert(role.name).second)
      diagnostics.error(role.where.at("name"), "duplicate name",
                        {json::quote(role.name) + " a second time", "a name of its own for each role and the master"});
    const auto [known, is_new] = skills.emplace(handshake::skill_id(role.skill), role.skill);
    if (!is_new && known->second != role.skill)
      diagnostics.error(role.where.at("skill"), "two skills that look the same on the network",
                        {json::quote(role.skill) + " and " + json::quote(known->second), "another name for one"});
  }
}

void check_nodes(const Program& program, json::Diagnostics& diagnostics) {
  const std::vector<std::string> nodes = nodes_of(program);
  std::set<std::string_view> seen;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (!seen.insert(nodes[i]).second)
      diagnostics.error(program.where.at(program.roles.empty() ? "slaves" : "candidates", i - 1),
                        "a node twice in one program",
                        {json::quote(nodes[i]) + (nodes[i] == program.master ? ", which is the master" : ""),
                         "each participant on a node of its own"});
}

class NestingCheck {
 public:
  NestingCheck(std::span<const Program> programs, bool is_complete, json::Diagnostics& diagnostics)
      : programs_(programs), is_complete_(is_complete), diagnostics_(diagnostics) {}

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
      diagnostics_.error_unless(
          !is_complete_, place, "unknown program",
          {json::quote(*program.within), "the name of a program", json::suggest(*program.within, names)});
      return;
    }
    if (is_in_a_circle(program)) {
      diagnostics_.error(place, "programs nested in a circle",
                         {json::quote(program.name) + " within itself, by way of " + json::quote(*program.within),
                          "a tree of programs"});
      return;
    }
    const std::vector<std::string_view> slaves(outer->slaves.begin(), outer->slaves.end());
    if (outer->roles.empty() && std::ranges::find(slaves, program.master) == slaves.end())
      diagnostics_.error_unless(diagnostics_.is_refused(outer->where.at("slaves")), program.where.at("master"),
                                "the master of a nested program is no slave of the outer one",
                                {json::quote(program.master), "a slave of " + json::quote(outer->name),
                                 json::suggest(program.master, slaves)});
    const auto [taken, is_new] = taken_.emplace(std::pair(outer->name, program.master), program.name);
    if (!is_new)
      diagnostics_.error(
          place, "two programs nested at one slave",
          {json::quote(program.name) + " and " + json::quote(taken->second) + " at " + json::quote(program.master),
           "one"});
    if (!outer->roles.empty() && refused_.insert(outer).second)
      diagnostics_.error(outer->where.at("roles"), "roles in an outer program",
                         {"\"roles\" of " + json::quote(outer->name),
                          "\"slaves\", of which the master of " + json::quote(program.name) + " is one"});
    if (!program.roles.empty() && program.on_replacement == OnReplacement::restart)
      diagnostics_.error(program.where.at("on_replacement"), "a nested program that starts by itself",
                         {"\"restart\"", "\"stay-halted\": the outermost program starts it"});
    for (const Program* each : {&program, outer})
      if (each->variant == Variant::paper && refused_.insert(each).second)
        diagnostics_.error(
            each->where.at("variant"), "nesting with the handshake of the paper",
            {"\"paper\", whose states alone do not tell one run from the next", "\"robust\" for both programs"});
  }

  const Program* find(const std::string& name) const {
    const auto found = std::ranges::find(programs_, name, &Program::name);
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
  bool is_complete_;
  json::Diagnostics& diagnostics_;
  std::map<std::pair<std::string, std::string>, std::string>
      taken_;                         // outer Program and slave: the Program nested there
  std::set<const Program*> refused_;  // whose roles or variant have been reported
};

}  // namespace

std::vector<std::string> participants_of(const Program& program) {
  std::vector<std::string> names = {program.master};
  names.insert(names.end(), program.slaves.begin(), program.slaves.end());
  for (const Role& role : program.roles) names.push_back(role.name);
  return names;
}

std::vector<std::string> nodes_of(const Program& program) {
  std::vector<std::string> names = {program.master};
  const std::vector<std::string>& others = program.roles.empty() ? program.slaves : program.candidates;
  names.insert(names.end(), others.begin(), others.end());
  return names;
}

bool may_be_participant(const Program& program, std::string_view name, const MayBeNode& may_be_node,
                        const json::Diagnostics& diagnostics) {
  if (!are_all_named(program.roles, program.where.at("roles"), diagnostics)) return true;
  return (diagnostics.is_refused(program.where.at("master")) || diagnostics.is_refused(program.where.at("slaves"))) &&
         may_be_node(name);
}

std::optional<std::uint8_t> participant_of(const Program& program, const std::string& name, const json::Place& place,
                                           const MayBeNode& may_be_node, json::Diagnostics& diagnostics) {
  const std::vector<std::string> participants = participants_of(program);
  const auto found = std::ranges::find(participants, name);
  if (found != participants.end()) return static_cast<std::uint8_t>(found - participants.begin());
  const std::vector<std::string_view> names(participants.begin(), participants.end());
  diagnostics.error_unless(
      may_be_participant(program, name, may_be_node, diagnostics), place, "not a participant of the program",
      {json::quote(name),
       (program.roles.empty() ? "the master or a slave of " : "the master or a role of ") + json::quote(program.name),
       json::suggest(name, names)});
  return std::nullopt;
}

bool has_cycle(const Program& program, const json::Diagnostics& diagnostics) {
  return program.cycle > Duration() && !diagnostics.is_refused(program.where.at("cycle"));
}

void check_program(const Program& program, json::Diagnostics& diagnostics) {
  if (has_cycle(program, diagnostics))
    check_times(program, diagnostics);
  else
    diagnostics.consequence();
  if (program.roles.empty())
    refuse_without_roles(program, diagnostics);
  else
    check_roles(program, diagnostics);
}

namespace {

/// Participants, each once. A run of the robust handshake begins at the master.
void check_callers(const Program& program, const MayBeNode& may_be_node, json::Diagnostics& diagnostics) {
  for (const program::MethodInfo& each : program::methods) {
    const std::optional<std::vector<std::string>>& names = callers_of(program, each.method);
    if (!names) continue;
    std::set<std::string_view> seen;
    for (std::size_t i = 0; i < names->size(); ++i) {
      const json::Place place = program.callers.where.at(each.name, i);
      if (!seen.insert((*names)[i]).second)
        diagnostics.error(place, "a participant twice", {json::quote((*names)[i]), "each participant once"});
      participant_of(program, (*names)[i], place, may_be_node, diagnostics);
    }
  }
}

}  // namespace

void check_members(const Program& program, std::uint32_t most_octets, const MayBeNode& may_be_node,
                   json::Diagnostics& diagnostics) {
  check_nodes(program, diagnostics);
  if (program.roles.empty())
    for (const auto& phase : program.phases)
      participant_of(program, phase.first, program.where.at("phases"), may_be_node, diagnostics);
  check_callers(program, may_be_node, diagnostics);
  std::set<std::string_view> names = {"state"};
  if (!program.roles.empty()) names.insert({"bindings", "announce"});
  const std::string taken =
      program.roles.empty() ? "(\"state\" is taken)" : "(\"state\", \"bindings\" and \"announce\" are taken)";
  for (const ProcessData& data : program.process_data) {
    if (!data.where.is_known() && diagnostics.has_errors()) {  // no object: nothing is known of it
      diagnostics.consequence();
      continue;
    }
    participant_of(program, data.from, data.where.at("from"), may_be_node, diagnostics);
    if (!data.name.empty() && !names.insert(data.name).second)
      diagnostics.error(data.where.at("name"), "duplicate name",
                        {json::quote(data.name), "a name of its own for each data set " + taken});
    const std::uint32_t octets = wire::process_data_octets(field_octets_of(data)) + octets_of_security(program);
    if (octets > most_octets)
      diagnostics.error(
          data.where.at("fields"), "more than one frame",
          {std::to_string(octets) + " octets with all headers", "at most " + std::to_string(most_octets)});
  }
}

void check_nesting(std::span<const Program> programs, bool is_complete, json::Diagnostics& diagnostics) {
  NestingCheck(programs, is_complete, diagnostics).run();
}

}  // namespace takt::plant
