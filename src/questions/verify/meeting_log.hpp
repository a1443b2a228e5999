// SPDX-License-Identifier: Apache-2.0
// Which frames met at which ports in a run, waiting included: whence the instants at which another phase of a stream
// would change something.
#pragma once

#include <cstdint>
#include <vector>

#include "models/network.hpp"
#include "models/port_directory.hpp"
#include "sim/trace.hpp"

namespace takt::verify {

class MeetingLog final : public sim::TraceSink {
 public:
  /// A frame at an egress port.
  struct Visit {
    std::uint32_t port = 0;  ///< its place in the port directory
    std::uint32_t stream = 0;
    sim::TrueTime produced;
    sim::TrueTime came;     ///< to the port
    sim::TrueTime started;  ///< never(): still waits
  };
  /// The network outlives it. What comes beyond `most` visits is left out.
  MeetingLog(const models::Network& network, std::size_t most);

  void record(const sim::TraceRecord& record) override;

  /// In the order in which they came.
  std::vector<Visit> visits;
  bool is_complete = true;

 private:
  const models::Network* network_;
  models::PortDirectory directory_;
  std::size_t most_;
  std::vector<std::vector<std::uint32_t>> waiting_;  // by port: visits of those that have not started
};

}  // namespace takt::verify
