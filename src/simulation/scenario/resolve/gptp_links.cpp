// SPDX-License-Identifier: Apache-2.0
#include "scenario/resolve/gptp_links.hpp"

#include <algorithm>
#include <tuple>

#include "models/ethernet/sizes.hpp"
#include "models/gptp/message.hpp"

namespace takt::scenario {
namespace {

constexpr Duration threshold_of_copper = Duration::from_ps(800'000);

// Octets of messages, IEEE 802.1AS-2020 10.6 and 11.4.
constexpr std::uint32_t follow_up = 76;
constexpr std::uint32_t follow_up_with_drift = 112;
constexpr std::uint32_t announce = 68;
constexpr std::uint32_t path_trace_entry = 8;

bool speaks_gptp(const Resolved& resolved, models::NodeIndex node) {
  return node.value < resolved.plan.gptp.size() && resolved.plan.gptp[node.value];
}

/// The neighbours of each node that gPTP reaches.
using Hearing = std::vector<std::vector<std::uint32_t>>;
Hearing who_hears_whom(const Resolved& resolved) {
  Hearing hearing(resolved.plan.nodes.size());
  for (const models::LinkPlan& link : resolved.plan.links) {
    if (!speaks_gptp(resolved, link.a.node) || !speaks_gptp(resolved, link.b.node) ||
        capability_of(resolved, link) == LinkCapability::never)
      continue;
    hearing[link.a.node.value].push_back(link.b.node.value);
    hearing[link.b.node.value].push_back(link.a.node.value);
  }
  return hearing;
}

constexpr std::uint32_t unreached = 0xFFFF'FFFF;

/// In links that gPTP crosses, by node.
std::vector<std::uint32_t> distances_from(std::uint32_t first, const Hearing& hearing) {
  std::vector<std::uint32_t> distance(hearing.size(), unreached);
  distance[first] = 0;
  std::vector<std::uint32_t> reached{first};
  for (std::size_t i = 0; i < reached.size(); ++i)
    for (const std::uint32_t other : hearing[reached[i]])
      if (distance[other] == unreached) {
        distance[other] = distance[reached[i]] + 1;
        reached.push_back(other);
      }
  return distance;
}

}  // namespace

std::optional<Duration> link_delay_threshold(const Gptp& gptp, const models::LinkPlan& link) {
  if (gptp.link_delay_threshold) return gptp.link_delay_threshold;
  return link.delay > longest_copper ? std::nullopt : std::optional(threshold_of_copper);
}

ShownLinkDelay shown_link_delay(const Resolved& resolved, const models::LinkPlan& link) {
  ShownLinkDelay shown{link.delay, {}, {}};
  for (const models::LinkPlan::End* const end : {&link.a, &link.b}) {
    const std::optional<models::NodeClockPlan>& clock = resolved.plan.nodes[end->node.value].clock;
    if (!clock) continue;
    const models::TimestampUnit& unit = clock->timestamps;
    // D = (round trip - turnaround) / 2: what each time stamp is off counts by half, and of the two latencies of a node
    // one makes the round trip longer and one the turnaround shorter.
    shown.uncorrected +=
        (unit.egress_latency - unit.egress_correction + unit.ingress_latency - unit.ingress_correction) / 2;
    shown.noise += unit.granularity / 2 + unit.jitter;
  }
  return shown;
}

LinkCapability capability_of(const Resolved& resolved, const models::LinkPlan& link) {
  const std::optional<Duration> threshold = link_delay_threshold(*resolved.scenario.clocks.gptp, link);
  if (!threshold) return LinkCapability::always;
  const ShownLinkDelay shown = shown_link_delay(resolved, link);
  if (shown.mean() - shown.noise > *threshold) return LinkCapability::never;
  return shown.mean() + shown.noise > *threshold ? LinkCapability::at_times : LinkCapability::always;
}

std::vector<std::vector<std::uint32_t>> gptp_parts(const Resolved& resolved) {
  std::vector<std::vector<std::uint32_t>> parts;
  if (!resolved.scenario.clocks.gptp) return parts;
  const Hearing hearing = who_hears_whom(resolved);
  std::vector<bool> is_known(hearing.size(), false);
  for (std::uint32_t n = 0; n < hearing.size(); ++n) {
    if (is_known[n] || !speaks_gptp(resolved, models::NodeIndex{n})) continue;
    std::vector<std::uint32_t>& part = parts.emplace_back(1, n);
    is_known[n] = true;
    for (std::size_t i = 0; i < part.size(); ++i)
      for (const std::uint32_t other : hearing[part[i]])
        if (!is_known[other]) {
          is_known[other] = true;
          part.push_back(other);
        }
    std::ranges::sort(part);
  }
  return parts;
}

std::vector<GptpFrames> longest_gptp_frames(const Resolved& resolved) {
  std::vector<GptpFrames> frames(resolved.plan.nodes.size());
  if (!resolved.scenario.clocks.gptp) return frames;
  const Hearing hearing = who_hears_whom(resolved);
  const auto station = [&](std::uint32_t node) -> const models::gptp::StationPlan& {
    return resolved.plan.gptp_stations[*resolved.plan.gptp[node]];
  };
  const auto rank = [&](std::uint32_t node) {
    return std::tuple(station(node).instances.front().system, node);
  };  // node numbers are in the order of clock identities
  for (const std::vector<std::uint32_t>& part : gptp_parts(resolved)) {
    const bool is_elected = std::ranges::none_of(
        part, [&](std::uint32_t node) { return station(node).instances.front().external_roles.has_value(); });
    const std::vector<std::uint32_t> distance = is_elected
                                                    ? distances_from(*std::ranges::min_element(part, {}, rank), hearing)
                                                    : std::vector<std::uint32_t>(frames.size(), 0);
    for (const std::uint32_t node : part) {
      const bool tracks = std::ranges::any_of(station(node).instances, &models::gptp::InstanceConfig::drift_tracking);
      const auto path = static_cast<std::uint32_t>(
          std::min<std::size_t>(distance[node] + 1, models::gptp::Announce::longest_path_trace));
      frames[node] = {models::frame_length(Octets{tracks ? follow_up_with_drift : follow_up}, false),
                      models::frame_length(Octets{announce + path_trace_entry * path}, false), distance[node]};
    }
  }
  return frames;
}

}  // namespace takt::scenario
