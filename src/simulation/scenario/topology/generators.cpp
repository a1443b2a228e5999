// SPDX-License-Identifier: Apache-2.0
#include "scenario/topology/generators.hpp"

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

#include "scenario/description/limits.hpp"
#include "sim/random.hpp"
#include "sim/time.hpp"

namespace takt::scenario {
namespace {

using sim::int128;
using Edges = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

constexpr std::uint64_t most_random_links = 200'000;  // a full mesh of 600 switches has 179'700

/// As many links as a mean degree makes, rounded to whole ones.
std::uint64_t links_of(std::uint64_t switches, double degree) {
  return static_cast<std::uint64_t>(degree * static_cast<double>(switches) / 2 + 0.5);
}

/// The switches of a shape: how many, and which are joined. Hosts hang below those from `first_with_hosts` on.
struct Skeleton {
  int128 switches = 0;
  std::uint32_t first_with_hosts = 0;
};

class Checker {
 public:
  Checker(const Generator& generator, json::Diagnostics& diagnostics)
      : generator_(generator), diagnostics_(diagnostics) {}

  std::uint64_t need(const std::optional<std::uint64_t>& value, std::string_view name, std::uint64_t least = 1) {
    if (!value) {
      diagnostics_.error(
          generator_.where.place(), "missing key for this topology",
          {"a " + std::string(spelling(generator_.shape)) + " without it", "\"" + std::string(name) + "\""});
      failed_ = true;
      return least;
    }
    if (*value < least) {
      if (*value != 0)  // 0: the table has refused the value
        diagnostics_.error(generator_.where.at(name), "too few for this topology",
                           {std::to_string(*value), "at least " + std::to_string(least)});
      failed_ = true;
      return least;
    }
    return *value;
  }
  template <class T>
  void forbid(const std::optional<T>& value, std::string_view name) {
    if (!value) return;
    diagnostics_.error(generator_.where.at(name), "this topology has no such parameter",
                       {"\"" + std::string(name) + "\" of a " + std::string(spelling(generator_.shape))});
    failed_ = true;
  }
  /// Whether n switches can have this mean degree.
  void check_degree(std::uint64_t n) {
    if (!generator_.degree) {
      need(std::nullopt, "degree");
      return;
    }
    if (n > most_nodes) return;  // reported by their number
    const auto links = links_of(n, *generator_.degree);
    const std::uint64_t most = std::min(n * (n - 1) / 2, most_random_links);
    // Its switches must hang together, and no two of them are joined twice.
    if (n < 2 || (links + 1 >= n && links <= most)) return;
    diagnostics_.error(generator_.where.at("degree"),
                       links > most_random_links ? "too many links" : "no connected graph has this degree",
                       {std::to_string(links) + " links between " + std::to_string(n) + " switches",
                        std::to_string(n - 1) + " to " + std::to_string(most) + " links"});
    failed_ = true;
  }
  bool failed() const { return failed_; }

