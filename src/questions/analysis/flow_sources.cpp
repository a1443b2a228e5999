// SPDX-License-Identifier: Apache-2.0
#include "analysis/flow_sources.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string_view>

#include "analysis/dds_sources.hpp"
#include "analysis/program_assessment.hpp"
#include "analysis/thread_arrivals.hpp"
#include "models/ethernet/sizes.hpp"
#include "scenario/resolved/resolved_dds.hpp"
#include "scenario/description/promises.hpp"
#include "scenario/resolve/port_configs.hpp"

namespace takt::analysis {
namespace {

/// Messages of one kind in a cycle of a participant that publishes on change: the cyclic one, and
/// Assumption::program_publishes.
constexpr std::int64_t messages_in_a_cycle = 5;

template <class... Cases>
struct Overloaded : Cases... {
  using Cases::operator()...;
};
template <class... Cases>
Overloaded(Cases...) -> Overloaded<Cases...>;

ArrivalPattern at_any_time() { return {1, 1, 0, unbounded_ps}; }

ArrivalPattern pattern_of(const models::TalkerPlan& talker, const ClockQuality& clock) {
  const auto periodic = [&](Ps period, Ps jitter) {
    ArrivalPattern pattern{std::max<Ps>(1, shortest(period, clock)), 1, 0, longest(jitter, clock) + 2 * clock.error};
    return pattern;
  };
  return std::visit(
      Overloaded{[&](const models::PeriodicSchedule& s) {
                   ArrivalPattern pattern = periodic(s.period.ps(), s.jitter.ps());
                   if (talker.until == sim::LocalTime::never()) return pattern;
                   // It ends: so many frames, and no more.
                   const Ps lasts = std::max<Ps>(0, talker.until.ps() - s.offset.ps());
                   return ArrivalPattern{unbounded_ps, lasts / s.period.ps() + 1, pattern.period, pattern.jitter};
                 },
                 [&](const models::ExponentialSchedule&) { return at_any_time(); },
                 [&](const models::RandomGapSchedule& s) {
                   return s.gap->least() > sim::Duration() ? periodic(s.gap->least().ps(), 0) : at_any_time();
                 },
                 [&](const models::BurstSchedule& s) {
                   ArrivalPattern pattern = periodic(s.period.ps(), 0);
                   pattern.frames = s.frames;
                   // The gap between the last frame of a burst and the first of the next counts too.
                   const Ps last_gap = s.period.ps() - (static_cast<Ps>(s.frames) - 1) * s.spacing.ps();
                   pattern.gap = shortest(std::max<Ps>(0, std::min(s.spacing.ps(), last_gap)), clock);
                   return pattern;
                 },
                 [&](const models::TraceSchedule& s) {
                   if (s.entries.empty()) return ArrivalPattern{unbounded_ps, 0, 0, 0};
                   Ps gap = s.entries.size() > 1 ? unbounded_ps : 0;
                   for (std::size_t i = 1; i < s.entries.size(); ++i)
                     gap = std::min(gap, (s.entries[i].time - s.entries[i - 1].time).ps());
                   return ArrivalPattern{unbounded_ps, static_cast<std::int64_t>(s.entries.size()),
                                         shortest(gap, clock), 2 * clock.error};
                 }},
      talker.schedule);
}

/// Streams whose talkers begin when the scenario says, not just somewhere in their periods.
std::set<std::string_view> streams_with_phases(const scenario::Scenario& scenario) {
  std::set<std::string_view> names;
  for (const scenario::Stream& stream : scenario.streams)
    if (scenario::promises_phase(stream)) names.insert(stream.name);
  return names;
}

/// From production to the egress queue: the operating system, and the thread that sends.
void set_source(const models::OsLatency& os, const ThreadTime& stack, Flow& flow) {
  flow.worst_source = sum(os.transmit.greatest().ps(), stack.worst);
  flow.best_source = os.transmit.least().ps() + stack.least;
  flow.source_reason = stack.reason;
}
Ps spread_of(const Flow& flow) {
  return is_bounded(flow.worst_source) ? flow.worst_source - flow.best_source : unbounded_ps;
}
Ps spread_of(const sim::Distribution& d) { return d.greatest().ps() - d.least().ps(); }

/// The pattern is that of production.
void set_arrivals(ArrivalPattern pattern, const models::OsLatency& os, Flow& flow) {
  ArrivalPattern at_stack = pattern;
  at_stack.jitter = sum(pattern.jitter, spread_of(os.transmit));
  flow.at_stack = FrameArrivals(at_stack);
  pattern.jitter = sum(pattern.jitter, spread_of(flow));
  flow.source = FrameArrivals(pattern);
}

void add_talker(const scenario::Resolved& r, const models::TalkerPlan& talker, bool has_phase,
                const BoundOptions& options, const HostTimes& hosts, FlowGraph& graph) {
  const models::NodeIndex node = r.plan.streams[talker.stream.value].talker;
  const ClockQuality clock = clock_quality(r, node, options);
  const models::OsLatency& os = r.plan.os_latencies[r.plan.nodes[node.value].os_latency];
  Flow flow;
  flow.stream = talker.stream;
  ArrivalPattern pattern = pattern_of(talker, clock);
  const ThreadTime& stack = hosts.transmit(node);
  set_source(os, stack, flow);
  const Ps handed_over = flow.worst_source;
  if (talker.launch) {
    flow.is_timed = true;
    const Ps handed_over_at_least = flow.best_source;
    flow.worst_source = longest(talker.launch->ps(), clock) + 2 * clock.error;
    flow.waits = std::max<Ps>(0, flow.worst_source - handed_over_at_least);
    // The clock is read in whole picoseconds: up to one of them is over already.
    const Ps unread = clock.slowest_ppt == 0 && clock.fastest_ppt == 0 ? 0 : 1;
    flow.best_source =
        std::max<Ps>(0, shortest(std::max<Ps>(0, talker.launch->ps() - unread), clock) - 2 * clock.error);
    // And one of them may be over where a frame is handed over at the very instant.
    flow.may_miss_launch =
        sum(handed_over, unread) > std::max<Ps>(0, shortest(talker.launch->ps(), clock) - 2 * clock.error);
  }
  set_arrivals(pattern, os, flow);
  if (talker.launch)
    flow.handed_over = flow.at_stack.delayed(is_bounded(stack.worst) ? stack.worst - stack.least : unbounded_ps);
  // One that is handed over too late is lost only then, and under way until then.
  if (flow.may_miss_launch) flow.worst_source = std::max(flow.worst_source, handed_over);
  if (const auto* const periodic = std::get_if<models::PeriodicSchedule>(&talker.schedule);
      periodic != nullptr && has_phase && !talker.babbles && stack.worst == 0)
    flow.produced = ArrivalPhase{periodic->offset.ps() - clock.error, periodic->period.ps(),
                                 periodic->jitter.ps() + 2 * clock.error, clock.is_synchronised ? 0 : node.value + 1,
                                 clock.rate_ppt};
  graph.flows.push_back(std::move(flow));
}

/// What a process publishes, and hands to the port by the operating system.
void add_pattern(const scenario::Resolved& r, models::NodeIndex node, models::StreamIndex stream,
                 const ArrivalPattern& pattern, const HostTimes& hosts, FlowGraph& graph) {
  const models::OsLatency& os = r.plan.os_latencies[r.plan.nodes[node.value].os_latency];
  Flow flow;
  flow.stream = stream;
  set_source(os, hosts.transmit(node), flow);
  set_arrivals(pattern, os, flow);
  graph.flows.push_back(std::move(flow));
}

/// `frames` in each period of its clock, each late by up to `lateness`.
void add_late(const scenario::Resolved& r, models::NodeIndex node, models::StreamIndex stream, Ps every,
              std::int64_t frames, Ps lateness, const BoundOptions& options, const HostTimes& hosts, FlowGraph& graph) {
  const ClockQuality clock = clock_quality(r, node, options);
  add_pattern(r, node, stream, {std::max<Ps>(1, shortest(every, clock)), frames, 0, sum(lateness, 2 * clock.error)},
              hosts, graph);
}

/// Of what a participant publishes when an alarm wakes it.
Ps lateness(const HostTimes& hosts, const scenario::ResolvedMember& member) {
  return sum(spread_of(hosts.wake_up(member.node, member.cpu_thread)),
             hosts.of(member.node, member.cpu_thread).spread());
}

/// Before the operating system has it: beside all threads, or a job of the thread that the member runs on.
void seal_at(const scenario::ResolvedMember& member, const HostTimes& hosts, Flow& flow) {
  const Ps seal = member.seal.ps();
  flow.best_source += seal;
  if (!member.cpu_thread || seal == 0) {
    flow.worst_source = sum(flow.worst_source, seal);
    return;
  }
  const ThreadTime& thread = hosts.of(member.node, member.cpu_thread);
  const Ps spread = is_bounded(thread.worst) ? std::max<Ps>(0, thread.worst - seal) : unbounded_ps;
  flow.sealing = flow.at_stack;
  flow.at_stack = flow.at_stack.delayed(spread);
  flow.source = flow.source.delayed(spread);
  flow.worst_source = sum(flow.worst_source, thread.worst);
  if (flow.source_reason.empty()) flow.source_reason = thread.reason;
}

void add_published(const scenario::Resolved& r, const scenario::ResolvedMember& member, models::StreamIndex stream,
                   Ps every, std::int64_t frames, const BoundOptions& options, const HostTimes& hosts,
                   FlowGraph& graph) {
  add_late(r, member.node, stream, every, frames, lateness(hosts, member), options, hosts, graph);
  seal_at(member, hosts, graph.flows.back());
}

/// Topics over OPC UA, of applications and gateways: a call of a thread publishes one message at most, which is one
/// frame.
void add_topics(const scenario::Resolved& r, const BoundOptions& options, const HostTimes& hosts, FlowGraph& graph) {
  for (const scenario::ResolvedApplication& application : r.applications)
    for (const scenario::ResolvedThread& thread : application.threads) {
      if (!thread.publishes || !thread.stream) continue;
      add_pattern(
          r, application.node, *thread.stream,
          calls_of(thread, hosts.of(application.node, thread.cpu_thread), clock_quality(r, application.node, options)),
          hosts, graph);
    }
}

/// With roles: whoever gets or loses one, or hears of it, publishes at once; afterwards its cycles begin anew. So many
/// more than the cyclic ones in the whole run are a cyclic one that may be late by so many cycles.
void add_roles(const scenario::Resolved& r, const scenario::ResolvedProgram& program, const BoundOptions& options,
               const HostTimes& hosts, FlowGraph& graph) {
  const Ps cycle = program.description->cycle.ps();
  const auto changes = most_changes_of_roles(r, static_cast<std::size_t>(&program - r.programs.data()));
  const auto add = [&](const scenario::ResolvedMember& member, models::StreamIndex stream) {
    if (!changes) return add_published(r, member, stream, cycle, messages_in_a_cycle, options, hosts, graph);
    add_late(r, member.node, stream, cycle, 1, sum(lateness(hosts, member), cycle * *changes), options, hosts, graph);
    seal_at(member, hosts, graph.flows.back());
  };
  graph.assumptions.add(Assumption::program_publishes);
  for (const scenario::ResolvedMember& each : program.members) {
    add(each, *each.roles);
    add(each, each.state);
    for (const auto& stream : each.data)
      if (stream) add(each, *stream);
  }
}

void add_program(const scenario::Resolved& r, const scenario::ResolvedProgram& program, const BoundOptions& options,
                 const HostTimes& hosts, FlowGraph& graph) {
  if (program.has_roles()) return add_roles(r, program, options, hosts, graph);
  const auto trains_before = static_cast<std::uint32_t>(graph.flows.size());  // no two Programs begin at the same flow
  const auto add = [&](std::uint8_t participant, models::StreamIndex stream, std::int64_t frames) {
    const scenario::ResolvedMember& member = program.members[participant];
    const models::NodeIndex node = member.node;
    add_published(r, member, stream, program.description->cycle.ps(), frames, options, hosts, graph);
    const ClockQuality clock = clock_quality(r, node, options);
    const models::OsLatency& os = r.plan.os_latencies[r.plan.nodes[node.value].os_latency];
    const Ps wake_up = os.wake_up.greatest().ps() - os.wake_up.least().ps();
    const bool waits_for_threads = member.cpu_thread || hosts.transmit(node).worst > 0;
    if (frames == 1 && clock.is_synchronised && !waits_for_threads &&
        scenario::promises_phase(*program.description, r.plan.nodes[node.value].name))
      graph.flows.back().produced =
          ArrivalPhase{program.phases[participant].ps() + os.wake_up.least().ps() - clock.error,
                       program.description->cycle.ps(), wake_up + 2 * clock.error, 0, clock.rate_ppt};
    if (graph.flows.back().produced)
      graph.flows.back().train = trains_before + participant;  // its state comes first, then its data
  };
  const bool on_change = program.description->publish == scenario::Publish::on_change;
  if (on_change) graph.assumptions.add(Assumption::program_publishes);
  for (std::uint8_t p = 0; p < program.members.size(); ++p)
    add(p, program.members[p].state, on_change ? messages_in_a_cycle : 1);
  for (std::size_t d = 0; d < program.process_data.size(); ++d) {
    const scenario::ResolvedProcessData& data = program.process_data[d];
    add(data.from, program.stream_of(d), 1);
    const auto reply = std::find_if(program.replies.begin(), program.replies.end(),
                                    [&](const scenario::ResolvedReply& answer) { return answer.with == d; });
    if (reply == program.replies.end()) continue;
    // A reply follows its request, whose latency is not known here. But who replies works at one message after the
    // other.
    Flow& flow = graph.flows.back();
    flow.produced.reset();
    flow.train.reset();
    const scenario::ResolvedProcessing& processing = program.processing[data.from];
    const Ps work = processing.per_message.least().ps() +
                    processing.per_field.least().ps() * static_cast<Ps>(program.process_data[reply->to].values);
    flow.at_stack =
        work > 0
            ? FrameArrivals(
                  {work, 1, 0,
                   spread_of(
                       r.plan.os_latencies[r.plan.nodes[program.members[data.from].node.value].os_latency].transmit)})
            : FrameArrivals(at_any_time());
    flow.source = work > 0 ? FrameArrivals({work, 1, 0, spread_of(flow)}) : FrameArrivals(at_any_time());
  }
}

/// What participants of DDS send; of some streams any number of frames at any time.
void add_dds(const scenario::Resolved& r, const BoundOptions& options, const HostTimes& hosts, FlowGraph& graph) {
  const DdsTraffic traffic = dds_traffic(r, options, hosts);
  std::vector<bool> is_known(r.plan.streams.size());
  for (const Flow& flow : graph.flows) is_known[flow.stream.value] = true;
  for (const DdsSource& source : traffic.sources) {
    const models::NodeIndex node = r.plan.streams[source.stream.value].talker;
    const models::OsLatency& os = r.plan.os_latencies[r.plan.nodes[node.value].os_latency];
    Flow flow;
    flow.stream = source.stream;
    flow.payload = source.payload;
    set_source(os, hosts.transmit(node), flow);
    flow.at_stack = source.arrivals.delayed(spread_of(os.transmit));
    flow.source = source.arrivals.delayed(spread_of(flow));
    graph.flows.push_back(std::move(flow));
    is_known[source.stream.value] = true;
  }
  for (const scenario::ResolvedStream& stream : r.streams) {
    if (is_known[stream.index.value]) continue;
    Flow flow;
    flow.stream = stream.index;
    flow.source = FrameArrivals(at_any_time());
    flow.payload = stream.largest_payload;  // others are shorter
    const auto sends = [&](const scenario::ResolvedParticipant& each) {
      return std::ranges::find(each.routes, stream.index, &scenario::ResolvedParticipant::Route::stream) !=
             each.routes.end();
    };
    if (const auto why = traffic.unknown.find(stream.index.value); why != traffic.unknown.end())
      flow.unlimited_reason = why->second;
    else if (r.dds && std::ranges::any_of(r.dds->participants, sends))
      flow.source = FrameArrivals({unbounded_ps, 0, 0, 0});  // a way for acknowledgements of best-effort readers, say
    graph.flows.push_back(std::move(flow));
  }
}

/// ATS schedulers at talkers, each alone in its group: frames are held until their tokens are there, no longer than a
/// bucket of its own keeps back what comes (as at a bridge, see NetworkBound).
class TalkerHolds {
 public:
  TalkerHolds(const scenario::Resolved& r, const BoundOptions& options) : r_(r), options_(options) {}

