// SPDX-License-Identifier: Apache-2.0
#include "analysis/server_network_file.hpp"

#include <algorithm>

#include "json/fields.hpp"
#include "json/reader.hpp"
#include "json/suggest.hpp"

namespace takt::analysis {
namespace file_format {

using json::optional;
using json::required;

struct Number {
  Rational value;
  bool operator==(const Number&) const = default;
};

struct ServerEntry {
  json::Source where;
  Number rate;
  Number latency;
  bool operator==(const ServerEntry&) const = default;
};

struct FlowEntry {
  json::Source where;
  std::vector<std::string> path;
  Number rate;
  Number burst;
  bool operator==(const FlowEntry&) const = default;
};

struct File {
  json::Source where;
  std::string name = "network";
  NetworkAnalysis analysis = NetworkAnalysis::both;
  Multiplexing multiplexing = Multiplexing::fifo;
  json::NameMap<ServerEntry> servers;
  json::NameMap<FlowEntry> flows;
  bool operator==(const File&) const = default;
};

void decode_number(const json::Node& node, Number& value, json::Reader& reader) {
  const bool is_text = node.kind == json::Kind::string || node.kind == json::Kind::number;
  const std::optional<Rational> number = is_text ? Rational::parse(node.text) : std::nullopt;
  if (!number || *number < Rational()) {
    reader.error(node, "not a number of network calculus",
                 {json::excerpt(node), "a number or a fraction such as \"575/12\", at least 0"});
    return;
  }
  value.value = *number;
}

json::Node encode_number(const Number& value) { return json::Node::of_string(value.value.to_text()); }

json::Node schema_number(json::SchemaBuilder&) {
  json::Node node = json::Node::object();
  json::Node types = json::Node::array();
  types.items.push_back(json::Node::of_string("number"));
  types.items.push_back(json::Node::of_string("string"));
  node.add("type", std::move(types));
  return node;
}

const json::Custom& describe(json::Type<Number>) {
  static constexpr json::Custom table = json::custom<Number, decode_number, encode_number, schema_number>();
  return table;
}

const json::Object& describe(json::Type<ServerEntry>) {
  static constexpr json::Field fields[] = {
      required<&ServerEntry::rate>("rate", "Data in a unit of time."),
      required<&ServerEntry::latency>("latency", "Time."),
  };
  static constexpr json::Object table = json::object<ServerEntry>("server", "A rate-latency server.", fields);
  return table;
}

const json::Object& describe(json::Type<FlowEntry>) {
  static constexpr json::Field fields[] = {
      required<&FlowEntry::path>("path", "The servers in their order.", {.min_items = 1, .max_items = 1000}),
      required<&FlowEntry::rate>("rate", "Data in a unit of time."),
      required<&FlowEntry::burst>("burst", "Data."),
  };
  static constexpr json::Object table = json::object<FlowEntry>("flow", "A flow with a token bucket.", fields);
  return table;
}

}  // namespace file_format

// Beside the enums, in their namespace.
const json::Enumeration& describe(json::Type<NetworkAnalysis>) {
  static constexpr json::EnumName names[] = {json::name(NetworkAnalysis::both, "both", "TFA, then SFA"),
                                             json::name(NetworkAnalysis::tfa, "TFA", "total-flow analysis"),
                                             json::name(NetworkAnalysis::sfa, "SFA", "separated-flow analysis")};
  static constexpr json::Enumeration table = json::enumeration<NetworkAnalysis>("an analysis", names);
  return table;
}

const json::Enumeration& describe(json::Type<Multiplexing>) {
  static constexpr json::EnumName names[] = {
      json::name(Multiplexing::fifo, "FIFO", "servers take all flows in the order of arrival"),
      json::name(Multiplexing::arbitrary, "arbitrary", "each flow is in order, nothing is known of the rest")};
  static constexpr json::Enumeration table = json::enumeration<Multiplexing>("a multiplexing", names);
  return table;
}

namespace file_format {

const json::Object& describe(json::Type<File>) {
  static constexpr json::Field fields[] = {
      optional<&File::name>("name", "For the report."),
      optional<&File::analysis>("analysis", "Which bounds are wanted."),
      optional<&File::multiplexing>("multiplexing", "How servers take their flows."),
      required<&File::servers>("servers", "By name.", {.min_items = 1, .max_items = 1000}),
      required<&File::flows>("flows", "By name.", {.min_items = 1, .max_items = 1000}),
  };
  static constexpr json::Object table = json::object<File>("server_network", "A network of servers.", fields);
  return table;
}

}  // namespace file_format

namespace {

using json::Node;

const char* const unbounded = "unbounded";

std::string text_of(const std::optional<Rational>& value) {
  if (!value) return unbounded;
  if (value->is_whole()) return value->to_text();
  return value->to_text() + " = " + Node::of_double(value->to_double()).text;
}

Node node_of(const std::optional<Rational>& value) { return value ? Node::of_string(value->to_text()) : Node(); }

Node node_of(const ServerNetwork& network, std::size_t f, const FlowBound& bound) {
  Node node = Node::object();
  node.add("name", Node::of_string(network.flows[f].name));
  node.add("delay", node_of(bound.delay));
  node.add("backlog", node_of(bound.backlog));
  if (!bound.servers.empty()) {
    Node hops = Node::array();
    for (std::size_t i = 0; i < bound.servers.size(); ++i) {
      Node hop = Node::object();
      hop.add("server", Node::of_string(network.servers[network.flows[f].path[i]].name));
      hop.add("delay", node_of(bound.servers[i].delay));
      hop.add("backlog", node_of(bound.servers[i].backlog));
      hops.items.push_back(std::move(hop));
    }
    node.add("hops", std::move(hops));
  }
  if (bound.service) {
    Node service = Node::object();
    service.add("rate", Node::of_string(bound.service->rate.to_text()));
    service.add("latency", Node::of_string(bound.service->latency.to_text()));
    node.add("service", std::move(service));
  }
  return node;
}

std::string text_of(const ServerNetwork& network, const char* title, const std::vector<FlowBound>& bounds) {
  std::string text = std::string(title) + "\n";
  for (std::size_t f = 0; f < bounds.size(); ++f) {
    text += "  " + network.flows[f].name + ": delay " + text_of(bounds[f].delay) + ", backlog " +
            text_of(bounds[f].backlog) + "\n";
    for (std::size_t i = 0; i < bounds[f].servers.size(); ++i)
      text += "    " + network.servers[network.flows[f].path[i]].name + ": delay " +
              text_of(bounds[f].servers[i].delay) + ", backlog " + text_of(bounds[f].servers[i].backlog) + "\n";
  }
  return text;
}

}  // namespace

bool is_server_network(const json::Document& document) { return document.root().find("servers") != nullptr; }

std::optional<ServerNetworkFile> read_server_network(const json::Document& document, json::Diagnostics& diagnostics) {
  file_format::File file;
  const std::size_t errors_before = diagnostics.errors();
  json::decode(document, file, diagnostics);
  ServerNetworkFile read{file.name, {}, file.analysis};
  read.network.multiplexing = file.multiplexing;
  std::vector<std::string_view> names;
  for (const auto& [name, server] : file.servers) {
    if (server.rate.value == Rational())
      diagnostics.error(server.where.at("rate"), "a server without a rate", {"0", "more than 0"});
    read.network.servers.push_back({name, {server.rate.value, server.latency.value}});
    names.push_back(name);
  }
  for (const auto& [name, flow] : file.flows) {
    ServerFlow made{name, {flow.rate.value, flow.burst.value}, {}};
    for (std::size_t i = 0; i < flow.path.size(); ++i) {
      const auto found = std::find(names.begin(), names.end(), flow.path[i]);
      const auto server = static_cast<std::size_t>(found - names.begin());
      if (found == names.end())
        diagnostics.error(flow.where.at("path", i), "unknown server",
                          {json::quote(flow.path[i]), "the name of a server", json::suggest(flow.path[i], names)});
      else if (std::find(made.path.begin(), made.path.end(), server) != made.path.end())
        diagnostics.error(flow.where.at("path", i), "a server twice",
                          {json::quote(flow.path[i]), "each server of a path once"});
      made.path.push_back(server);
    }
    read.network.flows.push_back(std::move(made));
  }
  if (diagnostics.errors() != errors_before) return std::nullopt;
  if (!read.network.is_feed_forward()) {
    diagnostics.error(file.where.at("flows"), "flows that go round in a circle",
                      {"paths that depend on each other", "a feed-forward network"});
    return std::nullopt;
  }
  return read;
}

std::string server_network_report(const ServerNetworkFile& file, bool as_json) {
  struct Part {
    bool is_wanted;
    const char* key;
    const char* title;
    std::vector<FlowBound> (*analyse)(const ServerNetwork&);
  };
  const Part parts[] = {
      {file.analysis != NetworkAnalysis::sfa, "TFA", "Total-flow analysis", total_flow_analysis},
      {file.analysis != NetworkAnalysis::tfa, "SFA", "Separated-flow analysis", separated_flow_analysis}};
  const bool is_fifo = file.network.multiplexing == Multiplexing::fifo;
  Node root = Node::object();
  root.add("name", Node::of_string(file.name));
  root.add("multiplexing", Node::of_string(is_fifo ? "FIFO" : "arbitrary"));
  std::string text = file.name + ": " + std::to_string(file.network.servers.size()) + " servers, " +
                     std::to_string(file.network.flows.size()) + " flows, " + (is_fifo ? "FIFO" : "arbitrary") +
                     " multiplexing\n\n";
  for (const Part& part : parts) {
    if (!part.is_wanted) continue;
    const std::vector<FlowBound> bounds = part.analyse(file.network);
    Node flows = Node::array();
    for (std::size_t f = 0; f < bounds.size(); ++f) flows.items.push_back(node_of(file.network, f, bounds[f]));
    root.add(part.key, std::move(flows));
    text += text_of(file.network, part.title, bounds) + "\n";
  }
  return as_json ? json::pretty(root) : text;
}

}  // namespace takt::analysis
