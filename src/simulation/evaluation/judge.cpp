// SPDX-License-Identifier: Apache-2.0
#include "evaluation/judge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "evaluation/misses.hpp"
#include "json/quantity.hpp"

namespace takt::evaluation {

using namespace results;
namespace {

using json::to_text;

/// What a run shows of a time.
struct Times {
  std::optional<Duration> longest;
  std::optional<Duration> shortest;
  std::optional<Duration> coming;  ///< what has not ended yet takes at least so long
  std::string counted;             ///< the remark: "7 frames"
  std::string none;                ///< ... if there is no longest
  std::string while_coming;        ///< ... if what is coming exceeds the limit
  std::string lost;                ///< ... if it fails for what never ends; else empty
};

class Judge {
 public:
  Judge(const scenario::Run& run, const scenario::RequiredFigure& required, const Figures& figures, bool partial)
      : run_(run),
        required_(required),
        figures_(figures),
        held_(partial ? Verdict::undecided : Verdict::pass),
        missing_(partial ? Verdict::undecided : Verdict::fail),
        partial_(partial) {}

  RequirementResult made() {
    verdict_.kind = required_.kind;
    verdict_.taken_as = required_.taken_as;
    verdict_.requirement = static_cast<std::size_t>(&required_ - run_.resolved().requirements.data());
    verdict_.subject = required_.subject;
    verdict_.name = required_.name;
    verdict_.text = required_.text;
    verdict_.limit = required_.longest;
    verdict_.least_limit = required_.shortest;
    verdict_.from = required_.from;
    switch (required_.kind) {
      case RequirementKind::reaction:
        reaction(*scenario::reaction_of(required_.figure));
        break;
      case RequirementKind::latency:
        latency(stream());
        break;
      case RequirementKind::jitter:
        jitter(stream());
        break;
      case RequirementKind::dropped:
        dropped(stream());
        break;
      case RequirementKind::delivered:
        delivered(stream());
        break;
      case RequirementKind::sync:
        required_.subject.empty() ? sync_of_all() : sync_of_node();
        break;
      case RequirementKind::clocks:
        clocks();
        break;
      case RequirementKind::success:
        percent(thread().calls);
        break;
      case RequirementKind::buffered:
        percent(*thread().values);
        break;
      case RequirementKind::irregular:
        irregular();
        break;
      case RequirementKind::lost_in_a_row:
      case RequirementKind::late_in_a_row:
      case RequirementKind::met:
        in_a_row();
        break;
      case RequirementKind::figure:
        figure();
        break;
      case RequirementKind::invariants:
        break;
    }
    return std::move(verdict_);
  }

 private:
  const StreamResult& stream() const { return *figures_.streams.at(required_.subject); }
  const ThreadResult& thread() const {
    const ApplicationResult& application =
        *std::ranges::find(figures_.result.applications, required_.figure.steps[1], &ApplicationResult::name);
    return *std::ranges::find(application.threads, required_.figure.steps[3], &ThreadResult::name);
  }

  /// By Program: those that are asked about.
  std::vector<std::vector<const ReactionResult*>> reactions_of(const scenario::AskedReaction& asked) const {
    const std::string_view kind = scenario::spelling(asked.kind);
    const std::string_view cause = asked.cause ? scenario::spelling(*asked.cause) : "";
    std::vector<std::vector<const ReactionResult*>> all;
    for (const ProgramResult& program : figures_.result.programs) {
      if (asked.program && program.name != *asked.program) continue;
      all.emplace_back();
      for (const ReactionResult& one : asked.of_tree ? program.tree_reactions : program.reactions) {
        if (one.kind != kind || one.superseded || (asked.cause && one.cause != cause)) continue;
        all.back().push_back(&one);
      }
    }
    return all;
  }

