// SPDX-License-Identifier: Apache-2.0
#include "schedule_instances/builder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <unordered_set>

namespace takt::schedule_instances {

using namespace schedule;

Builder::Builder(const Problem& problem, json::Diagnostics& diagnostics)
    : diagnostics_(diagnostics), problem_(problem) {
  for (NodeIndex n = 0; n < problem.nodes.size(); ++n) nodes_.emplace(problem.nodes[n].name, n);
  for (LinkIndex l = 0; l < problem.links.size(); ++l) {
    links_.emplace(problem.links[l].name, l);
    between_.emplace(std::uint64_t{problem.links[l].from} << 32 | problem.links[l].to, l);
  }
  for (StreamIndex s = 0; s < problem.streams.size(); ++s) streams_.emplace(problem.streams[s].name, s);
}

std::optional<StreamIndex> Builder::stream(const std::string& name) const {
  const auto found = streams_.find(name);
  return found == streams_.end() ? std::nullopt : std::optional(found->second);
}

void Builder::add_node(const std::string& name, bool is_bridge, const json::Place& where) {
  if (!nodes_.emplace(name, static_cast<NodeIndex>(problem_.nodes.size())).second)
    return diagnostics_.error(where, fmt::format("node {} is there twice", json::quote(name)));
  problem_.nodes.push_back({name, is_bridge});
  places_.nodes.push_back(where);
}

Ps Builder::octet_of(std::int64_t rate, const json::Place& where) {
  constexpr std::int64_t octet_at_1_bps = 8 * static_cast<std::int64_t>(ps_per_second);
  if (octet_at_1_bps % rate != 0)
    diagnostics_.error(where, "an octet takes no whole number of ps",
                       {fmt::format("{} bit/s", rate), "a rate such as 1000000000"});
  return octet_at_1_bps / rate;
}

NodeIndex Builder::node(const std::string& name, const json::Place& where) {
  const auto found = nodes_.find(name);
  if (found != nodes_.end()) return found->second;
  diagnostics_.error(where, fmt::format("there is no node {}", json::quote(name)));
  return 0;
}

void Builder::add_link(Link link, const std::string& from, const std::string& to, const json::Place& where) {
  const std::size_t mistakes = diagnostics_.errors();
  link.from = node(from, where);
  link.to = node(to, where);
  if (diagnostics_.errors() != mistakes) return;
  // A link from a node to itself is in some public instances. No way takes it.
  if (link.name.empty()) link.name = from + ">" + to;
  if (!links_.emplace(link.name, static_cast<LinkIndex>(problem_.links.size())).second)
    return diagnostics_.error(where, fmt::format("link {} is there twice", json::quote(link.name)));
  between_.emplace(std::uint64_t{link.from} << 32 | link.to, static_cast<LinkIndex>(problem_.links.size()));
  problem_.links.push_back(std::move(link));
  places_.links.push_back(where);
}

std::optional<LinkIndex> Builder::link(const std::string& name) const {
  const auto found = links_.find(name);
  return found == links_.end() ? std::nullopt : std::optional(found->second);
}

std::optional<LinkIndex> Builder::link_between(const std::string& from, const std::string& to) const {
  const auto a = nodes_.find(from), b = nodes_.find(to);
  if (a == nodes_.end() || b == nodes_.end()) return std::nullopt;
  const auto found = between_.find(std::uint64_t{a->second} << 32 | b->second);
  return found == between_.end() ? std::nullopt : std::optional(found->second);
}

void Builder::set_route(Stream& stream, std::vector<LinkIndex> links, const json::Place& where) {
  std::unordered_map<NodeIndex, std::vector<std::size_t>> from;
  for (std::size_t i = 0; i < links.size(); ++i) from[problem_.links[links[i]].from].push_back(i);
  std::vector<LinkIndex> ordered;
  std::unordered_set<NodeIndex> there;
  std::set<std::size_t> ready;  // of the links that begin where the route has come to, the first is next
  const auto come_to = [&](NodeIndex node) {
    there.insert(node);
    if (const auto found = from.find(node); found != from.end())
      ready.insert(found->second.begin(), found->second.end());
  };
  come_to(stream.talker);
  while (ordered.size() < links.size()) {
    if (ready.empty())
      return diagnostics_.error(where,
                                fmt::format("the route of {} is no tree from its talker", json::quote(stream.name)));
    const Link& next = problem_.links[links[*ready.begin()]];
    ordered.push_back(links[*ready.begin()]);
    ready.erase(ready.begin());
    if (there.contains(next.to))
      return diagnostics_.error(where,
                                fmt::format("the route of {} is no tree from its talker", json::quote(stream.name)));
    if (next.from != stream.talker && !problem_.nodes[next.from].is_bridge)
      return diagnostics_.error(
          where, fmt::format("the route of {} goes through {}, which forwards nothing", json::quote(stream.name),
                             json::quote(problem_.nodes[next.from].name)));
    come_to(next.to);
  }
  for (const NodeIndex listener : stream.listeners)
    if (!there.contains(listener))
      return diagnostics_.error(where, fmt::format("the route of {} does not come to {}", json::quote(stream.name),
                                                   json::quote(problem_.nodes[listener].name)));
  stream.route = std::move(ordered);
}

void Builder::add_stream(Stream stream, const json::Place& where) {
  if (!streams_.emplace(stream.name, static_cast<StreamIndex>(problem_.streams.size())).second)
    return diagnostics_.error(where, fmt::format("stream {} is there twice", json::quote(stream.name)));
  std::sort(stream.listeners.begin(), stream.listeners.end());
  if (std::adjacent_find(stream.listeners.begin(), stream.listeners.end()) != stream.listeners.end())
    return diagnostics_.error(where, fmt::format("stream {} names a listener twice", json::quote(stream.name)));
  if (std::find(stream.listeners.begin(), stream.listeners.end(), stream.talker) != stream.listeners.end())
    return diagnostics_.error(where,
                              fmt::format("the talker of stream {} is its listener, too", json::quote(stream.name)));
  problem_.streams.push_back(std::move(stream));
  places_.streams.push_back(where);
}

}  // namespace takt::schedule_instances
