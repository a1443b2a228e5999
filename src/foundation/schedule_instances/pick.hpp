// SPDX-License-Identifier: Apache-2.0
// Members of JSON objects in the files of others: typed, in range, and told where they are not. Unlike our own files
// (json/fields.hpp) these may hold more than is asked for.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "json/reader.hpp"
#include "schedule/problem.hpp"

namespace takt::schedule_instances {

/// Whole numbers that are allowed.
struct Range {
  std::int64_t least = 0;
  std::int64_t most = schedule::longest_time;
};

class Pick {
 public:
  /// `object` may be anything; what is not an object is told and has no members.
  Pick(json::Reader& reader, const json::Node& object);

  const json::Node& node() const { return node_; }
  /// Null if it is not there, or is null.
  const json::Node* find(std::string_view key) const;
  /// Told if it is not there.
  const json::Node* need(std::string_view key) const;
  const json::Node* need_array(std::string_view key) const;
  std::string text(std::string_view key) const;
  bool truth(std::string_view key, std::optional<bool> otherwise = std::nullopt) const;
  std::int64_t whole(std::string_view key, Range range, std::optional<std::int64_t> otherwise = std::nullopt) const;
  std::optional<std::int64_t> whole_if_any(std::string_view key, Range range) const;
  /// A number, perhaps with a fraction, in units of `unit`; told if that is no whole number but for noise of binary
  /// fractions.
  std::int64_t scaled(std::string_view key, double unit, Range range,
                      std::optional<std::int64_t> otherwise = std::nullopt) const;
  std::optional<std::int64_t> scaled_if_any(std::string_view key, double unit, Range range) const;

  json::Reader& reader() const { return *reader_; }

 private:
  json::Reader* reader_;
  const json::Node& node_;
};

std::string text_of(json::Reader& reader, const json::Node& node);
std::int64_t whole_of(json::Reader& reader, const json::Node& node, Range range);
std::int64_t scaled_of(json::Reader& reader, const json::Node& node, double unit, Range range);

}  // namespace takt::schedule_instances
