// SPDX-License-Identifier: Apache-2.0
#include "scenario/run/accounts.hpp"

#include <algorithm>
#include <set>

#include "results/run_result.hpp"
#include "scenario/figures/requirement.hpp"

namespace takt::scenario {

std::vector<Duration> account_instants(const Resolved& resolved) {
  std::set<Duration> instants = {resolved.scenario.warm_up};
  for (const RequiredFigure& required : resolved.requirements) instants.insert(required.from);
  return {instants.begin(), instants.end()};
}

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
  const bool links_double =
      std::any_of(resolved.plan.impairments.begin(), resolved.plan.impairments.end(),
                  [](const models::ImpairmentPlan& plan) { return plan.impairment.duplication.has_value(); });
  if (links_double)
    for (std::uint32_t s = 0; s < resolved.plan.streams.size(); ++s) network.keep_arrivals({s});
  else
    for (const ResolvedRedundancy& redundancy : resolved.redundancies) network.keep_arrivals(redundancy.stream);
}

}  // namespace takt::scenario
