// SPDX-License-Identifier: Apache-2.0
#include "emulate/plan.hpp"

#include <algorithm>
#include <functional>
#include <numeric>
#include <set>
#include <utility>

#include "json/fields.hpp"
#include "plant/protocol.hpp"

namespace takt::emulate {
namespace {

constexpr std::size_t most_nodes = 250;  // of the topology: each is a namespace

class Planner {
 public:
  explicit Planner(const scenario::Resolved& resolved) : resolved_(resolved) {}

  Plan run() {
    lay_network();
    for (std::uint32_t p = 0; p < resolved_.programs.size(); ++p) add_program(p);
    for (PlannedNode& node : plan_.nodes) write_file(node);
    for (const scenario::ResolvedAction& action : resolved_.script)
      std::visit([&](const auto& what) { add(action.at.since_start(), what); }, action.what);
    plan_.applications = application_files_of(resolved_, plan_.is_bridge, left_out_, plan_.refusals);
    note_what_is_left_out();
    if (plan_.nodes.empty() && plan_.applications.empty() && plan_.refusals.empty())
      plan_.refusals.push_back("there is neither a Program nor an application in it, so there are no nodes to run");
    return std::move(plan_);
  }

 private:
  /// Bridges without a spanning tree protocol must not stand in a ring, so links that would close one stay away.
  void lay_network() {
    const scenario::Topology& topology = resolved_.topology;
    if (topology.nodes.size() > most_nodes)
      plan_.refusals.push_back("it has " + std::to_string(topology.nodes.size()) + " nodes; at most " +
                               std::to_string(most_nodes) + " are laid on one machine");
    std::vector<std::uint32_t> root(topology.nodes.size());
    std::iota(root.begin(), root.end(), 0U);
    const std::function<std::uint32_t(std::uint32_t)> root_of = [&](std::uint32_t node) {
      return root[node] == node ? node : root[node] = root_of(root[node]);
    };
    for (const scenario::TopologyNode& node : topology.nodes) plan_.is_bridge.push_back(node.forwards());
    std::vector<std::uint32_t> interfaces(topology.nodes.size());
    for (std::uint32_t l = 0; l < topology.links.size(); ++l) {
      const std::uint32_t a = topology.links[l].a.node.value;
      const std::uint32_t b = topology.links[l].b.node.value;
      if (root_of(a) == root_of(b)) {
        plan_.notes.push_back("the link " + topology.nodes[a].name + " - " + topology.nodes[b].name +
                              " is left out: it would close a ring of bridges");
        continue;
      }
      root[root_of(a)] = root_of(b);
      const auto end = [&](std::uint32_t node) {
        return Cable::End{node, (plan_.is_bridge[node] ? "p" : "eth") + std::to_string(interfaces[node]++)};
      };
      Cable cable;
      cable.a = end(a);
      cable.b = end(b);
      cable.link = l;
      plan_.cables.push_back(std::move(cable));
    }
    for (std::uint32_t n = 0; n < topology.nodes.size(); ++n)
      if (!plan_.is_bridge[n] && interfaces[n] > 1)
        plan_.refusals.push_back("host " + topology.nodes[n].name +
                                 " has several interfaces, but a real node has one transport");
  }

  void add_program(std::uint32_t number) {
    const scenario::ResolvedProgram& program = resolved_.programs[number];
    if (!program.replies.empty())
      plan_.refusals.push_back("program " + program.name + " has \"replies\", which real nodes do not know");
    plant::Program same = *program.description;  // the same at all nodes: what is left to the scenario's order is said
    same.publisher_id = program.first_publisher_id;
    same.within.reset();
    same.candidates.clear();
    same.redundancy.reset();
    same.paths.clear();
    same.security.reset();
    if (program.description->redundancy) left_out_.insert("copies of messages");
    if (program.description->security) left_out_.insert("security of messages");
    if (!program.description->paths.empty()) left_out_.insert("paths");
    for (const scenario::ResolvedMember& each : program.candidates()) same.candidates.push_back(name_of(each));
    same.absent.clear();  // as each node says of itself: it may have been told to join before it starts again
    programs_.push_back(std::move(same));
    for (std::size_t p = 0; p < program.participants().size(); ++p) add_part(number, static_cast<std::uint8_t>(p));
    for (std::size_t c = 0; c < program.candidates().size(); ++c) add_candidate(number, static_cast<std::uint8_t>(c));
  }

  const std::string& name_of(const scenario::ResolvedMember& candidate) const {
    return resolved_.topology.nodes[candidate.node.value].name;
  }

  void add_candidate(std::uint32_t number, std::uint8_t candidate) {
    const scenario::ResolvedMember& resolved = resolved_.programs[number].candidates()[candidate];
    PlannedNode node;
    node.parts = {{number, 0, candidate}};
    node.host = resolved.node.value;
    node.name = "p" + std::to_string(number) + "-c" + std::to_string(candidate);
    node.is_absent = resolved.is_absent;
    plan_.nodes.push_back(std::move(node));
  }

  /// The master of a nested Program is where it is a slave of the outer one.
  void add_part(std::uint32_t number, std::uint8_t participant) {
    const scenario::ResolvedProgram& program = resolved_.programs[number];
    const bool is_inner = participant == 0 && program.outer;
    const PlannedNode::Part home = is_inner ? PlannedNode::Part{program.outer->program, program.outer->participant}
                                            : PlannedNode::Part{number, participant};
    const std::string name = "p" + std::to_string(home.program) + "-" + std::to_string(home.participant);
    auto node = std::find_if(plan_.nodes.begin(), plan_.nodes.end(),
                             [&](const PlannedNode& each) { return each.name == name; });
    if (node == plan_.nodes.end()) {
      node = plan_.nodes.insert(node, PlannedNode());
      node->name = name;
      node->host = program.members[participant].node.value;
    }
    node->parts.insert(is_inner ? node->parts.end() : node->parts.begin(), {number, participant});
  }

