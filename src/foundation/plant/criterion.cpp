// SPDX-License-Identifier: Apache-2.0
#include "plant/criterion.hpp"

#include <algorithm>

#include "json/record.hpp"

namespace takt::plant {

std::optional<double> CriterionFigures::percent() const {
  if (expected == 0) return std::nullopt;
  return 100.0 * static_cast<double>(counted) / static_cast<double>(expected);
}

const json::Record& describe(json::Type<CriterionFigures>) {
  using F = CriterionFigures;
  static constexpr json::Output outputs[] = {
      json::output<&F::tests>("tests", "Whole windows that were judged."),
      json::output<&F::expected>("expected", "What was expected in all of them."),
      json::output<&F::counted>("counted", "What happened, at most the expected ones of each window."),
      json::output<&F::beyond>("beyond", "What happened beyond what was expected."),
      json::output<&F::windows_below>("windows_below", "Windows in which less happened than was expected."),
      json::output<&F::discarded>("discarded",
                                  "Windows that were no tests, since the scheduler itself was not let run."),
      json::output_if_any<&F::percent>("percent", "Of what was expected.", "with a test", {.unit = "%"}),
  };
  static constexpr json::Record record{"criterion", "Whether a thread did what was expected of it, window by window.",
                                       outputs};
  return record;
}

namespace {
constexpr std::int64_t most_room = 4'096;  // windows
}

/// The open window, those that begin within the tolerance, that in which it ends, and one that begins while the
/// scheduler looks.
Criterion::Criterion(const Settings& settings)
    : settings_(settings),
      happened_(static_cast<std::size_t>(std::min(settings.tolerance / settings.length + 3, most_room))) {}

Criterion::Happened& Criterion::happened_in(std::int64_t window) {
  Happened& place = happened_[static_cast<std::size_t>(window) % happened_.size()];
  if (place.window != window) place = {window, 0};
  return place;
}

void Criterion::begin(std::int64_t now) {
  const std::int64_t since = std::max({now, settings_.after, settings_.phase}) - settings_.phase;
  number_ = (since + settings_.length - 1) / settings_.length;
  happened_in(number_).count = 0;
  has_begun_ = true;
}

void Criterion::end() {
  if (open()) ++figures_.discarded;
  has_begun_ = false;
}

std::optional<Criterion::Window> Criterion::open() const {
  if (!has_begun_ || (settings_.most_tests && figures_.tests >= *settings_.most_tests)) return std::nullopt;
  const std::int64_t from = settings_.phase + number_ * settings_.length;
  return Window{from, from + settings_.length};
}

void Criterion::add(std::int64_t due, std::uint64_t count) {
  if (const auto window = open(); window && due >= window->from)
    happened_in((due - settings_.phase) / settings_.length).count += count;
}

void Criterion::look(std::int64_t now) {
  const auto window = open();
  if (!window || now < window->to) return;
  const bool is_forgotten = happened_[static_cast<std::size_t>(number_) % happened_.size()].window > number_;
  if (is_forgotten || now - window->to > settings_.tolerance) {
    // What began before this look is discarded, but for the window that is open now.
    const std::int64_t number = (now - settings_.phase) / settings_.length;
    figures_.discarded += static_cast<std::uint64_t>(number - number_);
    number_ = number;
  } else {
    const std::uint64_t happened = happened_in(number_).count;
    ++figures_.tests;
    figures_.expected += settings_.expected;
    figures_.counted += std::min(happened, settings_.expected);
    figures_.beyond += happened - std::min(happened, settings_.expected);
    figures_.windows_below += happened < settings_.expected ? 1 : 0;
    figures_.windows_above += happened > settings_.expected ? 1 : 0;
    ++number_;
  }
}

}  // namespace takt::plant
