#include "emulate/plan.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <numeric>
#include <set>
#include <utility>

#include "scenario/json/fields.hpp"
#include "vocabulary/protocol.hpp"

namespace takt::emulate {
namespace {

namespace json = scenario::json;

constexpr std::size_t most_nodes = 250;  // of the topology: each is a namespace

/// Members of a scenario's Program that a node's file has too, and those that are said otherwise there or not at all.
constexpr std::array<std::string_view, 11> shared = {"name",    "variant",      "master",          "slaves",         "cycle",       "offset",
                                                     "publish", "subscription", "receive_timeout", "initialisation", "process_data"};
constexpr std::array<std::string_view, 4> translated = {"pcp", "vlan", "violations", "phases"};

template <class Range>
bool holds(const Range& range, std::string_view text) {
  return std::find(range.begin(), range.end(), text) != range.end();
}

class Planner {
 public:
  explicit Planner(const scenario::Resolved& resolved) : resolved_(resolved) {}

  Plan run() {
    lay_network();
    for (std::uint32_t p = 0; p < resolved_.programs.size(); ++p) add_program(p);
    for (const scenario::ResolvedAction& action : resolved_.script)
      std::visit([&](const auto& what) { add(action.at.since_start(), what); }, action.what);
    note_what_is_left_out();
    if (plan_.nodes.empty()) plan_.refusals.push_back("there is no Program in it, so there are no nodes to run");
    return std::move(plan_);
  }

 private:
  /// Bridges without a spanning tree protocol must not stand in a ring, so links that would close one stay away.
  void lay_network() {
    const scenario::Topology& topology = resolved_.topology;
    if (topology.nodes.size() > most_nodes)
      plan_.refusals.push_back("it has " + std::to_string(topology.nodes.size()) + " nodes; at most " + std::to_string(most_nodes) + " are laid on one machine");
    std::vector<std::uint32_t> root(topology.nodes.size());
    std::iota(root.begin(), root.end(), 0U);
    const std::function<std::uint32_t(std::uint32_t)> root_of = [&](std::uint32_t node) { return root[node] == node ? node : root[node] = root_of(root[node]); };
    for (const scenario::TopologyNode& node : topology.nodes) plan_.is_bridge.push_back(!node.is_host());
    std::vector<std::uint32_t> interfaces(topology.nodes.size());
    for (std::uint32_t l = 0; l < topology.links.size(); ++l) {
      const std::uint32_t a = topology.links[l].a.node.value;
      const std::uint32_t b = topology.links[l].b.node.value;
      if (root_of(a) == root_of(b)) {
        plan_.notes.push_back("the link " + topology.nodes[a].name + " - " + topology.nodes[b].name + " is left out: it would close a ring of bridges");
        continue;
      }
      root[root_of(a)] = root_of(b);
      const auto end = [&](std::uint32_t node) { return Cable::End{node, (plan_.is_bridge[node] ? "p" : "eth") + std::to_string(interfaces[node]++)}; };
      Cable cable;
      cable.a = end(a);
      cable.b = end(b);
      cable.link = l;
      plan_.cables.push_back(std::move(cable));
    }
  }

  void add_program(std::uint32_t number) {
    const scenario::ResolvedProgram& program = resolved_.programs[number];
    if (!program.description->roles.empty()) {
      plan_.refusals.push_back("program " + program.name + " has \"roles\", which real nodes do not know");
      return;
    }
    const json::Node written = json::encode_value(*program.description);
    const json::Node usual = json::encode_value(scenario::Program{});
    json::Node file = json::Node::object();
    for (const json::Member& member : written.members) {
      const json::Node* const without = usual.find(member.key);
      if (holds(shared, member.key))
        file.add(member.key, member.value);
      else if (!holds(translated, member.key) && (without == nullptr || !json::equal(*without, member.value)))
        plan_.refusals.push_back("program " + program.name + " has \"" + member.key + "\", which real nodes do not know");
    }
    file.add("publisher_id", json::Node::of_integer(program.first_publisher_id));
    for (std::size_t p = 0; p < program.participants.size(); ++p) add_node(number, p, file);
  }

