#include "node/plug_check.hpp"

#include <algorithm>
#include <set>

#include "json/suggest.hpp"

namespace takt::node {
namespace {

bool holds(const std::vector<std::string>& names, const std::string& name) { return std::find(names.begin(), names.end(), name) != names.end(); }

void check_candidates(const Program& program, json::Diagnostics& diagnostics) {
  std::set<std::string_view> nodes = {program.master};
  for (std::size_t i = 0; i < program.candidates.size(); ++i)
    if (!nodes.insert(program.candidates[i]).second)
      diagnostics.error(program.where.at("candidates", i), "a node twice",
                        {json::quote(program.candidates[i]) + (program.candidates[i] == program.master ? ", which is the master" : ""), "each candidate once, and not the master"});
}

}  // namespace

void check_roles(const Program& program, json::Diagnostics& diagnostics) {
  if (program.roles.empty()) return;
  if (program.candidates.empty())
    diagnostics.error(program.where.at("roles"), "roles that no node may have", {"no \"candidates\"", "the names of the nodes that may have a role"});
  check_candidates(program, diagnostics);
}

void check_offers(const Config& config, std::span<const Program> programs, json::Diagnostics& diagnostics) {
  const Program* of = nullptr;
  for (const Program& program : programs) {
    if (!holds(program.candidates, config.node) || program.roles.empty()) continue;
    if (of != nullptr)
      diagnostics.error(program.where.at("candidates"), "a node that offers its skills to two programs",
                        {json::quote(config.node) + " to " + json::quote(of->name) + " and " + json::quote(program.name), "\"candidates\" of one program"});
    of = &program;
  }
  const auto refuse = [&](bool is_there, std::string_view key) {
    if (is_there) diagnostics.error(config.where.at(key), "belongs to a candidate", {json::quote(config.node) + ", which no program has among its \"candidates\"", "no " + json::quote(key)});
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
    diagnostics.error(config.where.at("node"), "a candidate without skills", {json::quote(config.node) + " without \"offers\"", "\"offers\" with some of " + all});
  } else if (std::none_of(config.offers.begin(), config.offers.end(), [&](const std::string& skill) { return needed.contains(skill); })) {
    const std::vector<std::string_view> names(needed.begin(), needed.end());
    diagnostics.error(config.where.at("offers", 0), "a candidate for no role", {json::quote(config.offers.front()), "a skill that a role of " + json::quote(of->name) + " needs: " + all,
                                                                               json::suggest(config.offers.front(), names)});
  }
}

std::optional<wire::RoleSettings> roles_at(const Config& config, const Program& program, const wire::ProgramShape& shape) {
  if (program.roles.empty()) return std::nullopt;
  wire::RoleSettings roles;
  roles.format = std::make_shared<const wire::PlugFormat>(plant::plug_shape_of(shape, program.roles, program.candidates));
  roles.announce_cycle = program.announce_every.value_or(program.cycle * wire::cycles_of_announcement);
  roles.restarts = program.on_replacement == OnReplacement::restart;
  if (config.node == program.master) return roles;
  const auto number = std::find(program.candidates.begin(), program.candidates.end(), config.node) - program.candidates.begin();
  roles.offer = wire::Offer{static_cast<std::uint8_t>(number), 1, plant::skill_ids_of(config.offers), !config.absent && !holds(program.absent, config.node)};
  return roles;
}

bool may_have(const Config& config, const Role& role) { return holds(config.offers, role.skill); }

}  // namespace takt::node
