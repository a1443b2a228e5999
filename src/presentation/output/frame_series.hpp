// SPDX-License-Identifier: Apache-2.0
// What became of each frame, as comma-separated values.
#pragma once

#include <string>
#include <vector>

#include "output/frame_events.hpp"
#include "output/streaming_file.hpp"

namespace takt::output {

/// Columns: stream, sequence (from 0, within the stream), event, node, port, produced_ps, at_ps, latency_ps, reason. A
/// row for each listener that a frame has reached ("delivered": node is the listener), for each copy that was dropped
/// ("dropped": where, and why; of a multicast it stands for all listeners that this copy would have reached) and, when
/// all is over, for each frame that has still to come
/// ("under way"). Messages of gPTP, which end at the next node, are left out. Writes as it goes, in the order in which
/// it is told; rows of other events may come to stand between.
class FrameSeries final : public FrameEvents {
 public:
  /// The network outlives the recorder.
  FrameSeries(const models::Network& network, std::string path);

  /// Writes what is under way and gives the file its name. Returns an empty text, or what went wrong.
  [[nodiscard]] std::string close();

 private:
  void take(const FrameEvent& event) override;

  std::vector<std::string> streams_;  // names, ready for the file
  std::vector<std::string> nodes_;
  StreamingFile file_;
};

}  // namespace takt::output
