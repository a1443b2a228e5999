// SPDX-License-Identifier: Apache-2.0
#include "analysis/server_network.hpp"

#include <algorithm>
#include <map>
#include <tuple>

#include "sim/check.hpp"

namespace takt::analysis {
namespace {

constexpr std::size_t nowhere = ~std::size_t{0};  // before the first server of a path; no flow

using Flows = std::vector<std::size_t>;  // ascending

std::size_t server_before(const ServerFlow& flow, std::size_t server) {
  const auto found = std::find(flow.path.begin(), flow.path.end(), server);
  TAKT_CHECK(found != flow.path.end(), "the flow passes the server");
  return found == flow.path.begin() ? nowhere : *(found - 1);
}

/// Arrivals of groups of flows at servers, worked out backwards from where they are asked for.
class Arrivals {
 public:
  /// `spared`, if there is one, is nobody's cross traffic on its own path, for as long as others have come along with
  /// it.
  Arrivals(const ServerNetwork& network, std::size_t spared)
      : network_(network), spared_(spared), flows_at_(network.servers.size()) {
    for (std::size_t f = 0; f < network.flows.size(); ++f)
      for (const std::size_t server : network.flows[f].path) flows_at_[server].push_back(f);
  }

  const Flows& flows_at(std::size_t server) const { return flows_at_[server]; }

  /// What these flows bring to a server together. `along`: the flow that is spared is there, and looked at from its own
  /// path. Nothing if unbounded.
  std::optional<TokenBucket> at(std::size_t server, const Flows& flows, bool along) {
    std::map<std::size_t, Flows> by_link;  // by the server before
    for (const std::size_t f : flows) by_link[before(f, server)].push_back(f);
    TokenBucket sum;
    for (const auto& [from, group] : by_link) {
      std::optional<TokenBucket> part = TokenBucket{};
      if (from == nowhere)
        for (const std::size_t f : group) part = *part + network_.flows[f].arrival;
      else
        part = out_of(from, group, along && before(spared_, server) == from);
      if (!part) return std::nullopt;
      sum = sum + *part;
    }
    return sum;
  }

  /// What a server leaves to these flows.
  std::optional<RateLatency> left_over(std::size_t server, const Flows& flows, bool along) {
    const Flows others = others_at(server, flows, along);
    const RateLatency& service = network_.servers[server].service;
    if (others.empty()) return service;
    const std::optional<TokenBucket> cross = at(server, others, along);
    if (!cross) return std::nullopt;
    return network_.multiplexing == Multiplexing::fifo ? left_over_fifo(service, *cross)
                                                       : left_over_arbitrary(service, *cross);
  }

 private:
  /// All flows but these, and but the one that is spared where that is looked at from its own path.
  Flows others_at(std::size_t server, const Flows& flows, bool along) const {
    Flows others;
    for (const std::size_t f : flows_at_[server])
      if (!(along && f == spared_) && !std::binary_search(flows.begin(), flows.end(), f)) others.push_back(f);
    return others;
  }

  /// What these flows, which all go through `server`, bring out of it.
  std::optional<TokenBucket> out_of(std::size_t server, const Flows& flows, bool along) {
    const auto [known, is_new] = known_.try_emplace({server, flows, along});
    if (!is_new) return known->second;
    // Back along the path that they have in common.
    const std::size_t common = before(flows.front(), server);
    const bool all_came_so = common != nowhere && std::all_of(flows.begin(), flows.end(), [&](std::size_t f) {
                               return before(f, server) == common;
                             });
    const std::optional<TokenBucket> in =
        all_came_so ? out_of(common, flows, along && before(spared_, server) == common) : at(server, flows, along);
    std::optional<TokenBucket> out;
    if (in)
      if (const std::optional<RateLatency> service = left_over(server, flows, along)) out = output_bound(*in, *service);
    return known_[{server, flows, along}] = out;
  }

  std::size_t before(std::size_t flow, std::size_t server) const { return server_before(network_.flows[flow], server); }

