// SPDX-License-Identifier: Apache-2.0
#include "scenario/topology/topology.hpp"

#include <algorithm>
#include <charconv>
#include <set>
#include <utility>

#include "json/suggest.hpp"
#include "scenario/description/limits.hpp"
#include "scenario/topology/generators.hpp"

namespace takt::scenario {
namespace {

constexpr std::int64_t ps_per_millimetre = 5;  // 5 ns/m, light in copper and glass

/// The nearest rates below and above whose octet lasts a whole number of picoseconds: the divisors of 8 Tb/s, 2^15
/// times 5^12.
std::pair<DataRate, DataRate> nearest_exact_rates(DataRate rate) {
  std::uint64_t below = 1, above = DataRate::ps_in_8_seconds;
  for (std::uint64_t fives = 1, b = 0; b <= 12; ++b, fives *= 5)
    for (std::uint64_t each = fives, a = 0; a <= 15; ++a, each *= 2) {
      if (each < rate.bits_per_second) below = std::max(below, each);
      if (each > rate.bits_per_second) above = std::min(above, each);
    }
  return {DataRate{below}, DataRate{above}};
}

class Builder {
 public:
  Builder(const NetworkSection& network, json::Diagnostics& diagnostics)
      : network_(network), diagnostics_(diagnostics) {}

  Topology build() {
    note_refused();
    for (const Generator& generator : network_.generate) add_generated(generator);
    for (const auto& [name, node] : network_.nodes) add_written(name, node);
    // Ports that are named take their numbers first, so that the others find the free ones.
    std::vector<ParsedLink> parsed;
    for (const Link& link : network_.links) {
      if (auto ends = parse_link(link))
        parsed.push_back(*ends);
      else
        topology_.has_all_links = false;
    }
    for (ParsedLink& link : parsed)
      for (End* end : {&link.a, &link.b})
        if (end->port) claim_named(*end, *link.link);
    for (const GeneratedLink& link : generated_links_) join({link.a, {}, 0}, {link.b, {}, 0}, link.rate, link.delay);
    for (const ParsedLink& link : parsed) {
      join(link.a, link.b, rate_of(*link.link), delay_of(*link.link));
      parsed_where_.push_back(link.link->where);
    }
    check_pairs();
    for (std::uint32_t n = 0; n < topology_.nodes.size(); ++n)
      topology_.chooses_ports.push_back(
          topology_.nodes[n].forwards() ||
          std::ranges::any_of(topology_.neighbours[n], [](const Neighbour& neighbour) { return neighbour.port > 0; }));
    check_port_counts();
    return std::move(topology_);
  }

 private:
  struct End {
    std::uint32_t node = 0;
    std::optional<std::uint16_t> port;
    std::size_t which = 0;
  };
  struct ParsedLink {
    const Link* link = nullptr;
    End a;
    End b;
  };
  /// Lists that are none, so that nothing in them is known.
  void note_refused() {
    const auto is_none = [&](std::string_view key, bool is_empty) {
      return is_empty && diagnostics_.is_refused(network_.where.at(key));
    };
    if (is_none("nodes", network_.nodes.empty()) || is_none("generate", network_.generate.empty()))
      topology_.has_all_nodes = topology_.has_all_links = false;
    if (is_none("links", network_.links.empty())) topology_.has_all_links = false;
  }

  struct GeneratedLink {
    std::uint32_t a = 0;
    std::uint32_t b = 0;
    DataRate rate;
    Duration delay;
  };

  std::optional<std::uint32_t> add(std::string name, SharedNode description, json::Source where,
                                   const json::Place& place) {
    const auto next = static_cast<std::uint32_t>(topology_.nodes.size());
    if (!topology_.index.emplace(name, next).second) {
      diagnostics_.error(place, "duplicate node name",
                         {json::quote(name) + " a second time", "a name of its own for each node"});
      return std::nullopt;
    }
    topology_.nodes.push_back({std::move(name), std::move(description), std::move(where)});
    topology_.nodes.back().mtu = ports_of(topology_.nodes.back().description).mtu.value_or(network_.mtu);
    topology_.neighbours.emplace_back();
    used_ports_.emplace_back();
    return next;
  }

