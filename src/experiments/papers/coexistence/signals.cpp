// SPDX-License-Identifier: Apache-2.0
#include "papers/coexistence/signals.hpp"

#include <fmt/format.h>

#include <cmath>

#include "papers/coexistence/charts.hpp"
#include "scenario/resolve.hpp"

namespace takt::papers::coexistence {
namespace {

// What an eye calls clean, slightly desynchronised and irregular, as shares of pulses that are off by more than half an
// interval.
constexpr double most_of_clean = 0.01;
constexpr double most_of_slight = 1.0 / 3;
/// A length is "correct" if the median is that near.
constexpr double correct_length = 0.1;

std::string irregularity(const SignalStatistics& s) { return fmt::format("{:.1f} % irregular", 100 * s.irregular); }

void check_claims_of_figures(Reproduction& made) {
  const auto at = [&](std::size_t i) -> const SignalStatistics& { return made.signals[i].statistics; };
  const SignalStatistics& slow = at(0);
  const bool has_all = static_cast<double>(slow.pulses) >= 0.99 * (slow.expected - 2);
  made.comparisons.push_back(
      claim("Fig. 5, 100 ms: form and frequency", "as expected", irregularity(slow),
            slow.irregular <= most_of_clean && has_all,
            fmt::format("clean: at most {:.0f} % of the pulses off by more than half an interval, and 99 % of them "
                        "there ({} of {:.0f}); period {:.2f} +- {:.2f} ms",
                        100 * most_of_clean, slow.pulses, slow.expected, 100 * slow.period_mean,
                        100 * slow.period_deviation)));
  const SignalStatistics& ten = at(1);
  made.comparisons.push_back(
      claim("Fig. 6, 10 ms: length", "correct", fmt::format("median {:.2f} ms", 10 * ten.pulse_median),
            std::abs(ten.pulse_median - 1) <= correct_length, "correct: within a tenth of the interval"));
  made.comparisons.push_back(claim("Fig. 6, 10 ms: desynchronisation", "slight", irregularity(ten),
                                   ten.irregular > most_of_clean && ten.irregular <= most_of_slight,
                                   "slight: more than clean, but less than a third of the pulses"));
  for (std::size_t i = 2; i < made.signals.size(); ++i)
    made.comparisons.push_back(claim(fmt::format("Fig. {}, {} ms", 5 + i, made.signals[i].interval), "irregular",
                                     irregularity(at(i)), at(i).irregular > most_of_slight,
                                     i == 2 ? "irregular: more than a third of the pulses" : ""));
  bool grows = true;
  for (std::size_t i = 1; i < made.signals.size(); ++i) grows = grows && at(i).irregular > at(i - 1).irregular;
  made.comparisons.push_back(
      claim("irregularity grows with the rate", "said", grows ? "from each to next" : "not everywhere", grows));
}

}  // namespace

bool reproduce_signals(const Options& options, Reproduction& made, json::Diagnostics& diagnostics) {
  int figure = 5;
  for (const int interval : signal_intervals) {
    const auto resolved =
        scenario::load_file(fmt::format("{}/gateway-{}ms.json", options.scenarios, interval), {}, diagnostics);
    if (!resolved) return false;
    if (options.progress) options.progress(fmt::format("Fig. {}: the digital signal at {} ms", figure, interval));
    const RunFigures figures = run(*resolved);
    SignalRow row{interval, measure(figures.edges, sim::Duration::from_ps(interval * 1'000'000'000LL), figures.begin,
                                    figures.end)};
    made.figures.push_back({fmt::format("fig-{}", figure), signal_chart(figures, row, figure)});
    made.waves.emplace_back(fmt::format("fig-{}.vcd", figure), value_change_dump(figures.edges, figures.end));
    made.signals.push_back(row);
    made.speed.push_back(
        {figures.scenario, figures.simulated_seconds, figures.cpu_seconds, figures.events, figures.digest});
    ++figure;
  }
  check_claims_of_figures(made);
  return true;
}

}  // namespace takt::papers::coexistence
