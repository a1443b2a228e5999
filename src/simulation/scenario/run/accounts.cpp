// SPDX-License-Identifier: Apache-2.0
#include "scenario/run/accounts.hpp"

#include <algorithm>
#include <set>
#include <string_view>
#include <utility>

#include "results/run_result.hpp"
#include "scenario/figures/requirement.hpp"

namespace takt::scenario {

std::vector<Duration> account_instants(const Resolved& resolved) {
  std::set<Duration> instants = {resolved.scenario.warm_up};
  for (const RequiredFigure& required : resolved.requirements) instants.insert(required.from);
  return {instants.begin(), instants.end()};
}

namespace {

/// Limits on misses one after another ask which frames come in time.
void keep_timely(const Resolved& resolved, models::Network& network) {
  std::set<std::pair<std::string_view, Duration>> kept;
  for (const RequiredFigure& required : resolved.requirements) {
    const bool is_of_frames = required.figure.steps.size() == 3 && required.figure.steps[2] == "misses";
    const Duration deadline = required.deadline.value_or(Duration::max());
    if (!is_of_frames || !kept.insert({required.subject, deadline}).second) continue;
    const auto& streams = resolved.plan.streams;
    const auto stream = std::ranges::find(streams, required.subject, &models::StreamPlan::name);
    network.keep_timely({static_cast<std::uint32_t>(stream - streams.begin())}, deadline);
  }
}

}  // namespace

void keep_accounts(const Resolved& resolved, models::Network& network) {
  const auto streams = static_cast<std::uint32_t>(network.traffic().streams().size());
  for (const Duration from : account_instants(resolved)) {
    if (from == Duration()) continue;  // every stream has that account
    // Figures may be of any stream.
    std::set<std::string_view> named;
    bool of_all = from == resolved.scenario.warm_up;
    for (const RequiredFigure& required : resolved.requirements) {
      if (required.from != from) continue;
      of_all |= required.kind == results::RequirementKind::figure;
      named.insert(required.subject);
    }
    for (std::uint32_t s = 0; s < streams; ++s)
      if (of_all || named.contains(network.traffic().stream({s}).name))
        network.keep_account({s}, sim::TrueTime() + from);
  }
  keep_timely(resolved, network);
  const bool links_double =
      std::any_of(resolved.plan.impairments.begin(), resolved.plan.impairments.end(),
                  [](const models::ImpairmentPlan& plan) { return plan.impairment.duplication.has_value(); });
  if (links_double)
    for (std::uint32_t s = 0; s < resolved.plan.streams.size(); ++s) network.keep_arrivals({s});
  else
    for (const ResolvedRedundancy& redundancy : resolved.redundancies) network.keep_arrivals(redundancy.stream);
}

}  // namespace takt::scenario