  void apply(FlowGraph& graph) const {
    for (const models::TalkerAtsPlan& shaped : r_.plan.talker_ats) {
      const auto is_its = [&](const Flow& flow) { return flow.stream == shaped.stream; };
      const bool is_alone =
          std::ranges::count_if(graph.flows, is_its) == 1;  // else several take the tokens of one bucket
      for (Flow& flow : graph.flows)
        if (is_its(flow)) hold(shaped, is_alone, flow);
    }
  }

 private:
  void hold(const models::TalkerAtsPlan& shaped, bool is_alone, Flow& flow) const {
    const models::StreamPlan& plan = r_.plan.streams[shaped.stream.value];
    const ClockQuality clock = clock_quality(r_, plan.talker, options_);
    const std::int64_t bits = bits_of(shaped, flow.payload.value_or(r_.streams[shaped.stream.value].largest_payload));
    const std::int64_t burst = std::int64_t{8} * shaped.committed_burst_size.count;
    const auto rate = static_cast<std::int64_t>(shaped.committed_information_rate.bits_per_second);
    const Ps held = is_alone ? longest_hold(flow.source, bits, burst, slowest_rate(rate, clock)) : unbounded_ps;
    flow.is_timed = true;
    if (held == 0 && clock.error == 0) return;  // what comes keeps to the bucket
    flow.produced.reset();
    flow.train.reset();
    const Ps late = sum(held, 2 * clock.error);
    flow.handed_over = flow.source;
    flow.waits = late;
    flow.worst_source = sum(flow.worst_source, late);
    if (!is_bounded(late))
      flow.hold_reason = is_alone ? "more may come to its ATS scheduler at the talker than its rate"
                                  : "several sources take the tokens of its ATS scheduler at the talker";
    flow.source = flow.source.delayed(late);
    if (has_one_length(shaped.stream) && all_ports_mind(shaped.stream))
      flow.source.add(by_clock(pattern_of_token_bucket(bits, burst, rate), clock));
  }

