// SPDX-License-Identifier: Apache-2.0
// GraphML to a network. Keys differ by author: those that takt writes are known, and settings say what others are
// called.
#include <algorithm>
#include <charconv>
#include <map>
#include <set>

#include "interchange/graph/graph.hpp"
#include "xml/xml.hpp"
#include "json/quantity.hpp"
#include "json/suggest.hpp"

namespace takt::interchange {
namespace {

constexpr std::string_view graphml = "http://graphml.graphdrawing.org/xmlns";

constexpr SettingInfo graphml_import_table[] = {
    {"kind", "the name of a key", "kind", "of nodes: host, switch or station"},
    {"rate", "the name of a key", "rate", "of edges: a rate (1Gbps), or a number in rate-unit"},
    {"rate-unit", "bps|kbps|Mbps|Gbps", "Mbps", "of rates that are plain numbers"},
    {"delay", "the name of a key", "delay", "of edges: the propagation delay (50ns), or a number in delay-unit"},
    {"delay-unit", "ps|ns|us|ms", "ns", "of delays that are plain numbers"},
    {"length", "the name of a key", "length", "of edges: the length (10m), if there is no delay"},
};

class GraphmlReader {
 public:
  GraphmlReader(const ImportRequest& request, Imported& imported, json::Diagnostics& diagnostics)
      : settings_(request.settings), imported_(imported), diagnostics_(diagnostics) {}

  void read(const XmlElement& root, scenario::Scenario& scenario) {
    for (const XmlElement& key : root.children)
      if (key.name == "key") read_key(key);
    for (const XmlElement& graph : root.children) {
      if (graph.name != "graph") continue;
      if (scenario.name.empty()) scenario.name = value(graph, "id").empty() ? "graph" : value(graph, "id");
      for (const XmlElement& node : graph.children)
        if (node.name == "node") read_node(node, scenario);
      for (const XmlElement& edge : graph.children) {
        if (edge.name == "edge")
          read_edge(edge, scenario);
        else if (edge.name != "node" && edge.name != "data" && edge.name != "desc")
          error(edge.place, "an element that is not understood", json::quote(edge.name), "node or edge");
      }
    }
  }

 private:
  void error(const json::Place& place, std::string message, std::string found, std::string expected,
             std::string suggestion = {}) {
    diagnostics_.error(place, std::move(message), {std::move(found), std::move(expected), std::move(suggestion)});
  }
  static std::string value(const XmlElement& element, std::string_view name) {
    const XmlAttribute* const found = element.attribute(name);
    return found == nullptr ? std::string() : found->value;
  }

  void read_key(const XmlElement& key) {
    if (value(key, "id").empty()) return error(key.place, "a key without an id", "none", "id");
    names_[value(key, "id")] = value(key, "attr.name").empty() ? value(key, "id") : value(key, "attr.name");
  }

  /// The data of a node or edge by the names of their keys.
  std::map<std::string, const XmlElement*> data_of(const XmlElement& element) {
    std::map<std::string, const XmlElement*> data;
    for (const XmlElement& child : element.children) {
      if (child.name != "data") {
        if (child.name != "desc")
          error(child.place, "an element that is not understood", json::quote(child.name), "data");
        continue;
      }
      const auto name = names_.find(value(child, "key"));
      if (name == names_.end())
        error(child.place, "a key that is not declared", json::quote(value(child, "key")),
              "the id of a key at the top");
      else
        data[name->second] = &child;
    }
    return data;
  }

  void report_unknown_data(const std::map<std::string, const XmlElement*>& data,
                           std::initializer_list<std::string_view> known) {
    for (const auto& [name, element] : data)
      if (std::ranges::find(known, name) == known.end() && told_.insert(name).second)
        imported_.remark(RemarkKind::ignored, element->place, "key " + json::quote(name));
  }

