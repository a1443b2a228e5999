// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "interchange/planning/planning.hpp"
#include "json/quantity.hpp"
#include "models/egress/port_config.hpp"
#include "models/ethernet/sizes.hpp"

namespace takt::interchange {
namespace {

using schedule::LinkIndex;
using schedule::NodeIndex;
using schedule::Ps;
using schedule::StreamIndex;
using sim::Duration;

constexpr std::uint32_t around_frame =
    static_cast<std::uint32_t>((models::preamble_and_sfd + models::inter_packet_gap).count);
constexpr std::uint32_t tagged_header =
    static_cast<std::uint32_t>((models::mac_header + models::vlan_tag + models::frame_check_sequence).count);
constexpr std::uint32_t shortest_frame = static_cast<std::uint32_t>(models::minimum_frame.count);
constexpr std::uint32_t longest_frame = tagged_header + static_cast<std::uint32_t>(models::maximum_msdu.count);
constexpr std::uint32_t longest_jumbo = tagged_header + 9000;  // the greatest mtu
constexpr Ps usual_duration = 100'000'000'000;                 // 100 ms
constexpr Ps longest_duration = 86'400'000'000'000'000;        // a day

class ScenarioMaker {
 public:
  ScenarioMaker(const ProblemToScenario& from, Imported& imported, json::Diagnostics& diagnostics)
      : from_(from),
        problem_(from.instance.problem),
        places_(from.instance.places),
        imported_(imported),
        diagnostics_(diagnostics) {}

  void make() {
    made_.name = problem_.name.empty() ? "plan" : problem_.name;
    find_extras();
    made_.duration = duration();
    if (from_.extras != nullptr) made_.seed = from_.extras->seed;
    make_nodes();
    make_links();
    for (StreamIndex s = 0; s < problem_.streams.size(); ++s) make_stream(s);
    if (from_.plans_gates)
      plan_gates();
    else if (from_.solution == nullptr && problem_.model.margin != 0)
      ignored("margin", "a margin of " + json::to_text(Duration::from_ps(problem_.model.margin)) +
                            ": clocks are ideal, and no gates are asked for (-o gates=auto)");
    if (!diagnostics_.has_errors()) imported_.scenario = std::move(made_);
  }

 private:
  /// Once for each thing, however many there are of it.
  void remark(RemarkKind kind, const std::string& what, const json::Place& place, std::string text) {
    if (told_.insert(what).second) imported_.remark(kind, place, std::move(text));
  }
  void ignored(const std::string& what, std::string text) {
    remark(RemarkKind::ignored, what, places_.whole, std::move(text));
  }

  void find_extras() {
    if (from_.extras == nullptr) return;
    std::set<std::string, std::less<>> nodes, streams, links;
    for (const schedule::Node& each : problem_.nodes) nodes.insert(each.name);
    for (const schedule::Stream& each : problem_.streams) streams.insert(each.name);
    for (const schedule::Link& each : problem_.links) links.insert(each.name);
    const auto check = [&](const auto& known, const std::string& name, const json::Source& where, const char* key,
                           auto& into, const auto* value) {
      if (!known.contains(name))
        diagnostics_.error(where.at(key), std::string("no such ") + key,
                           {json::quote(name), std::string("a ") + key + " of the problem"});
      else if (!into.emplace(name, value).second)
        diagnostics_.error(where.at(key), std::string("a ") + key + " twice", {json::quote(name), "each once"});
    };
    for (const NodeExtras& each : from_.extras->nodes) check(nodes, each.node, each.where, "node", node_extras_, &each);
    for (const StreamExtras& each : from_.extras->streams)
      check(streams, each.stream, each.where, "stream", stream_extras_, &each);
    for (const CableExtras& each : from_.extras->cables)
      check(links, each.link, each.where, "link", cable_extras_, &each);
  }

  Duration duration() const {
    if (from_.extras != nullptr && from_.extras->duration) return *from_.extras->duration;
    const auto all = schedule::hyperperiod(problem_);
    return Duration::from_ps(!all || *all > longest_duration / 2 ? usual_duration : std::max(usual_duration, 2 * *all));
  }

  const std::string& name_of(NodeIndex node) const {
    const auto found = node_extras_.find(problem_.nodes[node].name);
    return found == node_extras_.end() ? problem_.nodes[node].name : found->second->name;
  }