  const ServerNetwork& network_;
  std::size_t spared_;
  std::vector<Flows> flows_at_;
  std::map<std::tuple<std::size_t, Flows, bool>, std::optional<TokenBucket>> known_;
};

/// A stretch of the analysed flow's path along which another flow goes with it.
struct Stretch {
  std::size_t first = 0;
  std::size_t last = 0;        // by their place in the path
  std::size_t from = nowhere;  // by which link it comes
};

/// Whether the analysed flow may be left out of what its cross traffic meets along its own path; docs/bounds.md has the
/// proof. Whatever the order, it may be if servers take the flows in any order. If that is first come, first served,
/// the stretches must be nested or apart, and what comes by one link, and is bounded together, must leave together.
bool may_spare(const ServerNetwork& network, std::size_t analysed) {
  if (network.multiplexing == Multiplexing::arbitrary) return true;
  const std::vector<std::size_t>& path = network.flows[analysed].path;
  std::vector<Stretch> stretches;
  for (std::size_t f = 0; f < network.flows.size(); ++f) {
    if (f == analysed) continue;
    const std::vector<std::size_t>& other = network.flows[f].path;
    for (std::size_t i = 0; i < path.size(); ++i) {
      const auto found = std::find(other.begin(), other.end(), path[i]);
      if (found == other.end()) continue;
      const std::size_t from = found == other.begin() ? nowhere : *(found - 1);
      const bool goes_on = i > 0 && from == path[i - 1];
      if (goes_on)
        stretches.back().last = i;
      else
        stretches.push_back({i, i, from});
    }
  }
  for (const Stretch& a : stretches)
    for (const Stretch& b : stretches) {
      if (a.first < b.first && b.first <= a.last && a.last < b.last) return false;
      if (a.first == b.first && a.from == b.from && a.from != nowhere && a.last != b.last) return false;
    }
  return true;
}

/// The longest time for which a server that takes its flows in any order has a backlog.
std::optional<Rational> busy_period(const TokenBucket& alpha, const RateLatency& beta) {
  if (alpha.rate >= beta.rate) return std::nullopt;
  return (beta.rate * beta.latency + alpha.burst) / (beta.rate - alpha.rate);
}

}  // namespace

bool ServerNetwork::is_feed_forward() const {
  // Servers without a flow into them that has not been taken away yet go first.
  std::vector<std::vector<std::size_t>> next(servers.size());
  std::vector<std::size_t> before(servers.size(), 0);
  for (const ServerFlow& flow : flows)
    for (std::size_t i = 0; i + 1 < flow.path.size(); ++i) {
      next[flow.path[i]].push_back(flow.path[i + 1]);
      ++before[flow.path[i + 1]];
    }
  std::vector<std::size_t> free;
  for (std::size_t s = 0; s < servers.size(); ++s)
    if (before[s] == 0) free.push_back(s);
  std::size_t seen = 0;
  for (; !free.empty(); ++seen) {
    const std::size_t server = free.back();
    free.pop_back();
    for (const std::size_t follower : next[server])
      if (--before[follower] == 0) free.push_back(follower);
  }
  return seen == servers.size();
}

std::vector<FlowBound> total_flow_analysis(const ServerNetwork& network) {
  TAKT_CHECK(network.is_feed_forward(), "an analysis from the sources on asks for a network without circles");
  Arrivals arrivals(network, nowhere);
  std::vector<ServerBound> at_server(network.servers.size());
  for (std::size_t s = 0; s < network.servers.size(); ++s) {
    const Flows& flows = arrivals.flows_at(s);
    if (flows.empty()) continue;
    const std::optional<TokenBucket> all = arrivals.at(s, flows, false);
    if (!all) continue;
    const RateLatency& service = network.servers[s].service;
    const bool in_order = network.multiplexing == Multiplexing::fifo || flows.size() == 1;
    at_server[s] = {in_order ? horizontal_deviation(*all, service) : busy_period(*all, service),
                    vertical_deviation(*all, service)};
  }
  std::vector<FlowBound> bounds;
  for (const ServerFlow& flow : network.flows) {
    FlowBound bound{Rational(), Rational(), {}, {}};
    for (const std::size_t server : flow.path) {
      const ServerBound& hop = at_server[server];
      bound.servers.push_back(hop);
      bound.delay = bound.delay && hop.delay ? std::optional(*bound.delay + *hop.delay) : std::nullopt;
      bound.backlog =
          bound.backlog && hop.backlog ? std::optional(std::max(*bound.backlog, *hop.backlog)) : std::nullopt;
    }
    bounds.push_back(std::move(bound));
  }
  return bounds;
}

std::vector<FlowBound> separated_flow_analysis(const ServerNetwork& network) {
  TAKT_CHECK(network.is_feed_forward(), "an analysis from the sources on asks for a network without circles");
  std::vector<FlowBound> bounds;
  for (std::size_t f = 0; f < network.flows.size(); ++f) {
    const ServerFlow& flow = network.flows[f];
    const bool is_spared = may_spare(network, f);
    Arrivals arrivals(network, f);
    std::optional<RateLatency> service;
    bool is_served = true;
    for (const std::size_t server : flow.path) {
      const std::optional<RateLatency> hop = arrivals.left_over(server, {f}, is_spared);
      is_served = is_served && hop;
      if (is_served) service = service ? convolution(*service, *hop) : *hop;
    }
    FlowBound bound;
    if (is_served)
      bound = {horizontal_deviation(flow.arrival, *service), vertical_deviation(flow.arrival, *service), {}, service};
    bounds.push_back(std::move(bound));
  }
  return bounds;
}

}  // namespace takt::analysis
