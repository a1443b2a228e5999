// SPDX-License-Identifier: Apache-2.0
// The way of each frame, hop by hop, as comma-separated values.
#pragma once

#include <string>
#include <vector>

#include "explain/way_recorder.hpp"
#include "output/selection.hpp"
#include "output/streaming_file.hpp"

namespace takt::output {

/// A row for each frame and egress port that it has left by or waited at, once, also where several copies share it,
/// when the frame (or the first copy that passed there) ends. Columns: stream, sequence (from 0), node, port, to,
/// class, produced_ps, came_ps (to the port), started_ps (empty: it never left), octets (DA to FCS), cuts, and how long
/// each cause took from then until it came to the next port or ended: a column for each explain::Cause that there can
/// be behind the talker, "gate_closed_ps". Of a row the columns add up to what the hop took; those of the talker's host
/// stand in a row without port.
class HopSeries final : public explain::WaySink {
 public:
  /// Both outlive it.
  HopSeries(const models::Network& network, const Selection& selection, std::string path);

  bool wants(models::StreamIndex stream) const override { return selection_->has(stream); }
  void ended(const explain::Way& way) override;
  /// Gives the file its name. Returns an empty text, or what went wrong.
  [[nodiscard]] std::string close() { return file_.close(); }

 private:
  void row(const explain::Way& way, const std::string& place, const std::string& times,
           const std::vector<explain::Part>& parts);

  const Selection* selection_;
  std::vector<std::string> streams_;  // names, ready for the file
  std::vector<std::string> nodes_;
  StreamingFile file_;
};

}  // namespace takt::output
