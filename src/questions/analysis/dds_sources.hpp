// SPDX-License-Identifier: Apache-2.0
// What participants of DDS send at most, stream by stream: samples, heartbeats, acknowledgements, what is sent again,
// discovery. docs/bounds.md derives it.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "analysis/flow_graph.hpp"

namespace takt::analysis {

/// Messages of a stream, none of them longer than `payload`.
struct DdsSource {
  models::StreamIndex stream;
  FrameArrivals arrivals;  ///< in true time, as participants hand them to their operating system
  sim::Octets payload{0};  ///< of UDP
};

struct DdsTraffic {
  std::vector<DdsSource> sources;
  std::map<std::uint32_t, std::string> unknown;  ///< streams that may carry any number of messages at any time, and why
};

/// No message of DDS, as participants make them, is shorter than this as a payload of UDP.
inline constexpr sim::Octets least_dds_message{36};

/// What answers what comes rests on options.dds_within: each message comes within that time or not at all, and no
/// participant wakes later than that. Without it nothing is known.
DdsTraffic dds_traffic(const scenario::Resolved& resolved, const BoundOptions& options, const HostTimes& hosts);

/// Why messages may be under way for longer than options.dds_within, or participants wake later; empty: neither, so
/// what rests on it holds. A first message that is too late would be one of which these bounds, which hold until then,
/// say that it is not.
std::string why_dds_is_late(const scenario::Resolved& resolved, const BoundOptions& options, const HostTimes& hosts,
                            const std::vector<StreamBound>& streams);

}  // namespace takt::analysis
