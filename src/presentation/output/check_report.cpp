// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "output/check_features.hpp"
#include "output/text_report.hpp"

namespace takt::output {
namespace {

using scenario::Resolved;

constexpr std::size_t rows_of_page = 40;

std::string path_text(const Resolved& r, const scenario::Path& path) {
  std::string text;
  // Where several links lead on, and it is not the first.
  const auto name = [&](std::size_t i) {
    const bool is_other = i < path.ports.size() && path.ports[i] != scenario::Path::first_link;
    return r.topology.nodes[path[i]].name + (is_other ? fmt::format(":{}", path.ports[i]) : std::string());
  };
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (path.size() > 12 && i == 5) {
      text += fmt::format(" > ... {} more ...", path.size() - 10);
      i = path.size() - 5;
    }
    text += (i == 0 ? "" : " > ") + name(i);
  }
  return text;
}

std::string counted(std::size_t n, std::string_view what) {
  return fmt::format("{} {}{}", n, what, n == 1 ? "" : what.ends_with("ch") ? "es" : "s");
}

std::string more(std::size_t all) {
  return all > rows_of_page ? fmt::format("  ... {} more\n", all - rows_of_page) : std::string();
}

}  // namespace

std::string check_report(const Resolved& r) {
  const auto count = [&](models::NodeKind kind) {
    return static_cast<std::size_t>(std::ranges::count(r.plan.nodes, kind, &models::NodePlan::kind));
  };
  const std::size_t stations = count(models::NodeKind::station);
  std::string out =
      fmt::format("{}: {}, {}, {}{}, {}, {}, {}, {} to simulate\n", r.scenario.name,
                  counted(count(models::NodeKind::host), "host"), counted(count(models::NodeKind::bridge), "switch"),
                  stations > 0 ? counted(stations, "station") + ", " : "", counted(r.topology.links.size(), "link"),
                  counted(r.plan.streams.size(), "stream"), counted(r.programs.size(), "program"),
                  counted(r.scenario.require.size(), "requirement"), readable(r.scenario.duration));

  out += "\nNodes\n";
  for (std::size_t n = 0; n < std::min(rows_of_page, r.topology.nodes.size()); ++n) {
    const scenario::TopologyNode& node = r.topology.nodes[n];
    std::string what;
    const scenario::EndStation* const end_station = scenario::end_station_of(node.description);
    const scenario::Relay* const relay = scenario::relay_of(node.description);
    const std::string forwarding =
        relay == nullptr
            ? std::string()
            : readable(r.plan.nodes[n].least_forwarding_delay()) +
                  (r.plan.nodes[n].forwarding_jitter ? " to " + readable(r.plan.nodes[n].greatest_forwarding_delay())
                                                     : std::string());
    if (relay == nullptr)
      what = fmt::format("host, os {}", scenario::spelling(end_station->os.profile));
    else if (end_station == nullptr)
      what = "switch, forwarding delay " + forwarding;
    else
      what = fmt::format("station, os {}, forwarding {}", scenario::spelling(end_station->os.profile), forwarding);
    std::string neighbours;
    for (std::size_t i = 0; i < std::min<std::size_t>(6, r.topology.neighbours[n].size()); ++i) {
      const scenario::Neighbour& neighbour = r.topology.neighbours[n][i];
      neighbours += fmt::format(" {}:{}", neighbour.port, r.topology.nodes[neighbour.node].name);
    }
    if (r.topology.neighbours[n].size() > 6) neighbours += " ...";
    out += fmt::format("  {:<20} {:<36} ports{}\n", node.name, what, neighbours);
  }
  out += more(r.topology.nodes.size());
  out += feature_pages(r, rows_of_page);

  if (!r.streams.empty()) out += "\nStreams and their paths\n";
  for (std::size_t s = 0; s < std::min(rows_of_page, r.streams.size()); ++s) {
    const models::StreamPlan& plan = r.plan.streams[r.streams[s].index.value];
    const std::string tag = plan.priority        ? fmt::format("PCP {} VLAN {}", *plan.priority, plan.vlan)
                            : plan.host_priority ? fmt::format("untagged, host {}", *plan.host_priority)
                                                 : std::string("untagged");
    out += fmt::format("  {:<32} {:<16} {:>10.1f} frames/s {:>9.3f} Mb/s\n", plan.name, tag,
                       r.streams[s].demand.frames_per_second, r.streams[s].demand.wire_bits_per_second / 1e6);
    for (std::size_t p = 0; p < std::min<std::size_t>(4, r.streams[s].paths.size()); ++p)
      out += "      " + path_text(r, r.streams[s].paths[p]) + "\n";
    if (r.streams[s].paths.size() > 4)
      out += fmt::format("      ... {} more receivers\n", r.streams[s].paths.size() - 4);
  }
  out += more(r.streams.size());

  if (!r.ports.empty()) out += "\nLoad of links, and of the queues of their ports\n";
  std::vector<const scenario::PortDemand*> ports;
  for (const scenario::PortDemand& port : r.ports) ports.push_back(&port);
  std::stable_sort(ports.begin(), ports.end(), [](const auto* a, const auto* b) { return a->share() > b->share(); });
  for (std::size_t i = 0; i < std::min(rows_of_page, ports.size()); ++i) {
    const scenario::PortDemand& port = *ports[i];
    std::string queues;
    for (std::size_t q = port.class_bits_per_second.size(); q-- > 0;)
      if (port.class_bits_per_second[q] > 0)
        queues +=
            fmt::format("  class {}: {:.2f} %", q, 100 * port.class_bits_per_second[q] / port.link_bits_per_second);
    out += fmt::format("  {:<32} {:>7.2f} %  {}\n",
                       fmt::format("{}:{} to {}", r.topology.nodes[port.node.value].name, port.port,
                                   r.topology.nodes[port.peer.value].name),
                       100 * port.share(), queues);
  }
  out += more(ports.size());
  return out;
}

}  // namespace takt::output
