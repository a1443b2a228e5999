#include "results/evaluate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "results/collect_applications.hpp"
#include "results/collect_clocks.hpp"
#include "results/collect_ingress.hpp"
#include "results/result_json.hpp"
#include "results/version.hpp"
#include "scenario/figures/requirement.hpp"
#include "scenario/topology/graph_figures.hpp"

namespace takt::results {
namespace {

using scenario::ResolvedProgram;

std::string kind_name(handshake::IntentKind kind) { return std::string(handshake::name_of(kind)); }

LatencySummary summary_of(const sim::Histogram& histogram) {
  return {histogram.minimum(),         histogram.mean(),    histogram.percentile(50, 100),
          histogram.percentile(99, 100), histogram.maximum(), histogram.standard_deviation()};
}

std::vector<RoundTripResult> round_trips_of(const scenario::ProgramMonitor& monitor, const ResolvedProgram& program) {
  std::vector<RoundTripResult> all;
  if (!monitor.round_trips()) return all;
  for (std::size_t i = 0; i < program.replies.size(); ++i) {
    const sim::Histogram& histogram = monitor.round_trips()->histogram(i);
    RoundTripResult one{program.process_data[program.replies[i].to].name, program.process_data[program.replies[i].with].name, histogram.count(), {}, {}, {}};
    if (!histogram.empty()) one.time = summary_of(histogram);
    if (const sim::Histogram& one_way = monitor.round_trips()->one_way(i); !one_way.empty()) one.one_way = summary_of(one_way);
    histogram.for_each_bucket([&](Duration from, Duration to, std::uint64_t n) { one.histogram.push_back({from, to, n}); });
    all.push_back(std::move(one));
  }
  return all;
}

StreamResult result_of(const models::Stream& stream, bool of_program) {
  StreamResult result;
  result.name = stream.name;
  result.of_program = of_program;
  result.listeners = stream.listeners;
  result.sent = stream.sent;
  result.copies = stream.copies;
  result.delivered = stream.delivered;
  result.in_flight = stream.in_flight();
  for (std::size_t reason = 0; reason < stream.dropped.size(); ++reason)
    if (stream.dropped[reason] > 0) result.dropped.emplace_back(models::name_of(static_cast<models::DropReason>(reason)), stream.dropped[reason]);
  if (!stream.latency.empty()) {
    result.latency = summary_of(stream.latency);
    stream.latency.for_each_bucket([&](Duration from, Duration to, std::uint64_t n) { result.histogram.push_back({from, to, n}); });
  }
  return result;
}

ReactionResult result_of(const handshake::Reaction& reaction, std::string initiator) {
  ReactionResult one;
  one.kind = kind_name(reaction.kind);
  one.initiator = std::move(initiator);
  one.cause = std::string(scenario::spelling(reaction.cause));
  one.began = reaction.began;
  if (reaction.outcome == handshake::ReactionOutcome::Completed) one.completed = reaction.completed;
  one.superseded = reaction.outcome == handshake::ReactionOutcome::Superseded;
  return one;
}

/// What the tree says whose outermost program this is.
void add_tree(const scenario::Run& run, std::size_t index, ProgramResult& result) {
  const auto name = [&](std::uint32_t program, std::uint8_t participant) {
    const ResolvedProgram& of = run.resolved().programs[program];
    return of.name + "/" + of.participant_names[participant];
  };
  for (const auto& tree : run.trees()) {
    if (tree->programs().front() != index) continue;
    for (const handshake::Reaction& reaction : tree->reactions()) {
      const auto [program, participant] = tree->initiator_of(reaction);
      result.tree_reactions.push_back(result_of(reaction, name(program, participant)));
    }
    for (const scenario::TreeMonitor::Violation& each : tree->violations())
      result.violations.push_back({each.time, std::string(handshake::name_of(each.violation.violation.invariant)) + " of the tree",
                                   name(tree->programs()[each.violation.group], each.violation.violation.participant),
                                   std::string(handshake::text_of(each.violation.violation.finding))});
  }
}

void add_timeline(const scenario::ProgramMonitor& monitor, TrueTime now, ProgramResult& result) {
  for (const scenario::ProgramFault& fault : monitor.faults()) {
    if (fault.at <= now) result.timeline.push_back({fault.at, 0, "", "", fault.text});
    if (fault.until <= now && !fault.end_text.empty()) result.timeline.push_back({fault.until, 0, "", "", fault.end_text});
  }
  for (const scenario::CallRecord& call : monitor.calls()) {
    std::string text = std::string(program::name_of(call.method));
    if (call.status != program::StatusCode::Good) text += " refused: " + std::string(program::name_of(call.status));
    result.timeline.push_back({call.time, call.participant, std::move(text), "", ""});
  }
  const auto is_death = [&](const scenario::StateRecord& record) {
    return record.change.transition == 0 && std::any_of(monitor.lives().begin(), monitor.lives().end(), [&](const scenario::LifeRecord& life) {
      return !life.is_back && life.time == record.time && life.participant == record.participant;
    });
  };
  for (const scenario::StateRecord& record : monitor.history())
    if (!is_death(record)) result.timeline.push_back({record.time, record.participant, "", std::string(handshake::name_of(record.change.to)), ""});
  for (const scenario::LifeRecord& life : monitor.lives()) result.timeline.push_back({life.time, life.participant, "", life.is_back ? "Halted" : "dead", ""});
  // What happens to the group stands before a call of the same instant, and both before the changes that they cause.
  const auto rank = [](const TimelineEntry& entry) { return !entry.fault.empty() ? 0 : !entry.call.empty() ? 1 : 2; };
  std::stable_sort(result.timeline.begin(), result.timeline.end(), [&](const TimelineEntry& a, const TimelineEntry& b) { return a.at != b.at ? a.at < b.at : rank(a) < rank(b); });
}

ProgramResult result_of(const scenario::Run& run, std::size_t index) {
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
  for (const handshake::Reaction& reaction : monitor.reactions()) result.reactions.push_back(result_of(reaction, result.participants[reaction.initiator]));
  for (const scenario::ViolationRecord& violation : monitor.violations())
    result.violations.push_back({violation.time, std::string(handshake::name_of(violation.violation.invariant)),
                                 result.participants[violation.violation.participant], std::string(handshake::text_of(violation.violation.finding))});
  add_tree(run, index, result);
  if (const scenario::PlugMonitor* const roles = run.roles(index))
    for (const scenario::BindingRecord& record : roles->history())
      result.bindings.push_back({record.time, program.participant_names[record.role + std::size_t{1}],
                                 record.candidate ? run.resolved().topology.nodes[program.candidates[*record.candidate].node.value].name : ""});
  result.violations_allowed = program.description->violations == scenario::Violations::reported;
  add_timeline(monitor, run.simulation().now(), result);
  result.changes = monitor.changes();
  result.process_data_received = monitor.process_data_received();
  result.round_trips = round_trips_of(monitor, program);
  return result;
}

std::uint64_t overruns_of(const models::EgressPort& port) {
  std::uint64_t sum = 0;
  for (models::TrafficClass q = 0; port.shaping() != nullptr && q < models::traffic_class_count; ++q) sum += port.shaping()->transmission_overrun(q);
  return sum;
}

/// By reason, in the order of DropReason.
std::vector<std::pair<std::string, std::uint64_t>> drops_of(const std::vector<models::Stream>& streams) {
  std::vector<std::pair<std::string, std::uint64_t>> drops;
  for (std::size_t reason = 0; reason < static_cast<std::size_t>(models::DropReason::count); ++reason) {
    std::uint64_t sum = 0;
    for (const models::Stream& stream : streams) sum += stream.dropped[reason];
    if (sum > 0) drops.emplace_back(models::name_of(static_cast<models::DropReason>(reason)), sum);
  }
  return drops;
}

std::vector<PortResult> ports_of(const scenario::Run& run, Duration simulated) {
  std::vector<PortResult> results;
  const models::NetworkPlan& plan = run.resolved().plan;
  for (const models::LinkPlan& link : plan.links) {
    const auto add = [&](const models::LinkPlan::End& from, const models::LinkPlan::End& to) {
      const models::EgressPort& port = run.network().ports(from.node)[from.port];
      if (port.frames_sent() == 0 && port.frames_dropped() == 0) return;
      const double busy = static_cast<double>(port.wire_octets_sent()) * static_cast<double>(link.rate.octet_time().ps());
      results.push_back({plan.nodes[from.node.value].name, from.port, plan.nodes[to.node.value].name, port.frames_sent(), port.frames_dropped(),
                         port.queues().peak_frames(), simulated > Duration() ? busy / static_cast<double>(simulated.ps()) : 0,
                         port.merge() == nullptr ? 0 : port.merge()->fragments_cut(), port.frames_cut_through(), port.bad_fcs_forwarded(), overruns_of(port)});
    };
    add(link.a, link.b);
    add(link.b, link.a);
  }
  return results;
}

/// Judges requirements against the result so far.
class Judge {
 public:
  explicit Judge(RunResult& result) : result_(result) {}

