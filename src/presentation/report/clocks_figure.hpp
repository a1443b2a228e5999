// SPDX-License-Identifier: Apache-2.0
// Offsets of clocks over time, and who gave the time when.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "chart/chart.hpp"
#include "results/run_result.hpp"
#include "scenario/run/run.hpp"

namespace takt::report {

/// Keeps what a picture can show of all offsets of a run: of each column of it the least and the greatest. Offsets are
/// from the grandmaster that most nodes follow at a look, so that a network in parts is seen to drift apart.
class ClockCurves final : public scenario::ClockSampleSink {
 public:
  static constexpr std::size_t most_curves = 8;  ///< more would not be told apart: those with the greatest offsets

  /// `result` is of the run that is watched, and outlives this.
  ClockCurves(const scenario::Run& run, const results::RunResult& result);

  void sample(const scenario::ClockSample& sample) override;
  /// To be called when the run is over.
  void finish() { record_sample(); }
  /// None if there was no sample.
  std::optional<chart::LineChart> figure() const;

 private:
  static constexpr std::size_t columns = 240;
  struct Extent {
    bool is_empty = true;
    std::int64_t low = 0;  // ps
    std::int64_t high = 0;
  };
  void record_sample();
  static sim::TrueTime begin_of(const results::RunResult& result);

  const scenario::Run* run_;
  const results::RunResult* result_;
  sim::TrueTime begin_;
  sim::TrueTime end_;
  std::vector<scenario::ClockSample> look_;              // samples of one instant
  std::map<std::uint32_t, std::vector<Extent>> curves_;  // by node
};

}  // namespace takt::report