  void add_node(std::uint32_t number, std::size_t participant, const json::Node& program_file) {
    const scenario::Program& description = *resolved_.programs[number].description;
    json::Node file = json::Node::object();
    file.add("node", json::Node::of_string(participant == 0 ? description.master : description.slaves[participant - 1]));
    json::Node program = program_file;
    std::erase_if(program.members, [](const json::Member& member) { return member.key == "offset"; });
    program.add("offset", json::encode_value(resolved_.programs[number].phases[participant]));
    file.add("program", std::move(program));
    json::Node& transport = file.add("transport", json::Node::object());
    transport.add("kind", json::Node::of_string("ethernet"));
    transport.add("interface", json::Node::of_string("eth0"));
    transport.add("vlan", json::Node::of_integer(description.vlan));
    transport.add("pcp", json::Node::of_integer(description.pcp));
    file.add("control", json::Node::of_string(control_mark));
    file.add("realtime", json::Node::of_bool(true));
    PlannedNode node;
    node.program = number;
    node.participant = static_cast<std::uint8_t>(participant);
    node.host = resolved_.programs[number].participants[participant].value;
    node.name = "p" + std::to_string(number) + "-" + std::to_string(participant);
    node.config = json::pretty(file);
    plan_.nodes.push_back(std::move(node));
  }

  void add(sim::Duration at, const scenario::ResolvedCall& call) {
    const auto found = std::find_if(plan_.nodes.begin(), plan_.nodes.end(),
                                    [&](const PlannedNode& node) { return node.program == call.program && node.participant == call.participant; });
    plan_.actions.push_back({at, CallAction{static_cast<std::uint32_t>(found - plan_.nodes.begin()), method_of(call.method)}});
  }
  void add(sim::Duration at, const scenario::ResolvedLink& change) {
    const auto found = std::find_if(plan_.cables.begin(), plan_.cables.end(), [&](const Cable& cable) { return cable.link == change.link; });
    if (found == plan_.cables.end()) return;
    plan_.actions.push_back({at, LinkAction{static_cast<std::uint32_t>(found - plan_.cables.begin()), change.up}});
  }
  void add(sim::Duration at, const scenario::ResolvedNode& change) {
    if (plan_.is_bridge[change.node.value]) {
      for (std::uint32_t c = 0; c < plan_.cables.size(); ++c)
        if (plan_.cables[c].a.node == change.node.value || plan_.cables[c].b.node == change.node.value) plan_.actions.push_back({at, LinkAction{c, change.up}});
    } else {
      plan_.actions.push_back({at, HostAction{change.node.value, change.up}});
    }
  }
  void add(sim::Duration, const scenario::ResolvedGates&) { left_out_.insert("gate lists"); }
  void add(sim::Duration, const scenario::ResolvedStuckGate&) { left_out_.insert("stuck gates"); }
  void add(sim::Duration, const scenario::ResolvedClockFault&) { left_out_.insert("faults of clocks"); }
  void add(sim::Duration, const scenario::ResolvedPlug&) {}  // the Program's roles are refused already
  void add(sim::Duration, const scenario::ResolvedRoutes&) { left_out_.insert("rerouting"); }

  void note_what_is_left_out() {
    const scenario::Scenario& scenario = resolved_.scenario;
    for (const scenario::TopologyNode& node : resolved_.topology.nodes) {
      const auto& egress = std::visit([](const auto& description) -> const auto& { return description.egress; }, node.description);
      if (!egress.empty()) left_out_.insert("gates, shapers and preemption");
      if (const auto* const bridge = std::get_if<scenario::SwitchNode>(&node.description); bridge != nullptr && bridge->ingress) left_out_.insert("policing at the ingress");
    }
    if (!scenario.streams.empty()) left_out_.insert("streams");
    if (scenario.clocks.gptp) left_out_.insert("gPTP (all nodes share CLOCK_MONOTONIC)");
    for (const scenario::Fault& fault : scenario.faults) {
      if (std::holds_alternative<scenario::FrameErrors>(fault)) left_out_.insert("frame errors");
      if (std::holds_alternative<scenario::Babble>(fault)) left_out_.insert("babbling talkers");
    }
    std::string all;
    for (const std::string& each : left_out_) all += (all.empty() ? "" : ", ") + each;
    if (!all.empty()) plan_.notes.push_back("not emulated: " + all);
    plan_.notes.push_back("rates, lengths and delays of links are those of the kernel");
  }

  const scenario::Resolved& resolved_;
  Plan plan_;
  std::set<std::string> left_out_;
};

}  // namespace

Plan plan_of(const scenario::Resolved& resolved) { return Planner(resolved).run(); }

}  // namespace takt::emulate
