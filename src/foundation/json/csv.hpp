// SPDX-License-Identifier: Apache-2.0
// Tables of JSON objects as CSV (RFC 4180).
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "json/node.hpp"

namespace takt::json {

/// A column and where its cells are in the row's object: "/latency_ps/min"; "/dropped/*" is the sum of all members.
struct Column {
  std::string_view name;
  std::string_view pointer;
};

/// A row: cells that come first, and the object that the others are found in. What is null or not there is an empty
/// cell, true is 1.
struct Row {
  std::vector<std::string> first;
  const Node* object = nullptr;
};

std::string csv(std::span<const std::string_view> first, std::span<const Column> columns, std::span<const Row> rows);

}  // namespace takt::json