  /// Whether it is known what nodes a generator makes.
  bool has_shape(const Generator& generator) const {
    constexpr std::string_view keys[] = {
        "topology", "switches",         "stations",      "station_prefix", "depth", "fanout", "rows",
        "columns",  "hosts_per_switch", "switch_prefix", "host_prefix",    "teeth", "degree", "seed"};
    const bool is_read = generator.where.is_known() || !diagnostics_.has_errors();
    return is_read && std::none_of(std::begin(keys), std::end(keys), [&](std::string_view key) {
             return diagnostics_.is_refused(generator.where.at(key));
           });
  }

  void add_generated(const Generator& generator) {
    const std::size_t errors_before = diagnostics_.errors();
    if (has_shape(generator))
      make_generated(generator);
    else
      diagnostics_.consequence();
    if (diagnostics_.errors() != errors_before) topology_.has_all_nodes = topology_.has_all_links = false;
  }

  void make_generated(const Generator& generator) {
    const Generated made =
        generate(generator, most_nodes - std::min<std::uint64_t>(most_nodes, topology_.nodes.size()), diagnostics_);
    std::vector<std::optional<std::uint32_t>> indices;
    indices.reserve(made.nodes.size());
    topology_.nodes.reserve(topology_.nodes.size() + made.nodes.size());
    std::map<models::NodeKind, SharedNode> of_kind;
    for (const Generated::Node& node : made.nodes) {
      auto description = of_kind.find(node.kind);
      if (description == of_kind.end()) description = of_kind.emplace(node.kind, node_of(node.kind, generator)).first;
      indices.push_back(add(node.name, description->second, generator.where, generator.where.place()));
    }
    const Duration delay = Duration::from_ps(generator.length.millimetres * ps_per_millimetre);
    for (const Generated::Link& link : made.links) {
      if (!indices[link.a] || !indices[link.b]) continue;
      const DataRate rate = link.to_host ? generator.host_rate.value_or(generator.rate) : generator.rate;
      check_rate(rate, generator.where.at(link.to_host && generator.host_rate ? "host_rate" : "rate"));
      generated_links_.push_back({*indices[link.a], *indices[link.b], rate, delay});
    }
  }

  static Node node_of(models::NodeKind kind, const Generator& generator) {
    const NodePorts ports{
        generator.traffic_classes, generator.queues, generator.egress, generator.gate_limits, generator.mtu,
        generator.gates,           std::nullopt,     generator.type};
    const EndStation end_station{generator.os};
    const Relay relay{.forwarding_delay = generator.forwarding_delay,
                      .forwarding_jitter = generator.forwarding_jitter,
                      .ingress = generator.ingress};
    switch (kind) {
      case models::NodeKind::host:
        return HostNode{{generator.traffic_classes, generator.queues, {}, generator.host_gate_limits, generator.mtu},
                        end_station,
                        generator.where};
      case models::NodeKind::bridge:
        return SwitchNode{ports, relay, generator.where};
      case models::NodeKind::station:
        break;
    }
    return StationNode{ports, end_station, relay, generator.where};
  }

  void add_written(const std::string& name, const Node& node) {
    const json::Source& where = source_of(node);
    if (name.empty() || name.find_first_of(":/") != std::string::npos) {
      diagnostics_.error(where.place(), "not a name for a node",
                         {json::quote(name), "at least one character, no ':' and no '/'"});
      topology_.has_all_nodes = topology_.has_all_links = false;
      return;
    }
    const auto added = add(name, node, where, where.place());
    if (!added || where.is_known() || !diagnostics_.has_errors()) return;
    topology_.nodes[*added].is_of_unknown_kind = true;
    topology_.has_all_links = false;  // nobody knows whether it forwards
  }

  std::optional<ParsedLink> parse_link(const Link& link) {
    if (link.ends.size() != 2) return std::nullopt;  // already reported by the table
    check_rate(rate_of(link), link.where.at("rate"));
    const auto a = parse_end(link, 0);
    const auto b = parse_end(link, 1);
    if (!a || !b) return std::nullopt;
    if (a->node == b->node) {
      diagnostics_.error(link.where.at("ends"), "a link to itself",
                         {"both ends at " + json::quote(topology_.nodes[a->node].name), "two different nodes"});
      return std::nullopt;
    }
    return ParsedLink{&link, *a, *b};
  }

