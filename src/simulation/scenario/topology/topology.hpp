// SPDX-License-Identifier: Apache-2.0
// The nodes and links of a scenario, generated and written ones together, with numbered ports.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "models/plan.hpp"
#include "scenario/description/description.hpp"

namespace takt::scenario {

/// What the file says of a node; all nodes of a generator that are of one kind share it, since it is large and they are
/// many.
class SharedNode {
 public:
  SharedNode(Node node) : node_(std::make_shared<const Node>(std::move(node))) {}  // NOLINT: as good as the node
  const Node& get() const { return *node_; }
  operator const Node&() const { return *node_; }  // NOLINT: the same

 private:
  std::shared_ptr<const Node> node_;
};

struct TopologyNode {
  std::string name;
  SharedNode description;
  json::Source where;
  bool is_end_station() const { return end_station_of(description) != nullptr; }
  bool forwards() const { return relay_of(description) != nullptr; }
  bool is_of_unknown_kind = false;  ///< its "kind" was refused
  Octets mtu{1500};                 ///< most octets after the EtherType, tags not counted
};

/// One end of a link as seen from a node.
struct Neighbour {
  std::uint32_t node = 0;
  std::uint16_t port = 0;        ///< of this node
  std::uint16_t their_port = 0;  ///< of the neighbour
};

struct Topology {
  std::vector<TopologyNode> nodes;
  std::vector<models::LinkPlan> links;
  std::vector<std::vector<Neighbour>> neighbours;  ///< of each node, in the order of the links
  /// Of each node whether what leaves it needs a filtering entry: it forwards, or has several interfaces.
  std::vector<bool> chooses_ports;
  std::map<std::string, std::uint32_t, std::less<>> index;
  /// False if nodes or links were refused: that a name or a way is missing may be a consequence then, which is not
  /// told.
  bool has_all_nodes = true;
  bool has_all_links = true;

  std::optional<std::uint32_t> find(std::string_view name) const;
  /// The port of `from` that leads to its neighbour `to`; the first if there are several links.
  std::optional<std::uint16_t> port_towards(std::uint32_t from, std::uint32_t to) const;
  /// Whether a "to" of a node means the link to that end of a neighbour: "sw2", or "sw2:1" for its port 1.
  bool is_named(std::string_view to, std::uint32_t neighbour, std::uint16_t their_port) const;
};

/// As it is written, else that of its medium.
DataRate rate_of(const Link& link);

/// Builds the topology; mistakes go to `diagnostics`. What could be built is returned even then.
Topology build_topology(const NetworkSection& network, json::Diagnostics& diagnostics);

/// Reports a name that no node has; `expected` is a phrase such as "the name of a host".
void report_unknown_node(const Topology& topology, std::string_view name, json::Place place, std::string expected,
                         json::Diagnostics& diagnostics);

/// Reports that no link joins the node to its neighbour.
void report_no_neighbour(const Topology& topology, std::string_view neighbour, std::string_view node, json::Place place,
                         json::Diagnostics& diagnostics);

/// The known node name nearest to `name`, or ""; not worked out for a diagnostic that would not be kept.
std::string suggest_node(const Topology& topology, std::string_view name, const json::Diagnostics& diagnostics);

}  // namespace takt::scenario
