#include "scenario/run/accounts.hpp"

#include <algorithm>
#include <set>

#include "scenario/figures/requirement_rules.hpp"

namespace takt::scenario {

std::vector<Duration> account_instants(const Scenario& scenario) {
  std::set<Duration> instants = {scenario.warm_up};
  for (const Requirement& requirement : scenario.require) instants.insert(counts_from(scenario, requirement));
  return {instants.begin(), instants.end()};
}

void keep_accounts(const Resolved& resolved, models::Network& network) {
  const Scenario& scenario = resolved.scenario;
  const auto streams = static_cast<std::uint32_t>(network.traffic().streams().size());
  for (const Duration from : account_instants(scenario)) {
    if (from == Duration()) continue;  // every stream has that account
    // Figures may be of any stream.
    std::set<std::string_view> named;
    bool of_all = from == scenario.warm_up;
    for (const Requirement& requirement : scenario.require) {
      if (counts_from(scenario, requirement) != from) continue;
      of_all |= requirement.figure.has_value();
      if (requirement.stream) named.insert(*requirement.stream);
    }
    for (std::uint32_t s = 0; s < streams; ++s)
      if (of_all || named.contains(network.traffic().stream({s}).name)) network.keep_account({s}, sim::TrueTime() + from);
  }
  const bool links_double = std::any_of(resolved.plan.impairments.begin(), resolved.plan.impairments.end(),
                                        [](const models::ImpairmentPlan& plan) { return plan.impairment.duplication.has_value(); });
  if (links_double)
    for (std::uint32_t s = 0; s < resolved.plan.streams.size(); ++s) network.keep_arrivals({s});
  else
    for (const ResolvedRedundancy& redundancy : resolved.redundancies) network.keep_arrivals(redundancy.stream);
}

}  // namespace takt::scenario
