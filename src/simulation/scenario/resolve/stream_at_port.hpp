// SPDX-License-Identifier: Apache-2.0
// What a stream is at the egress ports along its paths: in which traffic class its frames wait there, and how long they
// are on that wire. The one place that knows what switches do to frames before: stream gates give internal priority
// values, splits and merges put on and take off R-TAGs, ports take off C-tags.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <vector>

#include "models/egress/class_set.hpp"
#include "models/ingress/stream_table.hpp"
#include "scenario/resolved/resolved.hpp"

namespace takt::scenario {

/// gPTP frames are untagged; stations put them into the class of this priority.
inline constexpr models::Priority priority_of_gptp = 7;

/// The frames of a stream, or of one member of a redundant stream, at an egress port.
struct StreamAtPort {
  models::StreamIndex stream;
  std::optional<std::uint32_t> member = {};  ///< between split and merge: each member takes the port for itself
  std::uint32_t node = 0;
  std::uint16_t port = 0;
  models::ClassSet classes = 0;  ///< several if a stream gate spreads the stream; none if its gate is never open
  std::uint32_t peer = 0;
  std::optional<std::uint32_t> filter = {};  ///< the stream filter that the frames meet in the node
  Octets frame{0};                           ///< the longest, DA to FCS, as the port sends it
  Octets msdu{0};                            ///< the longest, as maximum SDU sizes count: with R-TAG
  Octets policed_frame{0};                   ///< as the ingress of the node meters it: merged already, not yet split
  Octets policed_msdu{0};
};
static_assert(sizeof(StreamAtPort) <= 72, "a plant of 100,000 streams has seven million of them");

/// All streams at all ports of their paths: by stream, each port of a multicast once, in the order of the path. To be
/// called when the ingress of switches is there (resolve_ingress).
std::vector<StreamAtPort> streams_at_ports(const Resolved& resolved);
/// The same one after another: of a large plant they are many.
void for_each_stream_at_port(const Resolved& resolved, const std::function<void(const StreamAtPort&)>& visit);

/// Whether frames can come before the list of the stream gate is in force.
bool begins_after_the_start(const models::NodePlan& node, const models::StreamGateConfig& gate);

/// Which class frames wait in at the ports of switches, after what the ingress there does.
class IngressClasses {
 public:
  explicit IngressClasses(const Resolved& resolved) : r_(resolved) {}

  /// The filter that such a frame meets when it comes to the node; or none.
  std::optional<std::uint32_t> filter(std::uint32_t node, const models::Frame& frame);
  /// The classes that frames of the priority can wait in at a port of the node, behind that filter.
  models::ClassSet classes(std::uint32_t node, const models::PortConfig& port, std::optional<std::uint32_t> filter,
                           models::Priority priority) const;

 private:
  const Resolved& r_;
  std::map<std::uint32_t, models::StreamTable> tables_;  // by node
};

}  // namespace takt::scenario