  void make_nodes() {
    std::vector<bool> talks(problem_.nodes.size()), listens(problem_.nodes.size());
    for (const schedule::Stream& stream : problem_.streams) {
      talks[stream.talker] = true;
      for (const NodeIndex listener : stream.listeners) listens[listener] = true;
    }
    std::vector<std::vector<LinkIndex>> into(problem_.nodes.size()), out(problem_.nodes.size());
    for (LinkIndex l = 0; l < problem_.links.size(); ++l) {
      into[problem_.links[l].to].push_back(l);
      out[problem_.links[l].from].push_back(l);
    }
    for (NodeIndex n = 0; n < problem_.nodes.size(); ++n) {
      scenario::Node node = scenario::HostNode{};
      if (problem_.nodes[n].is_bridge)
        node =
            talks[n] || listens[n] ? scenario::Node(scenario::StationNode{}) : scenario::Node(scenario::SwitchNode{});
      const Ps forwarding = forwarding_of(n, into[n]);
      if (scenario::Relay* const relay = scenario::relay_of(node)) {
        relay->forwarding_delay = Duration::from_ps(forwarding);
        set_cut_through(n, into[n], *relay, scenario::ports_of(node));
      } else if (forwarding != 0 && listens[n]) {
        scenario::end_station_of(node)->os.receive.emplace().fixed = Duration::from_ps(forwarding);
      }
      std::uint32_t entries = 1'000'000;
      for (const LinkIndex l : out[n]) entries = std::min(entries, problem_.links[l].entries);
      constexpr std::uint32_t usual_entries = 1024;
      if (!out[n].empty() && entries < usual_entries) scenario::ports_of(node).gate_limits.emplace().entries = entries;
      made_.network.nodes.emplace_back(name_of(n), std::move(node));
    }
  }

  std::uint8_t class_of(StreamIndex s) const {
    const auto extra = stream_extras_.find(problem_.streams[s].name);
    return from_.has_classes || extra == stream_extras_.end()
               ? problem_.streams[s].traffic_class
               : models::standard_traffic_classes[extra->second->pcp.value_or(0)];
  }

  Ps forwarding_of(NodeIndex node, const std::vector<LinkIndex>& links) {
    Ps most = 0;
    for (const LinkIndex l : links) most = std::max(most, problem_.links[l].forwarding);
    if (std::ranges::any_of(links, [&](LinkIndex l) { return problem_.links[l].forwarding != most; }))
      remark(RemarkKind::lost, "forwarding", places_.nodes[node],
             "forwarding times that differ by port, such as those of " + json::quote(problem_.nodes[node].name) +
                 ": takt takes the longest, " + json::to_text(Duration::from_ps(most)) + ", for all");
    return most;
  }

  void set_cut_through(NodeIndex node, const std::vector<LinkIndex>& links, scenario::Relay& relay,
                       scenario::NodePorts& ports) {
    const auto first =
        std::ranges::find_if(links, [&](LinkIndex l) { return problem_.links[l].cut_through.has_value(); });
    if (first == links.end()) return;
    const std::optional<std::uint32_t> octets = problem_.links[*first].cut_through;
    // takt counts the header of an untagged frame.
    const bool is_tagged = std::ranges::any_of(problem_.streams, [&](const schedule::Stream& stream) {
      const auto extra = stream_extras_.find(stream.name);
      return extra == stream_extras_.end() || extra->second->pcp.has_value();
    });
    const auto tag = is_tagged ? static_cast<std::uint32_t>(models::vlan_tag.count) : 0;
    if (std::ranges::any_of(links, [&](LinkIndex l) {
          return problem_.links[l].cut_through && problem_.links[l].cut_through != octets;
        }))
      imported_.remark(RemarkKind::lost, places_.nodes[node],
                       "ports of " + json::quote(problem_.nodes[node].name) +
                           " that cut through after other headers: takt takes " + std::to_string(*octets) +
                           " octets for all");
    if (*octets < tag)
      return diagnostics_.error(places_.links[*first], "cut through before there is a header",
                                {std::to_string(*octets), "more than the tag's " + std::to_string(tag)});
    relay.cut_through_header = sim::Octets{*octets - tag};
    std::set<std::uint8_t> classes;
    for (StreamIndex s = 0; s < problem_.streams.size(); ++s) classes.insert(class_of(s));
    scenario::Egress egress;
    egress.cut_through.assign(classes.begin(), classes.end());
    ports.egress.push_back(std::move(egress));
  }