  void write_file(PlannedNode& node) {
    const scenario::ResolvedProgram& first = resolved_.programs[node.parts.front().program];
    const auto candidate = node.parts.front().candidate;
    const std::string& name =
        candidate ? name_of(first.candidates()[*candidate]) : first.participant_names[node.parts.front().participant];
    json::Node file = json::Node::object();
    file.add("node", json::Node::of_string(name));
    if (candidate) {
      json::Node& offers = file.add("offers", json::Node::array());
      for (const std::string& skill : first.candidates()[*candidate].skills)
        offers.items.push_back(json::Node::of_string(skill));
      file.add("absent", json::Node::of_string(
                             std::string_view(absent_mark).substr(1, std::string_view(absent_mark).size() - 2)));
    }
    json::Node programs = json::Node::array();
    for (const PlannedNode::Part& part : node.parts) {
      const scenario::ResolvedProgram& resolved = resolved_.programs[part.program];
      plant::Program program = programs_[part.program];
      if (&part != &node.parts.front()) program.within = first.name;
      programs.items.push_back(json::encode_value(program));
      if (resolved.description->vlan != first.description->vlan || resolved.description->pcp != first.description->pcp)
        plan_.refusals.push_back("programs " + first.name + " and " + resolved.name +
                                 " have other VLANs or priorities, but " + name + " has one transport for both");
    }
    file.add("programs", std::move(programs));
    json::Node& transport = file.add("transport", json::Node::object());
    transport.add("kind", json::Node::of_string("ethernet"));
    transport.add("interface", json::Node::of_string(plan_.is_bridge[node.host] ? "br0" : "eth0"));
    transport.add("vlan", json::Node::of_integer(first.description->vlan));
    transport.add("pcp", json::Node::of_integer(first.description->pcp));
    file.add("control", json::Node::of_string(control_mark));
    file.add("realtime", json::Node::of_bool(true));
    node.config = json::pretty(file);
  }

  void add(sim::Duration at, const scenario::ResolvedCall& call) {
    const bool is_of_role = resolved_.programs[call.program].has_roles() && call.participant != 0;
    for (std::uint32_t n = 0; n < plan_.nodes.size(); ++n)
      for (std::uint32_t part = 0; part < plan_.nodes[n].parts.size(); ++part) {
        const PlannedNode::Part& each = plan_.nodes[n].parts[part];
        if (each.program != call.program || each.candidate || each.participant != (is_of_role ? 0 : call.participant))
          continue;
        plan_.actions.push_back(
            {at,
             CallAction{n, part, call.method,
                        is_of_role ? std::optional(static_cast<std::uint8_t>(call.participant - 1)) : std::nullopt}});
      }
  }
  void add(sim::Duration at, const scenario::ResolvedMembership& change) {
    const auto found = std::find_if(plan_.nodes.begin(), plan_.nodes.end(), [&](const PlannedNode& node) {
      return node.parts.front().program == change.program && node.parts.front().candidate == change.candidate;
    });
    plan_.actions.push_back(
        {at, MembershipAction{static_cast<std::uint32_t>(found - plan_.nodes.begin()), change.joins}});
  }
  void add(sim::Duration at, const scenario::ResolvedLink& change) {
    const auto found = std::find_if(plan_.cables.begin(), plan_.cables.end(),
                                    [&](const Cable& cable) { return cable.link == change.link; });
    if (found == plan_.cables.end()) return;
    plan_.actions.push_back({at, LinkAction{static_cast<std::uint32_t>(found - plan_.cables.begin()), change.up}});
  }
  void add(sim::Duration at, const scenario::ResolvedNode& change) {
    if (plan_.is_bridge[change.node.value]) {
      for (std::uint32_t c = 0; c < plan_.cables.size(); ++c)
        if (plan_.cables[c].a.node == change.node.value || plan_.cables[c].b.node == change.node.value)
          plan_.actions.push_back({at, LinkAction{c, change.up}});
    }
    if (resolved_.topology.nodes[change.node.value].is_end_station()) {
      plan_.actions.push_back({at, HostAction{change.node.value, change.up}});
    }
  }
  void add(sim::Duration, const scenario::ResolvedBypass&) { left_out_.insert("bypass relays"); }
  void add(sim::Duration, const scenario::ResolvedGates&) { left_out_.insert("gate lists"); }
  void add(sim::Duration, const scenario::ResolvedStuckGate&) { left_out_.insert("stuck gates"); }
  void add(sim::Duration, const scenario::ResolvedClockFault&) { left_out_.insert("faults of clocks"); }
  void add(sim::Duration, const scenario::ResolvedRoutes&) { left_out_.insert("rerouting"); }

  void note_what_is_left_out() {
    const scenario::Scenario& scenario = resolved_.scenario;
    for (const scenario::TopologyNode& node : resolved_.topology.nodes) {
      if (!scenario::ports_of(node.description).egress.empty()) left_out_.insert("gates, shapers and preemption");
      if (const scenario::EndStation* const host = scenario::end_station_of(node.description);
          host != nullptr && host->cpu)
        left_out_.insert("processors of hosts (nodes share that of this machine)");
      if (const scenario::Relay* const bridge = scenario::relay_of(node.description);
          bridge != nullptr && bridge->ingress)
        left_out_.insert("policing at the ingress");
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
  std::vector<plant::Program> programs_;  // as all their nodes have them
  std::set<std::string> left_out_;
};

}  // namespace

Plan plan_of(const scenario::Resolved& resolved) { return Planner(resolved).run(); }

}  // namespace takt::emulate
