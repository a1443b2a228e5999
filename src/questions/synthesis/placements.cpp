// SPDX-License-Identifier: Apache-2.0
#include "synthesis/placements.hpp"

#include <algorithm>
#include <map>
#include <queue>
#include <set>
#include <span>
#include <utility>

#include "analysis/bounds.hpp"
#include "scenario/gates/offsets.hpp"
#include "sim/random.hpp"

namespace takt::synthesis {
namespace {

using scenario::Path;
using scenario::Resolved;
using scenario::Scenario;
using sim::Duration;

constexpr std::uint32_t most_draws = 6;     // of offsets, for each choice of ways
constexpr std::uint32_t most_own_ways = 2;  // of the stream whose requirement breaks, besides its first

using LinkSet = std::set<std::pair<std::uint32_t, std::uint32_t>>;  // by the nodes at both ends

/// The way with fewest links of those that have fewest of `avoided`.
std::optional<Path> way_round(const scenario::Topology& topology, std::uint32_t from, std::uint32_t to,
                              const LinkSet& avoided) {
  constexpr std::uint64_t dear = 1'000'000;
  std::vector<std::uint64_t> cost(topology.nodes.size(), ~std::uint64_t{0});
  std::vector<std::uint32_t> before(topology.nodes.size(), from);
  using Entry = std::pair<std::uint64_t, std::uint32_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  cost[from] = 0;
  queue.emplace(0, from);
  while (!queue.empty()) {
    const auto [at, here] = queue.top();
    queue.pop();
    if (at > cost[here] || (here != from && !topology.nodes[here].forwards())) continue;
    for (const scenario::Neighbour& next : topology.neighbours[here]) {
      const std::uint64_t then = at + 1 + (avoided.contains({here, next.node}) ? dear : 0);
      if (then >= cost[next.node]) continue;
      cost[next.node] = then;
      before[next.node] = here;
      queue.emplace(then, next.node);
    }
  }
  if (cost[to] == ~std::uint64_t{0}) return std::nullopt;
  Path path{to};
  while (path.back() != from) path.push_back(before[path.back()]);
  std::ranges::reverse(path);  // of neighbours that several links join the first
  return path;
}

std::size_t shared(const Path& path, const LinkSet& links) {
  std::size_t count = 0;
  for (std::size_t i = 0; i + 1 < path.size(); ++i) count += links.count({path[i], path[i + 1]});
  return count;
}

/// Those between nodes that forward: the others nobody can avoid.
void add_links(const scenario::Topology& topology, const Path& path, LinkSet& links) {
  for (std::size_t i = 0; i + 1 < path.size(); ++i)
    if (topology.nodes[path[i]].forwards() && topology.nodes[path[i + 1]].forwards())
      links.emplace(path[i], path[i + 1]);
}

std::vector<std::string> names_of(const scenario::Topology& topology, const Path& path) {
  std::vector<std::string> names;
  for (const std::uint32_t node : path) names.push_back(topology.nodes[node].name);
  return names;
}

class Placer {
 public:
  Placer(const Scenario& asked, const PlacementOptions& options) : asked_(asked), options_(options) {
    for (std::size_t i = 0; i < asked.streams.size(); ++i)
      if (asked.streams[i].offset && asked.streams[i].offset->is_auto) is_movable_.insert(asked.streams[i].name);
  }

  Placed run(std::unique_ptr<Resolved> first) {
    if (note(std::move(first), "as soon as possible", false)) return std::move(placed_);
    // What breaks is looked at as the first schedule has it, so that the list does not depend on what came in between.
    const analysis::Bounds bounds = analysis::bound(*placed_.best.resolved);
    const analysis::StreamBound* const victim = victim_of(bounds);
    if (victim == nullptr) return std::move(placed_);
    name_ = victim->name;
    find_port(*victim, *placed_.best.resolved);
    const std::vector<std::pair<Scenario, std::string>> others = other_ways(*placed_.best.resolved, victim->index);
    const Scenario begun = with_gates_open(placed_.best.resolved->scenario);
    if (try_offsets(begun, scenario::GateProblem(placed_.best.resolved->gates->problem), {})) return std::move(placed_);
    for (const auto& [scenario, how] : others) {
      if (options_.stop()) break;
      auto resolved = options_.resolve(scenario);
      if (!resolved) continue;
      const Scenario here = with_gates_open(resolved->scenario);
      const scenario::GateProblem problem = resolved->gates->problem;
      if (note(std::move(resolved), how, true) || try_offsets(here, problem, how)) break;
    }
    return std::move(placed_);
  }

