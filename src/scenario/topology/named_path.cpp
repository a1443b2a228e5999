#include "scenario/topology/named_path.hpp"

#include <set>

#include "json/suggest.hpp"

namespace takt::scenario {

std::optional<Path> named_path(const Topology& topology, std::span<const std::string> names, std::uint32_t from, std::uint32_t to,
                               const json::Place& place_of_all, const std::function<json::Place(std::size_t)>& place_of, json::Diagnostics& diagnostics) {
  Path path;
  const std::size_t errors_before = diagnostics.errors();
  std::set<std::uint32_t> seen;
  bool follows_a_gap = false;   // the node before is none, so no link is missed
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string& name = names[i];
    const json::Place place = place_of(i);
    const auto node = topology.find(name);
    if (!node) {
      report_unknown_node(topology, name, place, "the name of a node", diagnostics);
      follows_a_gap = true;
      continue;
    }
    if (!seen.insert(*node).second) diagnostics.error(place, "a node twice in one path", {json::quote(name), "each node once"});
    const bool inner = i > 0 && i + 1 < names.size();
    if (inner && !topology.nodes[*node].forwards())
      diagnostics.error_unless(topology.nodes[*node].is_of_unknown_kind, place, "a host inside a path", {json::quote(name), "a switch or a station, since hosts do not forward"});
    if (!path.empty() && !follows_a_gap && !topology.port_towards(path.back(), *node))
      diagnostics.error_unless(!topology.has_all_links, place, "no link", {"none between " + json::quote(topology.nodes[path.back()].name) + " and " + json::quote(name), "neighbours along the path"});
    follows_a_gap = false;
    path.push_back(*node);
  }
  if (diagnostics.errors() != errors_before) return std::nullopt;
  if (path.empty() || path.front() != from || path.back() != to) {
    diagnostics.error(place_of_all, "a path between other nodes",
                      {path.empty() ? "no nodes" : json::quote(names.front()) + " to " + json::quote(names.back()),
                       json::quote(topology.nodes[from].name) + " to " + json::quote(topology.nodes[to].name)});
    return std::nullopt;
  }
  return path;
}

}  // namespace takt::scenario
