// SPDX-License-Identifier: Apache-2.0
// The offsets of all clocks over time, as comma-separated values.
#pragma once

#include <string>

#include "output/streaming_file.hpp"
#include "scenario/run/clock_monitor.hpp"

namespace takt::output {

/// Columns: time in seconds, node, grandmaster, offsets of the node's clock from the grandmaster's and from true time
/// in nanoseconds. Writes as it goes what lies in the stretch of time.
class ClockSeries final : public scenario::ClockSampleSink {
 public:
  ClockSeries(const models::Network& network, std::string path, sim::TrueTime from, sim::TrueTime to);
  void sample(const scenario::ClockSample& sample) override;
  /// Gives the file its name. Returns an empty text, or what went wrong.
  [[nodiscard]] std::string close() { return file_.close(); }

 private:
  const models::Network* network_;
  StreamingFile file_;
  sim::TrueTime from_;
  sim::TrueTime to_;
};

}  // namespace takt::output
