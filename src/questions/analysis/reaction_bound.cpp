// SPDX-License-Identifier: Apache-2.0
#include "analysis/reaction_bound.hpp"

#include <algorithm>

namespace takt::analysis {
namespace {

using sim::Duration;

/// By participant: what an inner group adds between hearing and being ready to answer.
std::vector<MaxPlus> with_inner(const ReactionGroup& group, std::vector<MaxPlus> own,
                                MaxPlus (*of_inner)(const ReactionGroup&)) {
  for (const ReactionGroup::Inner& inner : group.inner) own[inner.slave] += of_inner(inner.group);
  return own;
}

/// The master tells the slaves, each does its part, and tells the master: up * diagonal(part) * down.
MaxPlus there_and_back(const ReactionGroup& group, const std::vector<MaxPlus>& part) {
  const std::size_t slaves = group.initialise.size() - 1;
  MaxPlusMatrix down(slaves, 1);
  MaxPlusMatrix up(1, slaves);
  MaxPlusMatrix acts(slaves, slaves);
  for (std::size_t s = 0; s < slaves; ++s) {
    down(s, 0) = group.notify(s + 1, 0);
    up(0, s) = group.notify(0, s + 1);
    acts(s, s) = part[s + 1];
  }
  return (up * acts * down)(0, 0);
}

/// All participants of a tree of groups; an inner master is its outer slave.
struct Layout {
  struct Way {
    std::size_t from = 0;
    Ps takes = 0;
    Ps not_before = 0;  // after the call
  };
  std::vector<std::vector<Way>> heard_from{1};  // by participant
  std::vector<bool> is_origin{false};           // likewise
  std::vector<std::string> names;
};

void lay_out(const ReactionGroup& group, std::size_t master, Spread spread, Layout& layout) {
  if (master == 0 && !group.names.empty()) layout.names = {group.names.front()};
  std::vector<std::size_t> number{master};
  for (std::size_t s = 1; s < group.initialise.size(); ++s) {
    number.push_back(layout.heard_from.size());
    layout.heard_from.emplace_back();
    layout.is_origin.push_back(false);
    if (!group.names.empty()) layout.names.push_back(group.names[s]);
  }
  const auto is_nested = [&](std::size_t p) {
    return std::any_of(group.inner.begin(), group.inner.end(), [&](const auto& inner) { return inner.slave == p; });
  };
  for (std::size_t i = 0; i < number.size(); ++i)
    if (group.origins.empty() || group.origins[i]) layout.is_origin[number[i]] = true;
  for (std::size_t i = 0; i < number.size(); ++i)
    for (std::size_t j = 0; j < number.size(); ++j) {
      if (i == j || !group.notify(i, j).happens()) continue;
      const bool waits = spread == Spread::after_barriers && j != 0 && is_nested(j) && group.notify(j, 0).happens();
      layout.heard_from[number[i]].push_back({number[j], group.notify(i, j).ps(), waits ? group.notify(j, 0).ps() : 0});
    }
  for (const ReactionGroup::Inner& inner : group.inner) lay_out(inner.group, number[inner.slave], spread, layout);
}

const ReactionGroup* inner_at(const ReactionGroup& group, std::size_t slave) {
  for (const ReactionGroup::Inner& inner : group.inner)
    if (inner.slave == slave) return &inner.group;
  return nullptr;
}

/// The slave whose way there and back takes longest.
std::size_t slowest_slave(const ReactionGroup& group, const std::vector<MaxPlus>& part) {
  std::size_t slowest = 1;
  const auto chain = [&](std::size_t s) { return group.notify(s, 0) * part[s] * group.notify(0, s); };
  for (std::size_t s = 1; s < group.initialise.size(); ++s)
    if (chain(s) > chain(slowest)) slowest = s;
  return slowest;
}

void append(std::vector<ReactionPart>& parts, std::vector<ReactionPart> more) {
  parts.insert(parts.end(), more.begin(), more.end());
}
ReactionPart part_of(std::string what, MaxPlus takes) { return {std::move(what), Duration::from_ps(takes.ps())}; }

}  // namespace

MaxPlus ready_bound(const ReactionGroup& group) {
  return group.initialise[0] + there_and_back(group, with_inner(group, group.initialise, ready_bound));
}

MaxPlus run_bound(const ReactionGroup& group) {
  return there_and_back(group, with_inner(group, std::vector(group.initialise.size(), MaxPlus::one()), run_bound));
}

MaxPlus start_bound(const ReactionGroup& group) { return ready_bound(group) * run_bound(group); }

std::vector<ReactionPart> ready_parts(const ReactionGroup& group) {
  const std::vector<MaxPlus> part = with_inner(group, group.initialise, ready_bound);
  const std::size_t s = slowest_slave(group, part);
  const std::string& master = group.names.front();
  if (group.initialise[0] > there_and_back(group, part)) return {part_of(master + " initialises", group.initialise[0])};
  std::vector<ReactionPart> parts{part_of(group.names[s] + " hears of INIT", group.notify(s, 0))};
  if (group.initialise[s] == part[s])
    parts.push_back(part_of(group.names[s] + " initialises", part[s]));
  else
    append(parts, ready_parts(*inner_at(group, s)));
  parts.push_back(part_of(master + " hears of Ready", group.notify(0, s)));
  return parts;
}

std::vector<ReactionPart> run_parts(const ReactionGroup& group) {
  const std::size_t s =
      slowest_slave(group, with_inner(group, std::vector(group.initialise.size(), MaxPlus::one()), run_bound));
  std::vector<ReactionPart> parts{part_of(group.names[s] + " hears of Ready", group.notify(s, 0))};
  if (const ReactionGroup* const inner = inner_at(group, s)) append(parts, run_parts(*inner));
  parts.push_back(part_of(group.names.front() + " hears of Running", group.notify(0, s)));
  return parts;
}

std::vector<SpreadStep> slowest_spread(const ReactionGroup& group, Spread spread) {
  Layout layout;
  lay_out(group, 0, spread, layout);
  // Whoever hears first acts: the shortest of the longest ways. Few participants, so by relaxation from each.
  const std::size_t n = layout.heard_from.size();
  std::vector<SpreadStep> slowest;
  Ps latest = -1;
  for (std::size_t origin = 0; origin < n; ++origin) {
    if (!layout.is_origin[origin]) continue;
    std::vector<Ps> at(n, unbounded_ps);
    std::vector<std::size_t> before(n, origin);
    at[origin] = 0;
    for (bool changed = true; changed;) {
      changed = false;
      for (std::size_t to = 0; to < n; ++to)
        for (const Layout::Way& way : layout.heard_from[to])
          if (const Ps heard = sum(std::max(at[way.from], way.not_before), way.takes); heard < at[to]) {
            at[to] = heard;
            before[to] = way.from;
            changed = true;
          }
    }
    const auto to = static_cast<std::size_t>(std::max_element(at.begin(), at.end()) - at.begin());
    if (at[to] <= latest) continue;
    latest = at[to];
    slowest.clear();
    if (!is_bounded(latest)) return {{origin, to, MaxPlus::unbounded()}};
    for (std::size_t step = to; step != origin; step = before[step])
      slowest.insert(slowest.begin(), {before[step], step, MaxPlus(at[step] - at[before[step]])});
  }
  return slowest;
}

std::vector<ReactionPart> spread_parts(const ReactionGroup& group, Spread spread) {
  Layout layout;
  lay_out(group, 0, spread, layout);
  std::vector<ReactionPart> parts;
  for (const SpreadStep& step : slowest_spread(group, spread))
    parts.push_back(part_of(layout.names[step.to] + " hears of " + layout.names[step.from], step.takes));
  return parts;
}

MaxPlus spread_bound(const ReactionGroup& group, Spread spread) {
  MaxPlus all = MaxPlus::one();
  for (const SpreadStep& step : slowest_spread(group, spread)) all *= step.takes;
  return all;
}

}  // namespace takt::analysis
