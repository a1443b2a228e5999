// SPDX-License-Identifier: Apache-2.0
#include "scenario/applications/qos_places.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

namespace takt::scenario {
namespace {

/// Names of src/protocol/dds/qos, and the keys that say them.
constexpr std::array<std::pair<std::string_view, std::string_view>, 9> keys{{
    {"durability_service.", "durability_service"},
    {"history.depth", "depth"},
    {"resource_limits.", "resource_limits"},
    {"reliability.max_blocking_time", "max_blocking_time"},
    {"deadline.period", "deadline"},
    {"latency_budget.duration", "latency_budget"},
    {"liveliness.lease_duration", "lease_duration"},
    {"lifespan.duration", "lifespan"},
    {"time_based_filter.minimum_separation", "time_based_filter"},
}};

std::optional<json::Place> place_in(const Qos* qos, std::string_view key) {
  if (qos == nullptr || !qos->where.has(key)) return std::nullopt;
  return qos->where.at(key);
}

}  // namespace

json::Place place_of_problem(const QosSources& sources, std::string_view problem) {
  // In the order in which the problem names them: first what is wrong, then what it contradicts.
  std::vector<std::pair<std::size_t, std::string_view>> named;
  for (const auto& [name, key] : keys)
    if (const std::size_t at = problem.find(name); at != std::string_view::npos) named.emplace_back(at, key);
  std::sort(named.begin(), named.end());
  for (const auto& [at, key] : named)
    for (const Qos* const qos : {sources.own, sources.topic})
      if (auto place = place_in(qos, key)) return *std::move(place);
  // "ownership: ..." and other policies of one key.
  return place_of_policy(sources, problem.substr(0, problem.find_first_of(".: ")));
}

json::Place place_of_policy(const QosSources& sources, std::string_view key) {
  for (const Qos* const qos : {sources.own, sources.topic})
    if (auto place = place_in(qos, key)) return *std::move(place);
  return sources.endpoint;
}

json::Place place_of_mismatch(const QosSources& reader, const QosSources& writer, const dds::Mismatch& mismatch) {
  const bool is_lease = mismatch.reason.starts_with("lease duration");
  const std::string_view key = is_lease ? "lease_duration" : dds::name_of(mismatch.policy);
  for (const Qos* const qos : {reader.own, writer.own, reader.topic})
    if (auto place = place_in(qos, key)) return *std::move(place);
  return reader.endpoint;
}

}  // namespace takt::scenario
