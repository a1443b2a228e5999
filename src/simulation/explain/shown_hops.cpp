// SPDX-License-Identifier: Apache-2.0
#include "explain/shown_hops.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace takt::explain {
namespace {

bool is_wait(const ExplainedPart& part) {
  for (std::size_t cause = 0; cause < static_cast<std::size_t>(Cause::count); ++cause)
    if (part.cause == name_of(static_cast<Cause>(cause))) return is_waiting(static_cast<Cause>(cause));
  return false;
}

Duration wait_of(const ExplainedHop& hop) {
  Duration sum;
  for (const ExplainedPart& part : hop.parts)
    if (is_wait(part)) sum += part.takes;
  return sum;
}

/// The parts of another hop are added to those of the same causes.
void add_hop(ShownHop& shown, const ExplainedHop& hop) {
  ++shown.count;
  shown.hop.to = hop.to;
  for (const ExplainedPart& part : hop.parts) {
    const auto same = std::ranges::find(shown.hop.parts, part.cause, &ExplainedPart::cause);
    if (same == shown.hop.parts.end())
      shown.hop.parts.push_back(part);
    else
      same->takes += part.takes;
  }
}

/// Sums are of no frame and no entry of a list. A hop may have been cut, and so have several parts of one cause.
ExplainedHop summed(const ExplainedHop& first) {
  ExplainedHop hop = first;
  hop.parts.clear();
  hop.stored.reset();
  ShownHop sums{std::move(hop), 0};
  add_hop(sums, first);
  for (ExplainedPart& part : sums.hop.parts) {
    part.stream.reset();
    part.sequence.reset();
    part.gate_entry.reset();
    part.missing_bits.reset();
  }
  return std::move(sums.hop);
}

}  // namespace

std::string ShownHop::place_of(const ExplainedPart& part) const {
  return count == 1
             ? explain::place_of(hop, part)
             : fmt::format("{}:{} to {}, {} hops", hop.node, hop.port.value_or(0), hop.to.value_or("nothing"), count);
}

std::vector<ShownHop> shown_hops(const ExplainedFrame& frame) {
  std::vector<ShownHop> shown;
  if (frame.hops.size() <= most_hops) {
    for (const ExplainedHop& hop : frame.hops) shown.push_back({hop});
    return shown;
  }
  std::vector<std::size_t> order;  // hops at which the frame waited, the longest first
  for (std::size_t i = 0; i < frame.hops.size(); ++i)
    if (wait_of(frame.hops[i]) > Duration()) order.push_back(i);
  std::ranges::stable_sort(order, std::ranges::greater(), [&](std::size_t i) { return wait_of(frame.hops[i]); });
  order.resize(std::min(order.size(), most_waits));
  bool is_run = false;  // the last one is of hops that are summed
  for (std::size_t i = 0; i < frame.hops.size(); ++i) {
    const ExplainedHop& hop = frame.hops[i];
    const bool is_alone = !hop.port || i + 1 == frame.hops.size() || std::ranges::find(order, i) != order.end();
    if (is_alone) {
      shown.push_back({hop});
    } else if (is_run) {
      add_hop(shown.back(), hop);
    } else {
      // A single hop between two others keeps what it says.
      const bool is_single =
          i + 1 < frame.hops.size() && (i + 2 == frame.hops.size() || std::ranges::find(order, i + 1) != order.end());
      shown.push_back({is_single ? hop : summed(hop)});
    }
    is_run = !is_alone;
  }
  return shown;
}

}  // namespace takt::explain
