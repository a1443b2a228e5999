// SPDX-License-Identifier: Apache-2.0
// What the threads of applications did in the simulator and on real nodes, side by side. Activations, values and edges
// are compared; times stand beside one another. Pure.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scenario/run/run.hpp"

namespace takt::emulate {

/// Times of one kind in one world, in ns; all 0 of none.
struct Times {
  std::uint64_t count = 0;
  std::int64_t min_ns = 0;
  std::int64_t mean_ns = 0;
  std::int64_t max_ns = 0;
  bool operator==(const Times&) const = default;
};

/// Of a digital output in one world.
struct SignalCounts {
  std::uint64_t edges = 0;
  std::uint64_t irregular_pulses = 0;  ///< more than 10 % off
  Times latency = {};  ///< of each edge: from the activation whose call made it, on the clock of the node
  Times pulses = {};   ///< simulated in true time, real by the clock of the node
};

/// Of one thread in one world.
struct ThreadCounts {
  std::uint64_t activations = 0;  ///< those that it answered and those that it missed
  std::uint64_t missed = 0;
  std::uint64_t published = 0;  ///< values that its protocol took
  std::uint64_t received = 0;   ///< values that came
  std::uint64_t lost = 0;       ///< numbers that were jumped over on the way
  Times response = {};          ///< from an activation to its call
  std::optional<SignalCounts> signal = {};
};

struct ThreadComparison {
  std::string name;
  std::string topic;
  bool publishes = false;
  ThreadCounts simulated;
  ThreadCounts emulated;
  std::vector<std::string> differs;  ///< what is not as simulated, in a few words
  bool is_same() const { return differs.empty(); }
};

struct ApplicationComparison {
  std::string name;
  std::string node;
  bool is_whole = true;  ///< its node was never killed; else the counts are those of its last life, if it told them
  std::vector<ThreadComparison> threads;
  bool is_same() const;
};

/// What the simulated run has counted: by application and thread.
std::vector<std::vector<ThreadCounts>> threads_of(const scenario::Run& run);

/// What the real nodes have counted: by application and thread.
using EmulatedThreads = std::map<std::pair<std::string, std::string>, ThreadCounts>;

/// From the last line of a node's log, which tells its statistics. False if it is no such line.
bool add_threads(const std::string& line, EmulatedThreads& threads);

/// `simulated` by application and thread of the resolved scenario; `is_whole` by application.
///
/// The same are: who is activated at all, and how often, but for a quarter and a tenth of a second, since nodes do not
/// begin and end at one instant; who publishes and who gets values at all; and nobody gets more values than were sent
/// to it. A digital output that changes ten times or more in the simulator changes on a real node, and no output
/// changes more often than values came. How many activations are missed and values lost shows how busy the machine was.
std::vector<ApplicationComparison> compare_applications(const scenario::Resolved& resolved,
                                                        const std::vector<std::vector<ThreadCounts>>& simulated,
                                                        const EmulatedThreads& emulated,
                                                        const std::vector<bool>& is_whole);

}  // namespace takt::emulate
