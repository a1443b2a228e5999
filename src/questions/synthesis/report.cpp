// SPDX-License-Identifier: Apache-2.0
#include "synthesis/report.hpp"

#include <fmt/format.h>

#include "json/node.hpp"
#include "json/quantity.hpp"

namespace takt::synthesis {
namespace {

constexpr const char* verdicts[] = {"scheduled", "infeasible", "undecided"};

std::string verdict(const ScenarioSchedule& answer) { return verdicts[static_cast<std::size_t>(answer.verdict)]; }
std::vector<std::string> left_over(const ScenarioSchedule& answer) {
  std::vector<std::string> names;
  for (const schedule::LeftOver& each : answer.left_over) names.push_back(answer.instance->streams[each.stream].name);
  return names;
}
std::optional<std::string> proof(const ScenarioSchedule& answer) {
  return answer.proof.empty() ? std::nullopt : std::optional(answer.proof);
}
std::optional<sim::Duration> slack(const ScenarioSchedule& answer) {
  return answer.slack ? std::optional(answer.slack->margin) : std::nullopt;
}
std::optional<std::string> slack_end(const ScenarioSchedule& answer) {
  return answer.slack ? std::optional(answer.slack->with_more) : std::nullopt;
}
constexpr const char* states[] = {"kept", "broken", "unbounded"};
std::string state(const StreamRequirement& requirement) { return states[static_cast<std::size_t>(requirement.state)]; }
std::string in_us(sim::Duration time) { return fmt::format("{:.6g} us", static_cast<double>(time.ps()) / 1e6); }

/// Those that are not kept with the reason, the others with their bound.
std::string line_of(const StreamRequirement& requirement) {
  std::string text = fmt::format("  {}: {}", state(requirement), requirement.text);
  if (requirement.bound) text += ", the bound is " + in_us(*requirement.bound);
  if (requirement.simulated && requirement.limit && *requirement.simulated > *requirement.limit)
    text += ", " + in_us(*requirement.simulated) + " in its run";
  if (requirement.state == StreamRequirement::State::unbounded && !requirement.reason.empty())
    text += " (" + requirement.reason + ")";
  return text + "\n";
}

}  // namespace

const json::Record& describe(json::Type<StreamRequirement>) {
  static constexpr json::Output outputs[] = {
      json::output<&StreamRequirement::text>("requirement", "What is required, in words."),
      json::output<&StreamRequirement::stream>("stream", "Of which stream; * of all."),
      json::output<&state>("state",
                           "kept, broken (in the run, or the bound exceeds it, and some run may be better) or "
                           "unbounded (nothing is known)."),
      json::output<&StreamRequirement::bound>("bound_ps", "What is bounded, of a time; null if there is no bound."),
      json::output<&StreamRequirement::simulated>(
          "simulated_ps", "The greatest of a time in the run of the schedule; null if there was no run."),
      json::output<&StreamRequirement::limit>("limit_ps", "What is required, of a time."),
      json::output<&StreamRequirement::reason>("reason",
                                               "Why it is not kept; empty if it is, or if the bound says so."),
  };
  static constexpr json::Record record{
      "stream_requirement", "A required latency, jitter, loss or delivery of a stream, with windows or without.",
      outputs};
  return record;
}

const json::Record& describe(json::Type<JudgedStream>) {
  static constexpr json::Output outputs[] = {
      json::output<&JudgedStream::name>("stream", "Its name."),
      json::output<&JudgedStream::planned>("planned_ps",
                                           "Latency that the schedule promises from the release on, with the margin."),
      json::output<&JudgedStream::delivered>("delivered", "Frames that came in the run."),
      json::output<&JudgedStream::simulated>("simulated_ps", "The greatest latency of the run."),
      json::output<&JudgedStream::bound>("bound_ps", "The bound of its latency; null if there is none."),
  };
  static constexpr json::Record record{"scheduled_stream",
                                       "A stream with windows, as the simulator and the bound see it.", outputs};
  return record;
}

const json::Record& describe(json::Type<ScenarioSchedule>) {
  static constexpr json::Output outputs[] = {
      json::output<&verdict>("verdict", "scheduled, infeasible or undecided."),
      json::output<&ScenarioSchedule::how>("how",
                                           "With given paths or searched ones; of an undecided scenario what stood in "
                                           "the way; of an infeasible one the kind of its certificate."),
      json::output_if_any<&proof>("proof", "Why there is no schedule.", "infeasible"),
      json::output_if_any<&ScenarioSchedule::most_entries>("gate_entries", "Entries of the longest gate control list.",
                                                           "scheduled"),
      json::output_if_any<&ScenarioSchedule::clock_margin>(
          "clock_margin", "The margin \"auto\", and what it is made of.", "with \"margin\": \"auto\""),
      json::output_if_any<&slack>("slack_ps",
                                  "The greatest clock error that the schedule survives, with --objective slack.",
                                  "with --objective slack"),
      json::output_if_any<&slack_end>("slack_ends_because", "What is wrong with 1 ns more.", "with --objective slack"),
      json::output_if_any<&left_over>("left_over", "Streams that the best partial schedule leaves out.", "undecided"),
      json::output_if_any<&ScenarioSchedule::streams>("streams", "The streams with windows.", "scheduled"),
      json::output_if_any<&ScenarioSchedule::requirements>(
          "requirements",
          "What is required of streams; of an undecided scenario as the schedule that comes closest has it.",
          "with such requirements"),
      json::output<&ScenarioSchedule::placements>("placements",
                                                  "Schedules that were bounded until one kept what is required of "
                                                  "streams; 0 if nothing is, or if there is none."),
      json::output<&ScenarioSchedule::placement>(
          "placement",
          "How streams were placed in the one that the requirements are of: as soon as possible, spread at a port, "
          "drawn, on other ways; empty if none was bounded."),
  };
  static constexpr json::Record record{"scenario_schedule", "What became of a scenario.", outputs};
  return record;
}

std::string text_of(const std::string& name, const ScenarioSchedule& answer) {
  std::string text = fmt::format("{}: {}{}", name, verdict(answer), answer.how.empty() ? "" : " (" + answer.how + ")");
  if (answer.verdict != schedule::Decision::Verdict::scheduled) {
    text += "\n";
    if (!answer.proof.empty()) text += "  " + answer.proof + "\n";
    for (const StreamRequirement& each : answer.requirements) text += line_of(each);
    for (const std::string& each : left_over(answer)) text += "  left over: " + json::quote(each) + "\n";
    return text;
  }
  std::uint64_t frames = 0;
  std::size_t bounded = 0;
  for (const JudgedStream& each : answer.streams) {
    frames += each.delivered;
    bounded += each.bound ? 1 : 0;
  }
  text += fmt::format(", {} streams, at most {} gate entries\n", answer.streams.size(), answer.most_entries);
  text += fmt::format("  judged: the checker finds nothing; {} frames simulated, none lost; {} of {} streams bounded\n",
                      frames, bounded, answer.streams.size());
  if (answer.clock_margin) {
    const ClockMargin& clocks = *answer.clock_margin;
    text += fmt::format(
        "  margin {}: clocks on a way that differ by {}, and {} that oscillators drift in a period and on the way\n",
        in_us(clocks.margin), in_us(clocks.difference), in_us(clocks.on_the_way));
    text += fmt::format("    measured {} in {} runs from {} on, and {} that oscillators drift between looks; {}\n",
                        in_us(clocks.measured), clocks.seeds, json::to_text(clocks.from), in_us(clocks.between_looks),
                        clocks.required ? "required " + in_us(*clocks.required)
                                        : "the difference is a requirement \"clocks\" of the schedule");
  }
  if (answer.placements > 1)
    text += fmt::format("  placed {}, the first of {} schedules that keeps what is required of streams\n",
                        answer.placement, answer.placements);
  for (const StreamRequirement& each : answer.requirements) text += line_of(each);
  if (answer.slack)
    text += fmt::format("  clocks may differ by {}; with 1 ns more {}\n", in_us(answer.slack->margin),
                        answer.slack->with_more);
  text += fmt::format("  {:32} {:>14} {:>14} {:>14}\n", "stream", "planned", "simulated", "bound");
  for (const JudgedStream& each : answer.streams)
    text += fmt::format("  {:32} {:>14} {:>14} {:>14}\n", each.name, in_us(each.planned), in_us(each.simulated),
                        each.bound ? in_us(*each.bound) : "-");
  return text;
}

}  // namespace takt::synthesis
