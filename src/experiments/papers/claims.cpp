// SPDX-License-Identifier: Apache-2.0
#include "papers/claims.hpp"

#include <fmt/format.h>

#include "evaluation/evaluate.hpp"
#include "papers/published.hpp"
#include "scenario/resolve.hpp"

namespace takt::papers {
namespace {

/// The plant of Table I with other data and another cycle.
struct Case {
  int values = 0;
  int cycle_ms = 0;  // 0: as in the file
};

std::optional<results::RunResult> run(const ProgramsOptions& options, const Case& what,
                                      json::Diagnostics& diagnostics) {
  std::vector<std::string> overrides = {options.is_short ? "/duration=40s" : "/duration=610s"};
  for (const char* set : {"0", "1"})
    overrides.push_back(fmt::format("/programs/0/process_data/{}/fields/values/count={}", set, what.values));
  if (what.cycle_ms > 0) {
    overrides.push_back(fmt::format("/programs/0/cycle={}ms", what.cycle_ms));
    overrides.push_back(fmt::format("/require/0/within={}ms", 10 * what.cycle_ms));
  }
  const auto resolved = scenario::load_file(options.scenarios + "/round-trip-20.json", overrides, diagnostics);
  if (!resolved) return std::nullopt;
  if (options.progress)
    options.progress(fmt::format("claims: {} values, cycle {}", what.values,
                                 what.cycle_ms > 0 ? fmt::format("{} ms", what.cycle_ms) : "200 us"));
  scenario::Run live(*resolved);
  live.advance();
  return evaluation::evaluate(live, false);
}

}  // namespace

bool check_claims(const ProgramsOptions& options, Reproduction& made, json::Diagnostics& diagnostics) {
  const auto trip_of = [](const results::RunResult& result) -> const results::RoundTripResult& {
    return result.programs.front().round_trips.front();
  };

  // "a delay of approximately 0.4 milliseconds can be expected": from the greatest round trip of 160 bytes.
  const auto largest = run(options, {20, 0}, diagnostics);
  if (!largest) return false;
  const results::RoundTripResult& large = trip_of(*largest);
  const double half = milliseconds(large.time->max) / 2;
  const double usual = milliseconds(large.one_way->p99);
  made.comparisons.push_back(
      claim("one way, 160 bytes", fmt::format("about {:.1f} ms", one_way), fmt::format("{:.3f} ms", half),
            half <= one_way && usual <= one_way,
            fmt::format("half of the longest round trip; received and processed: {:.3f} ms on average, 99 % within "
                        "{:.3f}, longest {:.3f}",
                        milliseconds(large.one_way->mean), usual, milliseconds(large.one_way->max))));

  // "at least six floating-point values with a frequency of 1 kHz", section V.
  const auto robot = run(options, {6, 1}, diagnostics);
  if (!robot) return false;
  const double there_and_back = milliseconds(trip_of(*robot).time->max);
  made.comparisons.push_back(claim("6 values at 1 kHz, there and back", fmt::format("within {:.0f} ms", robot_deadline),
                                   fmt::format("{:.3f} ms at most", there_and_back),
                                   there_and_back <= robot_deadline && robot->verdict == results::Verdict::pass));

  // "a cycle time of 1 to 10 millisecond with small amounts of data (< 1 kilobyte) is possible without difficulty".
  for (const int cycle_ms : {1, 10}) {
    const auto kilobyte = run(options, {124, cycle_ms}, diagnostics);
    if (!kilobyte) return false;
    const results::RoundTripResult& trip = trip_of(*kilobyte);
    const double processed = milliseconds(trip.one_way->p99);
    made.comparisons.push_back(claim(
        fmt::format("992 bytes every {} ms", cycle_ms), "without difficulty",
        fmt::format("{:.3f} ms one way", processed),
        processed <= cycle_ms && kilobyte->verdict == results::Verdict::pass,
        fmt::format(
            "99 % received and processed within; longest {:.3f} ms, round trip {:.3f} ms on average, at most {:.3f}",
            milliseconds(trip.one_way->max), milliseconds(trip.time->mean), milliseconds(trip.time->max))));
  }
  return true;
}

}  // namespace takt::papers
