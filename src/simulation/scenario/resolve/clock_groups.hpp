// SPDX-License-Identifier: Apache-2.0
// Which clocks a run compares with each other, and how often it looks at them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scenario/resolved/resolved.hpp"

namespace takt::scenario {

/// Nodes whose clocks are compared with each other.
struct ClockGroup {
  std::string name;                  ///< "all", "ways", or the nodes of a requirement: "a, b"
  std::vector<std::uint32_t> nodes;  ///< ascending
};

/// The nodes that ways of streams join, directly or over other ways: what happens to a frame rests on no other
/// differences between clocks. One set for each part of the network that no stream leaves.
std::vector<std::vector<std::uint32_t>> nodes_joined_by_ways(const Resolved& resolved);

/// All nodes; those joined by ways, where there is gPTP those with it, "ways 1" and so on where streams leave the
/// network in several parts; and what requirements ask for.
std::vector<ClockGroup> clock_groups(const Resolved& resolved);
/// The name of the group that a requirement asks for, and whether the nodes are all.
std::string clock_group_name(const Names& clocks);
inline constexpr const char* all_clocks = "all";
/// The names of groups that are made of ways begin with it.
inline constexpr const char* clocks_on_ways = "ways";

/// Nothing if nobody looks: neither gPTP nor a requirement on differences of clocks.
std::optional<Duration> look_every(const Resolved& resolved);

/// For how long nodes may follow different grandmasters while one is elected: until what an old one announced is too
/// old, and one that comes back has measured its links.
Duration election_time(const Gptp& gptp);

}  // namespace takt::scenario
