// SPDX-License-Identifier: Apache-2.0
#include "output/division_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "output/table.hpp"
#include "output/text_report.hpp"

namespace takt::output {

std::string division_report(const scenario::Division& division) {
  std::string out = "Threads\n";
  if (division.parts < division.asked)
    out += fmt::format("  {} of {} asked for: {}\n", division.parts, division.asked, division.why_fewer);
  if (!division.is_divided()) return division.parts == division.asked ? out + "  1: nothing is divided\n" : out;
  const double all = std::accumulate(division.frame_hops_per_second.begin(), division.frame_hops_per_second.end(), 0.0);
  Table parts({{"part", Table::Align::right},
               {"nodes", Table::Align::right},
               {"frames/s", Table::Align::right},
               {"of all", Table::Align::right}});
  for (std::uint32_t part = 0; part < division.parts; ++part)
    parts.add({std::to_string(part), std::to_string(std::ranges::count(division.part_of_node, part)),
               fmt::format("{:.0f}", division.frame_hops_per_second[part]),
               fmt::format("{:.1f} %", all > 0 ? 100 * division.frame_hops_per_second[part] / all : 0.0)});
  out += parts.text({});
  Table boundaries({{"from part", Table::Align::right},
                    {"to", Table::Align::right},
                    {"links", Table::Align::right},
                    {"frames/s", Table::Align::right},
                    {"promise", Table::Align::quantity}});
  for (const scenario::Boundary& boundary : division.boundaries)
    boundaries.add({std::to_string(boundary.from), std::to_string(boundary.to), std::to_string(boundary.links),
                    fmt::format("{:.0f}", boundary.frames_per_second), readable(boundary.promise)});
  return out + boundaries.text({}) +
         fmt::format("  {:.2f} % of the frames on links cross from part to part\n", 100 * division.crossing_share());
}

}  // namespace takt::output
