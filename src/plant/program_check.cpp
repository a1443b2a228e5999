#include "plant/program_check.hpp"

#include <map>
#include <set>
#include <string_view>

#include "handshake/binder.hpp"

namespace takt::plant {
namespace {

void check_times(const Program& program, json::Diagnostics& diagnostics) {
  if (program.receive_timeout && *program.receive_timeout <= program.cycle)
    diagnostics.error(program.where.at("receive_timeout"), "a time-out within one cycle",
                      {json::to_text(*program.receive_timeout), "more than the cycle of " + json::to_text(program.cycle)});
  const auto check_phase = [&](Duration phase, const json::Place& place) {
    if (phase >= program.cycle && phase > Duration()) diagnostics.error(place, "an offset beyond the cycle", {json::to_text(phase), "less than " + json::to_text(program.cycle)});
  };
  if (program.offset) check_phase(*program.offset, program.where.at("offset"));
  for (const auto& phase : program.phases) check_phase(phase.second, program.where.at("phases"));
  if (program.announce_every && !program.roles.empty() && *program.announce_every < program.cycle)
    diagnostics.error(program.where.at("announce_every"), "announcements within one cycle",
                      {json::to_text(*program.announce_every), "at least the cycle of " + json::to_text(program.cycle)});
}

void refuse_without_roles(const Program& program, json::Diagnostics& diagnostics) {
  const auto refuse = [&](bool is_there, std::string_view key) {
    if (is_there) diagnostics.error(program.where.at(key), "belongs to a program with roles", {json::quote(key), "\"roles\" instead of \"slaves\""});
  };
  refuse(!program.candidates.empty(), "candidates");
  refuse(!program.absent.empty(), "absent");
  refuse(program.announce_every.has_value(), "announce_every");
  refuse(program.on_replacement != OnReplacement::stay_halted, "on_replacement");
}

void check_roles(const Program& program, json::Diagnostics& diagnostics) {
  if (program.variant == Variant::paper)
    diagnostics.error(program.where.at("variant"), "roles with the handshake of the paper", {"\"paper\", which cannot tell one node from the next", "\"robust\""});
  if (program.subscription == Subscription::all_to_all)
    diagnostics.error(program.where.at("subscription"), "roles with all-to-all subscription", {"\"all-to-all\"", "\"star\": who has a role hears the master"});
  if (!program.replies.empty())
    diagnostics.error(program.where.at("replies"), "replies in a program with roles", {"\"replies\" beside \"roles\"", "\"slaves\", whose replies are measured"});
  if (!program.phases.empty())
    diagnostics.error(program.where.at("phases"), "phases in a program with roles", {"\"phases\" beside \"roles\", whose participants come and go", "\"offset\""});
  std::set<std::string_view> names = {program.master};
  std::map<handshake::SkillId, std::string_view> skills;
  for (const Role& role : program.roles) {
    if (!names.insert(role.name).second)
      diagnostics.error(role.where.at("name"), "duplicate name", {json::quote(role.name) + " a second time", "a name of its own for each role and the master"});
    const auto [known, is_new] = skills.emplace(handshake::skill_id(role.skill), role.skill);
    if (!is_new && known->second != role.skill)
      diagnostics.error(role.where.at("skill"), "two skills that look the same on the network", {json::quote(role.skill) + " and " + json::quote(known->second), "another name for one"});
  }
}

}  // namespace

std::vector<std::string> participants_of(const Program& program) {
  std::vector<std::string> names = {program.master};
  names.insert(names.end(), program.slaves.begin(), program.slaves.end());
  for (const Role& role : program.roles) names.push_back(role.name);
  return names;
}

bool has_cycle(const Program& program, const json::Diagnostics& diagnostics) { return program.cycle > Duration() && !diagnostics.is_refused(program.where.at("cycle")); }

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

}  // namespace takt::plant