  std::optional<End> parse_end(const Link& link, std::size_t which) {
    const std::string& text = link.ends[which];
    const std::size_t colon = text.find(':');
    const std::string_view name = std::string_view(text).substr(0, colon);
    const auto node = topology_.find(name);
    if (!node) {
      report_unknown_node(topology_, name, link.where.at("ends", which),
                          "a name under /network/nodes or of a generated node", diagnostics_);
      return std::nullopt;
    }
    End end{*node, std::nullopt, which};
    if (colon != std::string::npos) {
      const std::string_view digits = std::string_view(text).substr(colon + 1);
      std::uint32_t port = 0;
      const auto [stop, error] = std::from_chars(digits.data(), digits.data() + digits.size(), port);
      if (error != std::errc() || stop != digits.data() + digits.size() || port >= most_ports) {
        diagnostics_.error(
            link.where.at("ends", which), "not a port",
            {json::quote(digits), "a number from 0 to " + std::to_string(most_ports - 1) + " after the ':'"});
        return std::nullopt;
      }
      end.port = static_cast<std::uint16_t>(port);
    }
    return end;
  }

  void claim_named(const End& end, const Link& link) {
    if (const std::size_t most = most_ports_of(topology_.nodes[end.node]); *end.port >= most) {
      diagnostics_.error(link.where.at("ends", end.which), "not a port of this node",
                         {"port " + std::to_string(*end.port), "ports 0 to " + std::to_string(most - 1)});
      return;
    }
    if (!used_ports_[end.node].insert(*end.port).second)
      diagnostics_.error(link.where.at("ends", end.which), "two links on one port",
                         {json::quote(link.ends[end.which]) + " a second time", "a port of its own for each link"});
  }

  std::uint16_t next_free_port(const End& end) {
    if (end.port) return *end.port;
    std::set<std::uint16_t>& used = used_ports_[end.node];
    if (used.size() >= most_ports) return 0;  // check_port_counts() reports the node
    std::uint16_t port = next_port_.size() > end.node ? next_port_[end.node] : std::uint16_t{0};
    while (used.contains(port)) ++port;
    used.insert(port);
    if (next_port_.size() <= end.node) next_port_.resize(topology_.nodes.size(), 0);
    next_port_[end.node] = static_cast<std::uint16_t>(port + 1);
    return port;
  }

  void join(const End& a, const End& b, DataRate rate, Duration delay) {
    const std::uint16_t port_a = next_free_port(a);
    const std::uint16_t port_b = next_free_port(b);
    topology_.links.push_back({{models::NodeIndex{a.node}, port_a}, {models::NodeIndex{b.node}, port_b}, rate, delay});
    topology_.neighbours[a.node].push_back({b.node, port_a, port_b});
    topology_.neighbours[b.node].push_back({a.node, port_b, port_a});
  }

  void check_rate(DataRate rate, const json::Place& place) {
    if (rate.has_exact_octet_time()) return;
    const auto [below, above] = nearest_exact_rates(rate);
    diagnostics_.error(place, "a rate whose octet does not last a whole number of picoseconds",
                       {json::to_text(rate), "a rate that divides 8 Tb/s, the nearest " + json::to_text(below) +
                                                 " and " + json::to_text(above) +
                                                 ", or one of Ethernet such as 10Mbps, 100Mbps, 1Gbps, 2.5Gbps, 5Gbps, "
                                                 "10Gbps, 25Gbps, 40Gbps, 50Gbps or 100Gbps"});
  }