  void make_links() {
    std::map<std::pair<NodeIndex, NodeIndex>, std::vector<LinkIndex>>
        open;  // directions that wait for their counterpart, latest first
    for (LinkIndex l = static_cast<LinkIndex>(problem_.links.size()); l-- > 0;)
      open[{problem_.links[l].from, problem_.links[l].to}].push_back(l);
    std::vector<bool> is_done(problem_.links.size());
    cable_of_.assign(problem_.links.size(), 0);
    std::size_t alone = 0;
    for (LinkIndex l = 0; l < problem_.links.size(); ++l) {
      if (is_done[l]) continue;
      const schedule::Link& link = problem_.links[l];
      open[{link.from, link.to}].pop_back();
      if (link.from == link.to) {
        remark(RemarkKind::ignored, "loop", places_.links[l], "links from a node to itself");
        continue;
      }
      auto& back = open[{link.to, link.from}];
      while (!back.empty() && is_done[back.back()]) back.pop_back();
      std::optional<LinkIndex> other;
      if (!back.empty()) {
        other = back.back();
        back.pop_back();
        is_done[*other] = true;
        cable_of_[*other] = made_.network.links.size();
      } else {
        ++alone;
      }
      cable_of_[l] = made_.network.links.size();
      add_cable(l, other);
    }
    if (alone != 0)
      remark(RemarkKind::changed, "alone", places_.whole,
             fmt::format("{} {} without the other direction: cables have both", alone, alone == 1 ? "link" : "links"));
  }

  void add_cable(LinkIndex l, std::optional<LinkIndex> other) {
    const schedule::Link& link = problem_.links[l];
    scenario::Link cable;
    cable.ends = {name_of(link.from), name_of(link.to)};
    const auto extra = cable_extras_.find(link.name),
               other_extra = other ? cable_extras_.find(problem_.links[*other].name) : cable_extras_.end();
    if (extra != cable_extras_.end())
      set_ports(cable, extra->second->from, extra->second->to);
    else if (other_extra != cable_extras_.end())
      set_ports(cable, other_extra->second->to, other_extra->second->from);
    Ps octet = link.octet, propagation = link.propagation;
    if (other) {
      const schedule::Link& back = problem_.links[*other];
      if (back.octet != octet)
        diagnostics_.error(places_.links[*other], "a cable of which each direction has another rate",
                           {json::quote(link.name) + " and " + json::quote(back.name), "the same rate both ways"});
      if (back.propagation != propagation) {
        propagation = std::max(propagation, back.propagation);
        remark(RemarkKind::lost, "propagation", places_.links[*other],
               "propagation delays that differ by direction, such as those of " + json::quote(link.name) + " and " +
                   json::quote(back.name) + ": takt takes the longer for both");
      }
    }
    cable.rate = sim::DataRate{static_cast<std::uint64_t>(8 * static_cast<Ps>(schedule::ps_per_second) / octet)};
    cable.delay = Duration::from_ps(propagation);
    made_.network.links.push_back(std::move(cable));
  }
  static void set_ports(scenario::Link& cable, std::uint16_t a, std::uint16_t b) {
    cable.ends[0] += ":" + std::to_string(a);
    cable.ends[1] += ":" + std::to_string(b);
  }

  void make_stream(StreamIndex s) {
    const schedule::Stream& from = problem_.streams[s];
    const auto extra = stream_extras_.find(from.name);
    const StreamExtras* const more = extra == stream_extras_.end() ? nullptr : extra->second;
    scenario::Stream stream;
    stream.name = more != nullptr && more->name ? *more->name : from.name;
    stream.from = name_of(from.talker);
    for (const NodeIndex listener : from.listeners) stream.to.names.push_back(name_of(listener));
    std::uint32_t frames = from.frames;
    set_size(s, more, stream, frames);
    if (frames == 1 && (more == nullptr || !more->is_burst))
      stream.every = Duration::from_ps(from.period);
    else
      stream.burst = scenario::Bursts{frames, Duration::from_ps(from.period), {}};
    if (from.release != 0) stream.offset = json::OrAuto<Duration>(Duration::from_ps(from.release));
    if (from.route) set_path(s, *from.route, stream);
    if (from_.solution != nullptr) place(s, stream);
    if (from_.plans_gates) {
      if (from.release != 0)
        remark(RemarkKind::lost, "release", places_.streams[s],
               "that streams with a release, such as " + json::quote(from.name) +
                   ", may be sent later: an offset that is given is kept");
      else if (stream.burst) {
        remark(RemarkKind::lost, "train", places_.streams[s],
               "that streams in several frames, such as " + json::quote(from.name) +
                   ", may be sent later: takt chooses the offsets of single frames");
        stream.offset = json::OrAuto<Duration>(Duration());
      } else
        stream.offset.emplace().is_auto = true;
    }
    require(from, stream);
    made_.streams.push_back(std::move(stream));
  }

