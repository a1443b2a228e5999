// SPDX-License-Identifier: Apache-2.0
// GraphML with applications: a network without rates and delays, whose end stations have ids that begin with "es", and
// time-triggered applications with their routes, beside applications of AVB. Ids and names differ in case. Rates, and
// to what a frequency refers, are assumed (GraphmlAssumptions).
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <unordered_set>

#include "schedule_instances/formats.hpp"

namespace takt::schedule_instances {

using namespace schedule;

namespace {

constexpr Ps ps_per_us = 1'000'000;

std::string upper(std::string text) {
  for (char& c : text)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  return text;
}

class ApplicationReader {
 public:
  ApplicationReader(Builder& builder, const GraphmlAssumptions& assumptions)
      : builder_(builder), diagnostics_(builder.diagnostics()), assumptions_(assumptions) {}

  void read_network(const XmlElement& root) {
    for (const XmlElement& graph : root.children) {
      if (graph.name != "graph") continue;
      for (const XmlElement& node : graph.children)
        if (node.name == "node") {
          const std::string name = upper(need(node, "id"));
          if (!name.empty()) builder_.add_node(name, !name.starts_with("ES"), node.place);
        }
      for (const XmlElement& edge : graph.children)
        if (edge.name == "edge") {
          const std::string a = upper(need(edge, "source")), b = upper(need(edge, "target"));
          if (!a.empty() && !b.empty())
            for (const auto& [from, to] : {std::pair(a, b), std::pair(b, a)}) {
              Link link;
              link.octet = builder_.octet_of(assumptions_.rate, edge.place);
              builder_.add_link(std::move(link), from, to, edge.place);
            }
        } else if (edge.name != "node" && edge.name != "data" && edge.name != "desc") {
          diagnostics_.error(edge.place, "an element that is not understood", {json::quote(edge.name), "node or edge"});
        }
    }
  }

  void read(const XmlElement& application) {
    const std::size_t mistakes = diagnostics_.errors();
    const bool is_timed = application.name == "TTApplication";
    if (!is_timed && application.name != "AVBApplication")
      return diagnostics_.error(application.place, "an application that is not understood",
                                {json::quote(application.name), "TTApplication or AVBApplication"});
    if (!is_timed && !assumptions_.with_avb) return;
    Stream stream;
    stream.name = need(application, "name");
    if (const XmlElement* const source = child(application, "Source")) stream.talker = node(*source);
    const XmlElement* const destinations = child(application, "Destinations");
    if (destinations != nullptr) {
      for (const XmlElement& each : destinations->children)
        if (each.name == "Dest") stream.listeners.push_back(node(each));
      if (stream.listeners.empty())
        diagnostics_.error(destinations->place, "a stream without listeners", {"no Dest", "one or more"});
    }
    if (is_timed)
      read_times(application, destinations, stream);
    else
      read_avb(application, stream);
    if (diagnostics_.errors() != mistakes || destinations == nullptr) return;
    if (is_timed && !set_routes(*destinations, stream)) return;
    builder_.add_stream(std::move(stream), application.place);
  }

 private:
  std::string need(const XmlElement& element, std::string_view name) {
    const XmlAttribute* const found = element.attribute(name);
    if (found == nullptr || found->value.empty())
      diagnostics_.error(element.place, fmt::format("{} without {}", element.name, json::quote(name)), {"none", "one"});
    return found == nullptr ? std::string() : found->value;
  }
  static const XmlElement* find(const XmlElement& element, std::string_view name) {
    const auto found = std::ranges::find(element.children, name, &XmlElement::name);
    return found == element.children.end() ? nullptr : &*found;
  }
  const XmlElement* child(const XmlElement& element, std::string_view name) {
    const XmlElement* const found = find(element, name);
    if (found == nullptr)
      diagnostics_.error(element.place, fmt::format("{} without {}", element.name, name), {"none", "one"});
    return found;
  }
  NodeIndex node(const XmlElement& named) {
    const std::string name = upper(need(named, "name"));
    return name.empty() ? 0 : builder_.node(name, named.place);
  }
  /// A number times `unit`, which must be whole but for noise of binary fractions.
  std::int64_t number(const std::string& text, double unit, Range range, const json::Place& where) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const double product = value * unit;
    if (error == std::errc() && end == text.data() + text.size() && product >= static_cast<double>(range.least) &&
        product <= static_cast<double>(range.most) && std::abs(product - std::nearbyint(product)) <= 0.01)
      return static_cast<std::int64_t>(std::nearbyint(product));
    diagnostics_.error(
        where, "not in range",
        {json::quote(text), fmt::format("a number from {:g} to {:g}", static_cast<double>(range.least) / unit,
                                        static_cast<double>(range.most) / unit)});
    return range.least;
  }

