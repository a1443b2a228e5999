// SPDX-License-Identifier: Apache-2.0
#include "scenario/gates/beginning.hpp"

#include <algorithm>

#include "models/ethernet/sizes.hpp"
#include "scenario/gates/crossings.hpp"

namespace takt::scenario {
namespace {

/// Where the longest time of the other classes ends, and how long it is; nothing if it never begins or ends.
struct OthersEnd {
  Duration at;
  Duration length;
};
std::optional<OthersEnd> longest_of_others(const GateList& list, models::GateStates scheduled) {
  const auto is_open = [&](const GateList::Entry& entry) {
    return (entry.open & static_cast<models::GateStates>(~scheduled)) != 0;
  };
  std::optional<OthersEnd> longest;
  Duration at, length;
  for (int round = 0; round < 2; ++round)  // it may go over the end of the cycle
    for (const GateList::Entry& entry : list.entries) {
      if (is_open(entry))
        length += entry.interval;
      else {
        if (length > Duration() && length < list.cycle && (!longest || length > longest->length))
          longest = OthersEnd{Duration::from_ps(modulo(at.ps(), list.cycle.ps())), length};
        length = Duration();
      }
      at += entry.interval;
    }
  return longest;
}

Duration rounded_up(Duration time, Duration to) { return to * ((time.ps() + to.ps() - 1) / to.ps()); }

/// The entries from that instant of the cycle on.
std::vector<GateList::Entry> turned(const GateList& list, Duration begin) {
  std::vector<GateList::Entry> behind, before;
  const auto add = [](std::vector<GateList::Entry>& to, models::GateStates open, Duration interval) {
    if (interval <= Duration()) return;
    if (!to.empty() && to.back().open == open)
      to.back().interval += interval;
    else
      to.push_back({open, interval});
  };
  Duration at;
  for (const GateList::Entry& entry : list.entries) {
    const Duration first = std::clamp(begin - at, Duration(), entry.interval);
    add(before, entry.open, first);
    add(behind, entry.open, entry.interval - first);
    at += entry.interval;
  }
  for (const GateList::Entry& entry : before) add(behind, entry.open, entry.interval);
  return behind;
}

}  // namespace

std::optional<Duration> clocks_synchronised_from(const Scenario& scenario) {
  if (!scenario.clocks.gptp) return std::nullopt;
  std::optional<Duration> from;
  for (const Requirement& required : scenario.require)
    if (required.sync || required.clocks)
      from = std::min(from.value_or(Duration::max()), required.after.value_or(scenario.warm_up));
  return from.value_or(scenario.warm_up);
}

BegunList begun_list(const GateList& list, const GatedPort& port, models::GateStates scheduled, Duration from) {
  Duration begin;
  if (const auto others = longest_of_others(list, scheduled)) {
    const auto octets = models::wire_length(port.longest_frame).count;
    const Duration frame = port.gap * octets / models::inter_packet_gap.count;
    const Duration early = port.guard >= frame
                               ? Duration()
                               : rounded_up(std::max(frame, port.limits.least_interval), port.limits.granularity);
    begin = others->at;
    // Whether there is an entry for it shows when it is laid.
    if (others->length >= early + port.limits.least_interval) {
      const Duration sooner = Duration::from_ps(modulo((begin - early).ps(), list.cycle.ps()));
      if (turned(list, sooner).size() <= port.limits.entries) begin = sooner;
    }
  }
  const std::int64_t cycles = (std::max(from - begin, Duration()).ps() + list.cycle.ps() - 1) / list.cycle.ps();
  return {begin + list.cycle * cycles, turned(list, begin)};
}

}  // namespace takt::scenario
