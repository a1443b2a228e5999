// SPDX-License-Identifier: Apache-2.0
// The features of scenarios that are combined at random: each is asked for by its number and seen by a key of the
// schema.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "tests/generator/coverage.hpp"

namespace takt::generator {

enum class Feature : std::uint8_t {
  any,  ///< what is always allowed
  generated,
  stations,
  rates,
  latencies,
  processors,
  queue_limits,
  identity_classes,
  gates,
  hold,
  set_gates,
  automatic_gates,
  listed_gates,
  shapers,
  ets,
  max_sdu,
  preemption,
  cut_through,
  untagged,
  policing,
  ats,
  cqf,
  identification,
  launch,
  multicast,
  explicit_path,
  redundancy,
  overload,
  traces,
  link_down,
  frame_errors,
  crash,
  babble,
  stuck_gate,
  clock_fault,
  rerouting,
  oscillators,
  gptp,
  hot_standby,
  programs,
  paper_variant,
  roles,
  nesting,
  replies,
  opc_ua,
  dds,
  gateways,
  persistence,
  signals,
  security,
  count
};

struct FeatureEntry {
  Feature feature{};
  std::string_view name;
  std::string_view key;  ///< of coverage.hpp: a scenario with it has the feature; or several, one of which is there
  std::vector<Feature> needs = {};  ///< asked for with it
};
/// By number, without `any`.
std::span<const FeatureEntry> features();
const FeatureEntry& entry_of(Feature feature);
/// Whether a scenario with these keys has the feature.
bool has(const Keys& keys, const FeatureEntry& feature);

/// Two features that no sound scenario has together.
struct Exclusion {
  Feature a{}, b{};
  std::string_view reason;
};
std::span<const Exclusion> exclusions();
bool excludes(Feature a, Feature b);

/// All pairs that may meet.
std::vector<std::pair<Feature, Feature>> pairs();

}  // namespace takt::generator
