// SPDX-License-Identifier: Apache-2.0
#include "analysis/bounds.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "analysis/assessment.hpp"
#include "analysis/dds_sources.hpp"
#include "analysis/delivery_bound.hpp"
#include "analysis/figure_bound.hpp"
#include "analysis/misses_bound.hpp"
#include "analysis/network_bound.hpp"
#include "analysis/outages.hpp"
#include "analysis/program_assessment.hpp"
#include "analysis/program_reactions.hpp"
#include "analysis/separated_flow.hpp"
#include "analysis/surviving_copies.hpp"
#include "json/quantity.hpp"
#include "results/run_result.hpp"
#include "scenario/figures/requirement.hpp"
#include "scenario/resolved/resolved_dds.hpp"
#include "sim/check.hpp"

namespace takt::analysis {
namespace {

using sim::Duration;

constexpr int most_host_rounds = 64;  // until what grows still is taken for unbounded
/// How long a message of DDS may be under way: of those that hold the least, since what answers is late by a few of
/// them.
constexpr Duration times_of_dds[] = {Duration::from_ps(2'000'000'000), Duration::from_ps(20'000'000'000),
                                     Duration::from_ps(200'000'000'000)};

std::uint64_t bits_of(Ps work, const GraphPort& port) {
  return static_cast<std::uint64_t>(8 * ((work + port.octet_time - 1) / port.octet_time));
}

std::vector<QueueBound> queue_bounds(const FlowGraph& graph, const NetworkResult& network) {
  std::vector<QueueBound> queues;
  for (std::size_t p = 0; p < graph.ports.size(); ++p)
    for (models::TrafficClass q = 0; q < models::traffic_class_count; ++q) {
      const PortClassBound& bound = network.ports[p].classes[q];
      if (!bound.is_used) continue;
      queues.push_back({graph.ports[p].node, graph.ports[p].number, q, {}, {}});
      if (!is_bounded(bound.backlog)) continue;
      queues.back().bits = bits_of(bound.backlog, graph.ports[p]);
      queues.back().frames = static_cast<std::uint64_t>(bound.backlog_frames);
    }
  return queues;
}

std::optional<Duration> later_of(const std::optional<Duration>& a, const std::optional<Duration>& b) {
  return a && b ? std::optional(std::max(*a, *b)) : std::nullopt;
}

std::vector<PassageBound> passages_of(const FlowGraph& graph, const NetworkResult& network) {
  std::vector<PassageBound> all;
  for (const Flow& flow : graph.flows)
    for (const std::uint32_t h : flow.hops) {
      const Hop& hop = graph.hops[h];
      const GraphPort& port = graph.ports[hop.port];
      const HopResult& result = network.hops[h];
      all.push_back({flow.stream, port.node, port.number, hop.highest_class, duration_of(result.worst),
                     duration_of(result.worst_left), hop.ats.has_value()});
    }
  const auto place = [](const PassageBound& passage) { return std::tuple(passage.stream, passage.node, passage.port); };
  std::stable_sort(all.begin(), all.end(),
                   [&](const PassageBound& a, const PassageBound& b) { return place(a) < place(b); });
  std::vector<PassageBound> slowest;
  for (const PassageBound& passage : all) {
    if (slowest.empty() || place(slowest.back()) != place(passage)) {
      slowest.push_back(passage);
      continue;
    }
    slowest.back().comes = later_of(slowest.back().comes, passage.comes);
    slowest.back().left = later_of(slowest.back().left, passage.left);
  }
  return slowest;
}

class StreamBounds {
 public:
  StreamBounds(const scenario::Resolved& resolved, const FlowGraph& graph, const NetworkResult& network,
               const HostTimes& hosts)
      : r_(resolved),
        graph_(graph),
        network_(network),
        hosts_(hosts),
        separated_(resolved, graph, network),
        outages_(resolved) {}

  std::vector<StreamBound> make() {
    std::vector<StreamBound> bounds(r_.streams.size());
    for (std::size_t s = 0; s < bounds.size(); ++s) {
      const models::StreamPlan& plan = r_.plan.streams[s];
      bounds[s].name = plan.name;
      bounds[s].index = models::StreamIndex{static_cast<std::uint32_t>(s)};
      bounds[s].by_listener.assign(plan.listeners.size(), Duration());
      bounds[s].least = Duration::max();
      bounds[s].latency = bounds[s].total_flow = bounds[s].separated_flow = Duration();
      bounds[s].assumptions = graph_.assumptions;
      bounds[s].loses_nothing = true;
    }
    for (const Flow& flow : graph_.flows) take(flow, bounds[flow.stream.value]);
    for (StreamBound& bound : bounds) bound.reaches_all = bound.loses_nothing;
    for (const scenario::ResolvedRedundancy& redundancy : r_.redundancies)
      look_for_copies(redundancy, bounds[redundancy.stream.value]);
    for (StreamBound& bound : bounds)
      if (bound.least == Duration::max()) {
        bound.least = Duration();
        bound.latency = bound.total_flow = bound.separated_flow = std::nullopt;
        lose(bound, "nothing is known of when it is sent");
        bound.reason = bound.loss_reason;
      }
    return bounds;
  }

 private:
  void take(const Flow& flow, StreamBound& bound) {
    const models::StreamPlan& plan = r_.plan.streams[bound.index.value];
    for (std::size_t l = 0; l < flow.last.size(); ++l) {
      const models::NodePlan& listener = r_.plan.nodes[plan.listeners[l].value];
      const sim::Distribution& receive = r_.plan.os_latencies[listener.os_latency].receive;
      const Ps to_host = listener.greatest_forwarding_delay().ps();  // in a station
      const ThreadTime& stack = hosts_.receive(plan.listeners[l]);
      const Ps taken_in = sum(receive.greatest().ps(), stack.worst, stack.worst > 0 ? waits_in_order : 0);
      for (const std::uint32_t last : flow.last[l]) {
        const HopResult& hop = network_.hops[last];
        const Ps propagation = graph_.ports[graph_.hops[last].port].propagation;
        const auto beyond = flow.beyond.find(last);  // over a bypass
        const Ps latency =
            sum(hop.worst_left, propagation, beyond == flow.beyond.end() ? 0 : beyond->second, to_host, taken_in);
        const Ps least =
            sum(hop.best_left, propagation, listener.least_forwarding_delay().ps(), receive.least().ps(), stack.least);
        bound.least = std::min(bound.least, Duration::from_ps(least));
        const SeparatedFlowBound separated = separated_.bound(last);
        const Ps second = beyond == flow.beyond.end() ? sum(separated.latency, to_host, taken_in) : unbounded_ps;
        if (bound.separated_flow_reason.empty()) bound.separated_flow_reason = separated.reason;
        bound.separated_flow = later_of(bound.separated_flow, duration_of(second));
        bound.by_listener[l] = later_of(bound.by_listener[l], duration_of(std::min(latency, second)));
        bound.latency = later_of(bound.latency, duration_of(std::min(latency, second)));
        const bool is_worst =
            bound.hops.empty() ||
            (bound.total_flow && (!is_bounded(latency) || Duration::from_ps(latency) > *bound.total_flow));
        bound.total_flow = later_of(bound.total_flow, duration_of(latency));
        if (!is_worst) continue;
        bound.listener = plan.listeners[l];
        add_hops(last, bound);
      }
      if (!is_bounded(stack.worst))
        wait_for_ever(thread_name(plan.listeners[l], &models::CpuPlan::receive) + ": " + stack.reason, bound);
    }
    if (!flow.hold_reason.empty())
      wait_for_ever(flow.hold_reason, bound);
    else if (!is_bounded(flow.worst_source))
      wait_for_ever(thread_name(plan.talker, &models::CpuPlan::transmit) + ": " + flow.source_reason, bound);
    if (bound.latency) bound.reason.clear();  // whatever one of the two analyses says
    if (!flow.loss_at_host.empty()) lose(bound, flow.loss_at_host);
    if (flow.may_miss_launch) lose(bound, "the operating system may hand a frame over after its launch time");
    for (const std::uint32_t h : flow.hops) look_for_losses(graph_.hops[h], bound);
  }

  /// A thread of a host for which no time is known may refuse frames as well.
  static void wait_for_ever(std::string why, StreamBound& bound) {
    bound.latency = bound.total_flow = bound.separated_flow = std::nullopt;
    std::fill(bound.by_listener.begin(), bound.by_listener.end(), std::nullopt);
    lose(bound, why);
    bound.reason = std::move(why);
  }
  std::string thread_name(models::NodeIndex node, std::optional<std::uint32_t> models::CpuPlan::*part) const {
    const models::NodePlan& plan = r_.plan.nodes[node.value];
    return "thread " + plan.name + "/" + plan.cpu->threads[*(plan.cpu.get()->*part)].name;
  }

  static void lose(StreamBound& bound, std::string why, bool is_fault = false) {
    bound.loses_nothing = false;
    bound.loses_by_faults_only = bound.loses_by_faults_only && is_fault;
    if (bound.loss_reason.empty()) bound.loss_reason = std::move(why);
  }

  std::string name_of(const GraphPort& port) const {
    return r_.plan.nodes[port.node.value].name + ":" + std::to_string(port.number);
  }

  /// What loses frames there although nothing has failed; empty: nothing.
  std::string own_loss(const Hop& hop) const {
    const GraphPort& port = graph_.ports[hop.port];
    if (std::string why = refusal_at(hop); !why.empty()) return why;
    if (network_.hops[static_cast<std::size_t>(&hop - graph_.hops.data())].may_drop)
      return "a stream filter may drop frames before " + name_of(port);
    return {};
  }
  std::string chance_loss(const Hop& hop) const {
    const GraphPort& port = graph_.ports[hop.port];
    for (const models::ImpairmentPlan& each : r_.plan.impairments)
      if (each.link == port.link && each.from_a_to_b == port.from_a &&
          (each.impairment.loss || each.impairment.corruption))
        return "chance loses frames on the link of " + name_of(port);
    return {};
  }

  void look_for_losses(const Hop& hop, StreamBound& bound) const {
    const GraphPort& port = graph_.ports[hop.port];
    if (std::string why = own_loss(hop); !why.empty()) lose(bound, std::move(why));
    if (outages_.uses_link(port.link)) lose(bound, "the link of " + name_of(port) + " goes down", true);
    if (std::string why = chance_loss(hop); !why.empty()) lose(bound, std::move(why), true);
  }

  void look_for_copies(const scenario::ResolvedRedundancy& redundancy, StreamBound& bound) const {
    const auto flow = std::ranges::find(graph_.flows, redundancy.stream, &Flow::stream);
    if (bound.loses_nothing || flow == graph_.flows.end() || flow->may_miss_launch || !flow->loss_at_host.empty() ||
        std::ranges::count(graph_.flows, redundancy.stream, &Flow::stream) != 1)
      return;
    const std::string why =
        why_copies_may_be_lost(r_, graph_, *flow, redundancy, bound, outages_, [this](const Hop& hop) {
          std::string own = own_loss(hop);
          return own.empty() ? chance_loss(hop) : own;
        });
    bound.reaches_all = why.empty();
    if (!why.empty()) bound.loss_reason = why;
  }

  /// The hops of the slowest way to this one.
  void add_hops(std::uint32_t last, StreamBound& bound) {
    std::vector<std::uint32_t> way{last};
    for (;;) {
      const std::vector<std::uint32_t>& parents = graph_.hops[way.back()].parents;
      if (parents.empty()) break;
      way.push_back(*std::max_element(parents.begin(), parents.end(), [&](std::uint32_t a, std::uint32_t b) {
        return network_.hops[a].worst_left < network_.hops[b].worst_left;
      }));
    }
    std::reverse(way.begin(), way.end());
    bound.hops.clear();
    bound.reason.clear();
    for (const std::uint32_t h : way) bound.hops.push_back(hop_bound(h, bound.reason));
    if (bound.reason.empty() && !is_bounded(network_.hops[last].worst))
      bound.reason = "an ATS scheduler holds what does not keep to its rate, for any time";
  }

  /// The first of the streams that may come at any time, in the class or one that goes before.
  std::string streams_without_spacing(const Hop& hop) const {
    for (const std::uint32_t h : graph_.ports[hop.port].hops) {
      const Hop& other = graph_.hops[h];
      const Flow& flow = graph_.flows[other.flow];
      if (flow.source.is_limited() || flow.stream.is_none() || other.highest_class < hop.lowest_class) continue;
      return ": " + r_.plan.streams[flow.stream.value].name +
             (flow.unlimited_reason.empty() ? "" : ", " + flow.unlimited_reason);
    }
    return {};
  }

  HopBound hop_bound(std::uint32_t h, std::string& reason) {
    const Hop& hop = graph_.hops[h];
    const GraphPort& port = graph_.ports[hop.port];
    const HopResult& result = network_.hops[h];
    const PortClassBound& traffic_class = network_.ports[hop.port].classes[hop.highest_class];
    HopBound made;
    made.node = port.node;
    made.port = port.number;
    made.name = r_.plan.nodes[port.node.value].name + ":" + std::to_string(port.number) + " to " +
                r_.plan.nodes[port.peer.value].name;
    made.delay = duration_of(result.delay);
    if (is_bounded(traffic_class.backlog)) made.backlog_bits = bits_of(traffic_class.backlog, port);
    if (!made.delay && reason.empty()) {
      std::string why = !hop.unsupported.empty() ? hop.unsupported
                        : !result.reason.empty() ? result.reason
                                                 : traffic_class.reason;
      if (why.starts_with("a stream without a least gap")) why += streams_without_spacing(hop);
      reason =
          "at " + made.name + ", class " + std::to_string(hop.highest_class) + ": " + (why.empty() ? "unbounded" : why);
    }
    return made;
  }

  /// Why a queue may refuse frames of the hop; empty: it takes them all. A queue without a limit does, whatever comes.
  std::string refusal_at(const Hop& hop) const {
    const models::PortConfig& config = *graph_.models[hop.port].config;
    const std::string at = " at " + name_of(graph_.ports[hop.port]);
    if (!hop.unsupported.empty()) return "nothing is known of what is lost" + at + ": " + hop.unsupported;
    for (models::TrafficClass q = hop.lowest_class; q <= hop.highest_class; ++q) {
      const PortClassBound& bound = network_.ports[hop.port].classes[q];
      if (!bound.is_used) continue;
      if (config.shaping.queue_max_sdu[q].count != 0 && hop.msdu > config.shaping.queue_max_sdu[q])
        return "a queue takes no frames of that length" + at;
      constexpr models::QueueLimit unlimited;
      const models::QueueLimit& limit = config.queue_limits[q];
      if (limit.frames == unlimited.frames && limit.octets == unlimited.octets) continue;
      const Ps octets = bound.backlog / graph_.ports[hop.port].octet_time + 1;
      if (!is_bounded(bound.backlog) || bound.backlog_frames > limit.frames || octets > limit.octets)
        return "a full queue may drop frames" + at;
    }
    return {};
  }

  const scenario::Resolved& r_;
  const FlowGraph& graph_;
  const NetworkResult& network_;
  const HostTimes& hosts_;
  SeparatedFlows separated_;
  Outages outages_;
};

/// Nothing is promised that the scenario itself contradicts.
void withdraw(Bounds& bounds) {
  for (StreamBound& stream : bounds.streams) {
    const std::string why = bounds.ledger.refutation(stream.assumptions);
    if (why.empty()) continue;
    stream.latency = stream.total_flow = stream.separated_flow = std::nullopt;
    std::fill(stream.by_listener.begin(), stream.by_listener.end(), std::nullopt);
    stream.loses_nothing = stream.reaches_all = false;
    stream.loss_reason = why;
    stream.reason = why;
    stream.hops.clear();
  }
  if (bounds.ledger.refutation(bounds.every).empty()) return;
  for (QueueBound& queue : bounds.queues) queue.bits = queue.frames = std::nullopt;
  bounds.passages.clear();
}

class RequirementBounds {
 public:
  RequirementBounds(const scenario::Resolved& resolved, const FlowGraph& graph, Bounds& bounds)
      : r_(resolved), graph_(graph), bounds_(bounds) {}

  void make() {
    for (const scenario::RequiredFigure& required : r_.requirements) bounds_.requirements.push_back(of(required));
  }

 private:
  RequirementBound of(const scenario::RequiredFigure& required) const {
    using enum results::RequirementKind;
    constexpr std::pair<results::RequirementKind, const char*> unbounded[] = {
        {buffered, "takt has no bound for how many values a thread finds buffered"},
        {irregular, "takt has no bound for how regular the pulses of a signal are"},
        {sync, "synchronisation is simulated, not bounded; gates and publishing rest on it"},
        {clocks, "how far clocks differ is simulated, not bounded; gates and publishing rest on it"},
        {delivered, "a number of delivered frames is no worst case"},
    };
    for (const auto& [kind, reason] : unbounded)
      if (required.kind == kind) return {{}, {}, reason, {}};
    if (required.kind == figure || required.kind == success) return of_figure(required);
    if (required.kind == reaction) return of_reaction(*scenario::reaction_of(required.figure));
    if (is_of_misses(required.kind) && required.figure.steps.front() == "programs") return of_late_reactions(required);
    const auto stream = std::ranges::find(bounds_.streams, required.subject, &StreamBound::name);
    TAKT_CHECK(stream != bounds_.streams.end(), "a stream of a requirement is one");
    if (required.kind == latency) return {stream->latency, {}, stream->reason, stream->assumptions};
    if (required.kind == jitter)
      return {stream->latency ? std::optional(*stream->latency - stream->least) : std::nullopt,
              {},
              stream->reason,
              stream->assumptions};
    if (is_of_misses(required.kind)) return misses_bound(r_, graph_, *stream, required);
    return of_losses(*stream);
  }

  /// None is late if all are bounded by the deadline.
  RequirementBound of_late_reactions(const scenario::RequiredFigure& required) const {
    RequirementBound bound = of_reaction(*scenario::reaction_of(required.figure));
    if (bound.duration && *bound.duration <= *required.deadline)
      bound.count = 0;
    else if (bound.duration)
      bound.reason = "it takes at most " + json::to_text(*bound.duration) +
                     ", beyond the deadline: nothing shows how many in a row are late";
    bound.duration.reset();
    return bound;
  }

  RequirementBound of_figure(const scenario::RequiredFigure& required) const {
    const scenario::Figure& figure = required.figure;
    RequirementBound bound = bound_of_figure(r_, bounds_, figure, required.from,
                                             [this](const scenario::AskedReaction& each) { return of_reaction(each); });
    bound.duration.reset();
    if (required.longest && bound.figure->greatest)
      bound.duration = Duration::from_ps(std::llround(*bound.figure->greatest * figure.divisor));
    return bound;
  }

  RequirementBound of_reaction(const scenario::AskedReaction& asked) const {
    RequirementBound worst;
    bool is_known = false;
    worst.duration = Duration();
    for (const ReactionBound& bound : bounds_.reactions) {
      if (bound.kind != asked.kind || bound.of_tree != asked.of_tree ||
          (asked.program && r_.programs[bound.program].name != *asked.program))
        continue;
      if (!is_meant(bound, asked.cause)) continue;
      is_known = true;
      worst.assumptions.add(bound.assumptions);
      if (!bound.bound && worst.reason.empty()) worst.reason = bound.reason;
      worst.duration =
          worst.duration && bound.bound ? std::optional(std::max(*worst.duration, *bound.bound)) : std::nullopt;
    }
    if (!is_known) worst = {{}, {}, "takt has no bound for reactions with this cause", {}};
    return worst;
  }

  /// Whether halts by a mismatch have a bound of their own, as they have where calls come from some alone.
  bool has_mismatches(const ReactionBound& like) const {
    return std::ranges::any_of(bounds_.reactions, [&](const ReactionBound& each) {
      return each.program == like.program && each.of_tree == like.of_tree && each.cause == handshake::Cause::mismatch;
    });
  }

  /// Without a cause: a call, and whatever the scenario's faults can do.
  bool is_meant(const ReactionBound& bound, const std::optional<handshake::Cause>& cause) const {
    using handshake::Cause;
    // A mismatch spreads as a call does that may be made anywhere.
    if (cause == Cause::mismatch && has_mismatches(bound)) return bound.cause == Cause::mismatch;
    if (cause) return bound.cause == (*cause == Cause::nested || *cause == Cause::mismatch ? Cause::command : *cause);
    if (bound.cause == Cause::command || bound.cause == Cause::mismatch) return true;
    const std::vector<Cause> causes = causes_of_halts(r_, bounds_, bound.program, bound.of_tree);
    return std::find(causes.begin(), causes.end(), bound.cause) != causes.end();
  }

  static RequirementBound of_losses(const StreamBound& stream) {
    RequirementBound bound;
    bound.assumptions = stream.assumptions;
    if (stream.reaches_all)  // of a redundant stream a frame counts whose copies are all lost
      bound.count = 0;
    else
      bound.reason = stream.loss_reason;
    return bound;
  }

  const scenario::Resolved& r_;
  const FlowGraph& graph_;
  Bounds& bounds_;
};

}  // namespace

namespace {

/// Whether a relay of a ladder may take a copy that comes back for something new, and send it round again: it forgets
/// what has passed when its reset timer expires, and match recovery as soon as another frame has come (as
/// NetworkBound's passes_once has it).
bool may_circle(const scenario::Resolved& resolved, const FlowGraph& graph, const NetworkResult& network,
                const scenario::ResolvedRedundancy& redundancy) {
  for (const Flow& flow : graph.flows) {
    if (flow.stream != redundancy.stream || !flow.comes_back) continue;
    Ps longest = 0;
    for (const std::uint32_t h : flow.hops) {
      const GraphPort& port = graph.ports[graph.hops[h].port];
      longest = std::max(longest, sum(network.hops[h].worst_left, port.propagation,
                                      resolved.plan.nodes[port.peer.value].greatest_forwarding_delay().ps()));
    }
    if (!is_bounded(longest) || longest >= redundancy.description->reset_timeout.ps()) return true;
    if (redundancy.description->algorithm == scenario::Recovery::match &&
        !(flow.source.is_limited() && flow.source.count(longest) <= 1))
      return true;
  }
  return false;
}

/// Then no bound of anything holds.
void note_circling_ladders(const scenario::Resolved& resolved, const NetworkResult& network, FlowGraph& graph,
                           std::vector<StreamBound>& streams) {
  for (const scenario::ResolvedRedundancy& redundancy : resolved.redundancies)
    if (redundancy.is_ladder() && may_circle(resolved, graph, network, redundancy))
      graph.uncertain_paths.push_back(resolved.plan.streams[redundancy.stream.value].name);
  if (graph.uncertain_paths.empty()) return;
  graph.assumptions.add(Assumption::no_disturbance);
  for (StreamBound& stream : streams) stream.assumptions.add(Assumption::no_disturbance);
}

/// Hosts and network, round and round until nothing changes.
struct Solved {
  std::shared_ptr<HostTimes> hosts;
  FlowGraph graph;
  NetworkResult network;
  std::vector<StreamBound> streams;
  std::optional<Duration> dds_within = {};
};
Solved solve(const scenario::Resolved& resolved, const BoundOptions& options) {
  auto hosts = std::make_shared<HostTimes>(resolved);
  FlowGraph graph = make_flow_graph(resolved, options, *hosts);
  NetworkResult network = bound_network(resolved, graph, options.interrupted);
  std::uint64_t port_analyses = network.port_analyses;
  for (int round = 0; !network.is_interrupted && hosts->has_processors() && hosts->refine(graph, network, options);
       ++round) {
    if (round >= most_host_rounds) hosts->give_up();
    graph = make_flow_graph(resolved, options, *hosts);
    network = bound_network(resolved, graph, options.interrupted);
    port_analyses += network.port_analyses;
  }
  network.port_analyses = port_analyses;
  std::vector<StreamBound> streams = StreamBounds(resolved, graph, network, *hosts).make();
  note_circling_ladders(resolved, network, graph, streams);
  return {std::move(hosts), std::move(graph), std::move(network), std::move(streams)};
}

/// Participants of DDS answer what comes: how much they send rests on how long that takes, which rests on how much they
/// send. The first time that the bounds themselves show.
Solved solve_with_dds(const scenario::Resolved& resolved, BoundOptions options) {
  options.dds_within.reset();
  options.dds_late.clear();
  if (!resolved.dds || resolved.dds->participants.empty()) return solve(resolved, options);
  std::uint64_t port_analyses = 0;
  for (const Duration within : times_of_dds) {
    options.dds_within = within;
    Solved solved = solve(resolved, options);
    port_analyses = solved.network.port_analyses += port_analyses;
    if (solved.network.is_interrupted) return solved;
    options.dds_late = why_dds_is_late(resolved, options, *solved.hosts, solved.streams);
    if (!options.dds_late.empty()) continue;
    solved.dds_within = within;
    return solved;
  }
  options.dds_within.reset();
  Solved solved = solve(resolved, options);
  solved.network.port_analyses += port_analyses;
  return solved;
}

/// What was not finished says nothing.
void forget_all(const scenario::Resolved& resolved, Bounds& bounds) {
  const std::string why = "the analysis was interrupted";
  for (StreamBound& stream : bounds.streams) {
    stream.latency = stream.total_flow = stream.separated_flow = std::nullopt;
    std::fill(stream.by_listener.begin(), stream.by_listener.end(), std::nullopt);
    stream.loses_nothing = stream.reaches_all = stream.loses_by_faults_only = false;
    stream.loss_reason = stream.reason = why;
    stream.least = Duration();
    stream.hops.clear();
  }
  for (QueueBound& queue : bounds.queues) queue.bits = queue.frames = std::nullopt;
  bounds.passages.clear();
  bounds.requirements.assign(resolved.requirements.size(), {{}, {}, why, {}, FigureRange{}});
  bounds.is_interrupted = true;
}

}  // namespace

Bounds bound(const scenario::Resolved& resolved, const BoundOptions& options) {
  auto [hosts, graph, network, streams, dds_within] = solve_with_dds(resolved, options);
  Bounds bounds;
  bounds.hosts = hosts;
  bounds.every = graph.assumptions;
  bounds.rounds = network.rounds;
  bounds.port_analyses = network.port_analyses;
  bounds.streams = std::move(streams);
  bounds.dds_within = dds_within;
  bounds.queues = queue_bounds(graph, network);
  bounds.passages = passages_of(graph, network);
  for (const scenario::ResolvedRedundancy& redundancy : resolved.redundancies) {
    StreamBound& stream = bounds.streams[redundancy.stream.value];
    stream.loses_nothing = stream.loses_by_faults_only = false;  // copies are
    if (stream.loss_reason.empty()) stream.loss_reason = "copies of a redundant stream are dropped";
  }
  bounds.ledger = assess(resolved, graph, options);
  if (network.is_interrupted) {
    forget_all(resolved, bounds);
    return bounds;
  }
  withdraw(bounds);
  bounds.deliveries = delivery_bounds(resolved, options, bounds);
  add_reactions(resolved, options, bounds);
  assess_programs(resolved, bounds);
  RequirementBounds(resolved, graph, bounds).make();
  return bounds;
}

}  // namespace takt::analysis
