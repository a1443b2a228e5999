// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <set>

#include "interchange/device_import.hpp"
#include "interchange/ports.hpp"
#include "interchange/qcc/qcc.hpp"
#include "models/ethernet/sizes.hpp"

namespace takt::interchange {
namespace {

using json::Node;
using sim::Duration;

class RequestWriter {
 public:
  RequestWriter(const scenario::Resolved& resolved, Exported& exported) : r_(resolved), exported_(exported) {}

  std::string write() {
    Node streams = Node::array();
    for (std::size_t i = 0; i < r_.scenario.streams.size(); ++i)
      if (auto request = request_of(r_.scenario.streams[i], i + 1)) streams.items.push_back(std::move(*request));
    for (const scenario::Program& program : r_.scenario.programs)
      exported_.lose("program " + program.name, "what it sends: a program's messages are no streams of the file");
    for (const scenario::Application& application : r_.scenario.applications)
      exported_.lose("application " + application.name, "what it sends");
    return cnc_config(std::move(streams), true);
  }

  /// What a CNC answers: the streams are ready, and how their talkers' interfaces are set.
  std::string configurations() { return cnc_config(std::move(configurations_), false); }

 private:
  static Node object(std::vector<std::pair<std::string_view, Node>> members) {
    Node made = Node::object();
    for (auto& [key, value] : members) made.add(key, std::move(value));
    return made;
  }
  std::string cnc_config(Node streams, bool is_request) const {
    Node cuc = object({{"cuc-id", Node::of_string("takt")}, {"stream", std::move(streams)}});
    Node domain = object({{"domain-id", Node::of_string(r_.scenario.name)}});
    if (is_request) domain.add("cnc-enabled", Node::of_bool(true));
    domain.add("cuc", list(std::move(cuc)));
    return json::pretty(
        object({{"ieee802-dot1q-cnc-config:cnc-config", object({{"domain", list(std::move(domain))}})}}));
  }
  static Node list(Node item) {
    Node made = Node::array();
    made.items.push_back(std::move(item));
    return made;
  }

  std::uint64_t whole_ns(Duration duration, const std::string& where, const char* what) {
    if (duration.ps() % 1000 != 0) exported_.lose(where, std::string(what) + " that is no whole number of ns");
    return static_cast<std::uint64_t>(duration.ps() / 1000);
  }
  static Node number(std::uint64_t value) { return Node::of_integer(static_cast<sim::int128>(value)); }

  /// The port through which a path begins or ends at a host.
  std::string interface_at(std::uint32_t host, std::uint32_t neighbour) const {
    return interface_name(r_.plan.nodes[host].kind != models::NodeKind::host,
                          r_.topology.port_towards(host, neighbour).value_or(0));
  }
  Node station(std::uint32_t host, std::uint32_t neighbour) const {
    return list(object({{"mac-address", Node::of_string(mac_text(mac_of(r_, {host}), '-'))},
                        {"interface-name", Node::of_string(interface_at(host, neighbour))}}));
  }

