// SPDX-License-Identifier: Apache-2.0
#include "schedule_instances/write.hpp"

#include <algorithm>

namespace takt::schedule_instances {

using namespace schedule;
using json::Node;

namespace {

Node link_names(const Problem& problem, const std::vector<LinkIndex>& links) {
  Node names = Node::array();
  for (const LinkIndex l : links) names.items.push_back(Node::of_string(problem.links[l].name));
  return names;
}

Node stream_names(const Problem& problem, const std::vector<StreamIndex>& streams) {
  Node names = Node::array();
  for (const StreamIndex s : streams) names.items.push_back(Node::of_string(problem.streams[s].name));
  return names;
}

template <class Number>
Node numbers(const std::vector<Number>& list) {
  Node all = Node::array();
  for (const Number each : list) all.items.push_back(Node::of_integer(static_cast<std::int64_t>(each)));
  return all;
}

/// `thresholds`: [stream, link, modulus, at]; `axioms`: literals; `steps`: [literals, from].
void add_clauses(const Problem& problem, const ClausalProof& proof, Node& all) {
  if (proof.anchor) all.add("anchor", Node::of_string(problem.streams[*proof.anchor].name));
  Node thresholds = Node::array();
  for (const Threshold& each : proof.thresholds) {
    Node threshold = Node::array();
    threshold.items.push_back(Node::of_string(problem.streams[each.stream].name));
    threshold.items.push_back(Node::of_string(problem.links[each.link].name));
    threshold.items.push_back(Node::of_integer(each.modulus));
    threshold.items.push_back(Node::of_integer(each.at));
    thresholds.items.push_back(std::move(threshold));
  }
  all.add("thresholds", std::move(thresholds));
  Node axioms = Node::array();
  for (const Clause& each : proof.axioms) axioms.items.push_back(numbers(each));
  all.add("axioms", std::move(axioms));
  Node steps = Node::array();
  for (const ClausalProof::Step& each : proof.steps) {
    Node step = Node::array();
    step.items.push_back(numbers(each.clause));
    step.items.push_back(numbers(each.from));
    steps.items.push_back(std::move(step));
  }
  all.add("steps", std::move(steps));
}

}  // namespace

Node write_problem(const Problem& problem) {
  Node all = Node::object();
  all.add("format", Node::of_string("schedule-problem-1"));
  all.add("name", Node::of_string(problem.name));
  all.add("source", Node::of_string(problem.source));
  Node& model = all.add("model", Node::object());
  model.add("preamble", Node::of_integer(problem.model.preamble));
  model.add("gap", Node::of_integer(problem.model.gap));
  model.add("strict", Node::of_bool(problem.model.is_strict));
  model.add("no_wait", Node::of_bool(problem.model.no_wait));
  model.add("margin", Node::of_integer(problem.model.margin));
  model.add("tick", Node::of_integer(problem.model.tick));
  model.add("guard_octets", Node::of_integer(problem.model.guard_octets));
  Node nodes = Node::array();
  for (const schedule::Node& each : problem.nodes) {
    Node node = Node::object();
    node.add("name", Node::of_string(each.name));
    node.add("bridge", Node::of_bool(each.is_bridge));
    nodes.items.push_back(std::move(node));
  }
  all.add("nodes", std::move(nodes));
  Node links = Node::array();
  for (const Link& each : problem.links) {
    Node link = Node::object();
    link.add("name", Node::of_string(each.name));
    link.add("from", Node::of_string(problem.nodes[each.from].name));
    link.add("to", Node::of_string(problem.nodes[each.to].name));
    link.add("rate", Node::of_integer(8 * static_cast<std::int64_t>(ps_per_second) / each.octet));
    link.add("propagation", Node::of_integer(each.propagation));
    link.add("forwarding", Node::of_integer(each.forwarding));
    if (each.cut_through) link.add("cut_through", Node::of_integer(*each.cut_through));
    link.add("entries", Node::of_integer(each.entries));
    links.items.push_back(std::move(link));
  }
  all.add("links", std::move(links));
  Node streams = Node::array();
  for (const Stream& each : problem.streams) {
    Node stream = Node::object();
    stream.add("name", Node::of_string(each.name));
    stream.add("talker", Node::of_string(problem.nodes[each.talker].name));
    Node listeners = Node::array();
    for (const NodeIndex n : each.listeners) listeners.items.push_back(Node::of_string(problem.nodes[n].name));
    stream.add("listeners", std::move(listeners));
    stream.add("octets", Node::of_integer(each.octets));
    stream.add("frames", Node::of_integer(each.frames));
    stream.add("period", Node::of_integer(each.period));
    stream.add("release", Node::of_integer(each.release));
    if (each.deadline) stream.add("deadline", Node::of_integer(*each.deadline));
    if (each.latency) stream.add("latency", Node::of_integer(*each.latency));
    if (each.jitter) stream.add("jitter", Node::of_integer(*each.jitter));
    if (each.route) stream.add("route", link_names(problem, *each.route));
    stream.add("class", Node::of_integer(each.traffic_class));
    streams.items.push_back(std::move(stream));
  }
  all.add("streams", std::move(streams));
  return all;
}

Node write_solution(const Problem& problem, const Solution& solution) {
  Node all = Node::object();
  all.add("format", Node::of_string("schedule-solution-1"));
  all.add("problem", Node::of_string(problem.name));
  all.add("timing", Node::of_string(solution.timing == GateTiming::held ? "held" : "flowing"));
  Node& streams = all.add("streams", Node::object());
  for (StreamIndex s = 0; s < problem.streams.size(); ++s) {
    if (!solution.streams[s]) continue;
    const Placement& placement = *solution.streams[s];
    Node stream = Node::object();
    stream.add("route", link_names(problem, placement.route));
    Node starts = Node::array();
    for (const auto& each : placement.starts) {
      if (each.size() == 1) {
        starts.items.push_back(Node::of_integer(each.front()));
        continue;
      }
      Node list = Node::array();
      for (const Ps start : each) list.items.push_back(Node::of_integer(start));
      starts.items.push_back(std::move(list));
    }
    stream.add("start", std::move(starts));
    if (std::any_of(placement.classes.begin(), placement.classes.end(),
                    [&](std::uint8_t c) { return c != problem.streams[s].traffic_class; })) {
      Node classes = Node::array();
      for (const std::uint8_t c : placement.classes) classes.items.push_back(Node::of_integer(c));
      stream.add("class", std::move(classes));
    }
    streams.members.push_back({problem.streams[s].name, {}, std::move(stream)});
  }
  if (solution.gates.empty()) return all;
  Node gates = Node::object();
  for (const auto& [link, list] : solution.gates) {
    Node node = Node::object();
    node.add("cycle", Node::of_integer(list.cycle));
    Node entries = Node::array();
    for (const GateEntry& each : list.entries) {
      Node classes = Node::array();
      for (int c = 0; c < 8; ++c)
        if ((each.open >> c & 1) != 0) classes.items.push_back(Node::of_integer(c));
      Node entry = Node::array();
      entry.items.push_back(Node::of_integer(each.interval));
      entry.items.push_back(std::move(classes));
      entries.items.push_back(std::move(entry));
    }
    node.add("entries", std::move(entries));
    gates.members.push_back({problem.links[link].name, {}, std::move(node)});
  }
  all.add("gates", std::move(gates));
  return all;
}

Node write_certificate(const Problem& problem, const Certificate& certificate) {
  using Kind = Certificate::Kind;
  Node all = Node::object();
  all.add("problem", Node::of_string(problem.name));
  static constexpr std::string_view names[] = {"latency", "load", "interval", "folded", "pair", "clausal"};
  all.add("kind", Node::of_string(names[static_cast<std::size_t>(certificate.kind)]));
  if (certificate.in_time) all.add("in_time", Node::of_bool(true));
  switch (certificate.kind) {
    case Kind::latency:
      all.add("stream", Node::of_string(problem.streams[certificate.streams.front()].name));
      all.add("listener", Node::of_string(problem.nodes[certificate.listener].name));
      break;
    case Kind::load:
      all.add("links", link_names(problem, certificate.links));
      all.add("streams", stream_names(problem, certificate.streams));
      break;
    case Kind::interval: {
      all.add("link", Node::of_string(problem.links[certificate.links.front()].name));
      all.add("from", Node::of_integer(certificate.from));
      all.add("until", Node::of_integer(certificate.until));
      Node jobs = Node::array();
      for (const auto& [stream, repetition] : certificate.jobs) {
        Node job = Node::array();
        job.items.push_back(Node::of_string(problem.streams[stream].name));
        job.items.push_back(Node::of_integer(static_cast<sim::int128>(repetition)));
        jobs.items.push_back(std::move(job));
      }
      all.add("jobs", std::move(jobs));
      break;
    }
    case Kind::pair:
      all.add("streams", stream_names(problem, certificate.streams));
      break;
    case Kind::clausal:
      all.add("streams", stream_names(problem, certificate.streams));
      add_clauses(problem, certificate.clauses, all);
      break;
    case Kind::folded:
      all.add("link", Node::of_string(problem.links[certificate.links.front()].name));
      all.add("modulus", Node::of_integer(certificate.modulus));
      all.add("streams", stream_names(problem, certificate.streams));
      break;
  }
  return all;
}

}  // namespace takt::schedule_instances