  void reaction(const scenario::Requirement& requirement) {
    RequirementResult verdict;
    const std::string kind(scenario::spelling(*requirement.reaction));
    verdict.kind = RequirementKind::reaction;
    verdict.subject = requirement.program.value_or("");
    verdict.reaction = kind;
    verdict.of_tree = requirement.tree;
    const std::string cause(requirement.cause ? scenario::spelling(*requirement.cause) : "");
    verdict.text = "reaction " + kind + (requirement.cause ? " because of a " + cause : "") + (requirement.tree ? " of the tree" : "") + (requirement.program ? " of " + *requirement.program : "") + " within " + json_text(*requirement.within);
    verdict.limit = *requirement.within;
    std::size_t seen = 0;
    std::size_t incomplete = 0;
    for (const ProgramResult& program : result_.programs) {
      if (requirement.program && program.name != *requirement.program) continue;
      for (const ReactionResult& one : requirement.tree ? program.tree_reactions : program.reactions) {
        if (one.kind != kind || one.superseded || (requirement.cause && one.cause != cause)) continue;
        ++seen;
        if (!one.completed)
          ++incomplete;
        else
          verdict.measured = std::max(verdict.measured.value_or(Duration()), *one.duration());
      }
    }
    verdict.remark = fmt::format("{} reaction{}", seen, seen == 1 ? "" : "s");
    if (verdict.measured && *verdict.measured > *verdict.limit) {
      verdict.verdict = Verdict::fail;
    } else if (seen == 0) {
      verdict.remark = "no such reaction";
      verdict.verdict = missing();
    } else if (incomplete > 0) {
      verdict.remark = fmt::format("{} of {} not complete at the end", incomplete, seen);
      verdict.verdict = missing();
    } else {
      verdict.verdict = held();
    }
    add(std::move(verdict));
  }