  std::optional<Node> request_of(const scenario::Stream& stream, std::size_t number_of_stream) {
    const std::string where = "stream " + stream.name;
    if (stream.exponential || stream.normal || stream.trace) {
      exported_.lose(where, "random or traced times: a request has an interval");
      return std::nullopt;
    }
    const auto plan = std::ranges::find(r_.plan.streams, stream.name, &models::StreamPlan::name);
    if (plan == r_.plan.streams.end()) return std::nullopt;
    const scenario::ResolvedStream& resolved = r_.streams[static_cast<std::size_t>(plan - r_.plan.streams.begin())];
    const Duration every = stream.burst ? stream.burst->every : stream.every.value_or(Duration::from_ps(1'000'000));
    if (stream.burst && stream.burst->spacing > Duration())
      exported_.lose(where, "the distance between the frames of a burst");
    if (stream.launch) exported_.lose(where, "launch times");
    if (stream.until) exported_.lose(where, "its end");
    if (std::ranges::find(r_.plan.talker_ats, resolved.index, &models::TalkerAtsPlan::stream) !=
        r_.plan.talker_ats.end())
      exported_.lose(where, "its ATS scheduler at the talker");
    const std::uint64_t numerator_ns = std::max<std::uint64_t>(whole_ns(every, where, "an interval"), 1);
    const std::uint64_t numerator = numerator_ns, denominator = 1'000'000'000;
    // Of an offset that is left to takt the request says the whole interval, and the answer which one it is.
    const bool is_chosen =
        std::ranges::find(r_.chosen_offsets, stream.name, &scenario::ResolvedOffset::name) != r_.chosen_offsets.end();
    const std::uint64_t common = std::gcd(numerator, denominator);
    const std::uint64_t offset = whole_ns(stream.offset ? stream.offset->value : Duration(), where, "an offset");
    const std::uint64_t jitter = whole_ns(stream.jitter, where, "jitter");
    const bool has_udp = stream.encapsulation == scenario::Encapsulation::udp;
    Node traffic = object(
        {{"interval",
          object({{"numerator", number(numerator / common)}, {"denominator", number(denominator / common)}})},
         {"max-frames-per-interval", number(stream.burst ? stream.burst->frames : 1)},
         // Without preamble, MAC header, tag, check sequence and gap.
         {"max-frame-size", number(stream.payload.count + (has_udp ? models::ipv4_and_udp_headers.count : 0))},
         {"transmission-selection", number(0)},
         {"time-aware", object({{"earliest-transmit-offset", number(is_chosen ? 0 : offset)},
                                {"latest-transmit-offset", number(is_chosen ? numerator_ns - 1 : offset + jitter)},
                                {"jitter", number(0)}})}});
    const std::uint32_t talker = plan->talker.value;
    const std::string own = mac_text(mac_of(r_, {talker}), '-');
    Node frames = list(
        object({{"index", number(0)},
                {"ieee802-mac-addresses",
                 object({{"destination-mac-address", Node::of_string(mac_text(mac_of(r_, plan->destination), '-'))},
                         {"source-mac-address", Node::of_string(own)}})}}));
    if (plan->priority)
      frames.items.push_back(object({{"index", number(1)},
                                     {"ieee802-vlan-tag", object({{"priority-code-point", number(*plan->priority)},
                                                                  {"vlan-id", number(plan->vlan)}})}}));
    const std::uint64_t trees = stream.redundancy ? (stream.redundancy->paths ? stream.redundancy->paths->size()
                                                                              : stream.redundancy->count.value_or(2))
                                                  : 1;
    const auto needs = [&](std::uint64_t latency) {
      return object({{"num-seamless-trees", number(trees)}, {"max-latency", number(latency)}});
    };
    const auto abilities = [] { return object({{"vlan-tag-capable", Node::of_bool(true)}}); };
    const std::uint64_t latency = latency_of(stream, resolved, *plan);
    Node listeners = Node::array();
    std::set<std::uint32_t> seen;
    for (const scenario::Path& path : resolved.paths) {
      if (path.size() < 2 || !seen.insert(path.back()).second) continue;
      listeners.items.push_back(object({{"index", number(listeners.items.size())},
                                        {"end-station-interfaces", station(path.back(), path[path.size() - 2])},
                                        {"user-to-network-requirements", needs(latency)},
                                        {"interface-capabilities", abilities()}}));
    }
    const std::uint32_t next =
        resolved.paths.empty() || resolved.paths.front().size() < 2 ? talker : resolved.paths.front()[1];
    Node talking = object({{"stream-rank", object({{"rank", number(1)}})},
                           {"end-station-interfaces", station(talker, next)},
                           {"data-frame-specification", std::move(frames)},
                           {"traffic-specification", std::move(traffic)},
                           {"user-to-network-requirements", needs(latency)},
                           {"interface-capabilities", abilities()}});
    const std::string id = fmt::format("{}:{:02x}-{:02x}", own, number_of_stream >> 8 & 0xFF, number_of_stream & 0xFF);
    names_.emplace_back(id, stream.name);
    configurations_.items.push_back(configuration_of(id, station(talker, next), offset, *plan));
    return object(
        {{"stream-id", Node::of_string(id)}, {"talker", std::move(talking)}, {"listener", std::move(listeners)}});
  }

  Node configuration_of(const std::string& id, Node talker, std::uint64_t offset,
                        const models::StreamPlan& plan) const {
    Node values = list(object({{"index", number(0)}, {"time-aware-offset", number(offset)}}));
    if (plan.priority)
      values.items.push_back(object({{"index", number(1)},
                                     {"ieee802-vlan-tag", object({{"priority-code-point", number(*plan.priority)},
                                                                  {"vlan-id", number(plan.vlan)}})}}));
    talker.items.front().add("config-list", std::move(values));
    return object({{"stream-id", Node::of_string(id)},
                   {"talker", object({{"interface-configuration", object({{"interface-list", std::move(talker)}})}})},
                   {"status-info", object({{"talker-status", Node::of_string("ready")},
                                           {"listener-status", Node::of_string("ready")}})}});
  }

  /// takt's latency ends with the last bit, a request's with the first one at the listener; 0: none is asked.
  std::uint64_t latency_of(const scenario::Stream& stream, const scenario::ResolvedStream& resolved,
                           const models::StreamPlan& plan) {
    std::uint64_t least = 0;
    for (const scenario::Requirement& requirement : r_.scenario.require) {
      if (requirement.stream != stream.name || !requirement.latency) continue;
      Duration last;
      for (const models::LinkPlan& link : r_.plan.links)
        for (const scenario::Path& path : resolved.paths)
          if (path.size() >= 2 && ((link.a.node.value == path[path.size() - 2] && link.b.node.value == path.back()) ||
                                   (link.b.node.value == path[path.size() - 2] && link.a.node.value == path.back())))
            last = std::max(last, link.rate.octet_time() *
                                      static_cast<std::int64_t>(
                                          (models::preamble_and_sfd +
                                           models::frame_length(sim::Octets{stream.payload.count + plan.headers.count},
                                                                plan.priority.has_value()))
                                              .count));
      const Duration greatest = requirement.latency->greatest();
      const auto left = static_cast<std::uint64_t>(std::max<std::int64_t>((greatest - last).ps() / 1000, 1));
      least = least == 0 ? left : std::min(least, left);
    }
    return least;
  }

 public:
  std::string names() const {
    Node table = Node::object();
    for (const auto& [id, name] : names_) table.add(id, Node::of_string(name));
    return json::pretty(table);
  }

 private:
  const scenario::Resolved& r_;
  Exported& exported_;
  std::vector<std::pair<std::string, std::string>> names_;
  Node configurations_ = Node::array();
};

}  // namespace

Exported export_qcc(const ExportRequest& request) {
  Exported exported;
  RequestWriter writer(request.resolved, exported);
  exported.files.push_back({"requests.json", writer.write()});
  exported.files.push_back({"configurations.json", writer.configurations()});
  exported.files.push_back({"stream-ids.json", writer.names()});
  return exported;
}

}  // namespace takt::interchange
