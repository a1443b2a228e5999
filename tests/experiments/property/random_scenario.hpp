// SPDX-License-Identifier: Apache-2.0
// Random scenario files that combine features, as text, so that a counter-example is a file that can be kept and run.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace takt::property {

/// What a random scenario may use besides switches, hosts and streams.
enum class Feature : std::uint8_t {
  gates,
  shapers,
  ats,
  preemption,
  cut_through,
  policing,
  redundancy,
  cqf,
  max_sdu,
  queue_limits,
  launch,
  frame_errors,
  link_down,
  crash,
  stuck_gate,
  rerouting,
  babble,
  multicast,
  rates,
  set_gates,
  latencies,
  untagged,
  identity_classes,
  overload,
  hold,
  count
};
std::string_view name_of(Feature feature);

/// What is asked for. The details are a function of the seed and of the element that they belong to, so that a scenario
/// with fewer streams, or without a feature, is otherwise the same.
struct Wishes {
  std::vector<Feature> features;
  std::size_t switches = 1;
  std::size_t hosts = 2;
  std::size_t streams = 1;
  std::uint64_t seed = 0;
};

/// The text of the scenario; it may ask for something that is refused.
std::string scenario_text(const Wishes& wishes);

}  // namespace takt::property
