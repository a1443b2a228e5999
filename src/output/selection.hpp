// What recorders are to record: a stretch of time, some streams.
#pragma once

#include <vector>

#include "explain/way.hpp"
#include "models/network.hpp"
#include "sim/trace.hpp"

namespace takt::output {

struct Selection {
  sim::TrueTime from;
  sim::TrueTime to = sim::TrueTime::never();
  std::vector<bool> streams = {};   ///< by stream; empty: all

  bool is_all() const { return from == sim::TrueTime() && to == sim::TrueTime::never() && streams.empty(); }
  bool has(models::StreamIndex stream) const { return streams.empty() || (stream.value < streams.size() && streams[stream.value]); }
  bool has(sim::TrueTime time) const { return from <= time && time <= to; }
  /// The frame was under way at some time of the stretch.
  bool has(const explain::Way& way) const { return has(way.frame.stream) && way.ended >= from && way.produced <= to; }
};

/// Hands on what is selected: records of frames of those streams, and all others, within that time.
class SelectedSink final : public sim::TraceSink {
 public:
  /// All outlive it.
  SelectedSink(const models::Network& network, const Selection& selection, sim::TraceSink& sink) : network_(&network), selection_(&selection), sink_(&sink) {}

  void record(const sim::TraceRecord& record) override {
    if (!selection_->has(record.time)) return;
    if (!selection_->streams.empty() && names_a_frame(static_cast<models::Occurrence>(record.kind)) &&
        !selection_->has(network_->traffic().frame({static_cast<std::uint32_t>(record.what)}).stream))
      return;
    sink_->record(record);
  }

 private:
  static bool names_a_frame(models::Occurrence kind) {
    switch (kind) {
      case models::Occurrence::drop:
      case models::Occurrence::produced:
      case models::Occurrence::started:
      case models::Occurrence::enqueued:
      case models::Occurrence::dequeued:
      case models::Occurrence::cut:
      case models::Occurrence::resumed:
      case models::Occurrence::received:
      case models::Occurrence::processing:
      case models::Occurrence::arrived: return true;
      default: return false;
    }
  }
  const models::Network* network_;
  const Selection* selection_;
  sim::TraceSink* sink_;
};

}  // namespace takt::output
