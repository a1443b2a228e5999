// SPDX-License-Identifier: Apache-2.0
// The network's skeleton: it is drawn first, and read back from the loader, so that everything else can name what is
// there.
#include <algorithm>

#include "scenario/resolve.hpp"
#include "sim/check.hpp"
#include "tests/generator/maker.hpp"

namespace takt::generator {
namespace {

Node link(const std::string& a, const std::string& b) {
  Node made = Node::object();
  made.add("ends", list({text(a), text(b)}));
  return made;
}

Node node(std::string_view kind) {
  Node made = Node::object();
  made.add("kind", text(kind));
  return made;
}

/// A shape with few switches.
Node any_shape(Draw& draw, bool wants_circles, bool wants_one, bool wants_stations) {
  Node made = Node::object();
  if (wants_stations && !wants_one) {
    const std::string of_stations = draw.word(wants_circles ? "ring dual-star" : "line ring star dual-star");
    made.add("topology", text(of_stations));
    made.add("stations", number(draw.between(3, 5)));
    return made;
  }
  if (wants_one) {
    made.add("topology", text("line"));
    made.add("switches", number(1));
    made.add("hosts_per_switch", number(draw.between(2, 3)));
    return made;
  }
  const auto add = [&](std::string_view key, std::size_t least, std::size_t most) {
    made.add(key, number(draw.between(least, most)));
  };
  const std::string shape =
      draw.word(wants_circles ? "ring mesh dual-star random" : "line ring star tree mesh comb random dual-star");
  made.add("topology", text(shape));
  if (shape == "line") add("switches", 1, 4);
  if (shape == "ring") add("switches", 3, 5);
  if (shape == "star") add("switches", 3, 4);
  if (shape == "dual-star") add("switches", 2, 3);
  if (shape == "tree") {
    add("depth", 1, 1);
    add("fanout", 2, 3);
  }
  if (shape == "mesh" && draw.one_in(2))
    add("switches", 3, 4);
  else if (shape == "mesh") {
    add("rows", 2, 2);
    add("columns", 2, 3);
  }
  if (shape == "comb") {
    add("switches", 2, 2);
    add("teeth", 1, 1);
  }
  if (shape == "random") {
    add("switches", 4, 5);
    made.add("degree", Node::of_literal(draw.word("2.0 2.5")));
    if (draw.one_in(2)) add("seed", 1, 50);
  }
  add("hosts_per_switch", 1, 2);
  return made;
}

/// Switches in a row, a circle or a star, and hosts that hang on them; two hosts without a switch now and then.
Node any_network(Draw& draw, bool wants_circles, std::size_t least_hosts, bool wants_stations) {
  Node nodes = Node::object();
  Node links = Node::array();
  const std::size_t switches = wants_circles                         ? draw.between(3, 5)
                               : draw.one_in(12) && least_hosts <= 2 ? 0
                                                                     : draw.between(1, 4);
  const std::size_t hosts = switches == 0 ? 2 : draw.between(least_hosts, 6);
  const auto sw = [](std::size_t s) { return "sw" + std::to_string(s); };
  const auto host = [](std::size_t h) { return "h" + std::to_string(h); };
  const bool is_star = draw.one_in(3) && !wants_circles;
  for (std::size_t s = 0; s < switches; ++s) {
    const bool is_station = wants_stations && (s == 0 || draw.one_in(2));
    nodes.add(sw(s), node(is_station ? "station" : "switch"));
    if (s > 0) links.items.push_back(link(sw(is_star ? 0 : s - 1), sw(s)));
  }
  if (switches > 2 && !is_star && (wants_circles || draw.one_in(3)))
    links.items.push_back(link(sw(switches - 1), sw(0)));
  // A second link between two switches, by ports that paths name.
  if (switches > 1 && !wants_stations && draw.one_in(6))
    links.items.push_back(link(sw(0) + second_link, sw(1) + second_link));
  for (std::size_t h = 0; h < hosts; ++h) {
    nodes.add(host(h), node("host"));
    if (switches > 0) links.items.push_back(link(host(h), sw(h % switches)));
    // Attached twice, with a way of its own to each.
    if (wants_stations && switches > 1 && draw.one_in(3)) links.items.push_back(link(host(h), sw((h + 1) % switches)));
  }
  if (switches == 0) links.items.push_back(link(host(0), host(1)));
  Node network = Node::object();
  network.add("nodes", std::move(nodes));
  network.add("links", std::move(links));
  return network;
}

Node generated_network(Draw& draw, bool wants_circles, bool wants_one, bool wants_stations) {
  Node network = Node::object();
  network.add("generate", list({any_shape(draw, wants_circles, wants_one, wants_stations)}));
  // Written nodes add to it.
  Node nodes = Node::object();
  nodes.add("plc", node("host"));
  nodes.add("panel", node("host"));
  network.add("nodes", std::move(nodes));
  const Node& made = network.find("generate")->items.front();
  const bool has_switch = made.find("stations") == nullptr || made.find("topology")->text.ends_with("star");
  const std::string first = has_switch ? "sw1" : "st1";
  network.add("links", list({link("plc", first), link("panel", first)}));
  return network;
}

}  // namespace

std::vector<std::string> World::nodes() const {
  std::vector<std::string> all = switches;
  std::ranges::copy_if(hosts, std::back_inserter(all), [&](const std::string& host) { return !forwards(host); });
  return all;
}

bool World::forwards(const std::string& node) const { return std::ranges::find(switches, node) != switches.end(); }

std::vector<std::string> World::path(Draw& draw, const std::string& from, const std::string& to,
                                     const std::set<std::string>& avoid) const {
  std::vector<std::string> way = {from};
  std::set<std::string> seen = avoid;
  seen.insert(from);
  // Depth first; a dead end is left again.
  while (!way.empty() && way.back() != to) {
    std::vector<std::string> next;
    for (const std::string& each : neighbours.at(way.back()))
      if (!seen.contains(each) && (each == to || forwards(each))) next.push_back(each);
    if (next.empty()) {
      way.pop_back();
      continue;
    }
    way.push_back(draw.any(next));
    seen.insert(way.back());
  }
  return way;
}

void Maker::lay_out() {
  const bool wants_circles = wants(Feature::redundancy) || wants(Feature::rerouting) ? !draw.one_in(8) : false;
  // Generated switches untag all of their ports or none: those without a neighbour that is a switch.
  skeleton = wants(Feature::generated)
                 ? generated_network(draw, wants_circles, wants(Feature::untagged) && !wants_circles && draw.one_in(2),
                                     wants(Feature::stations))
                 : any_network(draw, wants_circles, wants(Feature::nesting) ? 4 : 2, wants(Feature::stations));
  Node whole = Node::object();
  whole.add("name", text("skeleton"));
  whole.add("duration", text("1ms"));
  whole.add("network", skeleton);
  json::Diagnostics diagnostics;
  const auto resolved = scenario::load_text(json::pretty(whole), "skeleton.json", {}, diagnostics);
  TAKT_CHECK(resolved != nullptr,
             ("the skeleton of a network is sound: " + diagnostics.to_text() + json::pretty(skeleton)).c_str());
  for (std::size_t n = 0; n < resolved->topology.nodes.size(); ++n) {
    const scenario::TopologyNode& each = resolved->topology.nodes[n];
    if (each.is_end_station()) world.hosts.push_back(each.name);
    if (each.forwards()) world.switches.push_back(each.name);
    for (const scenario::Neighbour& other : resolved->topology.neighbours[n])
      world.neighbours[each.name].push_back(resolved->topology.nodes[other.node].name);
  }
  for (const models::LinkPlan& each : resolved->topology.links)
    world.links.emplace_back(resolved->topology.nodes[each.a.node.value].name,
                             resolved->topology.nodes[each.b.node.value].name);
}

Maker::Maker(std::uint64_t seed, std::set<Feature> wishes) : draw(seed), wishes_(std::move(wishes)) {
  for (bool grows = true; grows;) {  // what a feature needs, and what that needs
    grows = false;
    for (const FeatureEntry& entry : features())
      if (wishes_.contains(entry.feature))
        for (const Feature needed : entry.needs) grows |= wishes_.insert(needed).second;
  }
  // What waits behind a gate or for credit while a header comes.
  if (wants(Feature::cut_through) && !wants(Feature::automatic_gates) && draw.one_in(2))
    wishes_.insert(draw.one_in(3) ? Feature::shapers : Feature::gates);
  is_slow_ = wants(Feature::rates) && draw.one_in(2);
  is_long_ = wants(Feature::gptp);
  duration_us = is_long_ ? 1000 * draw.between(60, 120)
                : wants(Feature::dds) || wants(Feature::opc_ua) || wants(Feature::programs) ? 1000 * draw.between(8, 24)
                                                                                            : 1000 * draw.between(2, 6);
  streams = wants(Feature::programs) || wants(Feature::opc_ua) || wants(Feature::dds) ? draw.between(0, 4)
                                                                                      : draw.between(1, 6);
  for (const Feature of_streams : {Feature::launch, Feature::multicast, Feature::explicit_path, Feature::redundancy,
                                   Feature::traces, Feature::babble})
    if (wants(of_streams)) streams = std::max<std::size_t>(streams, 2);
  if (wants(Feature::nesting)) groups = {Group::outer, Group::inner};
  inner_has_roles = wants(Feature::nesting) && wants(Feature::roles) && draw.one_in(2);
  if (wants(Feature::roles) && !inner_has_roles) groups.push_back(Group::roles);
  if (wants(Feature::paper_variant) || (wants(Feature::replies) && groups.empty()) ||
      (wants(Feature::programs) && (groups.empty() || draw.one_in(3))))
    groups.push_back(Group::plain);
  topics = draw.between(2, 3);
  if (wants(Feature::roles)) skills = {"weld", "grip"};
  lay_out();
}

Node Maker::scenario() { return object("scenario", nullptr); }

namespace {

/// The members that the skeleton has, and what the rules add.
Node detailed(Maker& m, const Node& skeleton, std::string_view definition, const Scope& scope) {
  Node made = m.object(definition, &scope);
  for (const json::Member& member : skeleton.members) {
    if (Node* const there = made.find(member.key))
      *there = member.value;
    else
      made.members.insert(made.members.begin(), member);
  }
  return made;
}

std::optional<Node> nodes_of(Maker& m, const Scope& scope) {
  Node made = Node::object();
  if (const Node* const nodes = m.skeleton.find("nodes"))
    for (const json::Member& each : nodes->members)
      made.add(each.key, m.option("node", each.value.find("kind")->text, &scope, each.key));
  return made;
}

std::optional<Node> links_of(Maker& m, const Scope& scope) {
  Node made = Node::array();
  for (const Node& each : m.skeleton.find("links")->items) made.items.push_back(detailed(m, each, "link", scope));
  return made;
}

std::optional<Node> generators_of(Maker& m, const Scope& scope) {
  const Node* const generators = m.skeleton.find("generate");
  if (generators == nullptr) return std::nullopt;
  Node made = Node::array();
  for (const Node& each : generators->items) made.items.push_back(detailed(m, each, "generator", scope));
  return made;
}

std::optional<Node> offered_skills(Maker& m, const Scope&) {
  std::vector<Node> offered;
  for (const std::string& skill : m.draw.some(m.skills, m.draw.between(1, 2))) offered.push_back(text(skill));
  return list(std::move(offered));
}

/// Known from the skeleton.
/// Not where frames are cut through, or come to a buffer at known times.
std::optional<Node> jitter_of_switch(Maker& m, const Scope&) {
  for (const Feature each : {Feature::cut_through, Feature::cqf, Feature::automatic_gates})
    if (m.wants(each)) return std::nullopt;
  Node ends = Node::object(), made = Node::object();
  if (m.draw.one_in(4)) {
    ends.add("mean", text("100ns"));
    made.add("exponential", std::move(ends));
    made.add("max", text("2us"));
    return made;
  }
  ends.add("from", m.word("0ns 20ns"));
  ends.add("to", m.word("20ns 160ns 5us"));
  made.add("uniform", std::move(ends));
  return made;
}

std::optional<Node> never(Maker&, const Scope&) { return std::nullopt; }

std::optional<Node> name_of_skeleton(Maker&, const Scope&) { return list({text("?"), text("?")}); }
std::optional<Node> shape_of_skeleton(Maker&, const Scope&) { return text("?"); }

/// Applications of the host, and a Program that may have a participant there; if not, its name is left out again.
std::optional<Node> runs_of_thread(Maker& m, const Scope& s) {
  if (s.number == 0) return std::nullopt;  // that of the protocol stack
  const Scope* const host = s.around("host") != nullptr ? s.around("host") : s.around("station");
  const auto number = static_cast<std::size_t>(std::ranges::find(m.world.hosts, host->name) - m.world.hosts.begin());
  Node made = Node::array();
  if ((m.wants(Feature::opc_ua) || m.wants(Feature::dds)) && number < m.topics && s.number < 3)
    made.items.push_back(text("a" + std::to_string(number) + (s.number == 1 ? "" : "/th0")));
  if (!m.groups.empty() && s.number == 1 && m.draw.one_in(2))
    made.items.push_back(text("p" + std::to_string(m.draw.below(m.groups.size()))));
  return made.items.empty() ? std::nullopt : std::optional(made);
}

std::optional<Node> stack_of_thread(Maker& m, const Scope& s) {
  if (s.number != 0) return std::nullopt;
  Node made = Node::array();
  for (const char* const part : {"receive", "transmit", "gptp"})
    if ((std::string_view(part) != "gptp" || m.wants(Feature::gptp)) && (made.items.empty() || m.draw.one_in(2)))
      made.items.push_back(text(part));
  return made;
}

/// Before an ATS scheduler as long as frames are held, and longer.
std::optional<Node> forwarding_delay(Maker& m, const Scope&) {
  return m.word(m.wants(Feature::ats) ? "0ns 1us 3us 10us 30us 100us" : "0ns 500ns 1us 3us");
}

/// Frames that are longer than most functions expect are for networks without them.
std::optional<Node> jumbo(Maker& m, const Scope&) {
  for (const Feature each :
       {Feature::policing, Feature::ats, Feature::cqf, Feature::automatic_gates, Feature::queue_limits})
    if (m.wants(each) || m.is_slow()) return std::nullopt;
  return m.kept.insert_or_assign("mtu", text("9000B")).first->second;
}

/// Fewer than eight only where nothing names a class that is not there.
std::optional<Node> classes_of_node(Maker& m, const Scope&) {
  for (const Feature each :
       {Feature::gates, Feature::hold, Feature::shapers, Feature::ets, Feature::max_sdu, Feature::preemption,
        Feature::cut_through, Feature::ats, Feature::cqf, Feature::policing, Feature::queue_limits, Feature::set_gates,
        Feature::automatic_gates, Feature::listed_gates})
    if (m.wants(each)) return text("identity");
  if (m.draw.one_in(2)) return m.word("identity standard");
  return number(m.draw.between(1, 8));
}

/// Only where nothing has gates.
std::optional<Node> no_gates(Maker& m, const Scope&) {
  for (const Feature each : {Feature::gates, Feature::hold, Feature::cqf, Feature::set_gates, Feature::automatic_gates,
                             Feature::listed_gates})
    if (m.wants(each)) return std::nullopt;
  return text("none");
}

/// Types that say little, so that they go with what the scenario has. The exact one limits gates.
std::optional<Node> device_of_node(Maker& m, const Scope&) {
  for (const Feature each : {Feature::gates, Feature::automatic_gates, Feature::listed_gates})
    if (m.wants(each)) return text("plain.json");
  return m.word("plain.json exact.json");
}

/// A medium says the rate, which then is not written. One in half duplex is refused, so none is drawn.
std::optional<Node> medium_of_link(Maker& m, const Scope& s) {
  if (s.has("rate")) return std::nullopt;
  return m.word(m.is_slow() ? "10BASE-T 10BASE-T1L 100BASE-TX 100BASE-FX 100BASE-T1"
                            : "1000BASE-T 1000BASE-X 1000BASE-T1 2.5GBASE-T 2.5GBASE-X 5GBASE-T 10GBASE-T 10GBASE-R");
}

}  // namespace

std::span<const Rule> network_rules() {
  static const Rule rules[] = {
      {.key = "scenario.$schema", .percent = 5, .words = "scenario.schema.json"},
      {.key = "scenario.name", .words = "generated"},
      {.key = "scenario.description", .percent = 5, .words = "drawn"},
      {.key = "scenario.seed",
       .percent = 80,
       .make = [](Maker& m, const Scope&) -> std::optional<Node> { return number(m.draw.below(1000)); }},
      {.key = "scenario.warm_up",
       .percent = 15,
       .make = [](Maker& m, const Scope&) -> std::optional<Node> {
         return text(std::to_string(m.duration_us / 4) + "us");
       }},
      {.key = "scenario.duration",
       .make = [](Maker& m, const Scope&) -> std::optional<Node> {
         return text(std::to_string(m.duration_us) + "us");
       }},
      {.key = "scenario.network"},
      {.key = "scenario.allow_overload", .feature = Feature::overload, .percent = 100, .words = "true"},
      {.key = "network.nodes", .percent = 100, .make = nodes_of},
      {.key = "network.links", .percent = 100, .make = links_of},
      {.key = "network.mtu", .percent = 10, .make = jumbo},
      {.key = "host.mtu", .percent = 5, .words = "1500B 9000B"},
      {.key = "switch.mtu", .percent = 5, .words = "9000B"},
      {.key = "station.mtu", .percent = 5, .words = "9000B"},
      {.key = "generator.mtu", .percent = 5, .words = "9000B"},
      {.key = "network.generate", .percent = 100, .make = generators_of},
      {.key = "link.ends", .make = name_of_skeleton},
      {.key = "link.rate",
       .feature = Feature::rates,
       .percent = 70,
       .make = [](Maker& m, const Scope&) -> std::optional<Node> {
         return m.word(m.is_slow() ? "10Mbps 100Mbps 100Mbps 1Gbps" : "100Mbps 1Gbps 2.5Gbps 10Gbps");
       }},
      {.key = "link.medium", .feature = Feature::rates, .percent = 50, .make = medium_of_link},
      {.key = "host.device", .percent = 5, .make = device_of_node},
      {.key = "switch.device", .percent = 15, .make = device_of_node},
      {.key = "station.device", .percent = 15, .make = device_of_node},
      {.key = "generator.device", .percent = 15, .make = device_of_node},
      {.key = "host.gates", .percent = 5, .make = no_gates},
      {.key = "switch.gates", .percent = 15, .make = no_gates},
      {.key = "station.gates", .percent = 15, .make = no_gates},
      {.key = "generator.gates", .percent = 15, .make = no_gates},
      {.key = "link.length", .words = "1m 10m 100m 2km"},
      {.key = "link.delay", .words = "0ns 50ns 500ns 3us"},
      {.key = "generator.topology", .make = shape_of_skeleton},
      {.key = "generator.switches", .make = never},
      {.key = "generator.stations", .make = never},
      {.key = "generator.depth", .make = never},
      {.key = "generator.fanout", .make = never},
      {.key = "generator.rows", .make = never},
      {.key = "generator.columns", .make = never},
      {.key = "generator.teeth", .make = never},
      {.key = "generator.degree", .make = never},
      {.key = "generator.seed", .make = never},
      {.key = "generator.hosts_per_switch", .make = never},
      {.key = "generator.switch_prefix", .percent = 20, .words = "sw"},
      {.key = "generator.station_prefix", .percent = 20, .words = "st"},
      {.key = "generator.host_prefix", .percent = 20, .words = "h"},
      {.key = "generator.rate", .words = "100Mbps 1Gbps"},
      {.key = "generator.host_rate", .words = "100Mbps 1Gbps"},
      {.key = "generator.length", .words = "1m 10m 100m"},
      {.key = "generator.forwarding_delay", .percent = 50, .make = forwarding_delay},
      {.key = "generator.os", .feature = Feature::latencies, .percent = 60},
      {.key = "generator.queues", .feature = Feature::queue_limits, .percent = 60},
      {.key = "generator.traffic_classes",
       .feature = Feature::identity_classes,
       .percent = 60,
       .make = classes_of_node},
      {.key = "host.os", .feature = Feature::latencies, .percent = 70},
      {.key = "host.traffic_classes", .feature = Feature::identity_classes, .percent = 50, .make = classes_of_node},
      {.key = "host.queues", .feature = Feature::queue_limits, .percent = 50},
      {.key = "host.cryptography", .feature = Feature::security, .percent = 60},
      {.key = "host.processing", .feature = Feature::replies, .percent = 50},
      {.key = "host.offers", .feature = Feature::roles, .percent = 85, .make = offered_skills},
      {.key = "host.cpu", .feature = Feature::processors, .percent = 70},
      {.key = "station.cpu", .feature = Feature::processors, .percent = 70},
      {.key = "cpu.cores", .percent = 40, .words = "1 2 4"},
      {.key = "cpu.switching", .percent = 40, .words = "0us 1us 2us"},
      {.key = "cpu.slice", .percent = 30, .words = "50us 200us 1ms"},
      {.key = "cpu.threads",
       .make = [](Maker& m, const Scope& s) -> std::optional<Node> {
         return m.objects("cpu_thread", m.draw.between(2, 4), s);
       }},
      {.key = "cpu_thread.name",
       .make = [](Maker&, const Scope& s) -> std::optional<Node> { return text("t" + std::to_string(s.number)); }},
      {.key = "cpu_thread.policy", .percent = 50},
      {.key = "cpu_thread.priority",
       .percent = 70,
       .make = [](Maker& m, const Scope& s) -> std::optional<Node> {
         return s.has("policy") && s.text("policy") != "fifo" ? std::nullopt
                                                              : std::optional(number(m.draw.between(1, 9)));
       }},
      {.key = "cpu_thread.deadline",
       .percent = 100,
       .make = [](Maker& m, const Scope& s) -> std::optional<Node> {
         return s.text("policy") == "deadline" || m.draw.one_in(3) ? std::optional(m.word("100us 500us 2ms"))
                                                                   : std::nullopt;
       }},
      {.key = "cpu_thread.weight",
       .percent = 40,
       .make = [](Maker& m, const Scope& s) -> std::optional<Node> {
         return s.text("policy") == "fair" ? std::optional(m.word("1 512 2048")) : std::nullopt;
       }},
      {.key = "cpu_thread.core",
       .percent = 30,
       .make = [](Maker& m, const Scope& s) -> std::optional<Node> {
         const Node* const cores = s.around("cpu")->made->find("cores");
         return number(cores != nullptr && cores->text != "1" ? m.draw.below(2) : 0);
       }},
      {.key = "cpu_thread.execution",
       .make = [](Maker& m, const Scope&) -> std::optional<Node> {
         if (m.draw.one_in(2)) return m.word("2us 10us 60us");
         Node between = Node::object();
         between.add("from", m.word("0us 2us"));
         between.add("to", m.word("5us 40us"));
         Node made = Node::object();
         made.add("uniform", std::move(between));
         return made;
       }},
      {.key = "cpu_thread.non_preemptive", .percent = 30, .words = "1us 5us 50us"},
      {.key = "cpu_thread.wake_up", .percent = 30},
      {.key = "cpu_thread.runs", .percent = 100, .make = runs_of_thread},
      {.key = "cpu_thread.stack", .percent = 100, .make = stack_of_thread},
      {.key = "cpu_thread.every",
       .percent = 100,
       .make = [](Maker& m,
                  const Scope& s) -> std::
                                      optional<Node> {
                                        return s.has("runs") || s.has("stack")
                                                   ? m.draw.one_in(3) ? std::optional(m.word("500us 2ms"))
                                                                      : std::nullopt
                                                   : std::optional(m.word("200us 500us 1ms 2ms"));
                                      }},
      {.key = "cpu_thread.offset",
       .percent = 40,
       .make = [](Maker& m, const Scope& s)
           -> std::optional<Node> { return s.has("every") ? std::optional(m.word("0us 50us 199us")) : std::nullopt; }},
      {.key = "station.os", .feature = Feature::latencies, .percent = 70},
      {.key = "station.forwarding_delay", .percent = 70, .make = forwarding_delay},
      {.key = "station.cut_through_header", .feature = Feature::cut_through, .percent = 30, .words = "14B 22B 30B 72B"},
      {.key = "station.traffic_classes", .feature = Feature::identity_classes, .percent = 80, .make = classes_of_node},
      {.key = "station.queues", .feature = Feature::queue_limits, .percent = 80},
      {.key = "station.bypass", .feature = Feature::crash, .percent = 60, .words = "true"},
      {.key = "station.bypass_switching", .feature = Feature::crash, .percent = 50, .words = "200us 500us 1ms"},
      {.key = "station.cryptography", .feature = Feature::security, .percent = 60},
      {.key = "station.processing", .feature = Feature::replies, .percent = 50},
      {.key = "station.offers", .feature = Feature::roles, .percent = 85, .make = offered_skills},
      {.key = "switch.forwarding_delay", .percent = 70, .make = forwarding_delay},
      {.key = "switch.forwarding_jitter", .percent = 30, .make = jitter_of_switch},
      {.key = "station.forwarding_jitter", .percent = 30, .make = jitter_of_switch},
      {.key = "generator.forwarding_jitter", .percent = 20, .make = jitter_of_switch},
      {.key = "switch.cut_through_header", .feature = Feature::cut_through, .percent = 30, .words = "14B 22B 30B 72B"},
      {.key = "switch.traffic_classes", .feature = Feature::identity_classes, .percent = 80, .make = classes_of_node},
      {.key = "switch.queues", .feature = Feature::queue_limits, .percent = 80},
      {.key = "generator.gate_limits", .feature = Feature::gates, .percent = 30},
      {.key = "generator.host_gate_limits", .feature = Feature::gates, .percent = 10},
      {.key = "host.gate_limits", .feature = Feature::gates, .percent = 10},
      {.key = "station.gate_limits", .feature = Feature::gates, .percent = 30},
      {.key = "switch.gate_limits", .feature = Feature::gates, .percent = 30},
      {.key = "gate_limits.entries", .percent = 60, .words = "16 256 1024"},
      {.key = "gate_limits.least_interval", .percent = 40, .words = "1ns 100ns"},
      {.key = "gate_limits.granularity", .percent = 30, .words = "1ns 10ns"},
      {.key = "gate_limits.queues", .percent = 30, .words = "6 8"},
      {.key = "operating_system.profile", .percent = 40},
      {.key = "operating_system.transmit"},
      {.key = "operating_system.receive"},
      {.key = "operating_system.wake_up"},
      {.key = "latency.fixed", .percent = 60, .words = "0ns 1us 2us 20us"},
      {.key = "latency.min", .percent = 10, .words = "0ns 1us"},
      {.key = "latency.max", .percent = 20, .words = "50us 100us"},
      {.key = "latency.tail", .percent = 10},
      {.key = "latency.table",
       .make = [](Maker& m,
                  const Scope& s) -> std::optional<Node> { return m.objects("table_point", m.draw.between(1, 3), s); }},
      {.key = "table_point.value", .words = "0ns 3us 7us 40us"},
      {.key = "table_point.weight", .percent = 50, .words = "1 2 10"},
      {.key = "uniform.from", .words = "0ns 1us"},
      {.key = "uniform.to", .words = "1us 5us 20us"},
      {.key = "normal.mean", .words = "0ns 5us 20us"},
      {.key = "normal.deviation", .words = "0ns 1us 10us"},
      {.key = "exponential.mean", .words = "0ns 1us 5us"},
      {.key = "weibull.scale", .words = "0ns 1us 10us"},
      {.key = "weibull.shape", .words = "0.5 1.0 1.5"},
      {.key = "log_normal.median", .words = "1us 5us"},
      {.key = "log_normal.sigma", .words = "0.0 0.3 1.0"},
      {.key = "latency_tail.from", .words = "20us 50us"},
      {.key = "latency_tail.to", .words = "50us 100us"},
      {.key = "latency_tail.per_million", .percent = 70, .words = "1 1000 100000.5"},
      {.key = "queues.frames", .percent = 60, .words = "1 2 4 50"},
      {.key = "queues.octets", .percent = 50, .words = "700B 2000B 3100B 20000B"},
      {.key = "queues.drop", .percent = 40},
      {.key = "queue_of_class.drop", .percent = 30},
      {.key = "queues.classes",
       .percent = 40,
       .make = [](Maker& m, const Scope& s)
           -> std::optional<Node> { return m.objects("queue_of_class", m.draw.between(1, 2), s); }},
      {.key = "queue_of_class.class",
       .make = [](Maker& m, const Scope& s) -> std::optional<Node> { return number(4 * s.number + m.draw.below(4)); }},
      {.key = "queue_of_class.frames", .percent = 50, .words = "1 3 100"},
      {.key = "queue_of_class.octets", .percent = 50, .words = "64B 1600B 5000B"},
      {.key = "cryptography.seal", .percent = 80, .words = "200ns 1us 7us"},
      {.key = "cryptography.open", .percent = 80, .words = "250ns 2us 9us"},
      {.key = "processing.per_message", .percent = 60},
      {.key = "processing.per_field", .percent = 40},
  };
  return rules;
}

}  // namespace takt::generator
