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
std::optional<sim::Duration> slack(const ScenarioSchedule& answer) { return answer.slack ? std::optional(answer.slack->margin) : std::nullopt; }
std::optional<std::string> slack_end(const ScenarioSchedule& answer) { return answer.slack ? std::optional(answer.slack->with_more) : std::nullopt; }
std::string in_us(sim::Duration time) { return fmt::format("{:.6g} us", static_cast<double>(time.ps()) / 1e6); }

}  // namespace

const json::Record& describe(json::Type<JudgedStream>) {
  static constexpr json::Output outputs[] = {
      json::output<&JudgedStream::name>("stream", "Its name."),
      json::output<&JudgedStream::planned>("planned_ps", "Latency that the schedule promises from the release on, with the margin."),
      json::output<&JudgedStream::delivered>("delivered", "Frames that came in the run."),
      json::output<&JudgedStream::simulated>("simulated_ps", "The greatest latency of the run."),
      json::output<&JudgedStream::bound>("bound_ps", "The bound of its latency; null if there is none."),
  };
  static constexpr json::Record record{"scheduled_stream", "A stream with windows, as the simulator and the bound see it.", outputs};
  return record;
}

const json::Record& describe(json::Type<ScenarioSchedule>) {
  static constexpr json::Output outputs[] = {
      json::output<&verdict>("verdict", "scheduled, infeasible or undecided."),
      json::output<&ScenarioSchedule::how>("how", "With given paths or searched ones; of an undecided scenario what stood in the way."),
      json::output_if_any<&ScenarioSchedule::most_entries>("gate_entries", "Entries of the longest gate control list.", "scheduled"),
      json::output_if_any<&ScenarioSchedule::clock_margin>("clock_margin", "The margin \"auto\", and what it is made of.", "with \"margin\": \"auto\""),
      json::output_if_any<&slack>("slack_ps", "The greatest clock error that the schedule survives, with --objective slack.", "with --objective slack"),
      json::output_if_any<&slack_end>("slack_ends_because", "What is wrong with 1 ns more.", "with --objective slack"),
      json::output_if_any<&left_over>("left_over", "Streams that the best partial schedule leaves out.", "undecided"),
      json::output_if_any<&ScenarioSchedule::streams>("streams", "The streams with windows.", "scheduled"),
  };
  static constexpr json::Record record{"scenario_schedule", "What became of a scenario.", outputs};
  return record;
}

std::string text_of(const std::string& name, const ScenarioSchedule& answer) {
  std::string text = fmt::format("{}: {}{}", name, verdict(answer), answer.how.empty() ? "" : " (" + answer.how + ")");
  if (answer.verdict != schedule::Decision::Verdict::scheduled) {
    text += "\n";
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
  text += fmt::format("  judged: the checker finds nothing; {} frames simulated, none lost; {} of {} streams bounded\n", frames, bounded, answer.streams.size());
  if (answer.clock_margin) {
    const ClockMargin& clocks = *answer.clock_margin;
    text += fmt::format("  margin {}: twice an error of {}, and {} that oscillators drift in a period and on the way\n", in_us(clocks.margin), in_us(clocks.error), in_us(clocks.on_the_way));
    text += fmt::format("    measured {} in {} runs from {} on, and {} that oscillators drift between looks; {}\n", in_us(clocks.measured), clocks.seeds, json::to_text(clocks.from), in_us(clocks.between_looks),
                        clocks.required ? "required " + in_us(*clocks.required) : "the error is a requirement \"sync\" of the schedule");
  }
  if (answer.slack) text += fmt::format("  clocks may differ by {}; with 1 ns more {}\n", in_us(answer.slack->margin), answer.slack->with_more);
  text += fmt::format("  {:32} {:>14} {:>14} {:>14}\n", "stream", "planned", "simulated", "bound");
  for (const JudgedStream& each : answer.streams) text += fmt::format("  {:32} {:>14} {:>14} {:>14}\n", each.name, in_us(each.planned), in_us(each.simulated), each.bound ? in_us(*each.bound) : "-");
  return text;
}

}  // namespace takt::synthesis
