// SPDX-License-Identifier: Apache-2.0
// Puts a problem together from names: nodes, links and streams that refer to each other, all of it checked and in
// range.
#pragma once

#include <string>
#include <unordered_map>
#include <vector>

#include "schedule_instances/pick.hpp"

namespace takt::schedule_instances {

/// What numbers may be: such that no sum of the search overflows.
inline constexpr Range octets_range{1, 1'000'000};
inline constexpr Range frames_range{1, 4'096};
inline constexpr Range rate_range{1'000'000, 8'000'000'000'000};  ///< bit/s
inline constexpr Range delay_range{0, 100'000'000'000'000};       ///< ps
inline constexpr Range period_range{1, schedule::longest_time >> 4};
inline constexpr Range time_range{0, schedule::longest_time};

/// Where in its files the parts of a problem stand, by their indices.
struct Places {
  json::Place whole;
  std::vector<json::Place> nodes, links, streams;
};

struct Instance {
  schedule::Problem problem;
  Places places = {};
};

class Builder {
 public:
  explicit Builder(json::Diagnostics& diagnostics) : diagnostics_(diagnostics) {}
  /// Goes on with a problem.
  Builder(const schedule::Problem& problem, json::Diagnostics& diagnostics);

  void add_node(const std::string& name, bool is_bridge, const json::Place& where);
  bool has_node(const std::string& name) const { return nodes_.contains(name); }
  /// Octet time from a rate in bit/s; told if it is no whole number of ps.
  schedule::Ps octet_of(std::int64_t rate, const json::Place& where);
  void add_link(schedule::Link link, const std::string& from, const std::string& to, const json::Place& where);
  schedule::NodeIndex node(const std::string& name, const json::Place& where);
  std::optional<schedule::LinkIndex> link(const std::string& name) const;
  std::optional<schedule::StreamIndex> stream(const std::string& name) const;
  std::optional<schedule::LinkIndex> link_between(const std::string& from, const std::string& to) const;
  /// Orders the links of a route so that each is behind the one that it continues; told if that cannot be, or if it
  /// misses a listener.
  void set_route(schedule::Stream& stream, std::vector<schedule::LinkIndex> links, const json::Place& where);
  void add_stream(schedule::Stream stream, const json::Place& where);

  schedule::Problem& problem() { return problem_; }
  /// What has come together; the builder is empty then.
  Instance take() { return {std::move(problem_), std::move(places_)}; }
  json::Diagnostics& diagnostics() { return diagnostics_; }

 private:
  json::Diagnostics& diagnostics_;
  schedule::Problem problem_;
  Places places_;
  std::unordered_map<std::string, schedule::NodeIndex> nodes_;
  std::unordered_map<std::string, schedule::LinkIndex> links_;
  std::unordered_map<std::uint64_t, schedule::LinkIndex> between_;
  std::unordered_map<std::string, schedule::StreamIndex> streams_;
};

}  // namespace takt::schedule_instances