  void stream(const scenario::Requirement& requirement) {
    if (by_name_.empty())
      for (const StreamResult& each : result_.streams) by_name_.emplace(each.name, &each);
    const StreamResult& stream = *by_name_.at(*requirement.stream);
    if (requirement.latency) duration_of(stream, RequirementKind::latency, "latency", *requirement.latency, stream.latency ? std::optional(stream.latency->max) : std::nullopt);
    if (requirement.jitter)
      duration_of(stream, RequirementKind::jitter, "jitter", *requirement.jitter, stream.latency ? std::optional(stream.latency->max - stream.latency->min) : std::nullopt);
    if (requirement.dropped) {
      // Copies that sequence recovery takes out are what redundancy is for.
      std::uint64_t dropped = stream.dropped_in_all();
      for (const auto& [reason, count] : stream.dropped)
        if (reason == models::name_of(models::DropReason::duplicate)) dropped -= count;
      count_of(stream, RequirementKind::dropped, *requirement.dropped, fmt::format("stream {} drops at most {}", stream.name, *requirement.dropped),
               dropped <= *requirement.dropped ? held() : Verdict::fail, fmt::format("{} dropped", dropped));
    }
    if (requirement.delivered)
      count_of(stream, RequirementKind::delivered, *requirement.delivered, fmt::format("stream {} delivers at least {}", stream.name, *requirement.delivered),
               stream.delivered >= *requirement.delivered ? Verdict::pass : missing(), fmt::format("{} delivered", stream.delivered));
  }

  void sync(const scenario::Requirement& requirement, const scenario::ClockMonitor::Limit& seen) {
    RequirementResult verdict;
    verdict.kind = RequirementKind::sync;
    verdict.subject = requirement.node.value_or("");
    verdict.text = fmt::format("clock{} within {} of the grandmaster after {}", requirement.node ? " of " + *requirement.node : "s", json_text(*requirement.sync),
                               json_text(requirement.after));
    verdict.limit = *requirement.sync;
    if (seen.samples == 0) {
      verdict.remark = "not looked at";
      verdict.verdict = missing();
    } else {
      verdict.measured = seen.greatest;
      verdict.remark = fmt::format("{} samples", seen.samples);
      verdict.verdict = seen.greatest <= *requirement.sync ? held() : Verdict::fail;
    }
    add(std::move(verdict));
  }

