// Runs a scenario and holds what happened against what analysis says can happen.
#pragma once

#include <string>
#include <vector>

#include "analysis/bounds.hpp"
#include "scenario/resolve.hpp"
#include "scenario/run.hpp"

namespace takt::analysis::test {

/// What one run says of the bounds.
struct Verdict {
  std::vector<std::string> violations;   ///< empty if every bound held
  std::size_t compared = 0;              ///< streams with a bound that were delivered
  std::size_t unbounded = 0;             ///< streams without one that were delivered
  double tightest = 0;                   ///< the greatest simulated latency as a share of its bound
  std::vector<double> shares;            ///< of all streams with a bound
};

inline std::string microseconds(sim::Duration value) { return std::to_string(static_cast<double>(value.ps()) / 1e6) + " us"; }

/// Streams only: reactions are compared where Programs are.
inline Verdict judge(const scenario::Run& run, const Bounds& bounds) {
  Verdict verdict;
  for (std::size_t s = 0; s < bounds.streams.size(); ++s) {
    const models::Stream& stream = run.network().traffic().streams()[s];
    const StreamBound& bound = bounds.streams[s];
    if (bound.loses_nothing && bound.latency && !bound.assumptions.contains(Assumption::no_fault) && stream.dropped_in_all() > 0)
      verdict.violations.push_back(bound.name + ": " + std::to_string(stream.dropped_in_all()) + " frames dropped of a stream that loses none");
    if (stream.latency.empty()) continue;
    ++(bound.latency ? verdict.compared : verdict.unbounded);
    if (stream.latency.minimum() < bound.least)
      verdict.violations.push_back(bound.name + ": " + microseconds(stream.latency.minimum()) + " is less than the least, " + microseconds(bound.least));
    if (!bound.latency) continue;
    const double share = static_cast<double>(stream.latency.maximum().ps()) / static_cast<double>(bound.latency->ps());
    verdict.shares.push_back(share);
    verdict.tightest = std::max(verdict.tightest, share);
    if (stream.latency.maximum() > *bound.latency)
      verdict.violations.push_back(bound.name + ": simulated " + microseconds(stream.latency.maximum()) + " of at most " + microseconds(*bound.latency));
  }
  return verdict;
}

inline Verdict simulate(const scenario::Resolved& resolved, const Bounds& bounds) {
  scenario::Run run(resolved);
  run.advance();
  return judge(run, bounds);
}

}  // namespace takt::analysis::test
