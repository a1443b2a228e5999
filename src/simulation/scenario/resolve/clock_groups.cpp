// SPDX-License-Identifier: Apache-2.0
#include "scenario/resolve/clock_groups.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "results/run_result.hpp"
#include "scenario/figures/requirement.hpp"
#include "scenario/topology/node_sets.hpp"

namespace takt::scenario {
namespace {

bool asks_for_clocks(const RequiredFigure& required) {
  return required.kind == results::RequirementKind::clocks ||
         (!required.figure.steps.empty() && required.figure.steps.front() == "clock_differences");
}

}  // namespace

std::vector<std::vector<std::uint32_t>> nodes_joined_by_ways(const Resolved& resolved) {
  const auto nodes = static_cast<std::uint32_t>(resolved.plan.nodes.size());
  NodeSets sets(nodes);
  std::vector<bool> is_on_way(nodes, false);
  const auto join = [&](std::uint32_t a, std::uint32_t b) {
    is_on_way[a] = is_on_way[b] = true;
    sets.unite(a, b);
  };
  for (const ResolvedStream& stream : resolved.streams)
    for (const Path& path : stream.paths)
      for (const std::uint32_t node : path) join(path.front(), node);
  for (const ResolvedAction& action : resolved.script)  // ways that rerouting lays
    if (const auto* const routes = std::get_if<ResolvedRoutes>(&action.what))
      for (const ResolvedRoutes::Entry& entry : routes->entries)
        for (const Neighbour& neighbour : resolved.topology.neighbours[entry.node.value])
          if (std::ranges::find(entry.ports, neighbour.port) != entry.ports.end())
            join(entry.node.value, neighbour.node);
  std::vector<std::vector<std::uint32_t>> parts;
  std::vector<std::size_t> part_of(nodes, nodes);
  for (std::uint32_t n = 0; n < nodes; ++n) {
    if (!is_on_way[n]) continue;
    std::size_t& part = part_of[sets.root(n)];
    if (part == nodes) {
      part = parts.size();
      parts.emplace_back();
    }
    parts[part].push_back(n);
  }
  return parts;
}

std::string clock_group_name(const Names& clocks) {
  if (clocks.names.size() == 1 && clocks.names.front() == "*") return all_clocks;
  std::string name;
  for (const std::string& each : clocks.names) name += (name.empty() ? "" : ", ") + each;
  return name;
}

std::vector<ClockGroup> clock_groups(const Resolved& resolved) {
  std::vector<ClockGroup> groups{{all_clocks, std::vector<std::uint32_t>(resolved.plan.nodes.size())}};
  std::iota(groups.front().nodes.begin(), groups.front().nodes.end(), 0U);
  std::vector<std::vector<std::uint32_t>> joined = nodes_joined_by_ways(resolved);
  if (!resolved.plan.gptp.empty())
    for (std::vector<std::uint32_t>& part : joined)
      std::erase_if(part, [&](std::uint32_t node) { return !resolved.plan.gptp[node]; });
  for (std::size_t i = 0; i < joined.size(); ++i)
    groups.push_back({clocks_on_ways + (joined.size() > 1 ? " " + std::to_string(i + 1) : std::string()), joined[i]});
  for (const RequiredFigure& required : resolved.requirements) {
    if (required.kind != results::RequirementKind::clocks ||
        std::ranges::find(groups, required.subject, &ClockGroup::name) != groups.end())
      continue;
    ClockGroup& group = groups.emplace_back(ClockGroup{required.subject, {}});
    for (const std::string& name : resolved.scenario.require[required.entry].clocks->names)
      if (const auto node = resolved.topology.find(name)) group.nodes.push_back(*node);
    std::ranges::sort(group.nodes);
  }
  return groups;
}

std::optional<Duration> look_every(const Resolved& resolved) {
  if (resolved.scenario.clocks.gptp) return resolved.scenario.clocks.gptp->report_every;
  return std::ranges::any_of(resolved.requirements, asks_for_clocks) ? std::optional(Gptp{}.report_every)
                                                                     : std::nullopt;
}

Duration election_time(const Gptp& gptp) {
  const auto interval = [](int log_seconds) { return Duration::from_ps(std::llround(std::ldexp(1e12, log_seconds))); };
  return interval(gptp.log_announce_interval) * static_cast<std::int64_t>(gptp.announce_receipt_timeout) +
         interval(gptp.log_pdelay_interval) * 2;
}

}  // namespace takt::scenario
