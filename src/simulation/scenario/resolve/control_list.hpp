// SPDX-License-Identifier: Apache-2.0
// What control lists of transmission gates and of stream gates have in common before the models may lay them out.
#pragma once

#include <optional>

#include "json/diagnostics.hpp"
#include "json/quantity.hpp"
#include "models/egress/cyclic_schedule.hpp"
#include "scenario/description/description.hpp"

namespace takt::scenario {

/// All intervals of a list together; nothing if no list can be made of them, which has been told: by the table that
/// there are too many, here that they last too long.
template <class Description>
std::optional<Duration> length_of_list(const Description& list, json::Diagnostics& diagnostics) {
  using models::CyclicIntervals;
  if (list.entries.size() > CyclicIntervals::entry_limit) return std::nullopt;
  Duration sum;
  for (const auto& entry : list.entries) {
    if (entry.interval > CyclicIntervals::longest - sum) {
      diagnostics.error(list.where.at("entries"), "a control list that lasts too long",
                        {std::to_string(list.entries.size()) + " entries of more than " +
                             json::to_text(CyclicIntervals::longest) + " in all",
                         "entries of at most that"});
      return std::nullopt;
    }
    sum += entry.interval;
  }
  return sum;
}

/// What has been running since before the start has a base time in the past.
template <class Description>
void check_running(const Description& list, json::Diagnostics& diagnostics) {
  if (list.running && list.base_time > Duration() && !diagnostics.is_refused(list.where.at("base_time")) &&
      !diagnostics.is_refused(list.where.at("running")))
    diagnostics.error(list.where.at("running"), "a list that is running before it begins",
                      {"\"base_time\" of " + json::to_text(list.base_time), "one of at most 0s"});
}

/// Whether "running" makes no difference: a cycle begins at the start in any case.
template <class Description>
bool begins_at_the_start(const Description& list, Duration cycle) {
  return cycle > Duration() && list.base_time % cycle == Duration();
}

}  // namespace takt::scenario
