// SPDX-License-Identifier: Apache-2.0
// Streams of a scheduled scenario that come, go, or take other ways because something has failed: who gets which place,
// and who has to move for it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scenario/resolved/resolved.hpp"
#include "synthesis/running_gates.hpp"

namespace takt::synthesis {

struct AskedChanges {
  std::vector<scenario::Stream> add;
  std::vector<scenario::Requirement> require;  ///< of these
  std::vector<std::string> remove;             ///< names of streams
  std::vector<std::string> fail;               ///< "sw1>sw2" (the cable, both directions), or a node
  std::optional<sim::Duration> at;             ///< when it begins; absent: as soon as all streams send
  sim::Duration lead;                          ///< from writing a list to the instant from which it holds, at least
  std::uint32_t entries = scenario::most_gate_entries;
};

enum class StreamFate : std::uint8_t {
  comes,
  goes,
  moves,  ///< to another time or way
  lost,   ///< what failed was on its way, and there is no other place; or its host has failed
};

struct StreamChange {
  std::string name;
  StreamFate fate = StreamFate::comes;
  bool was_cut = false;                    ///< what failed was on its way
  std::optional<scenario::Stream> before;  ///< unless it comes
  std::optional<scenario::Stream> after;   ///< if it comes or moves: with path and offset
};

struct PlacedChanges {
  std::string
      why_not;  ///< not empty: the plant as it is cannot be changed stream by stream; nothing else is there then
  scenario::Scenario after;  ///< with automatic gates, and offsets and paths for which there are windows
  std::vector<StreamChange> changes;
  std::vector<std::string> without_place;   ///< that should come
  std::vector<std::string> without_way;     ///< streams without windows over what has failed; they stay as they are
  std::vector<std::uint32_t> failed_links;  ///< of resolved.plan.links
  std::vector<scenario::Fault> faults;      ///< what fails, from 0 on
};

/// Whatever need not move stays at its time and on its way; for a stream that comes at most one other moves. `plant`
/// says what may move at all: streams with "offset": "auto" and no path of their own; null: all that have one listener.
/// Mistakes are diagnostics; then there is nothing.
std::optional<PlacedChanges> place_changes(const scenario::Scenario& running, const RunningGates& gates,
                                           const scenario::Scenario* plant, const AskedChanges& asked,
                                           json::Diagnostics& diagnostics);

/// Nothing of what a run of a scheduled scenario does may depend on what a transition has to change: no other gates of
/// its script, no faults but such as last from the start on. Mistakes are diagnostics.
void check_changeable(const scenario::Scenario& running, json::Diagnostics& diagnostics);

}  // namespace takt::synthesis
