// SPDX-License-Identifier: Apache-2.0
#include "node/program_check.hpp"

#include <algorithm>
#include <set>

#include "json/suggest.hpp"
#include "plant/program_check.hpp"

namespace takt::node {
namespace {

constexpr Duration shortest_cycle = Duration::from_ps(10'000'000);
constexpr std::uint32_t most_octets = 1472;  // what UDP over IPv4 leaves of an Ethernet frame

/// What only a simulator does, or takes finer than a thread of an operating system can.
void check_hosting(const Program& program, json::Diagnostics& diagnostics) {
  if (program.cycle < shortest_cycle)
    diagnostics.error(program.where.at("cycle"), "too short for a real node",
                      {json::to_text(program.cycle), "at least " + json::to_text(shortest_cycle)});
  if (program.offset && program.offset->is_auto)
    diagnostics.error(program.where.at("offset"), "not on a real node",
                      {"\"auto\", which a simulator chooses for its network",
                       "the offset and \"phases\" that `takt check` shows, or others"});
  if (program.redundancy)
    diagnostics.error(program.where.at("redundancy"), "not on a real node",
                      {"copies of each message", "one message, which a network may copy"});
  if (program.security)
    diagnostics.error(program.where.at("security"), "security of one program",
                      {"\"security\" of a program", "\"security\" of the node, which has the keys"});
  if (!program.paths.empty())
    diagnostics.error(program.where.at("paths"), "not on a real node",
                      {"ways of messages", "a network that is configured for them"});
  if (!program.replies.empty())
    diagnostics.error(program.where.at("replies"), "not on a real node",
                      {"process data that answers other process data", "data that is published every cycle"});
  if (!program.roles.empty() && program.candidates.empty())
    diagnostics.error(program.where.at("roles"), "roles that no node may have",
                      {"no \"candidates\"", "the names of the nodes that may have a role"});
}

bool holds(const std::vector<std::string>& names, const std::string& name) {
  return std::ranges::find(names, name) != names.end();
}

}  // namespace

void check(const Program& program, json::Diagnostics& diagnostics) {
  plant::check_program(program, diagnostics);
  plant::check_members(
      program, most_octets, [](std::string_view) { return false; }, diagnostics);
  check_hosting(program, diagnostics);
}

void check_offers(const Config& config, std::span<const Program> programs, json::Diagnostics& diagnostics) {
  const Program* of = nullptr;
  for (const Program& program : programs) {
    if (!holds(program.candidates, config.node) || program.roles.empty()) continue;
    if (of != nullptr)
      diagnostics.error(
          program.where.at("candidates"), "a node that offers its skills to two programs",
          {json::quote(config.node) + " to " + json::quote(of->name) + " and " + json::quote(program.name),
           "\"candidates\" of one program"});
    of = &program;
  }
  const auto refuse = [&](bool is_there, std::string_view key) {
    if (is_there)
      diagnostics.error(
          config.where.at(key), "belongs to a candidate",
          {json::quote(config.node) + ", which no program has among its \"candidates\"", "no " + json::quote(key)});
  };
  if (of == nullptr) {
    refuse(!config.offers.empty(), "offers");
    refuse(config.absent, "absent");
    return;
  }
  std::set<std::string> needed;
  for (const Role& role : of->roles) needed.insert(role.skill);
  std::string all;
  for (const std::string& skill : needed) all += (all.empty() ? "" : ", ") + json::quote(skill);
  if (config.offers.empty()) {
    diagnostics.error(config.where.at("node"), "a candidate without skills",
                      {json::quote(config.node) + " without \"offers\"", "\"offers\" with some of " + all});
  } else if (std::none_of(config.offers.begin(), config.offers.end(),
                          [&](const std::string& skill) { return needed.contains(skill); })) {
    const std::vector<std::string_view> names(needed.begin(), needed.end());
    diagnostics.error(
        config.where.at("offers", 0), "a candidate for no role",
        {json::quote(config.offers.front()), "a skill that a role of " + json::quote(of->name) + " needs: " + all,
         json::suggest(config.offers.front(), names)});
  }
}

std::optional<wire::RoleSettings> roles_at(const Config& config, const Program& program,
                                           const wire::ProgramShape& shape) {
  if (program.roles.empty()) return std::nullopt;
  wire::RoleSettings roles;
  roles.format =
      std::make_shared<const wire::RoleFormat>(plant::role_shape_of(shape, program.roles, program.candidates));
  roles.announce_cycle = plant::announce_every_of(program);
  roles.restarts = program.on_replacement == OnReplacement::restart;
  if (config.node == program.master) return roles;
  const auto number =
      std::find(program.candidates.begin(), program.candidates.end(), config.node) - program.candidates.begin();
  roles.offer = wire::Offer{static_cast<std::uint8_t>(number), 1, plant::skill_ids_of(config.offers),
                            !config.absent && !holds(program.absent, config.node)};
  return roles;
}

bool may_have(const Config& config, const Role& role) { return holds(config.offers, role.skill); }

}  // namespace takt::node
