// What the threads of applications did in the simulator and on real nodes, side by side: activations and values, which are counted, and never times. Pure.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "scenario/run/run.hpp"

namespace takt::emulate {

/// Of one thread in one world.
struct ThreadCounts {
  std::uint64_t activations = 0;   ///< those that it answered and those that it missed
  std::uint64_t missed = 0;
  std::uint64_t published = 0;     ///< values that its protocol took
  std::uint64_t received = 0;      ///< values that came
  std::uint64_t lost = 0;          ///< numbers that were jumped over on the way
};

struct ThreadComparison {
  std::string name;
  std::string topic;
  bool publishes = false;
  ThreadCounts simulated;
  ThreadCounts emulated;
  std::vector<std::string> differs;   ///< what is not as simulated, in a few words
  bool is_same() const { return differs.empty(); }
};

struct ApplicationComparison {
  std::string name;
  std::string node;
  bool is_whole = true;               ///< its node was never killed; else the counts are those of its last life, if it told them
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
/// The same are: who is activated at all, and how often, but for a quarter and a tenth of a second, since nodes do not begin and end at one instant; who publishes and who gets values
/// at all; and nobody gets more values than were sent to it. How many activations are missed and values lost shows how busy the machine was.
std::vector<ApplicationComparison> compare_applications(const scenario::Resolved& resolved, const std::vector<std::vector<ThreadCounts>>& simulated, const EmulatedThreads& emulated,
                                                        const std::vector<bool>& is_whole);

}  // namespace takt::emulate
