// SPDX-License-Identifier: Apache-2.0
// At which port a frame ended that was given up: where it waited or, if a node discarded it, where it had come in.
#pragma once

#include <cstdint>
#include <vector>

#include "models/ethernet/traffic.hpp"
#include "models/port_directory.hpp"
#include "sim/trace.hpp"

namespace takt::output {

/// Records of a drop name the port whose queue the frame was in, or else only the node: filters, stream gates, meters
/// and sequence recovery have no port. By which one the frame came in is in the record of its arrival, which networks
/// write that tell ways (Network::trace_paths()).
class DropPlaces {
 public:
  static constexpr std::uint32_t none = models::PortDirectory::none;
  /// Positions in the directory.
  struct Place {
    std::uint32_t port =
        none;  ///< of the node that gave the frame up; its first one if nobody knows how the frame came there
    std::uint32_t sender =
        none;  ///< by which it came to that node; none: it was in a queue, or of an application of the node
  };

  /// Both outlive it.
  DropPlaces(const models::Network& network, const models::PortDirectory& directory);

  /// All records in their order.
  void record(const sim::TraceRecord& record);
  /// Where the frame of a record of a drop ended.
  Place of(const sim::TraceRecord& drop) const;

 private:
  /// One record may be that of several copies, each of which comes to other nodes.
  struct Arrival {
    models::NodeIndex node;
    models::ArrivalDetail how;
  };
  models::NodeIndex node_of(sim::ComponentId component) const {
    return component.index < node_of_component_.size() ? node_of_component_[component.index] : models::NodeIndex();
  }
  std::vector<Arrival>& arrivals_of(std::uint64_t frame);

  const models::PortDirectory* directory_;
  std::vector<models::NodeIndex> node_of_component_;
  std::vector<std::vector<Arrival>> arrivals_;  // by record of a frame, since it is that of this one
};

}  // namespace takt::output