  static Duration delay_of(const Link& link) {
    if (link.delay) return *link.delay;
    return Duration::from_ps(link.length.value_or(Length{10'000}).millimetres * ps_per_millimetre);
  }

  static std::size_t most_ports_of(const TopologyNode& node) {
    return node.is_end_station() && !node.is_of_unknown_kind ? most_end_station_ports : std::size_t{most_ports};
  }

  /// Paths are told by their nodes, so an end station that has two links to one neighbour would never use the second.
  void check_pairs() {
    std::set<std::pair<std::uint32_t, std::uint32_t>> joined;
    for (std::size_t l = generated_links_.size(); l < topology_.links.size(); ++l) {
      const std::uint32_t a = topology_.links[l].a.node.value;
      const std::uint32_t b = topology_.links[l].b.node.value;
      const bool has_end_station = topology_.nodes[a].is_end_station() || topology_.nodes[b].is_end_station();
      if (joined.insert(std::minmax(a, b)).second || !has_end_station || topology_.nodes[a].is_of_unknown_kind ||
          topology_.nodes[b].is_of_unknown_kind)
        continue;
      diagnostics_.error(
          parsed_where_[l - generated_links_.size()].at("ends"), "a second link to one neighbour",
          {"two links between " + json::quote(topology_.nodes[a].name) + " and " + json::quote(topology_.nodes[b].name),
           "interfaces of a host or station that lead to different nodes"});
    }
  }

  void check_port_counts() {
    for (std::uint32_t n = 0; n < topology_.nodes.size(); ++n) {
      const TopologyNode& node = topology_.nodes[n];
      const std::size_t count = topology_.neighbours[n].size();
      if (const std::size_t most = most_ports_of(node); count > most)
        diagnostics_.error(node.where.place(), "too many links at one node",
                           {std::to_string(count), "at most " + std::to_string(most) +
                                                       (!node.is_end_station() ? ""
                                                        : node.forwards()      ? " of a station"
                                                                               : " of a host")});
      if (node.is_end_station() && !node.is_of_unknown_kind && count == 0 && topology_.has_all_links)
        diagnostics_.warning(node.where.place(), node.forwards() ? "a station without a link" : "a host without a link",
                             {json::quote(node.name)});
    }
  }

  const NetworkSection& network_;
  json::Diagnostics& diagnostics_;
  Topology topology_;
  std::vector<std::set<std::uint16_t>> used_ports_;
  std::vector<std::uint16_t> next_port_;  // below it all ports of the node are used
  std::vector<GeneratedLink> generated_links_;
  std::vector<json::Source> parsed_where_;  // of the links behind them
};

}  // namespace

std::optional<std::uint32_t> Topology::find(std::string_view name) const {
  const auto found = index.find(name);
  if (found == index.end()) return std::nullopt;
  return found->second;
}

std::optional<std::uint16_t> Topology::port_towards(std::uint32_t from, std::uint32_t to) const {
  for (const Neighbour& neighbour : neighbours[from])
    if (neighbour.node == to) return neighbour.port;
  return std::nullopt;
}

bool Topology::is_named(std::string_view to, std::uint32_t neighbour, std::uint16_t their_port) const {
  const std::string& name = nodes[neighbour].name;
  return to.starts_with(name) &&
         (to.size() == name.size() || to.substr(name.size()) == ":" + std::to_string(their_port));
}

DataRate rate_of(const Link& link) {
  return link.medium && !link.where.has("rate") ? rate_of(*link.medium) : link.rate;
}

Topology build_topology(const NetworkSection& network, json::Diagnostics& diagnostics) {
  return Builder(network, diagnostics).build();
}

void report_unknown_node(const Topology& topology, std::string_view name, json::Place place, std::string expected,
                         json::Diagnostics& diagnostics) {
  diagnostics.error_unless(!topology.has_all_nodes, std::move(place), "unknown node",
                           {json::quote(name), std::move(expected), suggest_node(topology, name, diagnostics)});
}

void report_no_neighbour(const Topology& topology, std::string_view neighbour, std::string_view node, json::Place place,
                         json::Diagnostics& diagnostics) {
  const bool is_known = topology.find(neighbour).has_value();
  diagnostics.error_unless(!topology.has_all_links || (!is_known && !topology.has_all_nodes), std::move(place),
                           "not a neighbour",
                           {json::quote(neighbour), "a node that a link joins to " + json::quote(node),
                            is_known ? "" : suggest_node(topology, neighbour, diagnostics)});
}

std::string suggest_node(const Topology& topology, std::string_view name, const json::Diagnostics& diagnostics) {
  if (diagnostics.full()) return {};
  std::vector<std::string_view> names;
  names.reserve(topology.nodes.size());
  for (const TopologyNode& node : topology.nodes) names.push_back(node.name);
  return json::suggest(name, names);
}

}  // namespace takt::scenario
