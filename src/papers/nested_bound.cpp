#include "papers/nested_bound.hpp"

#include <algorithm>

#include "analysis/reaction_bound.hpp"

namespace takt::papers {
namespace {

using analysis::MaxPlus;
using analysis::Ps;

analysis::ReactionGroup group_of(const scenario::Resolved& resolved, const analysis::Bounds& bounds, std::size_t number) {
  const scenario::ResolvedProgram& program = resolved.programs[number];
  const std::size_t n = program.participants.size();
  analysis::ReactionGroup group;
  group.notify = analysis::MaxPlusMatrix(n, n);
  for (std::size_t p = 0; p < n; ++p) {
    const Ps wake_up = resolved.plan.os_latencies[resolved.plan.nodes[program.participants[p].value].os_latency].wake_up.greatest().ps();
    group.initialise.push_back(MaxPlus(program.description->initialisation.ps() + wake_up));
    // A change waits for the next publication, a cycle and the wake-up at most, and is then on its way.
    const analysis::StreamBound& stream = bounds.streams[program.state_streams[p].value];
    const models::StreamPlan& plan = resolved.plan.streams[stream.index.value];
    for (std::size_t l = 0; l < plan.listeners.size(); ++l) {
      const auto to = std::find(program.participants.begin(), program.participants.end(), plan.listeners[l]);
      const Ps latency = stream.by_listener[l] ? stream.by_listener[l]->ps() : analysis::unbounded_ps;
      if (to != program.participants.end())
        group.notify(static_cast<std::size_t>(to - program.participants.begin()), p) = MaxPlus(analysis::sum(program.description->cycle.ps() + wake_up, latency));
    }
  }
  for (std::size_t other = 0; other < resolved.programs.size(); ++other)
    if (const auto& outer = resolved.programs[other].outer; outer && outer->program == number)
      group.inner.push_back({outer->participant, group_of(resolved, bounds, other)});
  return group;
}

}  // namespace

std::optional<sim::Duration> bound_of_tree(const scenario::Resolved& resolved, const analysis::Bounds& bounds, bool is_start) {
  const analysis::ReactionGroup tree = group_of(resolved, bounds, 0);
  const MaxPlus bound = is_start ? analysis::start_bound(tree) : analysis::spread_bound(tree);
  if (!analysis::is_bounded(bound.ps())) return std::nullopt;
  return sim::Duration::from_ps(bound.ps());
}

}  // namespace takt::papers
