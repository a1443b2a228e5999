// SPDX-License-Identifier: Apache-2.0
// When the frames of a stream are at its talker's port, as far as the scenario says so.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scenario/resolved/resolved.hpp"

namespace takt::scenario {

/// One frame a period, or the frames of a burst, if it is known.
struct FrameTiming {
  Duration period;
  std::uint32_t frames = 1;  ///< in a period
  Duration spacing;          ///< between them; 0: they are handed to the port at one instant, one behind the other
  Duration release;  ///< by when the first frame is surely there; of an offset that is still to be chosen, with 0
  Duration early;    ///< how much before its release, at most, a frame may be there
  std::uint32_t train = 0;              ///< streams of one train are handed to the port at one instant, in their order
  bool is_known = false;                ///< the release can be told; at times without promise it is that of a run
  std::string no_window;                ///< why no window can be laid for it; empty: one can
  std::optional<std::uint32_t> choice;  ///< in Timings::choices: when it begins is not chosen yet
};

/// An "offset": "auto". What one participant publishes begins with it; or all participants of a program whose roles
/// bind nodes.
struct OffsetChoice {
  std::uint32_t item = 0;  ///< in Scenario::streams, or Resolved::programs
  bool is_program = false;
  std::optional<std::uint8_t> participant = {};  ///< of a program without roles
};

struct Timings {
  std::vector<FrameTiming> of_streams;  ///< by stream index
  std::vector<OffsetChoice> choices;
};

/// To be called when all streams are there and nothing was refused.
Timings timings_of(const Resolved& resolved);

}  // namespace takt::scenario
