// SPDX-License-Identifier: Apache-2.0
#include "schedule/phases.hpp"

#include <algorithm>

#include "schedule/attempt.hpp"

namespace takt::schedule {
namespace {

/// Claims of one mover on one resource that overlap are one.
std::vector<Claim> joined(std::vector<Claim> claims) {
  std::sort(claims.begin(), claims.end(), [](const Claim& a, const Claim& b) {
    return a.resource != b.resource ? a.resource < b.resource : a.lag < b.lag;
  });
  std::vector<Claim> kept;
  for (const Claim& each : claims)
    if (!kept.empty() && kept.back().resource == each.resource && each.lag <= kept.back().lag + kept.back().length)
      kept.back().length = std::max(kept.back().length, each.lag + each.length - kept.back().lag);
    else
      kept.push_back(each);
  return kept;
}

}  // namespace

std::optional<std::vector<Ps>> find_phases(std::uint32_t resources, const std::vector<Mover>& movers,
                                           std::uint32_t attempts) {
  Problem problem;
  problem.nodes.resize(1);
  problem.links.resize(resources);
  problem.model.no_wait = true;
  std::vector<Way> ways;
  std::vector<std::optional<Ps>> fixed;
  for (const Mover& mover : movers) {
    Stream stream;
    stream.name = mover.name;
    stream.period = mover.period;
    problem.streams.push_back(std::move(stream));
    Way way;
    for (const Claim& claim : joined(mover.claims)) {
      if (claim.length > mover.period) return std::nullopt;
      way.links.push_back(claim.resource);
      way.parents.push_back(-1);
      way.lags.push_back(claim.lag);
      way.occupied.push_back(claim.length);
    }
    ways.push_back(std::move(way));
    fixed.push_back(mover.fixed);
  }
  SearchOptions options;
  options.attempts = attempts;
  const Ground ground(problem, options, std::move(ways), std::move(fixed));
  const std::uint64_t steps = 200 + 10 * movers.size();
  for (std::uint32_t number = 0; number < attempts; ++number) {
    Attempt attempt(ground, number);
    if (!attempt.run(steps, options.stop)) continue;
    std::vector<Ps> phases;
    for (const Stand& stand : attempt.stands()) phases.push_back(stand.at);
    return phases;
  }
  return std::nullopt;
}

}  // namespace takt::schedule
