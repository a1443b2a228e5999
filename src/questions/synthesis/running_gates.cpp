// SPDX-License-Identifier: Apache-2.0
#include "synthesis/running_gates.hpp"

#include <algorithm>
#include <bit>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "json/node.hpp"
#include "json/quantity.hpp"
#include "scenario/resolve.hpp"

namespace takt::synthesis {
namespace {

using scenario::NetworkGates;
using scenario::Scenario;
using scenario::SetGates;
using sim::Duration;

models::GateStates states_of(const scenario::GateEntry& entry) {
  models::GateStates states = 0;
  for (const std::uint8_t q : entry.open) states = models::with(states, q);
  return states;
}

/// By node and neighbour.
using Lists = std::map<std::pair<std::string, std::string>, const scenario::Gates*>;
Lists by_port(const std::vector<SetGates>& lists) {
  Lists made;
  for (const SetGates& each : lists) made[{each.node, each.to.value_or("")}] = &each.gates;
  return made;
}

/// The port whose list is another one; empty: all are the same.
std::string first_difference(const NetworkGates& running, const NetworkGates& laid) {
  const Lists had = by_port(running.lists), has = by_port(laid.lists);
  for (const auto& [port, gates] : had) {
    const auto found = has.find(port);
    if (found == has.end() || *found->second != *gates) return port.first + " to " + port.second;
  }
  for (const auto& [port, gates] : has)
    if (!had.contains(port)) return port.first + " to " + port.second;
  return {};
}

/// Of each list the entry that opens most classes is taken for the one of the others, and what it closes for scheduled.
std::vector<std::uint8_t> guessed_classes(const NetworkGates& running) {
  models::ClassSet scheduled = 0;
  for (const SetGates& set : running.lists) {
    models::GateStates others = 0;
    for (const scenario::GateEntry& entry : set.gates.entries)
      if (std::popcount(states_of(entry)) > std::popcount(others)) others = states_of(entry);
    scheduled = static_cast<models::ClassSet>(scheduled | ~others);
  }
  std::vector<std::uint8_t> classes;
  for (models::TrafficClass q = 0; q < models::traffic_class_count; ++q)
    if (models::contains(scheduled, q)) classes.push_back(q);
  return classes;
}

/// At a talker a window is as long as its frame and the margin, unless others follow at once.
std::set<Duration> guessed_margins(const scenario::Resolved& without, const NetworkGates& running) {
  std::set<Duration> margins{Duration()};
  const Lists lists = by_port(running.lists);
  for (std::size_t s = 0; s < without.gates->problem.streams.size(); ++s) {
    const scenario::ScheduledStream& stream = without.gates->problem.streams[s];
    const scenario::ScheduledHop& hop = stream.hops.front();
    const scenario::StreamWindow& window = without.gates->schedule.windows[s].front();
    const scenario::GatedPort& port = without.gates->problem.ports[hop.port];
    const std::size_t middle = port.name.find(" to ");
    const auto found = lists.find({port.name.substr(0, middle), port.name.substr(middle + 4)});
    if (found == lists.end() || !found->second->cycle) continue;
    const std::int64_t cycle = found->second->cycle->ps();
    const Duration begin = Duration::from_ps((window.open.ps() % cycle + cycle) % cycle);
    Duration at = found->second->base_time;
    for (const scenario::GateEntry& entry : found->second->entries) {
      if (at % *found->second->cycle == begin &&
          states_of(entry) == models::with(models::ClassSet{0}, hop.traffic_class)) {
        const Duration margin = entry.interval - (window.close - window.open);
        if (margin > Duration()) margins.insert(margin);
      }
      at += entry.interval;
    }
    if (margins.size() > 8) break;
  }
  return margins;
}

/// With those of streams that come.
std::vector<std::uint8_t> with_classes_of(const std::vector<scenario::Stream>& coming,
                                          const std::vector<std::uint8_t>& classes) {
  std::set<std::uint8_t> all(classes.begin(), classes.end());
  for (const scenario::Stream& each : coming)
    if (each.pcp && *each.pcp < models::standard_traffic_classes.size())
      all.insert(models::standard_traffic_classes[*each.pcp]);
  return {all.begin(), all.end()};
}

std::unique_ptr<scenario::Resolved> laid(const Scenario& running, const NetworkGates& gates) {
  Scenario with = running;
  with.gates = gates;
  json::Diagnostics unheard;
  auto resolved = scenario::resolve(with, unheard);
  return unheard.has_errors() || !resolved || !resolved->gates ? nullptr : std::move(resolved);
}

/// The gates with a guard and margin that have the lists; else `difference` is a port with another one.
std::optional<RunningGates> guessed(const Scenario& running, NetworkGates guess,
                                    const std::optional<NetworkGates>& asked, std::string& difference) {
  const bool is_margin_known = asked && (!asked->margin || !asked->margin->is_auto);
  for (const scenario::GateGuard guard : {scenario::GateGuard::length_aware, scenario::GateGuard::longest_frame}) {
    if (asked && asked->guard != guard) continue;
    guess.guard = guard;
    std::set<Duration> margins{Duration()};
    if (!is_margin_known) {
      guess.margin = json::OrAuto<Duration>(Duration());
      if (const auto without = laid(running, guess)) margins = guessed_margins(*without, *running.gates);
    }
    for (const Duration margin : margins) {
      if (!is_margin_known) guess.margin = json::OrAuto<Duration>(margin);
      auto resolved = laid(running, guess);
      if (!resolved) continue;
      const std::string differs = first_difference(*running.gates, *resolved->scenario.gates);
      if (differs.empty()) {
        guess.margin = json::OrAuto<Duration>(resolved->gates->problem.margin);
        return RunningGates{guess, std::move(resolved)};
      }
      difference = differs;
    }
  }
  return std::nullopt;
}

}  // namespace

std::optional<RunningGates> gates_of_running(const Scenario& running, const std::optional<NetworkGates>& asked,
                                             const std::vector<scenario::Stream>& coming,
                                             json::Diagnostics& diagnostics) {
  const json::Place place = running.where.at("gates");
  if (!running.gates || running.gates->plan != scenario::GatePlanning::listed) {
    diagnostics.error(place, "not a scheduled scenario",
                      {"no listed gates", "what takt schedule SCENARIO --out FILE has written"});
    return std::nullopt;
  }
  std::string difference;
  if (asked) {
    if (auto found = guessed(running, *asked, asked, difference)) return found;
  } else {
    NetworkGates guess;
    guess.where = running.gates->where;
    guess.plan = scenario::GatePlanning::automatic;
    const std::vector<std::uint8_t> classes = guessed_classes(*running.gates);
    std::vector<std::vector<std::uint8_t>> candidates{with_classes_of(coming, classes)};
    if (candidates.front() != classes) candidates.push_back(classes);
    for (const auto& each : candidates) {
      guess.classes = each;
      if (auto found = guessed(running, guess, asked, difference)) return found;
    }
  }
  diagnostics.error(
      place, asked ? "lists that are not those of the plant" : "lists that no automatic gates have",
      {difference.empty() ? "no automatic gates for its streams" : "another list at " + json::quote(difference),
       asked ? "the scenario that takt schedule has made of the plant"
             : "what takt schedule has written; with the plant as SCENARIO its gates need not be guessed"});
  return std::nullopt;
}

}  // namespace takt::synthesis