  void application(const scenario::Requirement& requirement) {
    const auto found = std::find_if(result_.applications.begin(), result_.applications.end(), [&](const ApplicationResult& each) { return each.name == *requirement.application; });
    for (const ThreadResult& thread : found->threads) {
      if (requirement.thread && thread.name != *requirement.thread) continue;
      const std::string name = found->name + "/" + thread.name;
      if (requirement.success) percent_of(RequirementKind::success, name, "done in at least {:g} %", *requirement.success, thread.calls);
      if (requirement.buffered && thread.values) percent_of(RequirementKind::buffered, name, "values buffered, at least {:g} %", *requirement.buffered, *thread.values);
    }
  }

  void signal(const scenario::Requirement& requirement) {
    const auto found = std::find_if(result_.signals.begin(), result_.signals.end(), [&](const SignalResult& each) { return each.name == *requirement.signal; });
    RequirementResult verdict;
    verdict.kind = RequirementKind::irregular;
    verdict.subject = found->name;
    verdict.text = fmt::format("signal {}: at most {:g} % of its pulses irregular", found->name, *requirement.irregular);
    const std::optional<double> share = found->irregular_percent();
    verdict.remark = share ? fmt::format("{:.2f} % of {} pulses", *share, found->pulses->count) : std::string("no pulse");
    verdict.verdict = !share ? missing() : *share <= *requirement.irregular ? held() : Verdict::fail;
    add(std::move(verdict));
  }

  /// `result` is what the run leaves behind, as result.json has it. Of a run that was interrupted nothing can be said: a mean may fall again.
  void figure(const scenario::Requirement& requirement, const scenario::json::Node& result) {
    scenario::json::Diagnostics diagnostics;
    const auto asked = scenario::read_figure_requirement(requirement, diagnostics);
    TAKT_CHECK(asked, "a requirement that was resolved has a figure");
    const auto found = scenario::value_of(asked->figure, result);
    const char* const bound = asked->limit.is_upper ? "at most" : "at least";
    RequirementResult verdict;
    verdict.kind = RequirementKind::figure;
    verdict.figure = FigureResult{asked->name, asked->figure.unit, found, asked->limit.value, asked->limit.is_upper};
    verdict.text = fmt::format("figure {} {} {}", asked->name, bound, asked->limit.text);
    const std::optional<Duration> time = found && asked->figure.is_time ? std::optional(duration_of(*found, asked->figure)) : std::nullopt;
    verdict.remark = (!found                            ? std::string("the run has no such figure")
                      : time && !requirement.unit       ? "found " + json_text(*time)
                                                        : "found " + scenario::text_of(*found, asked->figure.unit)) +
                     fmt::format(", asked {} {}", bound, asked->limit.text);
    if (asked->figure.is_time && asked->limit.is_upper) {
      verdict.measured = time;
      verdict.limit = duration_of(asked->limit.value, asked->figure);
    }
    verdict.verdict = result_.partial ? Verdict::undecided : asked->limit.holds(found) ? Verdict::pass : Verdict::fail;
    add(std::move(verdict));
  }

  /// Every Program keeps its invariants, whether or not a requirement says so.
  void invariants(const ProgramResult& program) {
    RequirementResult verdict;
    verdict.kind = RequirementKind::invariants;
    verdict.subject = program.name;
    verdict.text = "program " + program.name + " keeps S1 to S5";
    if (program.violations_allowed) verdict.text += " (reported only)";
    verdict.remark = fmt::format("{} violation{}", program.violations.size(), program.violations.size() == 1 ? "" : "s");
    verdict.verdict = program.violations.empty() ? held() : program.violations_allowed ? Verdict::pass : Verdict::fail;
    add(std::move(verdict));
  }

 private:
  /// To the picosecond: what the division by the unit has made of a whole number of them, and of a mean the nearest.
  static Duration duration_of(double value, const scenario::Figure& figure) { return Duration::from_ps(std::llround(value * figure.divisor)); }
  static std::string json_text(Duration d) { return scenario::json::to_text(d); }
  Verdict held() const { return result_.partial ? Verdict::undecided : Verdict::pass; }
  Verdict missing() const { return result_.partial ? Verdict::undecided : Verdict::fail; }

  void duration_of(const StreamResult& stream, RequirementKind kind, const char* what, Duration limit, std::optional<Duration> measured) {
    RequirementResult verdict;
    verdict.kind = kind;
    verdict.subject = stream.name;
    verdict.text = fmt::format("stream {} {} at most {}", stream.name, what, json_text(limit));
    verdict.limit = limit;
    verdict.measured = measured;
    if (!measured) {
      verdict.remark = "nothing delivered";
      verdict.verdict = missing();
    } else {
      verdict.remark = fmt::format("{} frames", stream.delivered);
      verdict.verdict = *measured <= limit ? held() : Verdict::fail;
    }
    add(std::move(verdict));
  }

