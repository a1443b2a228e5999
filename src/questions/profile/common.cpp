// SPDX-License-Identifier: Apache-2.0
#include "profile/common.hpp"

#include <algorithm>

#include "json/quantity.hpp"

namespace takt::profile {
namespace {

constexpr std::size_t most_nodes_for_ways = 2'000;

/// The links to the farthest node over nodes with gPTP.
std::uint32_t farthest(const scenario::Topology& topology, const std::vector<bool>& has_gptp, std::uint32_t from) {
  std::vector<std::uint32_t> distance(topology.nodes.size(), 0);
  std::vector<bool> seen(topology.nodes.size());
  std::vector<std::uint32_t> queue = {from};
  seen[from] = true;
  for (std::size_t next = 0; next < queue.size(); ++next)
    for (const scenario::Neighbour& neighbour : topology.neighbours[queue[next]]) {
      if (seen[neighbour.node] || !has_gptp[neighbour.node]) continue;
      seen[neighbour.node] = true;
      distance[neighbour.node] = distance[queue[next]] + 1;
      // A host passes no time on.
      if (topology.nodes[neighbour.node].forwards()) queue.push_back(neighbour.node);
    }
  return *std::ranges::max_element(distance);
}

}  // namespace

std::string some_of(const std::vector<std::string>& names) {
  constexpr std::size_t most = 3;
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), most); ++i) text += (i == 0 ? "" : ", ") + names[i];
  if (names.size() > most) text += " and " + std::to_string(names.size() - most) + " more";
  return text;
}

std::string interval_text(int log) {
  const std::int64_t second = 1'000'000'000'000;
  return json::to_text(sim::Duration::from_ps(log < 0 ? second >> -log : second << log));
}

void judge_interval(const scenario::Resolved& resolved, Found& found, int asked, std::int8_t scenario::Gptp::*interval,
                    const char* key) {
  const std::optional<scenario::Gptp>& gptp = resolved.scenario.clocks.gptp;
  if (!gptp) return found.unknown("no gPTP");
  found.judge((*gptp).*interval == asked, interval_text((*gptp).*interval), gptp->where.at(key));
}

std::optional<std::uint32_t> longest_way(const scenario::Resolved& resolved) {
  const scenario::Topology& topology = resolved.topology;
  if (topology.nodes.size() > most_nodes_for_ways) return std::nullopt;
  std::vector<bool> has_gptp(topology.nodes.size(), true);
  if (resolved.scenario.clocks.gptp)
    for (const std::string& name : resolved.scenario.clocks.gptp->without)
      if (const auto node = topology.find(name)) has_gptp[*node] = false;
  std::uint32_t longest = 0;
  for (std::uint32_t n = 0; n < topology.nodes.size(); ++n)
    if (has_gptp[n]) longest = std::max(longest, farthest(topology, has_gptp, n));
  return longest;
}

std::vector<const scenario::Clock*> clocks_of(const scenario::Resolved& resolved) {
  std::vector<const scenario::Clock*> clocks;
  if (resolved.scenario.clocks.all) clocks.push_back(&*resolved.scenario.clocks.all);
  for (const auto& [name, clock] : resolved.scenario.clocks.nodes) clocks.push_back(&clock);
  return clocks;
}

}  // namespace takt::profile
