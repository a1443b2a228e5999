#include "evaluation/evaluate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "evaluation/collect_applications.hpp"
#include "evaluation/collect_clocks.hpp"
#include "evaluation/collect_ingress.hpp"
#include "evaluation/collect_streams.hpp"
#include "evaluation/judge_streams.hpp"
#include "results/result_json.hpp"
#include "results/version.hpp"
#include "scenario/figures/requirement.hpp"
#include "scenario/figures/requirement_rules.hpp"
#include "scenario/run/accounts.hpp"
#include "scenario/topology/graph_figures.hpp"

namespace takt::evaluation {

using namespace results;
namespace {

using scenario::ResolvedProgram;

std::string kind_name(handshake::IntentKind kind) { return std::string(handshake::name_of(kind)); }

std::vector<RoundTripResult> round_trips_of(const scenario::ProgramMonitor& monitor, const ResolvedProgram& program, Duration from) {
  std::vector<RoundTripResult> all;
  if (!monitor.round_trips()) return all;
  for (std::size_t i = 0; i < program.replies.size(); ++i) {
    const scenario::RoundTrips::Times& times = monitor.round_trips()->times(i, from);
    const sim::Histogram& histogram = times.round_trips;
    RoundTripResult one{program.process_data[program.replies[i].to].name, program.process_data[program.replies[i].with].name, histogram.count(), {}, {}, {}};
    if (!histogram.empty()) one.time = summary_of(histogram);
    if (!times.one_way.empty()) one.one_way = summary_of(times.one_way);
    histogram.for_each_bucket([&](Duration low, Duration high, std::uint64_t n) { one.histogram.push_back({low, high, n}); });
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
  if (reaction.outcome == handshake::ReactionOutcome::Completed) one.completed = reaction.completed;
  one.superseded = reaction.outcome == handshake::ReactionOutcome::Superseded;
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
      result.violations.push_back({each.time, std::string(handshake::name_of(each.violation.invariant)) + " of the tree",
                                   name(tree->programs()[each.violation.group], each.violation.participant),
                                   std::string(handshake::text_of(each.violation.finding))});
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
    if (reaction.began >= from) result.reactions.push_back(result_of(reaction, result.participants[reaction.initiator]));
  for (const scenario::ViolationRecord& violation : monitor.violations())
    result.violations.push_back({violation.time, std::string(handshake::name_of(violation.violation.invariant)),
                                 result.participants[violation.violation.participant], std::string(handshake::text_of(violation.violation.finding))});
  add_tree(run, index, from, result);
  if (const scenario::PlugMonitor* const roles = run.roles(index))
    for (const scenario::BindingRecord& record : roles->history())
      result.bindings.push_back({record.time, program.participant_names[record.role + std::size_t{1}],
                                 record.candidate ? run.resolved().topology.nodes[program.candidates[*record.candidate].node.value].name : ""});
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
  for (models::TrafficClass q = 0; port.shaping() != nullptr && q < models::traffic_class_count; ++q) sum += port.shaping()->transmission_overrun(q);
  return sum;
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

/// What a run shows from an instant on, in the ways in which requirements ask for it.
struct Figures {
  RunResult result;                                        // without verdicts
  json::Node node = {};                          // as result.json has it, if a requirement asks for a figure
  std::map<std::string_view, const StreamResult*> streams = {};  // by name, if a requirement is on a stream
};

/// Judges requirements, each by what began when it says.
class Judge {
 public:
  explicit Judge(RunResult& result) : result_(result) {}
  /// What the next requirements are judged by.
  void look_at(const Figures& figures) { figures_ = &figures; }

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
    for (const ProgramResult& program : figures_->result.programs) {
      if (requirement.program && program.name != *requirement.program) continue;
      for (const ReactionResult& one : requirement.tree ? program.tree_reactions : program.reactions) {
        if (one.kind != kind || one.superseded || (requirement.cause && one.cause != cause)) continue;
        ++seen;
        // One that is not complete takes longer than it has been going on for.
        const Duration lasted = one.completed ? *one.duration() : figures_->result.simulated - one.began.since_start();
        if (!one.completed) ++incomplete;
        if (one.completed || lasted > *verdict.limit) verdict.measured = std::max(verdict.measured.value_or(Duration()), lasted);
      }
    }
    verdict.remark = incomplete > 0 ? fmt::format("{} of {} not complete at the end", incomplete, seen) : fmt::format("{} reaction{}", seen, seen == 1 ? "" : "s");
    if (verdict.measured && *verdict.measured > *verdict.limit) {
      verdict.verdict = Verdict::fail;
    } else if (seen == 0) {
      verdict.remark = "no such reaction";
      verdict.verdict = missing();
    } else if (incomplete == seen) {
      verdict.verdict = missing();   // young as they are, none shows that there is an end to it
    } else {
      verdict.verdict = held();
    }
    add(std::move(verdict));
  }

  void stream(const scenario::Scenario& scenario, const scenario::Requirement& requirement) {
    for (RequirementResult& verdict : judge_stream(scenario, requirement, *figures_->streams.at(*requirement.stream), result_.partial)) add(std::move(verdict));
  }

  void sync(const scenario::Requirement& requirement, Duration from, const scenario::ClockMonitor::Limit& seen) {
    RequirementResult verdict;
    verdict.kind = RequirementKind::sync;
    verdict.subject = requirement.node.value_or("");
    verdict.text = fmt::format("clock{} within {} of the grandmaster after {}", requirement.node ? " of " + *requirement.node : "s", json_text(*requirement.sync),
                               json_text(from));
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
    const auto found = std::find_if(figures_->result.applications.begin(), figures_->result.applications.end(), [&](const ApplicationResult& each) { return each.name == *requirement.application; });
    for (const ThreadResult& thread : found->threads) {
      if (requirement.thread && thread.name != *requirement.thread) continue;
      const std::string name = found->name + "/" + thread.name;
      if (requirement.success) percent_of(RequirementKind::success, name, "done in at least {:g} %", *requirement.success, thread.calls);
      if (requirement.buffered && thread.values) percent_of(RequirementKind::buffered, name, "values buffered, at least {:g} %", *requirement.buffered, *thread.values);
    }
  }

  void signal(const scenario::Requirement& requirement) {
    const auto found = std::find_if(figures_->result.signals.begin(), figures_->result.signals.end(), [&](const SignalResult& each) { return each.name == *requirement.signal; });
    RequirementResult verdict;
    verdict.kind = RequirementKind::irregular;
    verdict.subject = found->name;
    verdict.text = fmt::format("signal {}: at most {:g} % of its pulses irregular", found->name, *requirement.irregular);
    const std::optional<double> share = found->irregular_percent();
    verdict.remark = share ? fmt::format("{:.2f} % of {} pulses", *share, found->pulses->count) : std::string("no pulse");
    verdict.verdict = !share ? missing() : *share <= *requirement.irregular ? held() : Verdict::fail;
    add(std::move(verdict));
  }

  /// Of a run that was interrupted nothing can be said: a mean may fall again.
  void figure(const scenario::Requirement& requirement) {
    json::Diagnostics diagnostics;
    const auto asked = scenario::read_figure_requirement(requirement, diagnostics);
    TAKT_CHECK(asked, "a requirement that was resolved has a figure");
    const auto found = scenario::value_of(asked->figure, figures_->node);
    const char* const bound = scenario::text_of(asked->limit.relation);
    RequirementResult verdict;
    verdict.kind = RequirementKind::figure;
    verdict.figure = FigureResult{asked->name, asked->figure.unit, found, asked->limit.value, asked->limit.is_upper(), {}};
    if (asked->limit.relation == scenario::Relation::equal) verdict.figure->within = asked->limit.within;
    verdict.text = fmt::format("figure {} {} {}", asked->name, bound, asked->limit.text);
    const std::optional<Duration> time = found && asked->figure.is_time ? std::optional(duration_of(*found, asked->figure)) : std::nullopt;
    verdict.remark = (!found                            ? std::string("the run has no such figure")
                      : time && !requirement.unit       ? "found " + json_text(*time)
                                                        : "found " + scenario::text_of(*found, asked->figure.unit)) +
                     fmt::format(", asked {} {}", bound, asked->limit.text);
    if (asked->figure.is_time && asked->limit.is_upper()) {
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
  static std::string json_text(Duration d) { return json::to_text(d); }
  Verdict held() const { return result_.partial ? Verdict::undecided : Verdict::pass; }
  Verdict missing() const { return result_.partial ? Verdict::undecided : Verdict::fail; }

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
  const Figures* figures_ = nullptr;
};

bool asks_for_graph(const scenario::Requirement& requirement) {
  return requirement.figure && (requirement.figure->starts_with("topology") || requirement.figure->starts_with("/topology"));
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
  result.verdict = partial ? Verdict::undecided : Verdict::pass;
  result.streams = streams_of(run, from);
  for (std::size_t p = 0; p < run.resolved().programs.size(); ++p) result.programs.push_back(result_of(run, p, TrueTime() + from));
  result.applications = applications_of(run, from);
  result.signals = signals_of(run, from);
  result.ports = ports_of(run, result.simulated);
  result.dropped = drops_of(run, from);
  result.clocks = clocks_of(run, from);
  result.ingress = ingress_of(run);
  result.redundancy = redundancy_of(run);
  return result;
}

/// The figures of every instant from which a requirement counts.
std::map<Duration, Figures> all_figures(const scenario::Run& run, bool partial) {
  const scenario::Scenario& scenario = run.resolved().scenario;
  std::map<Duration, Figures> all;
  for (const Duration from : run.instants()) all.emplace(from, Figures{collect(run, from, partial)});
  for (const scenario::Requirement& requirement : scenario.require) {
    Figures& figures = all.at(scenario::counts_from(scenario, requirement));
    if (requirement.stream && figures.streams.empty())
      for (const StreamResult& each : figures.result.streams) figures.streams.emplace(each.name, &each);
    if (!requirement.figure) continue;
    if (figures.node.kind == json::Kind::null) figures.node = run_node(figures.result);
    if (asks_for_graph(requirement) && figures.node.find("topology") == nullptr) figures.node.add("topology", scenario::topology_node(run.resolved()));
  }
  return all;
}

}  // namespace

RunResult evaluate(const scenario::Run& run, bool partial) {
  const scenario::Scenario& scenario = run.resolved().scenario;
  const std::map<Duration, Figures> figures = all_figures(run, partial);
  RunResult result = figures.at(scenario.warm_up).result;
  Judge judge(result);
  std::size_t next_limit = 0;  // of the clock monitor, in the order of the requirements
  for (const scenario::Requirement& requirement : scenario.require) {
    const std::size_t first = result.requirements.size();
    const Duration from = scenario::counts_from(scenario, requirement);
    judge.look_at(figures.at(from));
    if (requirement.reaction)
      judge.reaction(requirement);
    else if (requirement.sync)
      judge.sync(requirement, from, run.clocks()->limits()[next_limit++]);
    else if (requirement.application)
      judge.application(requirement);
    else if (requirement.signal)
      judge.signal(requirement);
    else if (requirement.figure)
      judge.figure(requirement);
    else
      judge.stream(scenario, requirement);
    for (std::size_t i = first; i < result.requirements.size(); ++i) {
      RequirementResult& made = result.requirements[i];
      made.requirement = static_cast<std::size_t>(&requirement - scenario.require.data());
      made.from = from;
      if (from > Duration() && !requirement.sync) made.text += " after " + json::to_text(from);
    }
  }
  for (const ProgramResult& program : result.programs) judge.invariants(program);
  result.nothing_required = result.requirements.empty() && !partial;
  return result;
}

}  // namespace takt::evaluation
