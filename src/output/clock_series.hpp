// The offsets of all clocks over time, as comma-separated values.
#pragma once

#include <string>

#include "output/streaming_file.hpp"
#include "scenario/run/clock_monitor.hpp"

namespace takt::output {

/// Columns: time in seconds, node, grandmaster, offset of the node's clock from the grandmaster's in nanoseconds. Writes as it goes.
class ClockSeries final : public scenario::ClockSampleSink {
 public:
  ClockSeries(const models::Network& network, std::string path);
  void sample(sim::TrueTime time, models::NodeIndex node, models::NodeIndex grandmaster, sim::Duration offset) override;
  /// Gives the file its name. Returns an empty text, or what went wrong.
  [[nodiscard]] std::string close() { return file_.close(); }

 private:
  const models::Network* network_;
  StreamingFile file_;
};

}  // namespace takt::output
