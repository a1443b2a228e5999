// SPDX-License-Identifier: Apache-2.0
#include "analysis/outages.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "models/bridge/internal_port.hpp"

namespace takt::analysis {
namespace {

constexpr std::size_t most_paths = 64;

bool happens(const scenario::Resolved& r, const scenario::ResolvedAction& action) {
  return action.at.since_start() < r.scenario.duration;
}

/// By node, the ports that the stream's frames leave by at any time.
using Ports = std::map<std::uint32_t, std::set<std::uint16_t>>;

class PathFinder {
 public:
  PathFinder(const scenario::Resolved& r, const models::StreamPlan& plan, const Ports& ports,
             const std::set<std::uint32_t>& relays)
      : r_(r), plan_(plan), ports_(ports), relays_(relays) {}

  std::optional<std::vector<PossiblePath>> find() {
    scenario::Path path{plan_.talker.value};
    is_bypassed_ = {false};
    if (r_.topology.chooses_ports[plan_.talker.value]) {
      if (!pass(path, plan_.talker.value)) return std::nullopt;
    } else {
      for (const scenario::Neighbour& neighbour : r_.topology.neighbours[plan_.talker.value])
        if (!follow(path, neighbour)) return std::nullopt;
    }
    return std::move(found_);
  }

 private:
  bool follow(scenario::Path& path, const scenario::Neighbour& neighbour) {
    const std::uint32_t node = neighbour.node;
    const bool is_back = std::find(path.begin(), path.end(), node) != path.end();
    if (is_back && r_.plan.nodes[node].forwards()) return false;
    const std::size_t found_before = found_.size();
    const std::uint32_t before = path.back();
    append(r_.topology, path, neighbour);
    is_bypassed_.push_back(false);
    bool is_fine = is_back || go_on(path, before, node);  // back at its talker, a host, a frame ends
    is_bypassed_.back() = false;
    // What leads to no listener takes the ports up to there, too.
    if (is_fine && found_.size() == found_before) is_fine = add({path, is_bypassed_});
    remove_last(path);
    is_bypassed_.pop_back();
    return is_fine;
  }
  bool go_on(scenario::Path& path, std::uint32_t before, std::uint32_t node) {
    const models::NodePlan& plan = r_.plan.nodes[node];
    if ((is_taken_in(node) && !arrive(path, node)) || (plan.forwards() && !pass(path, node))) return false;
    is_bypassed_.back() = true;
    return !relays_.contains(node) || pass_relay(path, before, node);
  }
  bool add(PossiblePath possible) {
    found_.push_back(std::move(possible));
    return found_.size() <= most_paths;
  }
  /// What comes by port 0 goes on by the cable at port 1, and the other way round.
  bool pass_relay(scenario::Path& path, std::uint32_t before, std::uint32_t node) {
    const std::optional<std::uint16_t> came_by = r_.topology.port_towards(node, before);
    if (!came_by || *came_by > 1) return true;
    for (const scenario::Neighbour& neighbour : r_.topology.neighbours[node])
      if (neighbour.port == 1 - *came_by && !follow(path, neighbour)) return false;
    return true;
  }
  bool is_taken_in(std::uint32_t node) const {
    if (!r_.plan.nodes[node].forwards()) return true;
    const auto entry = ports_.find(node);
    return entry != ports_.end() && entry->second.contains(models::internal_port);
  }
  bool arrive(const scenario::Path& path, std::uint32_t node) {
    const auto listener = std::find(plan_.listeners.begin(), plan_.listeners.end(), models::NodeIndex{node});
    return listener == plan_.listeners.end() ||
           add({path, is_bypassed_, static_cast<std::size_t>(listener - plan_.listeners.begin())});
  }
  bool pass(scenario::Path& path, std::uint32_t node) {
    const auto entry = ports_.find(node);
    if (entry == ports_.end()) return true;  // the frame is lost there
    for (const scenario::Neighbour& neighbour : r_.topology.neighbours[node]) {
      const bool came_by_it =
          path.size() > 1 && path[path.size() - 2] == neighbour.node;  // a bridge sends nothing back
      if (entry->second.contains(neighbour.port) && !came_by_it && !follow(path, neighbour)) return false;
    }
    return true;
  }

