#include "analysis/server_network.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "sim/check.hpp"

namespace takt::analysis {
namespace {

constexpr std::size_t nowhere = ~std::size_t{0};   // before the first server of a path; no flow

using Flows = std::vector<std::size_t>;   // ascending

/// Arrivals of groups of flows at servers, worked out backwards from where they are asked for.
class Arrivals {
 public:
  /// `excluded` is nobody's cross traffic.
  Arrivals(const ServerNetwork& network, std::size_t excluded) : network_(network), excluded_(excluded), flows_at_(network.servers.size()) {
    for (std::size_t f = 0; f < network.flows.size(); ++f)
      for (const std::size_t server : network.flows[f].path) flows_at_[server].push_back(f);
  }

  const Flows& flows_at(std::size_t server) const { return flows_at_[server]; }

  /// All flows but these, and but the one that is excluded.
  Flows others_at(std::size_t server, const Flows& flows) const {
    Flows others;
    for (const std::size_t f : flows_at_[server])
      if (f != excluded_ && !std::binary_search(flows.begin(), flows.end(), f)) others.push_back(f);
    return others;
  }

  /// What these flows bring to a server together. Nothing if unbounded.
  std::optional<TokenBucket> at(std::size_t server, const Flows& flows) {
    std::map<std::size_t, Flows> by_link;   // by the server before
    for (const std::size_t f : flows) by_link[before(f, server)].push_back(f);
    TokenBucket sum;
    for (const auto& [from, group] : by_link) {
      std::optional<TokenBucket> part = TokenBucket{};
      if (from == nowhere)
        for (const std::size_t f : group) part = *part + network_.flows[f].arrival;
      else
        part = out_of(from, group);
      if (!part) return std::nullopt;
      sum = sum + *part;
    }
    return sum;
  }

  /// What these flows, which all go through `server`, bring out of it.
  std::optional<TokenBucket> out_of(std::size_t server, const Flows& flows) {
    const auto [known, is_new] = known_.try_emplace({server, flows});
    if (!is_new) return known->second;
    // Back along the path that they have in common.
    const std::size_t common = before(flows.front(), server);
    const bool all_came_so = common != nowhere && std::all_of(flows.begin(), flows.end(), [&](std::size_t f) { return before(f, server) == common; });
    const std::optional<TokenBucket> in = all_came_so ? out_of(common, flows) : at(server, flows);
    std::optional<TokenBucket> out;
    if (in)
      if (const std::optional<RateLatency> service = left_over(server, flows)) out = output_bound(*in, *service);
    return known_[{server, flows}] = out;
  }

  /// What a server leaves to these flows.
  std::optional<RateLatency> left_over(std::size_t server, const Flows& flows) {
    const Flows others = others_at(server, flows);
    const RateLatency& service = network_.servers[server].service;
    if (others.empty()) return service;
    const std::optional<TokenBucket> cross = at(server, others);
    if (!cross) return std::nullopt;
    return network_.multiplexing == Multiplexing::fifo ? left_over_fifo(service, *cross) : left_over_arbitrary(service, *cross);
  }

 private:
  std::size_t before(std::size_t flow, std::size_t server) const {
    const std::vector<std::size_t>& path = network_.flows[flow].path;
    const auto found = std::find(path.begin(), path.end(), server);
    TAKT_CHECK(found != path.end(), "the flow passes the server");
    return found == path.begin() ? nowhere : *(found - 1);
  }

  const ServerNetwork& network_;
  std::size_t excluded_;
  std::vector<Flows> flows_at_;
  std::map<std::pair<std::size_t, Flows>, std::optional<TokenBucket>> known_;
};

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
    const std::optional<TokenBucket> all = arrivals.at(s, flows);
    if (!all) continue;
    const RateLatency& service = network.servers[s].service;
    const bool in_order = network.multiplexing == Multiplexing::fifo || flows.size() == 1;
    at_server[s] = {in_order ? horizontal_deviation(*all, service) : busy_period(*all, service), vertical_deviation(*all, service)};
  }
  std::vector<FlowBound> bounds;
  for (const ServerFlow& flow : network.flows) {
    FlowBound bound{Rational(), Rational(), {}, {}};
    for (const std::size_t server : flow.path) {
      const ServerBound& hop = at_server[server];
      bound.servers.push_back(hop);
      bound.delay = bound.delay && hop.delay ? std::optional(*bound.delay + *hop.delay) : std::nullopt;
      bound.backlog = bound.backlog && hop.backlog ? std::optional(std::max(*bound.backlog, *hop.backlog)) : std::nullopt;
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
    Arrivals arrivals(network, f);
    std::optional<RateLatency> service;
    bool is_served = true;
    for (const std::size_t server : flow.path) {
      const std::optional<RateLatency> hop = arrivals.left_over(server, {f});
      is_served = is_served && hop;
      if (is_served) service = service ? convolution(*service, *hop) : *hop;
    }
    FlowBound bound;
    if (is_served) bound = {horizontal_deviation(flow.arrival, *service), vertical_deviation(flow.arrival, *service), {}, service};
    bounds.push_back(std::move(bound));
  }
  return bounds;
}

}  // namespace takt::analysis
