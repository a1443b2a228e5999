// SPDX-License-Identifier: Apache-2.0
// Which links are capable of gPTP, by what the scenario says of them alone: before any run.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include "scenario/resolved/resolved.hpp"

namespace takt::scenario {

/// The delay of 100 m of copper. A link that is longer is taken for fibre.
inline constexpr Duration longest_copper = Duration::from_ps(500'000);

/// The delay beyond which a link is too long; nothing: none is. What the scenario says, or the default of the medium
/// (IEEE 802.1AS-2020 Table 11-1): 800 ns for copper, none for fibre.
std::optional<Duration> link_delay_threshold(const Gptp& gptp, const models::LinkPlan& link);

/// What both ports of a link measure.
struct ShownLinkDelay {
  Duration cable;
  Duration uncorrected;  ///< latencies of both PHYs beyond what the nodes make up for
  Duration noise;        ///< by how much granularity and jitter of time stamps may change it, either way
  Duration mean() const { return cable + uncorrected; }
};
ShownLinkDelay shown_link_delay(const Resolved& resolved, const models::LinkPlan& link);

enum class LinkCapability : std::uint8_t { always, at_times, never };
/// Between two nodes with gPTP, by its delay.
LinkCapability capability_of(const Resolved& resolved, const models::LinkPlan& link);

/// Nodes with gPTP that hear each other, over links that are capable at least at times: each part of the network has a
/// grandmaster of its own. Ascending, by their first node.
std::vector<std::vector<std::uint32_t>> gptp_parts(const Resolved& resolved);

/// The longest frames of gPTP that a node sends for certain, DA to FCS.
struct GptpFrames {
  Octets time{0};      ///< Follow_Up, of one-step clocks Sync
  Octets announce{0};  ///< names all nodes from the grandmaster to itself
  std::uint32_t distance =
      0;  ///< in links from the grandmaster that is elected: Announce goes to nodes that are farther away
  Octets to(const GptpFrames& neighbour) const {
    return neighbour.distance > distance ? std::max(time, announce) : time;
  }
};
/// By node.
std::vector<GptpFrames> longest_gptp_frames(const Resolved& resolved);

}  // namespace takt::scenario