  void read_times(const XmlElement& application, const XmlElement* destinations, Stream& stream) {
    const XmlElement* const list = destinations == nullptr ? nullptr : find(*destinations, "GCL");
    if (list == nullptr)
      return diagnostics_.error(application.place, "a time-triggered application without times",
                                {"no GCL", "GCL with duration and frequency"});
    stream.octets = static_cast<std::uint32_t>(
        number(need(*list, "duration"), static_cast<double>(assumptions_.rate) / 8e6, octets_range, list->place));
    const std::int64_t frequency = number(need(*list, "frequency"), 1, {1, 1'000'000}, list->place);
    stream.period = assumptions_.hyperperiod / frequency;
    if (assumptions_.hyperperiod % frequency != 0)
      diagnostics_.error(list->place, "a period of no whole number of ps",
                         {std::to_string(frequency) + " times a hyperperiod", "a divisor of the hyperperiod"});
  }

  void read_avb(const XmlElement& application, Stream& stream) {
    const XmlElement* const kind = find(application, "AVBClass");
    const bool is_b = kind != nullptr && kind->text == "CLASS_B";
    if (kind != nullptr && !is_b && kind->text != "CLASS_A")
      diagnostics_.error(kind->place, "not a class of AVB", {json::quote(kind->text), "CLASS_A or CLASS_B"});
    stream.period = (is_b ? 250 : 125) * ps_per_us;
    stream.latency = (is_b ? 50'000 : 2'000) * ps_per_us;
    stream.traffic_class = is_b ? 5 : 6;
    if (const XmlElement* const size = child(application, "PayloadSize"))
      stream.octets = static_cast<std::uint32_t>(
          std::max<std::int64_t>(64, number(size->text, 1, {0, octets_range.most - 22}, size->place) + 22));
    if (const XmlElement* const frames = find(application, "NoOfFrames"))
      stream.frames = static_cast<std::uint32_t>(number(frames->text, 1, frames_range, frames->place));
    if (const XmlElement* const deadline = find(application, "Deadline"))
      stream.latency = number(deadline->text, static_cast<double>(ps_per_us), time_range, deadline->place);
  }

  /// The ways to all listeners as one tree; a listener without one leaves the route open.
  bool set_routes(const XmlElement& destinations, Stream& stream) {
    const std::size_t mistakes = diagnostics_.errors();
    std::vector<LinkIndex> links;
    std::unordered_set<LinkIndex> seen;
    for (const XmlElement& listener : destinations.children) {
      if (listener.name != "Dest") continue;
      const XmlElement* const route = find(listener, "Route");
      if (route == nullptr) return true;
      std::string at = builder_.problem().nodes[stream.talker].name;
      const auto go_to = [&](const XmlElement& next) {
        const std::string name = upper(need(next, "name"));
        if (const auto link = builder_.link_between(at, name)) {
          if (seen.insert(*link).second) links.push_back(*link);
        } else {
          diagnostics_.error(
              next.place, "no link",
              {fmt::format("from {} to {}", json::quote(at), json::quote(name)), "nodes that an edge joins"});
        }
        at = name;
      };
      for (const XmlElement& bridge : route->children)
        if (bridge.name == "Bridge")
          go_to(bridge);
        else
          diagnostics_.error(bridge.place, "an element that is not understood", {json::quote(bridge.name), "Bridge"});
      go_to(listener);
    }
    if (diagnostics_.errors() != mistakes) return false;
    builder_.set_route(stream, std::move(links), destinations.place);
    return diagnostics_.errors() == mistakes;
  }

  Builder& builder_;
  json::Diagnostics& diagnostics_;
  const GraphmlAssumptions& assumptions_;
};

}  // namespace

Instance read_graphml(const XmlElement& network, const XmlElement& applications, const std::string& name,
                      const GraphmlAssumptions& assumptions, json::Diagnostics& diagnostics) {
  Builder builder(diagnostics);
  builder.problem().name = name;
  builder.problem().source = "GraphML and applications";
  builder.problem().model.is_strict = true;
  ApplicationReader reader(builder, assumptions);
  reader.read_network(network);
  if (diagnostics.has_errors()) return {};
  for (const XmlElement& application : applications.children) reader.read(application);
  return builder.take();
}

}  // namespace takt::schedule_instances