  void reaction(const scenario::AskedReaction& asked) {
    Times times;
    std::size_t seen = 0;
    std::size_t incomplete = 0;
    for (const std::vector<const ReactionResult*>& of_program : reactions_of(asked))
      for (const ReactionResult* const each : of_program) {
        const ReactionResult& one = *each;
        ++seen;
        if (one.completed) {
          times.longest = std::max(times.longest.value_or(Duration()), *one.duration());
          continue;
        }
        ++incomplete;
        // It takes longer than it has been going on for. Young as it is, it shows nothing.
        const Duration lasted = figures_.result.simulated - one.began.since_start();
        if (lasted > *required_.longest) times.coming = std::max(times.coming.value_or(Duration()), lasted);
      }
    times.counted = incomplete > 0 ? fmt::format("{} of {} not complete at the end", incomplete, seen)
                                   : fmt::format("{} reaction{}", seen, seen == 1 ? "" : "s");
    times.while_coming = times.counted;
    times.none = seen == 0 ? "no such reaction" : times.counted;
    judge(times);
  }

  /// Of frames or of reactions: which, when they began, and how many.
  void in_a_row() {
    const bool is_of_reactions = required_.figure.steps.front() == "programs";
    const Misses found = is_of_reactions ? misses_of_reactions() : misses_of_frames();
    const bool is_met = required_.kind == RequirementKind::met;
    const double value =
        static_cast<double>(is_met ? required_.of - std::min(required_.of, found.in_window) : found.in_a_row);
    const std::string what = is_of_reactions ? "reactions" : "frames";
    verdict_.figure = FigureResult{scenario::misses_name(required_), what, value, required_.limit.value,
                                   required_.limit.is_upper(),       {}};
    const std::string remark =
        is_met ? fmt::format("{:g} of the worst {} met; {} of {} {} missed", value, required_.of, found.missed,
                             found.counted, what)
               : fmt::format("{:g} in a row; {} of {} {} in all", value, found.missed, found.counted, what);
    if (found.counted > 0 || required_.kind == RequirementKind::lost_in_a_row) return judge(value, remark);
    verdict_.verdict = missing_;
    verdict_.remark = is_of_reactions ? "no such reaction" : "nothing sent";
  }

  Misses misses_of_frames() const {
    const auto& streams = run_.resolved().plan.streams;
    const auto index = static_cast<std::uint32_t>(
        std::ranges::find(streams, required_.subject, &models::StreamPlan::name) - streams.begin());
    return misses_of(run_, models::StreamIndex{index}, stream().sent, required_.deadline.value_or(Duration::max()),
                     required_.of);
  }

  /// Of each Program by itself. One that goes on and is not late yet is none of either.
  Misses misses_of_reactions() const {
    Misses most;
    for (const std::vector<const ReactionResult*>& of_program :
         reactions_of(*scenario::reaction_of(required_.figure))) {
      std::vector<bool> missed;
      for (const ReactionResult* const one : of_program) {
        const Duration lasted = one->duration().value_or(figures_.result.simulated - one->began.since_start());
        if (one->completed || lasted > *required_.deadline) missed.push_back(lasted > *required_.deadline);
      }
      most.take(misses_of(missed, required_.of));
    }
    return most;
  }

  /// A frame that is under way will have been so for at least as long when it comes: the latency is never less than
  /// this.
  void latency(const StreamResult& stream) {
    Times times = of_frames(stream);
    if (stream.latency) {
      times.longest = stream.latency->max;
      times.shortest = stream.latency->min;
    }
    times.coming = stream.oldest_in_flight;
    judge(times);
  }

  void jitter(const StreamResult& stream) {
    Times times = of_frames(stream);
    if (stream.latency) {
      times.longest = times.shortest = stream.latency->max - stream.latency->min;
      if (stream.oldest_in_flight && *stream.oldest_in_flight > stream.latency->min)
        times.coming = *stream.oldest_in_flight - stream.latency->min;
    }
    judge(times);
  }

