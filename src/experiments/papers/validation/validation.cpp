// SPDX-License-Identifier: Apache-2.0
#include "papers/validation/validation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <thread>

#include "papers/validation/charts.hpp"

namespace takt::papers::validation {

bool Validation::holds() const { return count(Agreement::missed) == 0; }

std::size_t Validation::count(Agreement verdict, std::optional<std::size_t> source) const {
  return static_cast<std::size_t>(std::count_if(figures.begin(), figures.end(), [&](const Judged& each) {
    return each.verdict == verdict && (!source || each.source == *source);
  }));
}

std::optional<Validation> validate(const Options& options, json::Diagnostics& diagnostics) {
  const auto entries = read_tables(options.tables, options.is_short, diagnostics);
  if (!entries) return std::nullopt;
  MeasureOptions how;
  how.jobs = options.jobs != 0 ? options.jobs : std::max(1U, std::thread::hardware_concurrency());
  how.progress = [&](std::size_t done, std::size_t of) {
    if (options.progress && (done % 50 == 0 || done == of))
      options.progress(fmt::format("{} of {} scenarios", done, of));
  };
  const std::vector<Measured> measured = measure(*entries, how, diagnostics);
  if (diagnostics.has_errors()) return std::nullopt;
  Validation made;
  made.is_short = options.is_short;
  made.sources = entries->sources;
  made.figures = judge(*entries, measured);
  made.pictures = draw_charts(made);
  return made;
}

}  // namespace takt::papers::validation
