// SPDX-License-Identifier: Apache-2.0
#include "synthesis/instance_of_scenario.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "json/node.hpp"
#include "scenario/gates/crossings.hpp"
#include "scenario/gates/timing.hpp"
#include "scenario/gates/resolve_gates.hpp"
#include "schedule/way.hpp"

namespace takt::synthesis {

using schedule::LinkIndex;
using schedule::Problem;
using schedule::Ps;

InstanceNetwork network_of(const scenario::Resolved& resolved) {
  InstanceNetwork network;
  Problem& problem = network.problem;
  problem.source = "takt";
  for (const scenario::TopologyNode& node : resolved.topology.nodes)
    problem.nodes.push_back({node.name, node.forwards()});
  for (const models::LinkPlan& plan : resolved.plan.links)
    for (const auto& [from, to] : {std::pair(plan.a, plan.b), std::pair(plan.b, plan.a)}) {
      schedule::Link link;
      link.from = from.node.value;
      link.to = to.node.value;
      link.name = problem.nodes[link.from].name + ">" + problem.nodes[link.to].name;
      if (from.port != 0 && std::any_of(problem.links.begin(), problem.links.end(),
                                        [&](const schedule::Link& other) { return other.name == link.name; }))
        link.name += "#" + std::to_string(from.port);
      link.octet = plan.rate.octet_time().ps();
      link.propagation = plan.delay.ps();
      link.forwarding = resolved.plan.nodes[link.to].greatest_forwarding_delay().ps();
      network.link_at[{link.from, from.port}] = static_cast<LinkIndex>(problem.links.size());
      problem.links.push_back(std::move(link));
    }
  return network;
}

namespace {

/// Takes the scheduled streams one after the other.
class InstanceMaker {
 public:
  InstanceMaker(scenario::Resolved& resolved, const scenario::Scenario& wanted, const OpenRoutes& open,
                const scenario::StreamsToGate& gated, InstanceFor purpose)
      : resolved_(resolved),
        wanted_(wanted),
        open_(open),
        gated_(gated),
        purpose_(purpose),
        crossings_(gated.problem, scenario::Waiting::at_gates) {
    auto [network, link_at] = network_of(resolved);
    made_.problem = std::move(network);
    made_.cuts_through = std::ranges::any_of(resolved.plan.port_configs,
                                             [](const models::PortConfig& config) { return config.cut_through != 0; });
    link_at_ = std::move(link_at);
    Problem& problem = made_.problem;
    problem.name = wanted.name;
    problem.model.is_strict = true;
    problem.model.no_wait = true;
    problem.model.margin = gated.problem.margin.ps();
    for (std::size_t i = 0; i < wanted.streams.size(); ++i) entry_of_[wanted.streams[i].name] = i;
    for (std::uint32_t s = 0; s < gated.problem.streams.size(); ++s)
      of_train_[gated.problem.streams[s].train].push_back(s);
  }

  std::optional<ScenarioInstance> run(std::string& why_not) {
    for (std::uint32_t s = 0; s < gated_.problem.streams.size(); ++s) {
      why_not = reason_to_stay(s);
      const bool may_stay = why_not.empty() || (purpose_ == InstanceFor::search && !is_open(s));
      if (!may_stay || (why_not.empty() && is_first_of_its_stream(s) && !add(s, why_not))) return std::nullopt;
      if (!why_not.empty()) staying_.insert(gated_.problem.streams[s].train);
    }
    for (const std::uint32_t train : staying_) add_blocks(of_train_.at(train));
    why_not.clear();
    return std::move(made_);
  }

 private:
  bool is_redundant(std::uint32_t s) const {
    return std::ranges::find(resolved_.redundancies, gated_.streams[s], &scenario::ResolvedRedundancy::stream) !=
           resolved_.redundancies.end();
  }
  bool is_open(std::uint32_t s) const { return open_.contains(gated_.problem.streams[s].name); }

  /// Frames of one stream that are handed over at one instant are a train of the instance.
  bool is_train(std::uint32_t s) const {
    const std::vector<std::uint32_t>& members = of_train_.at(gated_.problem.streams[s].train);
    return std::ranges::all_of(members,
                               [&](std::uint32_t member) { return gated_.streams[member] == gated_.streams[s]; });
  }
  bool is_first_of_its_stream(std::uint32_t s) const {
    return of_train_.at(gated_.problem.streams[s].train).front() == s;
  }

