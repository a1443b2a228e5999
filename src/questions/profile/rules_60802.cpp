// SPDX-License-Identifier: Apache-2.0
// IEC/IEEE 60802: synchronisation (6.2), bridges and what they announce (6.4.10.3).
#include <algorithm>
#include <cstdlib>

#include "json/quantity.hpp"
#include "profile/common.hpp"
#include "profile/rules.hpp"
#include "scenario/description/device.hpp"

namespace takt::profile {
namespace {

using scenario::Clock;
using scenario::Resolved;
using sim::Duration;
using namespace sim::literals;  // NOLINT: limits

constexpr std::int64_t ppm = 1'000'000;  // parts per trillion

std::int64_t greatest_of(const scenario::FrequencyRange& range) {
  std::int64_t greatest = 0;
  for (const auto* const each : {&range.fixed, &range.from, &range.to})
    if (*each) greatest = std::max<std::int64_t>(greatest, std::abs((*each)->parts_per_trillion));
  return greatest;
}

/// Of each clock that is not ideal, what `value` makes of it, at most `limit`.
template <class Value>
void judge_clocks(const Resolved& r, Found& found, std::int64_t limit, Value&& value) {
  const auto clocks = clocks_of(r);
  if (clocks.empty()) return found.unknown("ideal clocks");
  for (const Clock* const clock : clocks)
    if (!clock->ideal) {
      const auto [amount, text] = value(*clock);
      found.judge(amount <= limit, text, clock->where.place());
    }
  if (found.entries.empty()) found.unknown("ideal clocks");
}

void look_at_frequency(const Resolved& r, Found& found) {
  judge_clocks(r, found, 50 * ppm, [](const Clock& clock) {
    const std::int64_t most = greatest_of(clock.offset);
    return std::pair(most, json::to_text(sim::FrequencyOffset{most}));
  });
}

void look_at_drift(const Resolved& r, Found& found) {
  judge_clocks(r, found, ppm, [](const Clock& clock) {
    std::int64_t most = greatest_of(clock.drift);
    std::string text = json::to_text(sim::FrequencyOffset{most}) + " in a second";
    if (clock.temperature) {
      // The slope of a sine is 2 pi of its amplitude a period; rounded up.
      const auto milliseconds = std::max<std::int64_t>(1, clock.temperature->period / 1_ms);
      const std::int64_t slope = clock.temperature->amplitude.parts_per_trillion * 6'284 / milliseconds + 1;
      most += slope;
      text += ", and " + json::to_text(sim::FrequencyOffset{slope}) + " by temperature";
    }
    return std::pair(most, text);
  });
}

void look_at_granularity(const Resolved& r, Found& found) {
  judge_clocks(r, found, 8'000,
               [](const Clock& clock) { return std::pair(clock.granularity.ps(), json::to_text(clock.granularity)); });
}

void look_at_sync_interval(const Resolved& r, Found& found) {
  judge_interval(r, found, -3, &scenario::Gptp::log_sync_interval, "log_sync_interval");
}

void look_at_pdelay_interval(const Resolved& r, Found& found) {
  judge_interval(r, found, -3, &scenario::Gptp::log_pdelay_interval, "log_pdelay_interval");
}

void look_at_residence(const Resolved& r, Found& found) {
  if (!r.scenario.clocks.gptp) return found.unknown("no gPTP");
  Duration most;
  for (const models::gptp::StationPlan& station : r.plan.gptp_stations)
    most = std::max(most, station.processing.greatest());
  found.judge(most <= 15_ms, "at most " + json::to_text(most), r.scenario.clocks.gptp->where.at("processing"));
}

void look_at_drift_tracking(const Resolved& r, Found& found) {
  if (!r.scenario.clocks.gptp) return found.unknown("no gPTP");
  const bool tracks = r.scenario.clocks.gptp->drift_tracking;
  found.judge(tracks, tracks ? "the Drift_Tracking TLV" : "none", r.scenario.clocks.gptp->where.at("drift_tracking"));
}

void look_at_hops(const Resolved& r, Found& found) {
  const auto hops = longest_way(r);
  if (!hops) return found.unknown("a network of more than 2000 nodes");
  found.judge(*hops <= 64, std::to_string(*hops) + " links between the farthest two");
}

void look_at_sync_budget(const Resolved& r, Found& found) {
  for (const scenario::Requirement& requirement : r.scenario.require)
    if (requirement.sync)
      found.judge(*requirement.sync <= 1_us, "a required offset of at most " + json::to_text(*requirement.sync),
                  requirement.where.at("sync"));
  if (found.entries.empty()) found.unknown("no requirement \"sync\"");
}

void look_at_classes(const Resolved& r, Found& found) {
  std::vector<std::string> few, fewer;
  for (const scenario::TopologyNode& node : r.topology.nodes) {
    if (!node.forwards()) continue;
    const unsigned count = scenario::count_of(scenario::ports_of(node.description).traffic_classes);
    if (count < 4)
      fewer.push_back(node.name + " with " + std::to_string(count));
    else if (count < 8)
      few.push_back(node.name + " with " + std::to_string(count));
  }
  if (!fewer.empty()) found.missed(some_of(fewer));
  if (!few.empty()) found.met("class B: " + some_of(few));
  if (few.empty() && fewer.empty()) found.met("class A: eight at all bridges");
}

/// Bridges of class A have the feature; what no device says is unknown.
void look_at_feature(const Resolved& r, Found& found, std::optional<bool> scenario::DeviceFeatures::*feature,
                     bool no_gates) {
  std::vector<std::string> without, unknown;
  for (const scenario::TopologyNode& node : r.topology.nodes) {
    if (!node.forwards()) continue;
    const scenario::NodePorts& ports = scenario::ports_of(node.description);
    const std::optional<bool> has = ports.type.of ? ports.type.of->features.*feature : std::nullopt;
    if (has == false || (no_gates && ports.gates))
      without.push_back(node.name);
    else if (!has)
      unknown.push_back(node.name);
  }
  if (!without.empty()) found.missed("none at " + some_of(without));
  if (!unknown.empty()) found.unknown("no device says it of " + some_of(unknown));
  if (found.entries.empty()) found.met("all bridges");
}

void look_at_gates(const Resolved& r, Found& found) {
  look_at_feature(r, found, &scenario::DeviceFeatures::gates, true);
}

void look_at_preemption(const Resolved& r, Found& found) {
  look_at_feature(r, found, &scenario::DeviceFeatures::preemption, false);
}

void look_at_delays(const Resolved& r, Found& found) {
  std::vector<std::string> unknown;
  for (const scenario::TopologyNode& node : r.topology.nodes) {
    if (!node.forwards()) continue;
    const scenario::DeviceType& type = scenario::ports_of(node.description).type;
    if (!type.of || type.of->delays.empty()) unknown.push_back(node.name);
  }
  if (!unknown.empty()) return found.unknown("no device says delays of " + some_of(unknown));
  found.met("all bridges");
}

constexpr Rule table_of_60802[] = {
    {"IEC/IEEE 60802 6.2", "Frequency of clocks", "at most 50 ppm off", look_at_frequency},
    {"IEC/IEEE 60802 6.2", "Drift of clocks", "at most 1 ppm in a second", look_at_drift},
    {"IEC/IEEE 60802 6.2", "Granularity of time stamps", "at most 8 ns", look_at_granularity},
    {"IEC/IEEE 60802 6.2", "Sync interval", "125 ms", look_at_sync_interval},
    {"IEC/IEEE 60802 6.2", "Pdelay interval", "125 ms", look_at_pdelay_interval},
    {"IEC/IEEE 60802 6.2", "Residence and turn-around time", "at most 15 ms", look_at_residence},
    {"IEC/IEEE 60802 6.2", "Drift tracking", "the Drift_Tracking TLV", look_at_drift_tracking},
    {"IEC/IEEE 60802 6.2", "Links from a grandmaster to a clock", "at most 64", look_at_hops},
    {"IEC/IEEE 60802 6.2", "Working Clock: offset from the grandmaster", "at most 1 us", look_at_sync_budget},
    {"IEC/IEEE 60802 5", "Traffic classes of bridges", "8 (class A), at least 4 (class B)", look_at_classes},
    {"IEC/IEEE 60802 5", "Scheduled traffic at bridges", "gates at all bridges of class A", look_at_gates},
    {"IEC/IEEE 60802 5", "Frame preemption at bridges", "at all bridges of class A", look_at_preemption},
    {"IEC/IEEE 60802 6.4.10.3.6.2", "Delays of bridges", "announced by each bridge", look_at_delays},
};

}  // namespace

std::span<const Rule> rules_of_60802() { return table_of_60802; }

}  // namespace takt::profile