 private:
  /// Of the first requirement that breaks and is of a stream without windows; null: there is none, and a frame with
  /// windows takes as long at any time.
  const analysis::StreamBound* victim_of(const analysis::Bounds& bounds) const {
    std::set<std::string_view> scheduled;
    for (const scenario::ScheduledStream& stream : placed_.best.resolved->gates->problem.streams)
      scheduled.insert(stream.name);
    for (const StreamRequirement& each : placed_.best.requirements) {
      if (each.state != StreamRequirement::State::broken) continue;
      const analysis::StreamBound* slowest = nullptr;
      for (const analysis::StreamBound& stream : bounds.streams)
        if (!scheduled.contains(stream.name) && (each.stream == stream.name || each.stream == "*") &&
            (slowest == nullptr || stream.latency.value_or(Duration()) > slowest->latency.value_or(Duration())))
          slowest = &stream;
      if (slowest != nullptr) return slowest;
    }
    return nullptr;
  }

  /// The gates as they were asked for, and all else as it was chosen.
  Scenario with_gates_open(const Scenario& chosen) const {
    Scenario made = chosen;
    made.gates = asked_.gates;
    return made;
  }

  /// True: all that is required is kept.
  bool note(std::unique_ptr<Resolved> resolved, std::string how, bool has_other_ways) {
    ++placed_.tried;
    Placement made{std::move(resolved), std::move(how), has_other_ways, {}};
    made.requirements = stream_requirements(*made.resolved, analysis::bound(*made.resolved));
    const Shortfall shortfall = shortfall_of(made.requirements);
    if (placed_.best.resolved && shortfall_of(placed_.best.requirements) <= shortfall) return false;
    placed_.best = std::move(made);
    return shortfall.broken == 0;
  }

  /// Of the gated ports on its way the one where the victim waits longest.
  void find_port(const analysis::StreamBound& victim, const Resolved& resolved) {
    Duration most;
    for (const analysis::HopBound& hop : victim.hops)
      for (const scenario::GatedPort& port : resolved.gates->problem.ports)
        if (port.node == hop.node && port.port == hop.port &&
            (port_.empty() || hop.delay.value_or(Duration()) > most)) {
          most = hop.delay.value_or(Duration());
          port_ = port.name;
        }
  }

  std::vector<std::pair<Scenario, std::string>> other_ways(const Resolved& resolved, models::StreamIndex victim) const {
    std::vector<std::pair<Scenario, std::string>> made;
    const scenario::Topology& topology = resolved.topology;
    const Path own = resolved.streams[victim.value].paths.front();
    LinkSet links;
    for (const Path& path : resolved.streams[victim.value].paths) add_links(topology, path, links);
    // Whoever may goes round.
    Scenario round = asked_;
    bool is_other = false;
    for (scenario::Stream& stream : round.streams) {
      if (!options_.open.contains(stream.name) || stream.name == name_) continue;
      const auto known = std::ranges::find_if(resolved.streams, [&](const scenario::ResolvedStream& each) {
        return resolved.plan.streams[each.index.value].name == stream.name;
      });
      if (known == resolved.streams.end() || known->paths.size() != 1) continue;
      const Path& now = known->paths.front();
      const auto path = way_round(topology, now.front(), now.back(), links);
      if (!path || shared(*path, links) >= shared(now, links)) continue;
      stream.path = names_of(topology, *path);
      is_other = true;
    }
    if (is_other) made.emplace_back(std::move(round), "ways round those of " + name_);
    const auto entry = std::ranges::find(asked_.streams, name_, &scenario::Stream::name);
    if (!options_.open.contains(name_) || entry == asked_.streams.end() ||
        resolved.streams[victim.value].paths.size() != 1)
      return made;
    std::set<Path> known{own};
    for (std::uint32_t i = 0; i < most_own_ways; ++i) {
      const auto path = way_round(topology, own.front(), own.back(), links);
      if (!path || !known.insert(*path).second) break;
      add_links(topology, *path, links);
      made.emplace_back(asked_, "another way of " + name_ + (i == 0 ? "" : " (" + std::to_string(i + 1) + ")"));
      made.back().first.streams[static_cast<std::size_t>(entry - asked_.streams.begin())].path =
          names_of(topology, *path);
    }
    return made;
  }

