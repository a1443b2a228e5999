// SPDX-License-Identifier: Apache-2.0
// tsnkit: tasks and a topology as CSV, nodes and tasks by number. It counts nothing beside a frame, so sizes are those
// on the wire.
#include <fmt/format.h>

#include <map>

#include "interchange/planning/planning.hpp"
#include "json/fields.hpp"

namespace takt::interchange {
namespace {

using schedule::Ps;
constexpr Ps ps_per_ns = 1'000;

class TsnkitWriter {
 public:
  TsnkitWriter(PlanningProblem& made, Exported& exported) : made_(made), problem_(made.problem), exported_(exported) {}

  void write(const std::string& name) {
    const std::string topology = topology_text(), tasks = tasks_text();
    for (std::size_t n = 0; n < problem_.nodes.size(); ++n) {
      NodeExtras node;
      node.node = std::to_string(n);
      node.name = problem_.nodes[n].name;
      made_.extras.nodes.push_back(std::move(node));
    }
    for (std::size_t s = 0; s < made_.extras.streams.size(); ++s) {
      StreamExtras& stream = made_.extras.streams[s];
      stream.name = stream.stream;
      stream.stream = std::to_string(s);
    }
    for (CableExtras& cable : made_.extras.cables) cable.link = link_names_.at(cable.link);
    exported_.files.push_back({name + "_task.csv", tasks});
    exported_.files.push_back({name + "_topo.csv", topology});
    exported_.files.push_back({name + ".names.json", json::encode(made_.extras)});
  }

 private:
  /// Losses stand in the table of names: CSV has no comments.
  std::string topology_text() {
    std::string text = "link,q_num,rate,t_proc,t_prop\n";
    std::vector<std::size_t> ends(problem_.nodes.size());
    std::map<std::string, int> seen;
    for (const schedule::Link& link : problem_.links) {
      ++ends[link.from];
      ++ends[link.to];
      const std::string name = fmt::format("({}, {})", link.from, link.to), where = "link " + link.name;
      if (++seen[name] > 1) exported_.lose(where, "a second link between two nodes");
      link_names_[link.name] = name;
      if (link.cut_through) exported_.lose(where, "cut-through");
      constexpr Ps octet_at_1_bit_per_ns = 8'000;
      text += fmt::format("\"{}\",8,{},{},{}\n", name, ratio(octet_at_1_bit_per_ns, link.octet, where),
                          whole_ns(link.forwarding, where, "a processing time"),
                          whole_ns(link.propagation, where, "a propagation delay"));
    }
    for (std::size_t n = 0; n < problem_.nodes.size(); ++n)
      if (problem_.nodes[n].is_bridge != (ends[n] > 2))
        exported_.lose("node " + problem_.nodes[n].name,
                       problem_.nodes[n].is_bridge ? "that it forwards: a node with one link is an end station"
                                                   : "that it forwards nothing: a node with several links is a bridge");
    return text;
  }

  std::string tasks_text() {
    std::string text = "stream,src,dst,size,period,deadline,jitter\n";
    for (std::size_t s = 0; s < problem_.streams.size(); ++s) {
      const schedule::Stream& stream = problem_.streams[s];
      const std::string where = "stream " + stream.name;
      if (stream.frames != 1) exported_.lose(where, "several frames a period");
      if (stream.release != 0) exported_.lose(where, "its offset: tasks begin when the planner says");
      if (stream.route) exported_.lose(where, "its path: the planner chooses it");
      std::string listeners;
      for (const schedule::NodeIndex each : stream.listeners)
        listeners += (listeners.empty() ? "" : ", ") + std::to_string(each);
      const Ps deadline = whole_ns(stream.latency.value_or(stream.period), where, "a latency");
      const Ps jitter = stream.jitter ? whole_ns(*stream.jitter, where, "a jitter") : deadline;
      text += fmt::format("{},{},\"[{}]\",{},{},{},{}\n", s, stream.talker, listeners,
                          stream.octets + problem_.model.preamble + problem_.model.gap,
                          whole_ns(stream.period, where, "a period"), deadline, jitter);
    }
    return text;
  }

  Ps whole_ns(Ps time, const std::string& where, const char* what) {
    if (time % ps_per_ns != 0) exported_.lose(where, std::string(what) + " that is no whole number of ns");
    return time / ps_per_ns;
  }
  /// A rate in bit/ns, with three places at most.
  std::string ratio(Ps a, Ps b, const std::string& where) {
    if (a * 1'000 % b != 0) exported_.lose(where, "a rate of no whole number of Mbit/s");
    const Ps thousandths = a * 1'000 / b;
    return thousandths % 1'000 == 0 ? std::to_string(thousandths / 1'000)
                                    : fmt::format("{}.{:03}", thousandths / 1'000, thousandths % 1'000);
  }

  PlanningProblem& made_;
  const schedule::Problem& problem_;
  Exported& exported_;
  std::map<std::string, std::string> link_names_;
};

}  // namespace

Exported export_tsnkit(const ExportRequest& request) {
  Exported exported;
  PlanningProblem made = problem_of(request.resolved, exported);
  TsnkitWriter(made, exported).write(request.resolved.scenario.name);
  return exported;
}

}  // namespace takt::interchange