  Times of_frames(const StreamResult& stream) const {
    Times times;
    times.counted = fmt::format("{} frames", stream.delivered);
    times.none = "nothing delivered";
    if (stream.oldest_in_flight)
      times.while_coming = fmt::format("{} frames came; one has been under way for {} at the end", stream.delivered,
                                       to_text(*stream.oldest_in_flight));
    if (stream.lost > 0 && !scenario::requires_losses_separately(run_.resolved(), stream.name, required_.from))
      times.lost = fmt::format("{} frames came, {} lost and so late for ever; \"dropped\" says how many may be",
                               stream.delivered, stream.lost);
    return times;
  }

  const std::string& name_of(models::NodeIndex node) const { return run_.network().plan().nodes[node.value].name; }

  /// The distance to one grandmaster says nothing where nodes follow several: then that to the farthest of them counts.
  void sync_of_all() {
    const scenario::GrandmasterDistances& seen = run_.clocks()->distances().from(required_.from);
    Times times = of_looks(seen.samples, seen.greatest);
    if (seen.greatest > Duration())
      times.counted += fmt::format(", the greatest between {} and {} at {}", name_of(seen.node),
                                   name_of(seen.grandmaster), to_text(seen.at.since_start()));
    judge(times);
    judge_partings(run_.clocks()->partings());
  }

  void sync_of_node() {
    const auto& clocks = run_.clocks()->figures();
    const auto clock = std::ranges::find_if(
        clocks, [&](const scenario::ClockFigures& each) { return name_of(each.node) == required_.subject; });
    if (clock == clocks.end()) return judge(of_looks(0, {}));
    const scenario::ClockFigures::Distances& seen = clock->distances.from(required_.from);
    Times times = of_looks(seen.samples, seen.greatest);
    if (seen.greatest > Duration())
      times.counted += fmt::format(", the greatest at {}", to_text(seen.at.since_start()));
    judge(times);
    judge_partings(clock->alone);
  }

  void clocks() {
    const auto seen =
        std::ranges::find(figures_.result.clock_differences, required_.subject, &ClockDifferenceResult::name);
    Times times = of_looks(seen->samples, seen->greatest.value_or(Duration()));
    if (times.longest && *times.longest > Duration())
      times.counted +=
          fmt::format(", {} ahead of {} at {}", seen->ahead, seen->behind, to_text(seen->at->since_start()));
    judge(times);
  }

  static Times of_looks(std::uint64_t samples, Duration greatest) {
    Times times;
    if (samples > 0) times.longest = greatest;
    times.counted = fmt::format("{} samples", samples);
    times.none = "not looked at";
    return times;
  }

  /// Clocks that nothing holds together drift apart: how near they are in this run decides nothing.
  void judge_partings(const std::vector<scenario::Parting>& partings) {
    const auto found = std::ranges::find_if(partings, [&](const scenario::Parting& each) {
      return !each.until || each.until->since_start() > required_.from;
    });
    if (found == partings.end()) return;
    const std::string whom = !found->grandmaster                  ? "nobody"
                             : *found->grandmaster == found->node ? "itself"
                                                                  : name_of(*found->grandmaster);
    std::string words =
        !found->leader ? "no node can be grandmaster"
                       : fmt::format("{} follows {} and not {}", name_of(found->node), whom, name_of(*found->leader));
    words += fmt::format(", from {} {}", to_text(found->from.since_start()),
                         found->until ? "to " + to_text(found->until->since_start()) : std::string("on"));
    verdict_.remark = words + "; " + verdict_.remark;
    if (verdict_.verdict == Verdict::pass) verdict_.verdict = Verdict::undecided;
  }

  void judge(const Times& times) {
    const Duration limit = *required_.longest;
    verdict_.measured = times.coming ? std::max(times.coming, times.longest) : times.longest;
    if (required_.shortest) verdict_.least_measured = times.shortest;
    verdict_.remark = times.counted;
    if (times.longest && *times.longest > limit) {
      verdict_.verdict = Verdict::fail;
    } else if (times.coming && *times.coming > limit) {
      verdict_.verdict = Verdict::fail;
      verdict_.remark = times.while_coming;
    } else if (!times.longest) {
      verdict_.verdict = missing_;
      verdict_.remark = times.none;
      verdict_.measured.reset();
    } else if (required_.shortest && *times.shortest < *required_.shortest) {
      verdict_.verdict = Verdict::fail;
      verdict_.remark = fmt::format("{}, the least is {}", times.counted, to_text(*times.shortest));
    } else if (!times.lost.empty()) {
      verdict_.verdict = Verdict::fail;
      verdict_.remark = times.lost;
    } else {
      verdict_.verdict = held_;
    }
  }