 private:
  const Generator& generator_;
  json::Diagnostics& diagnostics_;
  bool failed_ = false;
};

/// Stations take the place of the switches that would have hosts.
Skeleton stations_of(const Generator& g, Checker& check) {
  check.forbid(g.switches, "switches");
  switch (g.shape) {
    case Shape::line:
      return {check.need(g.stations, "stations"), 0};
    case Shape::ring:
      return {check.need(g.stations, "stations", 3), 0};
    case Shape::star:
      return {static_cast<int128>(check.need(g.stations, "stations")) + 1, 1};
    case Shape::dual_star:
      return {static_cast<int128>(check.need(g.stations, "stations")) + 2, 2};
    case Shape::tree:
    case Shape::mesh:
    case Shape::comb:
    case Shape::random:
      check.forbid(g.stations, "stations");
      break;
  }
  return {};
}

Skeleton skeleton_of(const Generator& g, Checker& check) {
  if (g.shape != Shape::tree) {
    check.forbid(g.depth, "depth");
    check.forbid(g.fanout, "fanout");
  }
  if (g.shape != Shape::mesh) {
    check.forbid(g.rows, "rows");
    check.forbid(g.columns, "columns");
  }
  if (g.shape != Shape::comb) check.forbid(g.teeth, "teeth");
  if (g.shape != Shape::random) {
    check.forbid(g.degree, "degree");
    check.forbid(g.seed, "seed");
  }
  if (g.stations) return stations_of(g, check);
  switch (g.shape) {
    case Shape::line:
      return {check.need(g.switches, "switches"), 0};
    case Shape::ring:
      return {check.need(g.switches, "switches", 3), 0};
    case Shape::star: {
      const std::uint64_t n = check.need(g.switches, "switches");
      return {n, n > 1 ? 1u : 0u};
    }
    case Shape::tree: {
      check.forbid(g.switches, "switches");
      const std::uint64_t depth = check.need(g.depth, "depth", 0);
      const std::uint64_t fanout = check.need(g.fanout, "fanout");
      int128 level = 1;
      int128 total = 1;
      int128 inner = 0;
      for (std::uint64_t d = 0; d < depth && total <= static_cast<int128>(most_nodes); ++d) {
        inner = total;
        level *= fanout;
        total += level;
      }
      return {total, static_cast<std::uint32_t>(inner < UINT32_MAX ? inner : UINT32_MAX)};
    }
    case Shape::mesh:
      if (g.switches) {
        check.forbid(g.rows, "rows");
        check.forbid(g.columns, "columns");
        // A full mesh has a link for each pair; bound those too.
        const std::uint64_t n = check.need(g.switches, "switches");
        return {n > 600 ? static_cast<int128>(most_nodes) + n : int128{n}, 0};
      }
      return {static_cast<int128>(check.need(g.rows, "rows")) * static_cast<int128>(check.need(g.columns, "columns")),
              0};
    case Shape::comb: {
      const std::uint64_t spine = check.need(g.switches, "switches");
      return {static_cast<int128>(spine) * (static_cast<int128>(check.need(g.teeth, "teeth", 0)) + 1), 0};
    }
    case Shape::random: {
      const std::uint64_t n = check.need(g.switches, "switches");
      check.check_degree(n);
      return {n, 0};
    }
    case Shape::dual_star:
      return {static_cast<int128>(check.need(g.switches, "switches")) + 2, 2};
  }
  return {};
}

/// The spine first, then tooth after tooth.
Edges comb_edges(const Generator& g) {
  Edges edges;
  const auto spine = static_cast<std::uint32_t>(*g.switches);
  for (std::uint32_t i = 1; i < spine; ++i) edges.emplace_back(i - 1, i);
  std::uint32_t next = spine;
  for (std::uint32_t i = 0; i < spine; ++i) {
    std::uint32_t end = i;
    for (std::uint64_t t = 0; t < *g.teeth; ++t) {
      edges.emplace_back(end, next);
      end = next++;
    }
  }
  return edges;
}

/// A random tree, so that it is connected, and random links until there are enough.
Edges random_edges(const Generator& g, std::uint32_t n) {
  const std::uint64_t wanted = links_of(n, *g.degree);
  sim::RandomStream chance(g.seed.value_or(1), "network", "topology");
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (std::uint32_t i = 1; i < n; ++i) edges.emplace(static_cast<std::uint32_t>(chance.below(i)), i);
  while (n > 1 && edges.size() < wanted) {
    const auto a = static_cast<std::uint32_t>(chance.below(n));
    const auto b = static_cast<std::uint32_t>(chance.below(n));
    if (a != b) edges.emplace(std::min(a, b), std::max(a, b));
  }
  return {edges.begin(), edges.end()};
}

Edges edges_of(const Generator& g, std::uint32_t n) {
  Edges edges;
  switch (g.shape) {
    case Shape::line:
    case Shape::ring:
      for (std::uint32_t i = 1; i < n; ++i) edges.emplace_back(i - 1, i);
      if (g.shape == Shape::ring) edges.emplace_back(n - 1, 0);
      break;
    case Shape::star:
      for (std::uint32_t i = 1; i < n; ++i) edges.emplace_back(0, i);
      break;
    case Shape::tree: {
      const auto fanout = static_cast<std::uint32_t>(*g.fanout);
      for (std::uint32_t i = 1; i < n; ++i) edges.emplace_back((i - 1) / fanout, i);
      break;
    }
    case Shape::mesh:
      if (g.switches) {
        for (std::uint32_t i = 0; i < n; ++i)
          for (std::uint32_t j = i + 1; j < n; ++j) edges.emplace_back(i, j);
      } else {
        const auto columns = static_cast<std::uint32_t>(*g.columns);
        for (std::uint32_t i = 0; i < n; ++i) {
          if (i % columns != 0) edges.emplace_back(i - 1, i);
          if (i >= columns) edges.emplace_back(i - columns, i);
        }
      }
      break;
    case Shape::comb:
      return comb_edges(g);
    case Shape::random:
      return random_edges(g, n);
    case Shape::dual_star:
      for (std::uint32_t leaf = 2; leaf < n; ++leaf)
        for (const std::uint32_t core : {0u, 1u}) edges.emplace_back(core, leaf);
      break;
  }
  return edges;
}

}  // namespace

Generated generate(const Generator& g, std::uint64_t room, json::Diagnostics& diagnostics) {
  Checker check(g, diagnostics);
  const Skeleton skeleton = skeleton_of(g, check);
  if (check.failed()) return {};
  const int128 with_hosts = skeleton.switches - skeleton.first_with_hosts;
  const int128 hosts = g.stations ? int128{0} : with_hosts * static_cast<int128>(g.hosts_per_switch);
  if (skeleton.switches + hosts > static_cast<int128>(room)) {
    diagnostics.error(
        g.where.place(), "too many nodes",
        {json::to_text(skeleton.switches) + (g.stations ? " switches and stations and " : " switches and ") +
             json::to_text(hosts) + " hosts",
         "at most " + std::to_string(most_nodes) + " nodes in a scenario, 600 switches in a full mesh"});
    return {};
  }
  Generated made;
  const auto n = static_cast<std::uint32_t>(skeleton.switches);
  for (std::uint32_t i = 0; i < n; ++i) {
    const bool is_station = g.stations && i >= skeleton.first_with_hosts;
    const std::uint32_t first = is_station ? skeleton.first_with_hosts : 0;
    made.nodes.push_back({(is_station ? g.station_prefix : g.switch_prefix) + std::to_string(i - first + 1),
                          is_station ? models::NodeKind::station : models::NodeKind::bridge});
  }
  for (const auto& [a, b] : edges_of(g, n)) made.links.push_back({a, b, false});
  std::uint64_t host = 0;
  for (std::uint32_t i = skeleton.first_with_hosts; i < n && !g.stations; ++i) {
    for (std::uint64_t k = 0; k < g.hosts_per_switch; ++k) {
      made.links.push_back({i, static_cast<std::uint32_t>(made.nodes.size()), true});
      made.nodes.push_back({g.host_prefix + std::to_string(++host), models::NodeKind::host});
    }
  }
  return made;
}

}  // namespace takt::scenario