  void count_of(const StreamResult& stream, RequirementKind kind, std::uint64_t limit, std::string text, Verdict found, std::string remark) {
    RequirementResult verdict;
    verdict.kind = kind;
    verdict.subject = stream.name;
    verdict.count_limit = limit;
    verdict.text = std::move(text);
    verdict.verdict = found;
    verdict.remark = std::move(remark);
    add(std::move(verdict));
  }

  void percent_of(RequirementKind kind, const std::string& thread, const char* what, double limit, const CriterionResult& criterion) {
    RequirementResult verdict;
    verdict.kind = kind;
    verdict.subject = thread;
    verdict.text = fmt::format("thread {} ", thread) + fmt::format(fmt::runtime(what), limit);
    verdict.remark = criterion.percent ? fmt::format("{:.2f} % in {} tests", *criterion.percent, criterion.tests) : std::string("no test");
    verdict.verdict = !criterion.percent ? missing() : *criterion.percent >= limit ? held() : Verdict::fail;
    add(std::move(verdict));
  }

  void add(RequirementResult verdict) {
    if (verdict.verdict == Verdict::fail)
      result_.verdict = Verdict::fail;
    else if (verdict.verdict == Verdict::undecided && result_.verdict == Verdict::pass)
      result_.verdict = Verdict::undecided;
    result_.requirements.push_back(std::move(verdict));
  }

  RunResult& result_;
  std::map<std::string_view, const StreamResult*> by_name_;
};

}  // namespace

const char* name_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::pass: return "pass";
    case Verdict::fail: return "fail";
    case Verdict::undecided: return "undecided";
  }
  return "?";
}

namespace {

/// The result as JSON, without requirements and verdict; null if no requirement looks at it.
scenario::json::Node figures_of(const scenario::Run& run, const RunResult& result) {
  const auto& require = run.resolved().scenario.require;
  if (std::none_of(require.begin(), require.end(), [](const scenario::Requirement& r) { return r.figure.has_value(); })) return {};
  scenario::json::Node node = run_node(result);
  const auto is_of_graph = [](const scenario::Requirement& r) { return r.figure && (r.figure->starts_with("topology") || r.figure->starts_with("/topology")); };
  if (std::any_of(require.begin(), require.end(), is_of_graph)) node.add("topology", scenario::topology_node(run.resolved()));
  return node;
}

}  // namespace

RunResult evaluate(const scenario::Run& run, bool partial) {
  const scenario::Scenario& scenario = run.resolved().scenario;
  RunResult result;
  result.version = version;
  result.scenario = scenario.name;
  result.seed = scenario.seed;
  result.simulated = run.simulation().now().since_start();
  result.wanted = scenario.duration;
  result.partial = partial;
  result.digest = run.simulation().digest().value();
  result.events = run.simulation().event_count();
  result.verdict = partial ? Verdict::undecided : Verdict::pass;
  // Behind the streams of the scenario may stand that of gPTP.
  for (std::size_t s = 0; s < run.resolved().streams.size(); ++s)
    result.streams.push_back(result_of(run.network().traffic().streams()[s], run.resolved().streams[s].of_program));
  for (std::size_t p = 0; p < run.resolved().programs.size(); ++p) result.programs.push_back(result_of(run, p));
  result.applications = applications_of(run);
  result.signals = signals_of(run);
  result.ports = ports_of(run, result.simulated);
  result.dropped = drops_of(run.network().traffic().streams());
  result.clocks = clocks_of(run);
  result.ingress = ingress_of(run);
  result.redundancy = redundancy_of(run);

  const scenario::json::Node figures = figures_of(run, result);
  Judge judge(result);
  std::size_t next_limit = 0;  // of the clock monitor, in the order of the requirements
  for (const scenario::Requirement& requirement : scenario.require) {
    const std::size_t first = result.requirements.size();
    if (requirement.reaction)
      judge.reaction(requirement);
    else if (requirement.sync)
      judge.sync(requirement, run.clocks()->limits()[next_limit++]);
    else if (requirement.application)
      judge.application(requirement);
    else if (requirement.signal)
      judge.signal(requirement);
    else if (requirement.figure)
      judge.figure(requirement, figures);
    else
      judge.stream(requirement);
    for (std::size_t i = first; i < result.requirements.size(); ++i) result.requirements[i].requirement = static_cast<std::size_t>(&requirement - scenario.require.data());
  }
  for (const ProgramResult& program : result.programs) judge.invariants(program);
  return result;
}

}  // namespace takt::results
