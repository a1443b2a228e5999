// SPDX-License-Identifier: Apache-2.0
#include "chart/stacked_bars.hpp"

#include <fmt/format.h>

#include "chart/svg.hpp"

namespace takt::chart {
namespace {

double size_of(const StackedGroup& group) {
  double sum = 0;
  for (const StackedPart& part : group.parts) sum += part.size;
  return sum;
}

/// Shares of a row: below 1 in all they would not fill it.
std::string grown(double size, double whole) { return fmt::format("flex-grow:{:.3f}", 100 * size / whole); }

}  // namespace

std::string stacked_bar_element(const StackedBar& bar) {
  double whole = 0;
  for (const StackedGroup& group : bar.groups) whole += size_of(group);
  if (whole <= 0) return {};
  std::string text = fmt::format("<div class=\"stack\" role=\"img\" aria-label=\"{}\">", escaped(bar.label));
  for (const StackedGroup& group : bar.groups) {
    const double size = size_of(group);
    if (size <= 0) continue;
    text += fmt::format("<div class=\"group\" style=\"{}\"><div class=\"parts\">", grown(size, whole));
    for (const StackedPart& part : group.parts)
      if (part.size > 0)
        text += fmt::format("<span class=\"part k{}\" style=\"{}\" title=\"{}\"></span>", part.look,
                            grown(part.size, size), escaped(part.title));
    text += fmt::format("</div><div class=\"name\">{}</div></div>", escaped(group.name));
  }
  return text + "</div>\n";
}

std::string stacked_legend(const std::vector<StackedKey>& keys) {
  std::string text = "<ul class=\"legend\">";
  for (const StackedKey& key : keys)
    text += fmt::format("<li><span class=\"part k{}\"></span>{}</li>", key.look, escaped(key.name));
  return text + "</ul>\n";
}

}  // namespace takt::chart
