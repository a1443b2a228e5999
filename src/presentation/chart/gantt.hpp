// SPDX-License-Identifier: Apache-2.0
// What happens by time in several rows: stretches behind (a gate is open), bars before them (a frame is sent), crosses
// on top (a frame is discarded).
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace takt::chart {

struct GanttBar {
  double from = 0;
  double to = 0;
  std::size_t colour = 0;  ///< of the palette
  std::string title;       ///< shown when the mouse rests on it
};

struct GanttStretch {
  double from = 0;
  double to = 0;
};

/// Something ends that should have gone on.
struct GanttCross {
  double at = 0;
  std::string title;  ///< shown when the mouse rests on it
};

struct GanttRow {
  std::string name;
  std::vector<GanttStretch> stretches;
  std::vector<GanttBar> bars;
  std::vector<GanttCross> crosses;
};

struct Gantt {
  std::string title;
  std::string unit;  ///< of times
  double from = 0;
  double to = 1;
  std::vector<GanttRow> rows;
  std::vector<std::string> legend;  ///< names of the colours, by number
};

std::string draw(const Gantt& chart);

}  // namespace takt::chart