  std::int64_t bits_of(const models::TalkerAtsPlan& shaped, sim::Octets payload) const {
    const models::StreamPlan& plan = r_.plan.streams[shaped.stream.value];
    const sim::Octets frame = models::frame_length(plan.headers + payload, plan.priority.has_value(), false);
    return std::int64_t{8} * (shaped.media_overhead ? models::wire_length(frame) : frame).count;
  }
  /// Rerouting may lead a stream by a port that does not hold it.
  bool all_ports_mind(models::StreamIndex stream) const {
    const models::StreamPlan& plan = r_.plan.streams[stream.value];
    return std::ranges::all_of(r_.plan.links, [&](const models::LinkPlan& link) {
      return std::ranges::all_of(std::array{&link.a, &link.b}, [&](const models::LinkPlan::End* end) {
        const models::PortConfig& config = scenario::port_config_of(r_.plan, *end);
        return end->node != plan.talker ||
               config.shaping.is_timed(config.traffic_class_of_priority[plan.priority_at_talker()]);
      });
    });
  }
  /// Of short frames a bucket lets more pass.
  bool has_one_length(models::StreamIndex stream) const {
    const auto talker = std::ranges::find(r_.plan.talkers, stream, &models::TalkerPlan::stream);
    return talker != r_.plan.talkers.end() && !std::holds_alternative<models::TraceSchedule>(talker->schedule);
  }

