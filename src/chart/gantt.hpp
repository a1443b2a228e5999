// What happens by time in several rows: stretches behind (a gate is open), bars before them (a frame is sent).
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace takt::chart {

struct GanttBar {
  double from = 0;
  double to = 0;
  std::size_t colour = 0;   ///< of the palette
  std::string title;        ///< shown when the mouse rests on it
};

struct GanttStretch {
  double from = 0;
  double to = 0;
};

struct GanttRow {
  std::string name;
  std::vector<GanttStretch> stretches;
  std::vector<GanttBar> bars;
};

struct Gantt {
  std::string title;
  std::string unit;         ///< of times
  double from = 0;
  double to = 1;
  std::vector<GanttRow> rows;
  std::vector<std::string> legend;   ///< names of the colours, by number
};

std::string draw(const Gantt& chart);

}  // namespace takt::chart
