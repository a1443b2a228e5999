// SPDX-License-Identifier: Apache-2.0
#include "evaluation/evaluate.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "evaluation/collect_applications.hpp"
#include "evaluation/collect_clocks.hpp"
#include "evaluation/collect_cpus.hpp"
#include "evaluation/collect_ingress.hpp"
#include "evaluation/collect_streams.hpp"
#include "evaluation/judge.hpp"
#include "results/result_json.hpp"
#include "results/version.hpp"
#include "scenario/figures/graph_figures.hpp"
#include "scenario/run/accounts.hpp"
#include "sim/check.hpp"

namespace takt::evaluation {

using namespace results;
namespace {

using scenario::ResolvedProgram;

std::string kind_name(handshake::IntentKind kind) { return std::string(handshake::name_of(kind)); }

std::vector<RoundTripResult> round_trips_of(const scenario::ProgramMonitor& monitor, const ResolvedProgram& program,
                                            Duration from) {
  std::vector<RoundTripResult> all;
  if (!monitor.round_trips()) return all;
  for (std::size_t i = 0; i < program.replies.size(); ++i) {
    const scenario::RoundTrips::Times& times = monitor.round_trips()->times(i, from);
    const sim::Histogram& histogram = times.round_trips;
    RoundTripResult one{program.process_data[program.replies[i].to].name,
                        program.process_data[program.replies[i].with].name,
                        histogram.count(),
                        {},
                        {},
                        {}};
    if (!histogram.empty()) one.time = summary_of(histogram);
    if (!times.one_way.empty()) one.one_way = summary_of(times.one_way);
    histogram.for_each_bucket([&](Duration low, Duration high, std::uint64_t n) {
      one.histogram.push_back({low, high, n});
    });
    all.push_back(std::move(one));
  }
  return all;
}

ReactionResult result_of(const handshake::Reaction& reaction, std::string initiator) {
  ReactionResult one;
  one.kind = kind_name(reaction.kind);
  one.initiator = std::move(initiator);
  one.cause = std::string(scenario::spelling(reaction.cause));
  one.began = reaction.began;
  if (reaction.outcome == handshake::ReactionOutcome::completed) one.completed = reaction.completed;
  one.superseded = reaction.outcome == handshake::ReactionOutcome::superseded;
  return one;
}

/// What the tree says whose outermost program this is.
void add_tree(const scenario::Run& run, std::size_t index, TrueTime from, ProgramResult& result) {
  const auto name = [&](std::uint32_t program, std::uint8_t participant) {
    const ResolvedProgram& of = run.resolved().programs[program];
    return of.name + "/" + of.participant_names[participant];
  };
  for (const auto& tree : run.trees()) {
    if (tree->programs().front() != index) continue;
    for (const handshake::Reaction& reaction : tree->reactions()) {
      if (reaction.began < from) continue;
      const auto [program, participant] = tree->initiator_of(reaction);
      result.tree_reactions.push_back(result_of(reaction, name(program, participant)));
    }
    for (const scenario::TreeMonitor::Violation& each : tree->violations())
      result.violations.push_back({each.time,
                                   std::string(handshake::name_of(each.violation.invariant)) + " of the tree",
                                   name(tree->programs()[each.violation.group], each.violation.participant),
                                   std::string(handshake::text_of(each.violation.finding))});
  }
}

void add_timeline(const scenario::ProgramMonitor& monitor, TrueTime now, ProgramResult& result) {
  for (const scenario::ProgramFault& fault : monitor.faults()) {
    if (fault.at <= now) result.timeline.push_back({fault.at, 0, "", "", fault.text});
    if (fault.until <= now && !fault.end_text.empty())
      result.timeline.push_back({fault.until, 0, "", "", fault.end_text});
  }
  for (const scenario::CallRecord& call : monitor.calls()) {
    std::string text = std::string(program::name_of(call.method));
    if (call.status != program::StatusCode::Good) text += " refused: " + std::string(program::name_of(call.status));
    result.timeline.push_back({call.time, call.participant, std::move(text), "", ""});
  }
  const auto is_death = [&](const scenario::StateRecord& record) {
    return record.change.transition == 0 &&
           std::any_of(monitor.lives().begin(), monitor.lives().end(), [&](const scenario::LifeRecord& life) {
             return !life.is_back && life.time == record.time && life.participant == record.participant;
           });
  };
  for (const scenario::StateRecord& record : monitor.history())
    if (!is_death(record))
      result.timeline.push_back(
          {record.time, record.participant, "", std::string(handshake::name_of(record.change.to)), ""});
  for (const scenario::LifeRecord& life : monitor.lives())
    result.timeline.push_back({life.time, life.participant, "", life.is_back ? "Halted" : "dead", ""});
  // What happens to the group stands before a call of the same instant, and both before the changes that they cause.
  const auto rank = [](const TimelineEntry& entry) { return !entry.fault.empty() ? 0 : !entry.call.empty() ? 1 : 2; };
  std::stable_sort(result.timeline.begin(), result.timeline.end(), [&](const TimelineEntry& a, const TimelineEntry& b) {
    return a.at != b.at ? a.at < b.at : rank(a) < rank(b);
  });
}

/// The reactions that began at `from` or later; invariants have no warm-up.
ProgramResult result_of(const scenario::Run& run, std::size_t index, TrueTime from) {
  const ResolvedProgram& program = run.resolved().programs[index];
  const scenario::ProgramMonitor& monitor = run.monitor(index);
  ProgramResult result;
  result.name = program.name;
  result.variant = std::string(scenario::spelling(program.description->variant));
  result.cycle = program.description->cycle;
  for (std::size_t p = 0; p < program.participant_names.size(); ++p) {
    result.participants.push_back(program.participant_names[p]);
    result.states.emplace_back(monitor.is_dead(p) ? "dead" : handshake::name_of(run.state(index, p)));
  }
  for (const handshake::Reaction& reaction : monitor.reactions())
    if (reaction.began >= from)
      result.reactions.push_back(result_of(reaction, result.participants[reaction.initiator]));
  for (const scenario::ViolationRecord& violation : monitor.violations())
    result.violations.push_back({violation.time, std::string(handshake::name_of(violation.violation.invariant)),
                                 result.participants[violation.violation.participant],
                                 std::string(handshake::text_of(violation.violation.finding))});
  add_tree(run, index, from, result);
  if (const scenario::RoleMonitor* const roles = run.roles(index))
    for (const scenario::BindingRecord& record : roles->history())
      result.bindings.push_back(
          {record.time, program.participant_names[record.role + std::size_t{1}],
           record.candidate ? run.resolved().topology.nodes[program.candidates()[*record.candidate].node.value].name
                            : ""});
  result.violations_allowed = program.description->violations == scenario::Violations::reported;
  add_timeline(monitor, run.simulation().now(), result);
  const scenario::ProgramMonitor::Counts& counts = monitor.counts(from.since_start());
  result.changes = counts.changes;
  result.process_data_received = counts.process_data_received;
  result.round_trips = round_trips_of(monitor, program, from.since_start());
  return result;
}

std::uint64_t overruns_of(const models::EgressPort& port) {
  std::uint64_t sum = 0;
  for (models::TrafficClass q = 0; port.shaping() != nullptr && q < models::traffic_class_count; ++q)
    sum += port.shaping()->transmission_overrun(q);
  return sum;
}

std::vector<PortResult> ports_of(const scenario::Run& run, Duration simulated) {
  std::vector<PortResult> results;
  const models::NetworkPlan& plan = run.resolved().plan;
  for (const models::LinkPlan& link : plan.links) {
    const auto add = [&](const models::LinkPlan::End& from, const models::LinkPlan::End& to) {
      const models::EgressPort& port = run.network().ports(from.node)[from.port];
      if (port.frames_sent() == 0 && port.frames_dropped() == 0) return;
      const double busy =
          static_cast<double>(port.wire_octets_sent()) * static_cast<double>(link.rate.octet_time().ps());
      results.push_back({plan.nodes[from.node.value].name, from.port, plan.nodes[to.node.value].name,
                         port.frames_sent(), port.frames_dropped(), port.queues().peak_frames(),
                         simulated > Duration() ? busy / static_cast<double>(simulated.ps()) : 0,
                         port.merge() == nullptr ? 0 : port.merge()->fragments_cut(), port.frames_cut_through(),
                         port.bad_fcs_forwarded(), overruns_of(port)});
    };
    add(link.a, link.b);
    add(link.b, link.a);
  }
  return results;
}

std::vector<QueueResult> queues_of(const scenario::Run& run) {
  std::vector<QueueResult> results;
  const models::NetworkPlan& plan = run.resolved().plan;
  for (const models::LinkPlan& link : plan.links) {
    const auto add = [&](const models::LinkPlan::End& from, const models::LinkPlan::End& to) {
      const models::PortQueues& queues = run.network().ports(from.node)[from.port].queues();
      for (models::TrafficClass q = 0; q < models::traffic_class_count; ++q)
        if (queues.peak_frames(q) > 0)
          results.push_back({plan.nodes[from.node.value].name, from.port, plan.nodes[to.node.value].name, q,
                             queues.peak_frames(q), queues.peak_octets(q)});
    };
    add(link.a, link.b);
    add(link.b, link.a);
  }
  return results;
}

/// The figures of what began at `from` or later.
RunResult collect(const scenario::Run& run, Duration from, bool partial) {
  const scenario::Scenario& scenario = run.resolved().scenario;
  RunResult result;
  result.version = version;
  result.scenario = scenario.name;
  result.seed = scenario.seed;
  result.simulated = run.simulation().now().since_start();
  result.wanted = scenario.duration;
  result.partial = partial;
  result.from = from;
  result.digest = run.simulation().digest().value();
  result.events = run.simulation().event_count();
  result.streams = streams_of(run, from);
  for (std::size_t p = 0; p < run.resolved().programs.size(); ++p)
    result.programs.push_back(result_of(run, p, TrueTime() + from));
  result.applications = applications_of(run, from);
  result.cpus = cpus_of(run, from);
  result.signals = signals_of(run, from);
  result.ports = ports_of(run, result.simulated);
  result.queues = queues_of(run);
  result.dropped = drops_of(run, from);
  result.clocks = clocks_of(run, from);
  result.grandmasters = grandmasters_of(result.clocks);
  result.gptp_links = gptp_links_of(run);
  result.clock_differences = clock_differences_of(run, from);
  result.ingress = ingress_of(run);
  result.redundancy = redundancy_of(run);
  return result;
}

/// The verdict of all that is required.
void conclude(RunResult& result) {
  result.verdict = result.partial ? Verdict::undecided : Verdict::pass;
  for (const RequirementResult& each : result.requirements)
    if (each.verdict == Verdict::fail || result.verdict == Verdict::pass) result.verdict = each.verdict;
  result.nothing_required = result.requirements.empty() && !result.partial;
}

/// The figures of every instant from which a requirement counts.
std::map<Duration, Figures> all_figures(const scenario::Run& run, bool partial) {
  std::map<Duration, Figures> all;
  for (const Duration from : run.instants()) all.emplace(from, Figures{collect(run, from, partial)});
  for (const scenario::RequiredFigure& required : run.resolved().requirements) {
    Figures& figures = all.at(required.from);
    if (figures.streams.empty())
      for (const StreamResult& each : figures.result.streams) figures.streams.emplace(each.name, &each);
    if (required.kind != RequirementKind::figure) continue;
    if (figures.node.kind == json::Kind::null) figures.node = run_node(figures.result);
    if (required.figure.steps.front() == "topology" && figures.node.find("topology") == nullptr)
      figures.node.add("topology", scenario::topology_node(run.resolved()));
  }
  return all;
}

}  // namespace

RunResult evaluate(const scenario::Run& run, bool partial) {
  const std::map<Duration, Figures> figures = all_figures(run, partial);
  RunResult result = figures.at(run.resolved().scenario.warm_up).result;
  for (const scenario::RequiredFigure& required : run.resolved().requirements)
    result.requirements.push_back(judge(run, required, figures.at(required.from), partial));
  for (const ProgramResult& program : result.programs)
    result.requirements.push_back(judge_invariants(program, partial));
  conclude(result);
  return result;
}

void keep_requirements(RunResult& result, const std::vector<bool>& asked) {
  TAKT_CHECK(asked.size() == result.requirements.size(), "what is asked for is said of each line of the result");
  std::vector<RequirementResult> kept;
  for (std::size_t i = 0; i < asked.size(); ++i)
    if (asked[i]) kept.push_back(std::move(result.requirements[i]));
  result.requirements = std::move(kept);
  conclude(result);
}

}  // namespace takt::evaluation