  const scenario::Resolved& r_;
  const models::StreamPlan& plan_;
  const Ports& ports_;
  const std::set<std::uint32_t>& relays_;  // stations
  std::vector<bool> is_bypassed_;          // by node of the path
  std::vector<PossiblePath> found_;
};

}  // namespace

Outages::Outages(const scenario::Resolved& resolved)
    : resolved_(&resolved), links_(resolved.plan.links.size()), nodes_(resolved.plan.nodes.size()) {
  for (const scenario::ResolvedAction& action : resolved.script) {
    if (!happens(resolved, action)) continue;
    if (const auto* const link = std::get_if<scenario::ResolvedLink>(&action.what)) {
      links_[link->link] = true;
      any_ = true;
    } else if (const auto* const node = std::get_if<scenario::ResolvedNode>(&action.what)) {
      nodes_[node->node.value] = true;
      any_ = true;
    }
  }
  for (std::size_t l = 0; l < links_.size(); ++l) {
    const models::LinkPlan& link = resolved.plan.links[l];
    if (nodes_[link.a.node.value] || nodes_[link.b.node.value]) links_[l] = true;
  }
}

std::vector<Outage> Outages::of_link(std::uint32_t link) const {
  std::vector<Outage> found;
  if (!links_[link]) return found;
  const models::LinkPlan& plan = resolved_->plan.links[link];
  // Up again when the last of several faults ends.
  const auto note = [&](const auto& is_cause) {
    std::size_t reasons = 0;
    for (const scenario::ResolvedAction& action : resolved_->script) {
      const std::optional<bool> up = happens(*resolved_, action) ? is_cause(action) : std::nullopt;
      if (!up) continue;
      if (!*up && reasons++ == 0) found.push_back({action.at});
      if (*up && --reasons == 0) found.back().up = action.at;
    }
  };
  note([&](const scenario::ResolvedAction& action) -> std::optional<bool> {
    const auto* const change = std::get_if<scenario::ResolvedLink>(&action.what);
    return change != nullptr && change->link == link ? std::optional(change->up) : std::nullopt;
  });
  for (const models::NodeIndex end : {plan.a.node, plan.b.node}) {
    note([&](const scenario::ResolvedAction& action) -> std::optional<bool> {
      const auto* const change = std::get_if<scenario::ResolvedNode>(&action.what);
      return change != nullptr && change->node == end ? std::optional(change->up) : std::nullopt;
    });
  }
  return found;
}

bool has_bypass(const scenario::Resolved& resolved) {
  return std::ranges::any_of(resolved.script, [&](const scenario::ResolvedAction& action) {
    return std::holds_alternative<scenario::ResolvedBypass>(action.what) && happens(resolved, action);
  });
}

std::optional<std::vector<PossiblePath>> possible_paths(const scenario::Resolved& resolved,
                                                        const scenario::ResolvedStream& stream, models::VlanId vlan,
                                                        models::AddressIndex address) {
  const models::StreamPlan& plan = resolved.plan.streams[stream.index.value];
  Ports ports;
  std::set<std::uint32_t> relays;
  bool is_rerouted = false;
  for (const scenario::ResolvedAction& action : resolved.script) {
    if (!happens(resolved, action)) continue;
    if (const auto* const bypass = std::get_if<scenario::ResolvedBypass>(&action.what))
      relays.insert(bypass->node.value);
    const auto* const routes = std::get_if<scenario::ResolvedRoutes>(&action.what);
    if (routes == nullptr) continue;
    for (const scenario::ResolvedRoutes::Entry& entry : routes->entries)
      if (entry.vlan == vlan && entry.address == address) {
        ports[entry.node.value].insert(entry.ports.begin(), entry.ports.end());
        is_rerouted = true;
      }
  }
  if (!is_rerouted && relays.empty()) return std::vector<PossiblePath>();
  for (const models::FilteringPlan& entry : resolved.plan.filtering)
    if (entry.vlan == vlan && entry.address == address) ports[entry.node.value].insert(entry.port);
  std::optional<std::vector<PossiblePath>> found = PathFinder(resolved, plan, ports, relays).find();
  const auto goes_over_relays = [](const PossiblePath& each) {
    return std::ranges::find(each.is_bypassed, true) != each.is_bypassed.end();
  };
  if (found && !is_rerouted && std::ranges::none_of(*found, goes_over_relays)) found->clear();
  return found;
}

}  // namespace takt::analysis