  /// The same ways, other times. `ways`: what is said of them; empty: those that were asked for.
  bool try_offsets(const Scenario& begun, const scenario::GateProblem& problem, const std::string& ways) {
    std::map<std::string, std::size_t, std::less<>> entry_of;
    for (std::size_t i = 0; i < begun.streams.size(); ++i) entry_of[begun.streams[i].name] = i;
    std::vector<std::uint32_t> movable;  // streams of the problem
    for (std::uint32_t s = 0; s < problem.streams.size(); ++s)
      if (is_movable_.contains(problem.streams[s].name)) movable.push_back(s);
    if (movable.empty()) return false;
    const auto attempt = [&](const std::vector<Duration>& targets, const std::string& name) {
      scenario::OffsetProblem moved;
      moved.gates = problem;
      for (std::size_t m = 0; m < movable.size(); ++m) {
        scenario::ScheduledStream& stream = moved.gates.streams[movable[m]];
        const Duration chosen = begun.streams[entry_of.at(stream.name)].offset->value;
        stream.release += targets[m] - chosen;
        moved.movable.push_back({movable[m]});
      }
      const std::vector<scenario::ChosenOffset> offsets = scenario::choose_offsets(moved);
      if (std::ranges::any_of(offsets, [](const scenario::ChosenOffset& each) { return !each.meetings.empty(); }))
        return false;
      Scenario made = begun;
      for (std::size_t m = 0; m < movable.size(); ++m) {
        const scenario::ScheduledStream& stream = problem.streams[movable[m]];
        made.streams[entry_of.at(stream.name)].offset =
            json::OrAuto<Duration>(Duration::from_ps((targets[m] + offsets[m].offset).ps() % stream.period.ps()));
      }
      auto resolved = options_.resolve(made);
      return resolved && note(std::move(resolved), ways.empty() ? name : name + ", " + ways, !ways.empty());
    };
    // When each is at the port, counted from its start; nothing if it does not come there.
    std::vector<std::optional<Duration>> lags;
    std::int64_t there = 0;
    for (const std::uint32_t s : movable) {
      lags.push_back(lag_of(problem, problem.streams[s]));
      there += lags.back() ? 1 : 0;
    }
    const auto at_port = [&](bool is_spread) {
      std::vector<Duration> targets;
      std::int64_t turn = 0;
      for (std::size_t m = 0; m < movable.size(); ++m) {
        const Duration period = problem.streams[movable[m]].period;
        const Duration at = lags[m] && is_spread ? period / there * turn++ : Duration();
        targets.push_back(lags[m] ? whole_ns(modulo(at - *lags[m], period)) : Duration());
      }
      return targets;
    };
    if (there > 1 && (attempt(at_port(false), "one behind the other at " + port_) ||
                      (!options_.stop() && attempt(at_port(true), "spread at " + port_))))
      return true;
    for (std::uint32_t draw = 0; draw < most_draws && !options_.stop(); ++draw) {
      std::vector<Duration> targets;
      for (const std::uint32_t s : movable) {
        sim::RandomStream random(options_.seed, problem.streams[s].name, "placement " + std::to_string(draw));
        // Anywhere, or close together.
        const Duration within = draw % 2 == 0 ? problem.streams[s].period : problem.streams[s].period / 4;
        targets.push_back(whole_ns(
            Duration::from_ps(static_cast<std::int64_t>(random.below(static_cast<std::uint64_t>(within.ps()))))));
      }
      if (attempt(targets, "drawn (" + std::to_string(draw + 1) + ")")) return true;
    }
    return false;
  }

  std::optional<Duration> lag_of(const scenario::GateProblem& problem, const scenario::ScheduledStream& stream) const {
    std::vector<Duration> at(stream.hops.size());
    for (std::size_t h = 0; h < stream.hops.size(); ++h) {
      if (const auto previous = stream.hops[h].previous)
        at[h] = at[*previous] + stream.hops[*previous].transmission + stream.hops[*previous].behind;
      if (problem.ports[stream.hops[h].port].name == port_) return at[h];
    }
    return std::nullopt;
  }

  static Duration modulo(Duration time, Duration period) {
    return Duration::from_ps((time.ps() % period.ps() + period.ps()) % period.ps());
  }
  static Duration whole_ns(Duration time) { return Duration::from_ps(time.ps() / 1'000 * 1'000); }

  const Scenario& asked_;
  const PlacementOptions& options_;
  std::set<std::string, std::less<>> is_movable_;
  std::string name_;  ///< of the stream whose requirement breaks
  std::string port_;  ///< where it waits longest; empty: at none that has windows
  Placed placed_;
};

}  // namespace

Placed place_for_requirements(std::unique_ptr<Resolved> first, const Scenario& asked, const PlacementOptions& options) {
  return Placer(asked, options).run(std::move(first));
}

}  // namespace takt::synthesis