  /// Why the instance has no stream for it; empty: it has one.
  std::string reason_to_stay(std::uint32_t s) const {
    const scenario::ScheduledStream& gate = gated_.problem.streams[s];
    if (is_redundant(s)) return gate.name + " is redundant, and its copies go several ways";
    const bool is_alone = of_train_.at(gate.train).size() == 1;
    if (purpose_ == InstanceFor::change)
      return is_alone ? "" : gate.name + " is one of several that leave at one instant";
    if (!is_train(s)) return gate.name + " is one of several that leave at one instant";
    const scenario::ResolvedStream& from = resolved_.streams[gated_.streams[s].value];
    const bool has_several =
        std::ranges::count(gated_.streams, from.index) > static_cast<std::ptrdiff_t>(of_train_.at(gate.train).size());
    return has_several ? gate.name + " has frames at several times of its period" : std::string();
  }

  bool add(std::uint32_t s, std::string& why_not) {
    const scenario::ScheduledStream& gate = gated_.problem.streams[s];
    const scenario::ResolvedStream& from = resolved_.streams[gated_.streams[s].value];
    const auto entry = entry_of_.find(gate.name);
    const scenario::Stream* const written = entry == entry_of_.end() ? nullptr : &wanted_.streams[entry->second];
    Problem& problem = made_.problem;
    schedule::Stream stream;
    stream.name = gate.name;
    stream.frames = static_cast<std::uint32_t>(of_train_.at(gate.train).size());
    stream.talker = from.paths.front().front();
    for (const auto& path : from.paths) stream.listeners.push_back(path.back());
    std::sort(stream.listeners.begin(), stream.listeners.end());
    stream.listeners.erase(std::unique(stream.listeners.begin(), stream.listeners.end()), stream.listeners.end());
    std::vector<LinkIndex> route;
    for (const scenario::ScheduledHop& hop : gate.hops) route.push_back(link_of(hop));
    // Frames may lose a tag on their way: the longest counts, which only takes more than there is.
    Ps octets = 0;
    for (std::size_t h = 0; h < gate.hops.size(); ++h)
      octets = std::max(octets, gate.hops[h].transmission.ps() / problem.links[route[h]].octet);
    stream.octets = static_cast<std::uint32_t>(octets) - problem.model.preamble;
    stream.period = gate.period.ps();
    stream.traffic_class = gate.hops.front().traffic_class;
    for (const scenario::Requirement& requirement : wanted_.require)
      if (requirement.stream == gate.name && requirement.latency)
        stream.latency =
            std::min(stream.latency.value_or(schedule::longest_time), requirement.latency->greatest().ps());
    const bool is_free = written != nullptr && written->offset && written->offset->is_auto;
    if (is_open(s) && !is_free) {
      why_not = json::quote(gate.name) +
                " says \"route\": \"auto\", and ways are searched for streams with \"offset\": \"auto\"";
      return false;
    }
    if (!is_free || (written->path && !is_open(s)) || stream.listeners.size() != 1) stream.route = route;
    if (!is_free && !pin(stream, route, gate.release.ps())) {
      why_not = gate.name + " cannot take its path as an instance has it";
      return false;
    }
    const Ps chosen =
        is_free ? resolved_.scenario.streams[entry->second].offset.value_or(scenario::Duration()).value.ps() : 0;
    made_.lags.push_back(gate.release.ps() - chosen);
    made_.is_given.push_back(is_free || !is_chosen(s, written));
    made_.streams.push_back(written == nullptr ? std::nullopt : std::optional(entry->second));
    problem.streams.push_back(std::move(stream));
    return true;
  }

  /// Of a Program with "offset": "auto" the place is one of many.
  bool is_chosen(std::uint32_t s, const scenario::Stream* written) const {
    if (written != nullptr) return false;
    const scenario::ResolvedStream& from = resolved_.streams[gated_.streams[s].value];
    return from.of_program && std::ranges::any_of(wanted_.programs, [](const scenario::Program& program) {
             return program.offset && program.offset->is_auto;
           });
  }

  /// One start only: deadline and release leave no other.
  bool pin(schedule::Stream& stream, const std::vector<LinkIndex>& route, Ps release) const {
    const schedule::Timing timing(made_.problem, schedule::GateTiming::flowing);
    schedule::Stream unlimited = stream;
    unlimited.latency.reset();
    const auto way = schedule::make_way(timing, unlimited, route);
    if (!way) return false;
    stream.release = release;
    stream.deadline = release + way->arrival;
    return true;
  }

