// SPDX-License-Identifier: Apache-2.0
// A path that a scenario spells out, node by node.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "scenario/topology/routing.hpp"
#include "scenario/topology/topology.hpp"

namespace takt::scenario {

/// A node of a path, and the port by which it is left: "sw1", or "sw1:2" where several links lead on.
struct NamedStep {
  std::string_view node;
  std::optional<std::string_view> port;
};
NamedStep step_named(std::string_view name);
/// The path of names that are sound.
Path path_named(const Topology& topology, std::span<const std::string> names);

/// The path of these names from host `from` to host `to`. Mistakes are reported: at `place_of(i)` what is wrong with
/// name i, at `place` what is wrong with all.
std::optional<Path> named_path(const Topology& topology, std::span<const std::string> names, std::uint32_t from,
                               std::uint32_t to, const json::Place& place,
                               const std::function<json::Place(std::size_t)>& place_of, json::Diagnostics& diagnostics);

}  // namespace takt::scenario