  const scenario::Resolved& r_;
  const BoundOptions& options_;
};

Ps interval_ps(int log_seconds) { return rounded_up(std::ldexp(1e12, log_seconds)); }

}  // namespace

void add_flows(const scenario::Resolved& resolved, const BoundOptions& options, const HostTimes& hosts,
               FlowGraph& graph) {
  const std::set<std::string_view> with_phases = streams_with_phases(resolved.scenario);
  for (const models::TalkerPlan& talker : resolved.plan.talkers)
    add_talker(resolved, talker, with_phases.contains(resolved.plan.streams[talker.stream.value].name), options, hosts,
               graph);
  for (const scenario::ResolvedProgram& program : resolved.programs)
    add_program(resolved, program, options, hosts, graph);
  add_topics(resolved, options, hosts, graph);
  add_dds(resolved, options, hosts, graph);
  TalkerHolds(resolved, options).apply(graph);
}

std::vector<GptpMessages> gptp_messages(const scenario::Resolved& resolved, models::NodeIndex node) {
  const auto& stations = resolved.plan.gptp;
  if (node.value >= stations.size() || !stations[node.value]) return {};
  const models::gptp::StationPlan& plan = resolved.plan.gptp_stations[*stations[node.value]];
  // Request, response and its follow-up of the link delay; Sync, Follow_Up, Announce and Signaling of each domain.
  const auto domains = static_cast<std::int64_t>(plan.instances.size());
  int shortest = plan.link.log_pdelay_req_interval;
  for (const models::gptp::InstanceConfig& instance : plan.instances)
    shortest = std::min({shortest, instance.log_sync_interval, instance.log_announce_interval});
  if (plan.log_gptp_capable_interval) shortest = std::min<int>(shortest, *plan.log_gptp_capable_interval);
  // What anybody asks for may be relayed by all.
  std::int64_t requests = 0;
  for (const models::gptp::StationPlan& each : resolved.plan.gptp_stations)
    for (const models::gptp::TimedIntervalRequest& asked : each.interval_requests) {
      if (&each == &plan) ++requests;
      for (const int log : {asked.request.time_sync, asked.request.announce, asked.request.link_delay})
        if (log != models::gptp::MessageInterval::as_it_is)
          shortest = std::min(shortest, std::max(log, models::gptp::MessageInterval::shortest));
    }
  const std::size_t nodes = static_cast<std::size_t>(
      std::count_if(stations.begin(), stations.end(), [](const auto& station) { return station.has_value(); }));
  const auto messages = [&](std::int64_t frames, std::size_t octets) {
    return GptpMessages{FrameArrivals({interval_ps(shortest) / 2, frames, 0, 0}),
                        models::frame_length(sim::Octets{static_cast<std::uint32_t>(octets)}, false)};
  };
  // A Follow_Up has 76 octets, with Drift_Tracking 112, an Announce 68 and 8 for each node on the path; all others are
  // shorter.
  const bool tracks = std::any_of(plan.instances.begin(), plan.instances.end(),
                                  [](const models::gptp::InstanceConfig& instance) { return instance.drift_tracking; });
  std::vector<GptpMessages> all{
      messages(3 + requests + (plan.log_gptp_capable_interval ? 3 : 2) * domains, tracks ? 112 : 76)};
  if (domains > 0)
    all.push_back(messages(domains, 68 + 8 * std::min<std::size_t>(nodes, models::gptp::Announce::longest_path_trace)));
  return all;
}

}  // namespace takt::analysis
