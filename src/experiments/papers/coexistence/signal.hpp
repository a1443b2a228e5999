// SPDX-License-Identifier: Apache-2.0
// The digital signal of case study 2 and what can be measured at it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sim/time.hpp"

namespace takt::papers::coexistence {

/// From that instant on the output is high or low. Neighbours differ.
struct SignalEdge {
  sim::TrueTime time;
  bool is_high = false;
};

/// A pulse lasts from an edge to the next; a period from a rising edge to the next. Messages alternate, so that a pulse
/// should last one interval, a period two.
struct SignalStatistics {
  std::uint64_t pulses = 0;
  double expected = 0;         ///< pulses, from how long was measured
  double pulse_mean = 0;       ///< all of these in intervals
  double pulse_deviation = 0;  ///< standard deviation
  double pulse_median = 0;
  double pulse_least = 0;
  double pulse_greatest = 0;
  double period_mean = 0;
  double period_deviation = 0;
  /// Share of pulses that are off by more than half an interval: what an eye sees as a wrong pulse.
  double irregular = 0;
  /// Share of pulses that are off by more than a tenth.
  double off_by_a_tenth = 0;
};

/// Of the pulses that begin and end in [from, to].
SignalStatistics measure(const std::vector<SignalEdge>& edges, sim::Duration interval, sim::TrueTime from,
                         sim::TrueTime to);

struct ReactionTimes {
  std::uint64_t commands = 0;
  std::uint64_t answered = 0;  ///< before the next command
  sim::Duration mean;
  sim::Duration p99;  ///< 99 % of them take no longer
  sim::Duration greatest;
};

/// From each command to the first edge after it: the output follows commands of high and low by turns, the first of
/// which is high. Commands in [from, to].
ReactionTimes reactions(const std::vector<sim::TrueTime>& commands, const std::vector<SignalEdge>& edges,
                        sim::TrueTime from, sim::TrueTime to);

/// The signal as a value change dump (IEEE 1364 clause 18), low before the first edge; a tick is a nanosecond.
std::string value_change_dump(const std::vector<SignalEdge>& edges, sim::TrueTime end);

}  // namespace takt::papers::coexistence
