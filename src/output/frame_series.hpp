// What became of each frame, as comma-separated values.
#pragma once

#include <string>
#include <vector>

#include "output/port_directory.hpp"
#include "output/streaming_file.hpp"
#include "sim/trace.hpp"

namespace takt::output {

/// Columns: stream, sequence (from 0, within the stream), event, node, port, produced_ps, at_ps, latency_ps, reason. A row for each listener that a frame has reached ("delivered": node is the listener), for
/// each copy that was dropped ("dropped": where, and why; of a multicast it stands for all listeners that this copy would have reached) and, when all is over, for each frame that has still to come
/// ("under way"). Messages of gPTP, which end at the next node, are left out. Writes as it goes, in the order of events; rows of other events may come to stand between.
class FrameSeries final : public sim::TraceSink {
 public:
  /// The network outlives the recorder.
  FrameSeries(const models::Network& network, std::string path);

  void record(const sim::TraceRecord& record) override;
  /// Writes what is under way and gives the file its name. Returns an empty text, or what went wrong.
  [[nodiscard]] std::string close();

 private:
  struct Place {
    std::string node;   ///< ready for the file
    std::string port;   ///< empty: the node itself
  };
  Place place_of(sim::ComponentId component) const;
  void row(const models::Frame& frame, std::string_view event, const Place& place, std::string_view end);

  const models::Network* network_;
  PortDirectory directory_;
  std::vector<std::string> streams_;                   // names, ready for the file
  std::vector<std::string> nodes_;
  std::vector<std::uint32_t> node_of_component_;       // of those that are no ports
  StreamingFile file_;
};

}  // namespace takt::output
