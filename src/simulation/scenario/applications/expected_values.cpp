// SPDX-License-Identifier: Apache-2.0
#include "scenario/applications/expected_values.hpp"

#include <algorithm>
#include <set>

namespace takt::scenario {
namespace {

/// Gateways that feed each other in a circle have no further source there.
using Visited = std::set<std::uint32_t>;

/// The publications that a gateway sends on; null for who makes its samples itself.
const std::vector<ResolvedInput>* sources_of(const Resolved& resolved, const ResolvedInput& publication) {
  const ResolvedApplication& application = resolved.applications[publication.application];
  if (!application.gateway) return nullptr;
  const auto receives = std::find_if(application.threads.begin(), application.threads.end(),
                                     [](const ResolvedThread& thread) { return !thread.publishes; });
  return &receives->inputs;
}

Duration interval_of(const Resolved& resolved, const ResolvedInput& publication) {
  return resolved.applications[publication.application].threads[publication.thread].every;
}

std::uint64_t expected(const Resolved& resolved, const ResolvedInput& publication, Duration window, Visited& visited) {
  const auto own = static_cast<std::uint64_t>(window / interval_of(resolved, publication));
  const std::vector<ResolvedInput>* const sources = sources_of(resolved, publication);
  if (sources == nullptr) return own;
  if (!visited.insert(publication.application).second) return 0;
  std::uint64_t got = 0;
  for (const ResolvedInput& source : *sources) got += expected(resolved, source, window, visited);
  visited.erase(publication.application);
  return std::min(own, got);
}

Duration slowest(const Resolved& resolved, const ResolvedInput& publication, Visited& visited) {
  Duration longest = interval_of(resolved, publication);
  const std::vector<ResolvedInput>* const sources = sources_of(resolved, publication);
  if (sources == nullptr || !visited.insert(publication.application).second) return longest;
  for (const ResolvedInput& source : *sources) longest = std::max(longest, slowest(resolved, source, visited));
  return longest;
}

}  // namespace

std::uint64_t values_expected(const Resolved& resolved, const ResolvedInput& publication, Duration window) {
  Visited visited;
  return expected(resolved, publication, window, visited);
}

Duration slowest_interval(const Resolved& resolved, const ResolvedInput& publication) {
  Visited visited;
  return slowest(resolved, publication, visited);
}

}  // namespace takt::scenario
