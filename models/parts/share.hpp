// SPDX-License-Identifier: Apache-2.0
// Which nodes of a network act. A run on several threads has several networks that are alike, and each node acts in one
// of them.
#pragma once

#include <cstdint>
#include <span>

#include "models/ethernet/frame.hpp"

namespace takt::models {

class FrameExchange;

struct Share {
  std::span<const std::uint32_t> part_of_node = {};  ///< empty: all nodes act here
  std::uint32_t part = 0;
  FrameExchange* exchange = nullptr;  ///< takes what leaves for nodes that act elsewhere; null if all act here

  bool is_whole() const { return part_of_node.empty(); }
  bool has(NodeIndex node) const { return is_whole() || part_of_node[node.value] == part; }
  std::uint32_t part_of(NodeIndex node) const { return is_whole() ? part : part_of_node[node.value]; }
};

}  // namespace takt::models
