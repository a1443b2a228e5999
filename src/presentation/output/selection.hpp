// SPDX-License-Identifier: Apache-2.0
// What recorders are to record: a stretch of time, some streams.
#pragma once

#include <vector>

#include "explain/way.hpp"
#include "models/moment.hpp"
#include "models/network.hpp"
#include "sim/trace.hpp"

namespace takt::output {

struct Selection {
  sim::TrueTime from;
  sim::TrueTime to = sim::TrueTime::never();
  std::vector<bool> streams = {};  ///< by stream; empty: all

  bool is_all() const { return from == sim::TrueTime() && to == sim::TrueTime::never() && streams.empty(); }
  bool has(models::StreamIndex stream) const {
    return streams.empty() || (stream.value < streams.size() && streams[stream.value]);
  }
  bool has(sim::TrueTime time) const { return from <= time && time <= to; }
  /// The frame was under way at some time of the stretch.
  bool has(const explain::Way& way) const { return has(way.frame.stream) && way.ended >= from && way.produced <= to; }
};

/// Hands on what is selected: records of frames of those streams, and all others, within that time; what gates are at
/// any time.
class SelectedSink final : public sim::TraceSink {
 public:
  /// All outlive it.
  SelectedSink(const models::Network& network, const Selection& selection, sim::TraceSink& sink)
      : view_(network), selection_(&selection), sink_(&sink) {}

  /// It is told of things later than they happen, each with its moment.
  void look_at(const models::Moment& moment) { view_.look_at(moment); }

  void record(const sim::TraceRecord& record) override {
    const auto kind = static_cast<models::Occurrence>(record.kind);
    // What gates are at the beginning was said before it.
    if (kind != models::Occurrence::gates_shown) {
      if (!selection_->has(record.time)) return;
      if (!selection_->streams.empty() && models::names_a_frame(kind) &&
          !selection_->has(view_.frame({static_cast<std::uint32_t>(record.what)}).stream))
        return;
    }
    sink_->record(record);
  }

 private:
  models::View view_;
  const Selection* selection_;
  sim::TraceSink* sink_;
};

}  // namespace takt::output
