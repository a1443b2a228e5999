// SPDX-License-Identifier: Apache-2.0
// A run once more, watched where its page shows it. The first one was judged and pays nothing; this one is the same by
// its digest.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "chart/gantt.hpp"
#include "chart/sequence_chart.hpp"
#include "output/fan_out.hpp"
#include "report/clocks_figure.hpp"
#include "report/gates_figure.hpp"
#include "report/sequence_figure.hpp"
#include "report/worst_ways.hpp"
#include "results/run_result.hpp"
#include "scenario/run/run.hpp"

namespace takt::report {

class Replay {
 public:
  /// `result` is of a run of `resolved`; both outlive this.
  Replay(const scenario::Resolved& resolved, const results::RunResult& result);
  Replay(const Replay&) = delete;
  Replay& operator=(const Replay&) = delete;

  /// To the last instant that is shown; `is_interrupted` is asked now and then. False if it was interrupted.
  bool advance(const std::function<bool()>& is_interrupted);

  /// Of each kind of reaction the slowest, by program.
  std::vector<chart::SequenceChart> sequences() const;
  /// Gates and frames of one cycle; without gates, the frames around the first one that was discarded; none without
  /// either.
  std::optional<chart::Gantt> gates() const;
  bool shows_gates() const { return watch_ != nullptr && watch_->shows_gates(); }
  /// Of each stream the slowest frame.
  const WorstWays& ways() const { return ways_; }
  /// None without gPTP.
  std::optional<chart::LineChart> clocks() const { return clocks_ ? clocks_->figure() : std::nullopt; }

 private:
  bool run_until(sim::TrueTime time, const std::function<bool()>& is_interrupted);
  bool watch_gates(const std::function<bool()>& is_interrupted);
  bool go_to_end(const std::function<bool()>& is_interrupted);

  scenario::Run run_;
  std::vector<Excerpt> excerpts_;
  std::vector<std::unique_ptr<MessageLog>> logs_;  // by program; null: nothing is shown of it
  std::unique_ptr<GateWatch> watch_;               // null: no port ever has gates, and no frame was discarded
  WorstWays ways_;
  std::optional<explain::WayRecorder> way_recorder_;
  std::optional<ClockCurves> clocks_;
  sim::TrueTime end_;  // of what was judged
  output::FanOut sinks_;
};

}  // namespace takt::report
