// SPDX-License-Identifier: Apache-2.0
#include "papers/round_trips.hpp"

#include <fmt/format.h>

#include <chrono>

#include "chart/histogram.hpp"
#include "evaluation/evaluate.hpp"
#include "papers/published.hpp"
#include "scenario/resolve.hpp"
#include "scenario/run/run.hpp"

namespace takt::papers {
namespace {

// What the reproduction promises. Rows 1 and 20 were fitted, the others must come out.
struct Tolerances {
  double average;
  double deviation;
  double greatest;
};
constexpr Tolerances of_prediction = {0.04, 0.20, 0.25};
constexpr Tolerances of_calibration = {0.005, 0.05, 0.10};

// Clocks settle for 10 s before the Program is started.
constexpr const char* full_length = "3610s";
constexpr const char* short_length = "190s";

bool is_calibrated(int values) { return values == table_1.front().values || values == table_1.back().values; }

std::string histogram_of(const results::RoundTripResult& trip, int values, char letter) {
  std::vector<chart::Bar> bars;
  for (const results::HistogramBucket& bucket : trip.histogram) {
    // Buckets are wider above 262 us than below: messages a microsecond are comparable.
    const double width_us = static_cast<double>(bucket.to.ps() - bucket.from.ps() + 1) * 1e-6;
    bars.push_back({milliseconds(bucket.from), milliseconds(bucket.to), static_cast<double>(bucket.count) / width_us});
  }
  chart::HistogramTexts texts;
  texts.title = fmt::format("Fig. 8{}: round trips of {} floating-point value{} ({} bytes), {} messages", letter,
                            values, values == 1 ? "" : "s", 8 * values, trip.count);
  texts.x_label = "round trip time (ms)";
  texts.y_label = "messages in a microsecond";
  return chart::histogram(texts, bars, 0.2, 0.7);
}

}  // namespace

bool reproduce_round_trips(const ProgramsOptions& options, Reproduction& made, json::Diagnostics& diagnostics) {
  char letter = 'a';
  for (const PublishedRoundTrip& row : table_1) {
    const auto resolved =
        scenario::load_file(fmt::format("{}/round-trip-{}.json", options.scenarios, row.values),
                            {std::string("/duration=") + (options.is_short ? short_length : full_length)}, diagnostics);
    if (!resolved) return false;
    if (options.progress)
      options.progress(
          fmt::format("Table I, {} values: {} simulated", row.values, options.is_short ? "three minutes" : "an hour"));
    const auto began = std::chrono::steady_clock::now();
    scenario::Run run(*resolved);
    run.advance();
    const double took = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
    const results::RunResult result = evaluation::evaluate(run, false);
    const results::RoundTripResult& trip = result.programs.front().round_trips.front();
    made.speed.push_back({row.values, static_cast<double>(result.simulated.ps()) * 1e-12, took, result.events,
                          result.digest, trip.count});

    const bool fitted = is_calibrated(row.values);
    const Standing standing = fitted ? Standing::calibrated : Standing::predicted;
    const Tolerances& tolerance = fitted ? of_calibration : of_prediction;
    const std::string of = fmt::format(", {} value{}", row.values, row.values == 1 ? "" : "s");
    const sim::Duration mean = trip.time ? trip.time->mean : sim::Duration();
    const sim::Duration greatest = trip.time ? trip.time->max : sim::Duration();
    const sim::Duration deviation = trip.time ? trip.time->stddev : sim::Duration();
    made.comparisons.push_back(
        compare("average" + of, row.average, milliseconds(mean), "ms", 4, tolerance.average, standing));
    made.comparisons.push_back(compare("standard deviation" + of, row.deviation, milliseconds(deviation), "ms", 5,
                                       tolerance.deviation, standing));
    made.comparisons.push_back(
        compare("maximum" + of, row.greatest, milliseconds(greatest), "ms", 3, tolerance.greatest, standing));
    if (options.is_short) made.comparisons.back().remark = "of three minutes, not an hour";
    Comparison run_itself;
    run_itself.what = "handshake, synchronisation, no loss" + of;
    run_itself.published = "holds";
    run_itself.holds = result.verdict == results::Verdict::pass;
    run_itself.reproduced = run_itself.holds ? "holds" : "does not hold";
    run_itself.standing = Standing::claim;
    made.comparisons.push_back(run_itself);
    made.figures.push_back({fmt::format("fig-8{}", letter), histogram_of(trip, row.values, letter)});
    ++letter;
  }
  return true;
}

}  // namespace takt::papers