  void judge(const std::optional<double>& found, std::string remark) {
    verdict_.remark = std::move(remark);
    verdict_.verdict = !found ? missing_ : required_.limit.holds(found) ? held_ : Verdict::fail;
  }

  void dropped(const StreamResult& stream) {
    judge(static_cast<double>(stream.lost),
          !stream.has_copies ? fmt::format("{} dropped", stream.lost)
                             : fmt::format("{} lost; {} copies dropped", stream.lost, stream.dropped_in_all()));
  }

  /// Frames that have come stay so; more may come.
  void delivered(const StreamResult& stream) {
    verdict_.remark = fmt::format("{} delivered", stream.delivered);
    verdict_.verdict = required_.limit.holds(static_cast<double>(stream.delivered)) ? Verdict::pass : missing_;
  }

  void percent(const CriterionResult& criterion) {
    judge(criterion.percent,
          criterion.percent ? fmt::format("{:.2f} % in {} tests", *criterion.percent, criterion.tests) : "no test");
  }

  void irregular() {
    const SignalResult& signal = *std::ranges::find(figures_.result.signals, required_.subject, &SignalResult::name);
    const std::optional<double> share = signal.irregular_percent();
    judge(share, share ? fmt::format("{:.2f} % of {} pulses", *share, signal.pulses->count) : "no pulse");
  }

  /// Of a run that was interrupted nothing can be said: a mean may fall again.
  void figure() {
    const scenario::Figure& asked = required_.figure;
    const scenario::FigureLimit& limit = required_.limit;
    const auto found = scenario::value_of(asked, figures_.node);
    verdict_.figure = FigureResult{required_.figure_name, asked.unit, found, limit.value, limit.is_upper(), {}};
    if (limit.relation == scenario::Relation::equal) verdict_.figure->within = limit.within;
    // To the picosecond: what the division by the unit has made of a whole number of them, and of a mean the nearest.
    const std::optional<Duration> time =
        found && asked.is_time ? std::optional(Duration::from_ps(std::llround(*found * asked.divisor))) : std::nullopt;
    if (required_.longest) verdict_.measured = time;
    const std::string value =
        !found ? "the run has no such figure"
               : "found " + (time && !required_.has_unit ? to_text(*time) : scenario::text_of(*found, asked.unit));
    verdict_.remark = fmt::format("{}, asked {} {}", value, scenario::text_of(limit.relation), limit.text);
    verdict_.verdict = partial_ ? Verdict::undecided : limit.holds(found) ? Verdict::pass : Verdict::fail;
  }

  const scenario::Run& run_;
  const scenario::RequiredFigure& required_;
  const Figures& figures_;
  Verdict held_;
  Verdict missing_;
  bool partial_;
  RequirementResult verdict_;
};

}  // namespace

RequirementResult judge(const scenario::Run& run, const scenario::RequiredFigure& required, const Figures& figures,
                        bool partial) {
  return Judge(run, required, figures, partial).made();
}

RequirementResult judge_invariants(const ProgramResult& program, bool partial) {
  RequirementResult verdict;
  verdict.kind = verdict.taken_as = RequirementKind::invariants;
  verdict.subject = program.name;
  verdict.text = scenario::invariants_text(program.name, program.violations_allowed);
  verdict.remark = fmt::format("{} violation{}", program.violations.size(), program.violations.size() == 1 ? "" : "s");
  const bool may_come = partial && program.violations.empty();
  verdict.verdict = may_come                                                   ? Verdict::undecided
                    : program.violations.empty() || program.violations_allowed ? Verdict::pass
                                                                               : Verdict::fail;
  return verdict;
}

}  // namespace takt::evaluation
