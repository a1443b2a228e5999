#include "scenario/stream_builder.hpp"

#include <algorithm>
#include <set>

#include "models/ethernet/sizes.hpp"
#include "scenario/limits.hpp"

namespace takt::scenario {

std::optional<std::uint32_t> StreamBuilder::host(const std::string& name, const json::Place& place) {
  const auto node = r_.topology.find(name);
  if (!node) {
    diagnostics_.error(place, "unknown node", {json::quote(name), "the name of a host", suggest_node(r_.topology, name, diagnostics_)});
    return std::nullopt;
  }
  if (!r_.topology.nodes[*node].is_host()) {
    diagnostics_.error(place, "not a host", {"the switch " + json::quote(name), "the name of a host"});
    return std::nullopt;
  }
  return node;
}

std::optional<models::StreamIndex> StreamBuilder::add(const NewStream& wanted) {
  const std::size_t errors_before = diagnostics_.errors();
  check_size(wanted);
  if (!wanted.from || wanted.to.empty()) return std::nullopt;
  std::set<std::uint32_t> receivers;
  for (const auto& [to, place] : wanted.to) {
    if (to == *wanted.from)
      diagnostics_.error(place, "a stream to its own sender", {json::quote(r_.topology.nodes[to].name), "another host"});
    if (!receivers.insert(to).second)
      diagnostics_.error(place, "a receiver twice", {json::quote(r_.topology.nodes[to].name), "each receiver once"});
  }
  if (diagnostics_.errors() != errors_before) return std::nullopt;
  std::vector<Path> paths = paths_of(wanted);
  if (diagnostics_.errors() != errors_before) return std::nullopt;

  for (const Path& path : paths) path_nodes_ += path.size();
  if (path_nodes_ > most_path_nodes) {
    diagnostics_.error(wanted.where.place(), "too many nodes on all paths together", {"more with this stream", "at most " + std::to_string(most_path_nodes)});
    return std::nullopt;
  }

  const bool is_group = wanted.to.size() > 1 || wanted.path != nullptr;
  const models::AddressIndex address{is_group ? static_cast<std::uint32_t>(r_.plan.nodes.size()) + groups_++ : wanted.to.front().first};
  models::StreamPlan plan;
  plan.name = wanted.name;
  plan.talker = models::NodeIndex{*wanted.from};
  plan.destination = address;
  plan.vlan = wanted.vlan;
  plan.priority = wanted.priority;
  plan.headers = wanted.headers;
  for (const auto& [to, place] : wanted.to) plan.listeners.push_back(models::NodeIndex{to});
  for (const Path& path : paths) add_filtering(path, wanted.vlan, address);

  const models::StreamIndex index{static_cast<std::uint32_t>(r_.plan.streams.size())};
  r_.plan.streams.push_back(std::move(plan));
  r_.streams.push_back({index, std::move(paths), {}, wanted.where, wanted.of_program, wanted.payload});
  return index;
}

bool StreamBuilder::check_size(const NewStream& wanted) {
  const Octets msdu = wanted.headers + wanted.payload;
  if (msdu <= models::maximum_msdu) return true;
  diagnostics_.error(wanted.of_program ? wanted.where.at("fields") : wanted.where.at("payload"), "more than one frame",
                     {std::to_string(msdu.count) + " octets after the EtherType", "at most 1500 with all headers"});
  return false;
}

std::vector<Path> StreamBuilder::paths_of(const NewStream& wanted) {
  std::vector<Path> paths;
  if (wanted.path != nullptr) {
    if (auto path = explicit_path(wanted)) paths.push_back(std::move(*path));
    return paths;
  }
  for (const auto& [to, place] : wanted.to) {
    auto path = wanted.to.size() == 1 ? router_.to_host(*wanted.from, to) : router_.from_host(*wanted.from, to);
    if (path)
      paths.push_back(std::move(*path));
    else
      diagnostics_.error(place, "no path", {json::quote(r_.topology.nodes[to].name) + " cannot be reached from " + json::quote(r_.topology.nodes[*wanted.from].name),
                                            "links that join them over switches"});
  }
  return paths;
}

std::optional<Path> StreamBuilder::explicit_path(const NewStream& wanted) {
  Path path;
  const std::size_t errors_before = diagnostics_.errors();
  if (wanted.to.size() != 1) {
    diagnostics_.error(wanted.where.at("path"), "a path for several receivers", {std::to_string(wanted.to.size()) + " receivers", "one receiver"});
    return std::nullopt;
  }
  std::set<std::uint32_t> seen;
  for (std::size_t i = 0; i < wanted.path->size(); ++i) {
    const std::string& name = (*wanted.path)[i];
    const json::Place place = wanted.where.at("path", i);
    const auto node = r_.topology.find(name);
    if (!node) {
      diagnostics_.error(place, "unknown node", {json::quote(name), "the name of a node", suggest_node(r_.topology, name, diagnostics_)});
      continue;
    }
    if (!seen.insert(*node).second) diagnostics_.error(place, "a node twice in one path", {json::quote(name), "each node once"});
    const bool inner = i > 0 && i + 1 < wanted.path->size();
    if (inner && r_.topology.nodes[*node].is_host())
      diagnostics_.error(place, "a host inside a path", {json::quote(name), "a switch, since hosts do not forward"});
    if (!path.empty() && !r_.topology.port_towards(path.back(), *node))
      diagnostics_.error(place, "no link", {"none between " + json::quote(r_.topology.nodes[path.back()].name) + " and " + json::quote(name), "neighbours along the path"});
    path.push_back(*node);
  }
  if (diagnostics_.errors() != errors_before) return std::nullopt;
  if (path.front() != *wanted.from || path.back() != wanted.to.front().first) {
    diagnostics_.error(wanted.where.at("path"), "a path between other nodes",
                       {json::quote(wanted.path->front()) + " to " + json::quote(wanted.path->back()),
                        json::quote(r_.topology.nodes[*wanted.from].name) + " to " + json::quote(r_.topology.nodes[wanted.to.front().first].name)});
    return std::nullopt;
  }
  return path;
}

void StreamBuilder::add_filtering(const Path& path, models::VlanId vlan, models::AddressIndex address) {
  for (std::size_t i = 1; i + 1 < path.size(); ++i)
    r_.plan.filtering.push_back({models::NodeIndex{path[i]}, vlan, address, *r_.topology.port_towards(path[i], path[i + 1])});
}

}  // namespace takt::scenario
