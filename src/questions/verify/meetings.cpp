// SPDX-License-Identifier: Apache-2.0
#include "verify/meetings.hpp"

#include <algorithm>
#include <numeric>
#include <queue>
#include <set>

#include "models/ethernet/sizes.hpp"

namespace takt::verify {
namespace {

using sim::Duration;

constexpr std::size_t most_phases = 4;

bool is_fixed(const sim::Distribution& distribution) { return distribution.least() == distribution.greatest(); }

bool is_plain(const models::PortConfig& config) {
  const bool is_unlimited = std::ranges::none_of(config.queue_limits, &models::QueueLimit::is_finite);
  return config.shaping.is_plain() && !config.preemption && config.cut_through == 0 && is_unlimited;
}

/// Meetings on a grid: all times of the scenario are multiples of its width, and how close frames are to each other is
/// a few picoseconds beside it.
class Grid {
 public:
  Grid(const scenario::Resolved& resolved, const std::vector<FreeVariable>& variables)
      : variables_(variables), most_beside_(2 * static_cast<std::int64_t>(variables.size())) {
    std::int64_t width = 0;
    const auto add = [&](Duration time) { width = std::gcd(width, time.ps()); };
    for (const models::LinkPlan& link : resolved.plan.links) {
      add(link.rate.octet_time());
      add(link.delay);
    }
    for (const models::NodePlan& node : resolved.plan.nodes) add(node.forwarding_delay);
    for (const models::OsLatency& os : resolved.plan.os_latencies)
      for (const sim::Distribution* each : {&os.transmit, &os.receive}) add(each->greatest());
    bool are_all_free = true;
    for (const scenario::Stream& stream : resolved.scenario.streams) {
      add(*stream.every);
      if (!stream.offset) continue;
      add(*stream.offset);
      are_all_free = false;
    }
    width_ = width;
    is_free_ = are_all_free;
  }
  bool is_wide_enough() const { return width_ > 8 * most_beside_; }

  /// The same meetings, as all phases that have them are written: the first one is 0 where the plant promises none.
  /// Nothing if some are between the lines.
  std::optional<Choice> place_of(Choice choice) const {
    const Duration first = is_free_ ? choice.values.front() : Duration();
    for (std::size_t f = 0; f < variables_.size(); ++f) {
      const std::int64_t range = variables_[f].range.ps();
      const std::int64_t value = ((choice.values[f] - first).ps() % range + range) % range;
      const std::int64_t beside = value % width_;
      if (std::min(beside, width_ - beside) > most_beside_) return std::nullopt;
      choice.values[f] = Duration::from_ps(value);
    }
    return choice;
  }

 private:
  const std::vector<FreeVariable>& variables_;
  std::int64_t most_beside_;
  std::int64_t width_ = 1;
  bool is_free_ = true;
};

}  // namespace

bool is_network_of_phases(const scenario::Resolved& resolved, const std::vector<FreeVariable>& variables) {
  const scenario::Scenario& s = resolved.scenario;
  const models::NetworkPlan& plan = resolved.plan;
  if (variables.empty() || variables.size() > most_phases ||
      !std::ranges::all_of(variables, [](const FreeVariable& each) { return each.kind == FreeVariable::Kind::talker; }))
    return false;
  if (!s.programs.empty() || !s.applications.empty() || !s.gateways.empty() || !s.persistence.empty() ||
      !s.script.empty() || !s.faults.empty() || s.rerouting)
    return false;
  if (!plan.impairments.empty() || !plan.gptp_stations.empty() || !plan.ingress_configs.empty() ||
      !plan.talker_ats.empty() || !plan.host_splits.empty())
    return false;
  const bool are_streams_plain = std::ranges::all_of(s.streams, [](const scenario::Stream& each) {
    return each.every && each.jitter == Duration() && !each.launch && !each.redundancy && !each.until && !each.burst;
  });
  const bool are_nodes_plain = std::ranges::all_of(
      plan.nodes, [](const models::NodePlan& each) { return !each.clock && !each.forwarding_jitter && !each.cpu; });
  const bool are_hosts_fixed = std::ranges::all_of(plan.os_latencies, [](const models::OsLatency& each) {
    return is_fixed(each.transmit) && is_fixed(each.receive) && is_fixed(each.wake_up);
  });
  return are_streams_plain && are_nodes_plain && are_hosts_fixed && std::ranges::all_of(plan.port_configs, is_plain) &&
         Grid(resolved, variables).is_wide_enough();
}

bool shows_all_meetings(const scenario::Resolved& resolved, const analysis::Bounds& bounds) {
  sim::int128 common = 1;
  for (const scenario::Stream& stream : resolved.scenario.streams) {
    common = common / std::gcd(static_cast<std::int64_t>(common), stream.every->ps()) * stream.every->ps();
    if (common > resolved.scenario.duration.ps()) return false;
  }
  Duration longest;
  for (const analysis::StreamBound& stream : bounds.streams) {
    if (!stream.latency) return false;
    longest = std::max(longest, *stream.latency);
  }
  return Duration::from_ps(static_cast<std::int64_t>(common)) * 2 + longest * 2 <= resolved.scenario.duration;
}

bool run_meetings(Trials& trials, const CriticalInstants& instants, const scenario::Resolved& resolved,
                  const std::vector<Choice>& beginnings) {
  const std::vector<FreeVariable>& variables = trials.ground().variables;
  const Grid grid(resolved, variables);
  struct Place {
    std::int64_t badness = 0;
    std::uint64_t number = 0;
    Choice choice;
    bool operator<(const Place& other) const {
      return badness != other.badness ? badness < other.badness : number > other.number;
    }
  };
  std::priority_queue<Place> places;
  std::set<std::vector<Duration>> known;
  std::uint64_t number = 0;
  bool is_complete = true;
  const auto run = [&](const std::vector<Choice>& choices) {
    std::vector<Choice> fresh;
    for (const Choice& choice : choices)
      if (std::optional<Choice> place = grid.place_of(choice); place && known.insert(place->values).second)
        fresh.push_back(std::move(*place));
    const std::vector<std::int64_t> found = trials.try_all(fresh);
    is_complete = is_complete && found.size() == fresh.size();
    for (std::size_t i = 0; i < found.size(); ++i) places.push({found[i], number++, std::move(fresh[i])});
  };
  run(beginnings);
  while (!places.empty() && is_complete) {
    const Choice at = places.top().choice;
    places.pop();
    const auto met = trials.is_affordable() ? trials.meetings_of(at) : std::nullopt;
    if (!met) return false;
    std::vector<Choice> next;
    for (std::size_t f = 0; f < variables.size(); ++f)
      for (const Duration value : instants.of_meetings(f, at, *met)) {
        next.push_back(at);
        next.back().values[f] = value;
      }
    run(next);
  }
  return is_complete;
}

}  // namespace takt::verify
