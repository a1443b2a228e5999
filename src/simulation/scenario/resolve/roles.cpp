// SPDX-License-Identifier: Apache-2.0
#include "scenario/resolve/roles.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "json/suggest.hpp"
#include "plant/protocol.hpp"
#include "scenario/resolve/known_names.hpp"

namespace takt::scenario {
namespace {

class RoleResolver {
 public:
  RoleResolver(const Resolved& resolved, StreamBuilder& builder, ResolvedProgram& program,
               json::Diagnostics& diagnostics)
      : r_(resolved),
        builder_(builder),
        program_(program),
        description_(*program_.description),
        diagnostics_(diagnostics) {}

  void run() {
    const auto master = builder_.host(description_.master, description_.where.at("master"));
    program_.announce_every = plant::announce_every_of(description_);
    if (!master) return;
    program_.members.push_back({.node = models::NodeIndex{*master}});
    find_candidates(*master);
  }

 private:
  void find_candidates(std::uint32_t master) {
    std::set<std::string_view> needed;
    for (const Role& role : description_.roles) needed.insert(role.skill);
    std::set<std::string_view> listed;
    for (std::size_t i = 0; i < description_.candidates.size(); ++i) {
      const json::Place place = description_.where.at("candidates", i);
      const std::string& name = description_.candidates[i];
      if (builder_.host(name, place)) listed.insert(name);
    }
    std::set<std::string_view> offered;
    for (std::uint32_t n = 0; n < r_.topology.nodes.size(); ++n) {
      const TopologyNode& node = r_.topology.nodes[n];
      const EndStation* const host = end_station_of(node.description);
      if (host == nullptr || n == master || (!listed.empty() && !listed.contains(node.name))) continue;
      if (std::none_of(host->offers.begin(), host->offers.end(),
                       [&](const std::string& skill) { return needed.contains(skill); })) {
        if (listed.contains(node.name)) refuse_idle(node.name);
        continue;
      }
      offered.insert(host->offers.begin(), host->offers.end());
      program_.members.push_back({.node = models::NodeIndex{n}, .skills = host->offers});
    }
    for (const Role& role : description_.roles)
      if (!offered.contains(role.skill) && (role.where.is_known() || !diagnostics_.has_errors()))
        refuse_skill(role, offered);
    if (program_.candidates().size() > handshake::most_candidates)
      diagnostics_.error(description_.where.at("roles"), "too many candidates",
                         {std::to_string(program_.candidates().size()), "at most 64; \"candidates\" names some"});
    note_absent();
  }

  /// Whether skills could not be read, so that nobody knows who can have which role.
  bool offers_are_unclear() const {
    if (!r_.topology.has_all_nodes) return true;
    return std::any_of(r_.topology.nodes.begin(), r_.topology.nodes.end(), [&](const TopologyNode& node) {
      return node.is_of_unknown_kind || diagnostics_.is_refused(node.where.at("offers"));
    });
  }
  bool roles_are_unclear() const { return diagnostics_.is_refused(description_.where.at("roles")); }

  void refuse_idle(const std::string& name) {
    const auto found = std::find(description_.candidates.begin(), description_.candidates.end(), name);
    const bool is_unclear = offers_are_unclear() ||
                            !are_all_named(description_.roles, description_.where.at("roles"), diagnostics_) ||
                            roles_are_unclear();
    diagnostics_.error_unless(
        is_unclear,
        description_.where.at("candidates", static_cast<std::size_t>(found - description_.candidates.begin())),
        "a candidate for no role",
        {json::quote(name) + ", which offers no skill that a role needs", "a host with such a skill in \"offers\""});
  }
  void refuse_skill(const Role& role, const std::set<std::string_view>& offered) {
    const std::vector<std::string_view> names(offered.begin(), offered.end());
    diagnostics_.error_unless(
        offers_are_unclear(), role.where.at("skill"), "a skill that nobody offers",
        {json::quote(role.skill), "a skill in the \"offers\" of a host", json::suggest(role.skill, names)});
  }

  void note_absent() {
    std::vector<std::string_view> names;
    for (const ResolvedMember& each : program_.candidates()) names.push_back(r_.topology.nodes[each.node.value].name);
    for (std::size_t i = 0; i < description_.absent.size(); ++i) {
      const auto found = std::find(names.begin(), names.end(), description_.absent[i]);
      if (found == names.end())
        diagnostics_.error_unless(
            offers_are_unclear() || roles_are_unclear() || diagnostics_.is_refused(description_.where.at("candidates")),
            description_.where.at("absent", i), "not a candidate of the program",
            {json::quote(description_.absent[i]), "a host that offers a skill it needs",
             json::suggest(description_.absent[i], names)});
      else
        program_.members[1 + static_cast<std::size_t>(found - names.begin())].is_absent = true;
    }
  }

  const Resolved& r_;
  StreamBuilder& builder_;
  ResolvedProgram& program_;
  const Program& description_;
  json::Diagnostics& diagnostics_;
};

}  // namespace

void resolve_roles(const Resolved& resolved, StreamBuilder& builder, ResolvedProgram& program,
                   json::Diagnostics& diagnostics) {
  RoleResolver(resolved, builder, program, diagnostics).run();
}

void check_candidates(const Resolved& resolved, json::Diagnostics& diagnostics) {
  std::map<std::uint32_t, const ResolvedProgram*> taken;
  for (const ResolvedProgram& program : resolved.programs) {
    for (const ResolvedMember& each : program.candidates()) {
      const auto [other, is_new] = taken.emplace(each.node.value, &program);
      if (is_new) continue;
      diagnostics.error(program.description->where.at("roles"), "a node that offers its skills to two programs",
                        {json::quote(resolved.topology.nodes[each.node.value].name) + " to " +
                             json::quote(other->second->name) + " and " + json::quote(program.name),
                         "\"candidates\" that share no host"});
    }
  }
}

std::optional<ResolvedAction> membership_of(const Resolved& resolved, const ScriptEntry& entry,
                                            json::Diagnostics& diagnostics) {
  const std::string& name = entry.join ? *entry.join : *entry.leave;
  std::vector<std::string_view> names;
  for (std::uint32_t p = 0; p < resolved.programs.size(); ++p) {
    const ResolvedProgram& program = resolved.programs[p];
    for (std::size_t c = 0; c < program.candidates().size(); ++c) {
      names.push_back(resolved.topology.nodes[program.candidates()[c].node.value].name);
      if (names.back() != name) continue;
      return ResolvedAction{sim::TrueTime() + entry.at,
                            ResolvedMembership{p, static_cast<std::uint8_t>(c), entry.join.has_value()}};
    }
  }
  // A program that was refused has no candidates.
  const bool programs_are_refused = resolved.programs.size() != resolved.scenario.programs.size() ||
                                    may_be_unread_program(resolved.scenario, diagnostics);
  const auto node = resolved.topology.find(name);
  const bool may_be_candidate = node ? programs_are_refused || resolved.topology.nodes[*node].is_of_unknown_kind ||
                                           diagnostics.is_refused(resolved.topology.nodes[*node].where.at("offers"))
                                     : !resolved.topology.has_all_nodes;
  diagnostics.error_unless(may_be_candidate, entry.where.at(entry.join ? "join" : "leave"),
                           "not a candidate of a program",
                           {json::quote(name), "a host that offers a skill a role needs", json::suggest(name, names)});
  return std::nullopt;
}

}  // namespace takt::scenario