  /// What the stream has on the wire, as takt has it: the preamble and the gap beside the frame.
  void set_size(StreamIndex s, const StreamExtras* more, scenario::Stream& stream, std::uint32_t& frames) {
    const schedule::Stream& from = problem_.streams[s];
    const auto priority =
        static_cast<std::uint8_t>(std::ranges::find(models::standard_traffic_classes, from.traffic_class) -
                                  models::standard_traffic_classes.begin());
    const std::uint32_t wire = from.octets + problem_.model.preamble + problem_.model.gap;
    if (more != nullptr) {
      stream.encapsulation = more->encapsulation;
      stream.pcp = more->pcp;
      stream.vlan = more->vlan;
      stream.payload = more->payload;
      const sim::Octets headers =
          more->encapsulation == scenario::Encapsulation::udp ? models::ipv4_and_udp_headers : sim::Octets{0};
      const auto length =
          static_cast<std::uint32_t>(models::frame_length(more->payload + headers, more->pcp.has_value()).count);
      if (length + around_frame != wire)
        diagnostics_.error(more->where.at("payload"), "a payload that does not make the size of the problem",
                           {fmt::format("{} octets on the wire", length + around_frame), fmt::format("{}", wire)});
      if (from_.has_classes && models::standard_traffic_classes[more->pcp.value_or(0)] != from.traffic_class)
        diagnostics_.error(more->where.at("pcp"), "a priority that is not that of the class",
                           {more->pcp ? std::to_string(*more->pcp) : "none",
                            fmt::format("{}, of class {}", priority, from.traffic_class)});
      return;
    }
    stream.encapsulation = scenario::Encapsulation::ethernet;
    stream.pcp = priority;
    const bool is_jumbo = wire > longest_frame + around_frame && wire <= longest_jumbo + around_frame;
    const std::uint32_t pieces =
        is_jumbo ? 1 : (wire + longest_frame + around_frame - 1) / (longest_frame + around_frame);
    if (is_jumbo) {
      made_.network.mtu = std::max(made_.network.mtu, sim::Octets{wire - around_frame - tagged_header});
      remark(
          RemarkKind::changed, "jumbo", places_.streams[s],
          fmt::format("frames longer than Ethernet's ({} octets on the wire at {}): the network takes them, by its mtu",
                      wire, json::quote(from.name)));
    }
    if (pieces > 1)
      remark(RemarkKind::lost, "long", places_.streams[s],
             fmt::format("frames longer than Ethernet's ({} octets on the wire at {}): takt sends them in pieces that "
                         "are stored one by one",
                         wire, json::quote(from.name)));
    frames *= std::max(pieces, 1u);
    const std::uint32_t each = (wire + pieces - 1) / std::max(pieces, 1u);
    const std::uint32_t least = shortest_frame + around_frame;
    if (each < least)
      remark(RemarkKind::lost, "short", places_.streams[s],
             fmt::format("frames shorter than Ethernet's ({} octets on the wire at {}): takt sends {}", each,
                         json::quote(from.name), least));
    stream.payload = sim::Octets{std::max(each, least) - around_frame - tagged_header};
  }

  void set_path(StreamIndex s, const std::vector<LinkIndex>& route, scenario::Stream& stream) {
    const schedule::Stream& from = problem_.streams[s];
    if (from.listeners.size() > 1)
      return remark(
          RemarkKind::lost, "tree", places_.streams[s],
          "routes to several listeners, such as those of " + json::quote(from.name) + ": takt goes the shortest ways");
    // A tree to one listener may have branches to nobody. That of a schedule may be none: it is walked no further than
    // there are nodes.
    std::map<NodeIndex, LinkIndex> into;
    for (const LinkIndex l : route) into[problem_.links[l].to] = l;
    std::vector<std::string> back;
    NodeIndex at = from.listeners.front();
    while (at != from.talker && back.size() < problem_.nodes.size()) {
      const auto link = into.find(at);
      if (link == into.end()) break;
      back.push_back(name_of(at));
      at = problem_.links[link->second].from;
    }
    if (at != from.talker)
      return diagnostics_.error(places_.streams[s], "a route that does not come to the listener",
                                {json::quote(from.name), "links from the talker to the listener"});
    auto& path = stream.path.emplace();
    path.push_back(name_of(from.talker));
    path.insert(path.end(), back.rbegin(), back.rend());
  }

