// SPDX-License-Identifier: Apache-2.0
// What became of each frame, column by column in memory: for tables that others make of it without a copy.
#pragma once

#include <string>
#include <vector>

#include "output/frame_events.hpp"

namespace takt::output {

/// Rows as those of frame_series.hpp. Names are indices; -1 stands for none, also of a latency. Hangs on a run as a
/// trace sink.
class FrameColumns final : public FrameEvents {
 public:
  explicit FrameColumns(const models::Network& network) : FrameEvents(network) {}
  /// Adds what is under way, when all is over.
  void close() { emit_rest(); }

  std::vector<std::int32_t> stream;
  std::vector<std::int64_t> sequence;
  std::vector<std::int8_t> event;  ///< FrameEnd
  std::vector<std::int32_t> node;
  std::vector<std::int32_t> port;
  std::vector<std::int64_t> produced_ps;
  std::vector<std::int64_t> at_ps;
  std::vector<std::int64_t> latency_ps;  ///< of delivered frames
  std::vector<std::int8_t> reason;       ///< models::DropReason, of dropped frames

 private:
  void take(const FrameEvent& row) override {
    const bool is_delivered = row.end == FrameEnd::delivered;
    stream.push_back(static_cast<std::int32_t>(row.stream));
    sequence.push_back(static_cast<std::int64_t>(row.sequence));
    event.push_back(static_cast<std::int8_t>(row.end));
    node.push_back(row.node);
    port.push_back(row.port);
    produced_ps.push_back(row.produced.ps());
    at_ps.push_back(row.end == FrameEnd::under_way ? -1 : row.at.ps());
    latency_ps.push_back(is_delivered ? (row.at - row.produced).ps() : -1);
    reason.push_back(row.end == FrameEnd::dropped ? static_cast<std::int8_t>(row.reason) : std::int8_t{-1});
  }
};

}  // namespace takt::output
