// SPDX-License-Identifier: Apache-2.0
// Where a scenario says a policy of a writer or reader: at its thread, otherwise at its topic.
#pragma once

#include <string_view>
#include <vector>

#include "dds/qos/matching.hpp"
#include "scenario/description/dds.hpp"

namespace takt::scenario {

/// What a file says of the quality of service of an endpoint; either may be null.
struct QosSources {
  const Qos* own = nullptr;
  const Qos* topic = nullptr;
  json::Place endpoint;  ///< where neither says anything
};

/// `problem` is one of dds::problems_of ("history.depth: 5 is above resource_limits.max_samples 3"): the place of the
/// first key in it that is written.
json::Place place_of_problem(const QosSources& sources, std::string_view problem);
/// Where a key is written, at the endpoint or its topic.
json::Place place_of_policy(const QosSources& sources, std::string_view key);
/// The first written key of the policies that do not fit, at the reader's thread, at the writer's, at their topic.
json::Place place_of_mismatch(const QosSources& reader, const QosSources& writer, const dds::Mismatch& mismatch);

}  // namespace takt::scenario