  /// Where a schedule has put it.
  void place(StreamIndex s, scenario::Stream& stream) {
    const schedule::Stream& from = problem_.streams[s];
    const auto& placement = from_.solution->streams[s];
    if (!placement)
      return diagnostics_.error(places_.streams[s], "a stream that the schedule has not",
                                {json::quote(from.name), "a start for each"});
    stream.path.reset();
    set_path(s, placement->route, stream);
    if (placement->starts.empty() || placement->starts.front().empty())
      return diagnostics_.error(places_.streams[s], "a stream without a start",
                                {json::quote(from.name), "a start on each link"});
    const auto& starts = placement->starts.front();
    bool is_periodic = true;
    for (std::size_t k = 0; k < starts.size(); ++k)
      is_periodic = is_periodic && starts[k] == starts.front() + static_cast<Ps>(k) * from.period;
    if (!is_periodic)
      return diagnostics_.error(places_.streams[s], "repetitions at other distances than the period",
                                {json::quote(from.name), "one start that repeats"});
    stream.offset = json::OrAuto<Duration>(Duration::from_ps(starts.front()));
    if (std::ranges::any_of(placement->classes, [&](std::uint8_t c) { return c != from.traffic_class; }))
      diagnostics_.error(places_.streams[s], "a stream in several classes",
                         {json::quote(from.name), "the class of the problem on every link"});
  }

  void require(const schedule::Stream& from, const scenario::Stream& stream) {
    std::optional<Ps> latency = from.latency;
    // From the start at the talker, which is the release unless somebody delays it.
    if (from.deadline && *from.deadline > from.release)
      latency = std::min(
          latency.value_or(schedule::longest_time),
          *from.deadline - (stream.offset && !stream.offset->is_auto ? stream.offset->value.ps() : from.release));
    if (!latency && !from.jitter) return;
    scenario::Requirement requirement;
    requirement.stream = stream.name;
    if (latency) requirement.latency.emplace().at_most = Duration::from_ps(std::max<Ps>(*latency, 1));
    if (from.jitter) requirement.jitter.emplace().at_most = Duration::from_ps(*from.jitter);
    made_.require.push_back(std::move(requirement));
  }

  void plan_gates() {
    auto& gates = made_.gates.emplace();
    gates.plan = scenario::GatePlanning::automatic;
    if (problem_.model.margin != 0) gates.margin = json::OrAuto<Duration>(Duration::from_ps(problem_.model.margin));
    std::set<std::uint8_t> classes;
    for (StreamIndex s = 0; s < problem_.streams.size(); ++s) classes.insert(class_of(s));
    gates.classes.assign(classes.begin(), classes.end());
    if (problem_.model.guard_octets != 0) gates.guard = scenario::GateGuard::longest_frame;
  }

 public:
  /// The gate control lists of the schedule at the ports that send on its links.
  void set_gates() {
    for (const auto& [l, list] : from_.solution->gates) {
      const schedule::Link& link = problem_.links[l];
      scenario::Egress egress;
      egress.to = name_of(link.to);
      scenario::Gates& gates = egress.gates.emplace();
      gates.cycle = Duration::from_ps(list.cycle);
      for (const schedule::GateEntry& each : list.entries) {
        scenario::GateEntry entry;
        entry.interval = Duration::from_ps(each.interval);
        for (std::uint8_t c = 0; c < 8; ++c)
          if ((each.open >> c & 1) != 0) entry.open.push_back(c);
        gates.entries.push_back(std::move(entry));
      }
      auto& ports = scenario::ports_of(imported_.scenario->network.nodes[link.from].second);
      if (!ports.egress.empty()) egress.cut_through = ports.egress.front().cut_through;
      ports.egress.push_back(std::move(egress));
    }
  }

 private:
  const ProblemToScenario& from_;
  const schedule::Problem& problem_;
  const schedule_instances::Places& places_;
  Imported& imported_;
  json::Diagnostics& diagnostics_;
  scenario::Scenario made_;
  std::vector<std::size_t> cable_of_;
  std::map<std::string, const NodeExtras*> node_extras_;
  std::map<std::string, const StreamExtras*> stream_extras_;
  std::map<std::string, const CableExtras*> cable_extras_;
  std::set<std::string> told_;
};

}  // namespace

void make_scenario(const ProblemToScenario& from, Imported& imported, json::Diagnostics& diagnostics) {
  ScenarioMaker maker(from, imported, diagnostics);
  maker.make();
  if (imported.scenario && from.solution != nullptr) maker.set_gates();
}

}  // namespace takt::interchange
