// SPDX-License-Identifier: Apache-2.0
// Digital signals as an oscilloscope shows them: ten divisions of time, one trace below the other.
#pragma once

#include <string>
#include <vector>

namespace takt::chart {

/// From that time on the signal is high or low.
struct Edge {
  double time = 0;
  bool is_high = false;
};

struct Trace {
  std::string name;
  std::vector<Edge> edges;  ///< in the order of time; before the first the signal is the opposite of it
};

struct SquareWaves {
  std::string title;
  std::string note;     ///< below the screen
  std::string unit;     ///< of times: "ms"
  double from = 0;      ///< the left edge of the screen
  double division = 1;  ///< a tenth of the screen
  std::vector<Trace> traces;
};

std::string draw(const SquareWaves& waves);

}  // namespace takt::chart