  void read_node(const XmlElement& node, scenario::Scenario& scenario) {
    const std::string name = value(node, "id");
    if (name.empty()) return error(node.place, "a node without an id", "none", "id");
    if (std::ranges::any_of(scenario.network.nodes, [&](const auto& each) { return each.first == name; }))
      return error(node.place, "a node twice", json::quote(name), "a name of its own for each");
    const auto data = data_of(node);
    const auto kind = data.find(settings_["kind"]);
    std::string said = kind == data.end() ? "" : kind->second->text;
    scenario::Node made = scenario::HostNode{};
    if (said == "switch" || said == "bridge")
      made = scenario::SwitchNode{};
    else if (said == "station")
      made = scenario::StationNode{};
    else if (said != "host" && said != "end_station")
      return error(kind == data.end() ? node.place : kind->second->place, "no kind of node",
                   said.empty() ? "no data with key " + json::quote(settings_["kind"]) : json::quote(said),
                   "host, switch or station");
    if (const auto delay = data.find("forwarding_delay"); delay != data.end())
      if (scenario::Relay* const relay = scenario::relay_of(made)) {
        const auto parsed = json::parse_duration(delay->second->text);
        if (parsed)
          relay->forwarding_delay = *parsed;
        else
          error(delay->second->place, "not a delay", json::quote(delay->second->text), "such as 2us");
      }
    report_unknown_data(data, {settings_["kind"], "forwarding_delay"});
    scenario.network.nodes.emplace_back(name, std::move(made));
  }

  void read_edge(const XmlElement& edge, scenario::Scenario& scenario) {
    scenario::Link link;
    const auto data = data_of(edge);
    for (const char* const which : {"source", "target"}) {
      std::string end = value(edge, which);
      const bool is_known =
          std::ranges::any_of(scenario.network.nodes, [&](const auto& each) { return each.first == end; });
      if (!is_known) {
        std::vector<std::string_view> names;
        for (const auto& each : scenario.network.nodes) names.push_back(each.first);
        return error(edge.place, "an edge to a node that is not there", json::quote(end), "the id of a node",
                     diagnostics_.full() ? "" : json::suggest(end, names));
      }
      if (const auto port = data.find(std::string(which) + "_port"); port != data.end())
        end += ":" + port->second->text;
      link.ends.push_back(std::move(end));
    }
    if (const auto rate = data.find(settings_["rate"]); rate != data.end()) {
      const std::string text =
          is_number(rate->second->text) ? rate->second->text + settings_["rate-unit"] : rate->second->text;
      const auto parsed = json::parse_data_rate(text);
      if (parsed)
        link.rate = *parsed;
      else
        error(rate->second->place, "not a rate", json::quote(rate->second->text), "such as 1Gbps");
    }
    if (const auto delay = data.find(settings_["delay"]); delay != data.end()) {
      const std::string text =
          is_number(delay->second->text) ? delay->second->text + settings_["delay-unit"] : delay->second->text;
      const auto parsed = json::parse_duration(text);
      if (parsed)
        link.delay = *parsed;
      else
        error(delay->second->place, "not a delay", json::quote(delay->second->text), "such as 50ns");
    } else if (const auto length = data.find(settings_["length"]); length != data.end()) {
      const auto parsed = json::parse_length(length->second->text);
      if (parsed)
        link.length = *parsed;
      else
        error(length->second->place, "not a length", json::quote(length->second->text), "such as 10m");
    }
    report_unknown_data(data,
                        {settings_["rate"], settings_["delay"], settings_["length"], "source_port", "target_port"});
    scenario.network.links.push_back(std::move(link));
  }

  static bool is_number(std::string_view text) {
    return !text.empty() && text.find_first_not_of("0123456789.") == std::string_view::npos;
  }

  const Settings& settings_;
  Imported& imported_;
  json::Diagnostics& diagnostics_;
  std::map<std::string, std::string> names_;  // of keys by their ids
  std::set<std::string> told_;
};

}  // namespace

const std::span<const SettingInfo> graphml_import_settings = graphml_import_table;

Imported import_graphml(const ImportRequest& request, json::Diagnostics& diagnostics) {
  Imported imported;
  scenario::Scenario scenario;
  scenario.duration = sim::Duration::from_ps(100'000'000'000);
  for (const InputFile& file : request.files) {
    const auto elements = parse_xml(file.text, file.name, diagnostics);
    if (!elements) continue;
    if (elements->empty()) diagnostics.error({file.name, 1, 1, ""}, "not GraphML", {"nothing", "graphml"});
    for (const XmlElement& element : *elements) {
      if (element.name != "graphml" || (!element.name_space.empty() && element.name_space != graphml))
        diagnostics.error(element.place, "not GraphML", {json::quote(element.name), "graphml"});
      else
        GraphmlReader(request, imported, diagnostics).read(element, scenario);
    }
  }
  if (scenario.name.empty()) scenario.name = "graph";
  if (!diagnostics.has_errors()) imported.scenario = std::move(scenario);
  return imported;
}

}  // namespace takt::interchange
