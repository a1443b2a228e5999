#include "analysis/outages.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "models/bridge/internal_port.hpp"

namespace takt::analysis {
namespace {

constexpr std::size_t most_paths = 64;

bool happens(const scenario::Resolved& r, const scenario::ResolvedAction& action) { return action.at.since_start() < r.scenario.duration; }

/// By node, the ports that the stream's frames leave by at any time.
using Ports = std::map<std::uint32_t, std::set<std::uint16_t>>;

class PathFinder {
 public:
  PathFinder(const scenario::Resolved& r, const models::StreamPlan& plan, const Ports& ports) : r_(r), plan_(plan), ports_(ports) {}

  std::optional<std::vector<PossiblePath>> find() {
    scenario::Path path{plan_.talker.value};
    if (r_.topology.chooses_ports[plan_.talker.value]) {
      if (!pass(path, plan_.talker.value)) return std::nullopt;
    } else {
      for (const scenario::Neighbour& neighbour : r_.topology.neighbours[plan_.talker.value])
        if (!follow(path, neighbour.node)) return std::nullopt;
    }
    return std::move(found_);
  }

 private:
  bool follow(scenario::Path& path, std::uint32_t node) {
    if (std::find(path.begin(), path.end(), node) != path.end()) return false;
    path.push_back(node);
    const models::NodePlan& plan = r_.plan.nodes[node];
    const bool is_fine = (!is_taken_in(node) || arrive(path, node)) && (!plan.forwards() || pass(path, node));
    path.pop_back();
    return is_fine;
  }
  bool is_taken_in(std::uint32_t node) const {
    if (!r_.plan.nodes[node].forwards()) return true;
    const auto entry = ports_.find(node);
    return entry != ports_.end() && entry->second.contains(models::internal_port);
  }
  bool arrive(const scenario::Path& path, std::uint32_t node) {
    const auto listener = std::find(plan_.listeners.begin(), plan_.listeners.end(), models::NodeIndex{node});
    if (listener != plan_.listeners.end()) found_.push_back({path, static_cast<std::size_t>(listener - plan_.listeners.begin())});
    return found_.size() <= most_paths;
  }
  bool pass(scenario::Path& path, std::uint32_t node) {
    const auto entry = ports_.find(node);
    if (entry == ports_.end()) return true;   // the frame is lost there
    for (const scenario::Neighbour& neighbour : r_.topology.neighbours[node]) {
      const bool came_by_it = path.size() > 1 && path[path.size() - 2] == neighbour.node;   // a bridge sends nothing back
      if (entry->second.contains(neighbour.port) && !came_by_it && !follow(path, neighbour.node)) return false;
    }
    return true;
  }

  const scenario::Resolved& r_;
  const models::StreamPlan& plan_;
  const Ports& ports_;
  std::vector<PossiblePath> found_;
};

}  // namespace

Outages::Outages(const scenario::Resolved& resolved) : resolved_(&resolved), links_(resolved.plan.links.size()), nodes_(resolved.plan.nodes.size()) {
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

std::optional<std::vector<PossiblePath>> rerouted_paths(const scenario::Resolved& resolved, const scenario::ResolvedStream& stream) {
  const models::StreamPlan& plan = resolved.plan.streams[stream.index.value];
  Ports ports;
  bool is_rerouted = false;
  for (const scenario::ResolvedAction& action : resolved.script) {
    const auto* const routes = std::get_if<scenario::ResolvedRoutes>(&action.what);
    if (routes == nullptr || !happens(resolved, action)) continue;
    for (const scenario::ResolvedRoutes::Entry& entry : routes->entries)
      if (entry.vlan == plan.vlan && entry.address == plan.destination) {
        ports[entry.node.value].insert(entry.ports.begin(), entry.ports.end());
        is_rerouted = true;
      }
  }
  if (!is_rerouted) return std::vector<PossiblePath>();
  for (const models::FilteringPlan& entry : resolved.plan.filtering)
    if (entry.vlan == plan.vlan && entry.address == plan.destination) ports[entry.node.value].insert(entry.port);
  return PathFinder(resolved, plan, ports).find();
}

}  // namespace takt::analysis