  /// What a train that stays where it is takes of each link; what of it follows at once is one piece.
  void add_blocks(const std::vector<std::uint32_t>& train) {
    struct Piece {
      Ps from, until;
      std::uint32_t stream;
      models::TrafficClass traffic_class;
    };
    std::map<LinkIndex, std::vector<Piece>> pieces;
    for (const std::uint32_t s : train)
      for (std::uint32_t h = 0; h < gated_.problem.streams[s].hops.size(); ++h) {
        const scenario::ScheduledHop& hop = gated_.problem.streams[s].hops[h];
        const Ps start = crossings_.window({s, h}).start.ps();
        pieces[link_of(hop)].push_back({start, start + hop.transmission.ps(), s, hop.traffic_class});
      }
    for (auto& [l, all] : pieces) {
      std::ranges::stable_sort(all, {}, &Piece::from);
      const schedule::Link& link = made_.problem.links[l];
      const Ps apart = made_.problem.model.gap * link.octet + 2 * made_.problem.model.margin;
      for (std::size_t i = 0; i < all.size();) {
        Piece piece = all[i];
        for (++i; i < all.size() && all[i].from < piece.until + apart; ++i)
          piece.until = std::max(piece.until, all[i].until);
        add_block(l, piece.from, piece.until, gated_.problem.streams[piece.stream], piece.traffic_class);
      }
    }
  }

  void add_block(LinkIndex l, Ps from, Ps until, const scenario::ScheduledStream& gate,
                 models::TrafficClass traffic_class) {
    Problem& problem = made_.problem;
    const schedule::Link& link = problem.links[l];
    schedule::Stream stream;
    stream.name = gate.name + " on " + link.name;
    stream.talker = link.from;
    stream.listeners = {link.to};
    stream.octets = static_cast<std::uint32_t>(
        std::max<Ps>((until - from + link.octet - 1) / link.octet - problem.model.preamble, 1));
    stream.period = gate.period.ps();
    stream.traffic_class = traffic_class;
    stream.route = std::vector<LinkIndex>{l};
    if (!pin(stream, *stream.route, scenario::modulo(from, stream.period)))
      return;  // it fills its period: the resolver finds out
    made_.lags.push_back(0);
    made_.is_given.push_back(false);
    made_.streams.push_back(std::nullopt);
    problem.streams.push_back(std::move(stream));
  }

  LinkIndex link_of(const scenario::ScheduledHop& hop) const {
    const scenario::GatedPort& port = gated_.problem.ports[hop.port];
    return link_at_.at({port.node.value, port.port});
  }

  scenario::Resolved& resolved_;
  const scenario::Scenario& wanted_;
  const OpenRoutes& open_;
  const scenario::StreamsToGate& gated_;
  InstanceFor purpose_;
  scenario::Crossings crossings_;
  ScenarioInstance made_;
  std::map<std::pair<std::uint32_t, std::uint16_t>, LinkIndex> link_at_;
  std::map<std::string, std::size_t, std::less<>> entry_of_;
  std::map<std::uint32_t, std::vector<std::uint32_t>> of_train_;  // streams of the problem of gates
  std::set<std::uint32_t> staying_;                               // trains
};

}  // namespace

std::optional<ScenarioInstance> instance_of(scenario::Resolved& resolved, const scenario::Scenario& wanted,
                                            const OpenRoutes& open, json::Diagnostics& diagnostics,
                                            std::string& why_not, InstanceFor purpose) {
  // The problem of gates is what these streams need; with the gates that are asked for, but not yet laid.
  resolved.scenario.gates = wanted.gates;
  const auto gated = scenario::gate_problem_of(resolved, scenario::timings_of(resolved), diagnostics);
  resolved.scenario.gates.reset();
  if (!gated) return std::nullopt;
  return InstanceMaker(resolved, wanted, open, *gated, purpose).run(why_not);
}

ScenarioInstance given_streams(const ScenarioInstance& whole) {
  ScenarioInstance given = whole;
  given.problem.streams.clear();
  given.streams.clear();
  given.lags.clear();
  given.is_given.clear();
  for (std::size_t s = 0; s < whole.problem.streams.size(); ++s) {
    if (!whole.is_given[s]) continue;
    given.problem.streams.push_back(whole.problem.streams[s]);
    given.streams.push_back(whole.streams[s]);
    given.lags.push_back(whole.lags[s]);
    given.is_given.push_back(true);
  }
  return given;
}

}  // namespace takt::synthesis
