// SPDX-License-Identifier: Apache-2.0
#include "tests/generator/features.hpp"

#include <algorithm>
#include <array>

#include "tests/generator/draw.hpp"

namespace takt::generator {

std::span<const FeatureEntry> features() {
  using enum Feature;
  static const std::vector<FeatureEntry> all = {
      {generated, "generated", "network.generate"},
      {stations, "stations", "node=station generator.stations"},
      {rates, "rates", "link.rate"},
      {latencies, "latencies", "host.os generator.os"},
      {processors, "processors", "host.cpu station.cpu"},
      {queue_limits, "queue_limits", "queues.frames"},
      {identity_classes, "identity_classes", "switch.traffic_classes generator.traffic_classes"},
      {gates, "gates", "egress.gates"},
      {hold, "hold", "gate_entry.mac", {gates, preemption}},
      {set_gates, "set_gates", "script_entry.set_gates"},
      {automatic_gates, "automatic_gates", "network_gates.plan=auto"},
      {listed_gates, "listed_gates", "network_gates.lists"},
      {shapers, "shapers", "egress.shapers"},
      {ets, "ets", "egress.ets"},
      {max_sdu, "max_sdu", "egress.max_sdu"},
      {preemption, "preemption", "egress.preemption"},
      {cut_through, "cut_through", "egress.cut_through"},
      {untagged, "untagged", "egress.untagged"},
      {policing, "policing", "ingress.filters"},
      {ats, "ats", "egress.ats"},
      {cqf, "cqf", "ingress.cqf"},
      {identification, "identification", "ingress.streams"},
      {launch, "launch", "stream.launch"},
      {multicast, "multicast", "stream.to:several"},
      {explicit_path, "explicit_path", "stream.path"},
      {redundancy, "redundancy", "stream.redundancy"},
      {overload, "overload", "scenario.allow_overload"},
      {traces, "traces", "stream.trace"},
      {link_down, "link_down", "link-down.at"},
      {frame_errors, "frame_errors", "frame-errors.link"},
      {crash, "crash", "crash.at"},
      {babble, "babble", "babble.at"},
      {stuck_gate, "stuck_gate", "stuck-gate.at"},
      {clock_fault, "clock_fault", "clock-fault.at", {oscillators}},
      {rerouting, "rerouting", "scenario.rerouting"},
      {oscillators, "oscillators", "scenario.clocks"},
      {gptp, "gptp", "clocks.gptp"},
      {hot_standby, "hot_standby", "gptp.hot_standby", {gptp}},
      {programs, "programs", "scenario.programs"},
      {paper_variant, "paper_variant", "program.variant=paper", {programs}},
      {roles, "roles", "program.roles", {programs}},
      {nesting, "nesting", "program.within", {programs}},
      {replies, "replies", "program.replies", {programs}},
      {opc_ua, "opc_ua", "topic.protocol=opc-ua"},
      {dds, "dds", "topic.protocol=dds"},
      {gateways, "gateways", "scenario.gateways", {opc_ua, dds}},
      {persistence, "persistence", "scenario.persistence", {dds}},
      {signals, "signals", "thread.signal", {opc_ua}},
      {security, "security", "program.security", {programs}},
  };
  return all;
}

bool has(const Keys& keys, const FeatureEntry& feature) {
  return std::ranges::any_of(words_of(feature.key), [&](const std::string& key) { return keys.contains(key); });
}

const FeatureEntry& entry_of(Feature feature) { return features()[static_cast<std::size_t>(feature) - 1]; }

std::span<const Exclusion> exclusions() {
  using enum Feature;
  static constexpr std::array all = {
      Exclusion{automatic_gates, listed_gates, "one \"gates\" of a scenario says either"},
      Exclusion{automatic_gates, rerouting, "windows lie along one path: rerouting of scheduled streams is refused"},
  };
  return all;
}

bool excludes(Feature a, Feature b) {
  return std::ranges::any_of(exclusions(), [&](const Exclusion& each) {
    return (each.a == a && each.b == b) || (each.a == b && each.b == a);
  });
}

std::vector<std::pair<Feature, Feature>> pairs() {
  std::vector<std::pair<Feature, Feature>> all;
  for (const FeatureEntry& a : features())
    for (const FeatureEntry& b : features())
      if (a.feature < b.feature && !excludes(a.feature, b.feature)) all.emplace_back(a.feature, b.feature);
  return all;
}

}  // namespace takt::generator
