// SPDX-License-Identifier: Apache-2.0
#include "chart/network_chart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "chart/graph_layout.hpp"
#include "chart/svg.hpp"

namespace takt::chart {
namespace {

constexpr std::array<LoadColour, 5> steps = {{
    {0.01, "#9fb0ba", "below 1 %"},
    {0.25, "#56b4e9", "to 25 %"},
    {0.50, "#0072b2", "to 50 %"},
    {0.75, "#e69f00", "to 75 %"},
    {2.00, "#d55e00", "above 75 %"},
}};

constexpr double picture_width = 900;
constexpr double most_height = 720;
constexpr double picture_margin = 46;
constexpr double legend_height = 34;
constexpr std::size_t most_hosts = 300;
constexpr std::size_t most_names = 90;

/// Which nodes are drawn: all, or without the hosts that hang on one switch.
std::vector<bool> shown_nodes(const NetworkChart& chart) {
  std::vector<bool> shown(chart.nodes.size(), true);
  const auto hosts = std::count_if(chart.nodes.begin(), chart.nodes.end(),
                                   [](const NetworkNode& node) { return node.kind == NetworkNode::Kind::host; });
  if (static_cast<std::size_t>(hosts) <= most_hosts) return shown;
  std::vector<std::size_t> links(chart.nodes.size());
  for (const NetworkLink& link : chart.links) {
    ++links[link.a];
    ++links[link.b];
  }
  for (std::size_t n = 0; n < shown.size(); ++n)
    shown[n] = chart.nodes[n].kind != NetworkNode::Kind::host || links[n] > 1;
  return shown;
}

class Drawing {
 public:
  explicit Drawing(const NetworkChart& chart) : chart_(chart), at_(places(chart)) { place(); }

  std::string take() {
    Svg svg(picture_width, height_);
    for (const NetworkLink& link : chart_.links)
      if (at_[link.a] && at_[link.b]) draw_link(svg, link);
    for (std::size_t n = 0; n < chart_.nodes.size(); ++n)
      if (at_[n]) draw_node(svg, n);
    draw_legend(svg);
    return svg.element(chart_.title);
  }

 private:
  void place() {
    std::optional<Point> least;
    std::optional<Point> greatest;
    for (const auto& point : at_) {
      if (!point) continue;
      ++shown_;
      if (!least) least = greatest = point;
      least = {std::min(least->x, point->x), std::min(least->y, point->y)};
      greatest = {std::max(greatest->x, point->x), std::max(greatest->y, point->y)};
    }
    if (!least) return;
    const Point extent{std::max(greatest->x - least->x, 1e-3), std::max(greatest->y - least->y, 1e-3)};
    scale_ = std::min(
        {110.0, (picture_width - 2 * picture_margin) / extent.x, (most_height - 2 * picture_margin) / extent.y});
    for (auto& point : at_)
      if (point)
        point = {picture_width / 2 + (point->x - (least->x + greatest->x) / 2) * scale_,
                 picture_margin + (point->y - least->y) * scale_};
    height_ = extent.y * scale_ + 2 * picture_margin + legend_height;
  }

  Point at(std::size_t node) const { return *at_[node]; }

  void draw_link(Svg& svg, const NetworkLink& link) const {
    const std::string line = fmt::format("M{} {} L{} {}", coordinate(at(link.a).x), coordinate(at(link.a).y),
                                         coordinate(at(link.b).x), coordinate(at(link.b).y));
    svg.titled_path(line, colour_of_load(link.load), scale_ > 25 ? 3 : 1.5, link.title);
    if (!link.has_failed) return;
    const Point middle{(at(link.a).x + at(link.b).x) / 2, (at(link.a).y + at(link.b).y) / 2};
    svg.line({middle.x - 6, middle.y - 6}, {middle.x + 6, middle.y + 6}, Class{"failed"});
    svg.line({middle.x - 6, middle.y + 6}, {middle.x + 6, middle.y - 6}, Class{"failed"});
  }

  void draw_node(Svg& svg, std::size_t n) const {
    const NetworkNode& node = chart_.nodes[n];
    const double size = std::clamp(scale_ / 9, 2.0, 8.0);
    const Point centre = at(n);
    const std::string_view colour = node.has_failed                        ? "#c0392b"
                                    : node.kind == NetworkNode::Kind::host ? palette(2)
                                                                           : palette(0);
    if (node.kind == NetworkNode::Kind::host)
      svg.mark_circle(centre, size * 0.8, colour, node.title);
    else
      svg.mark_rectangle({centre.x - size, centre.y - size}, 2 * size, 2 * size, colour, node.title);
    if (node.kind == NetworkNode::Kind::station) svg.mark_circle(centre, size * 0.55, palette(2), node.title);
    if (shown_ <= most_names) svg.text({centre.x, centre.y - size - 3}, node.name, Anchor::middle, Class{"note"});
  }

  void draw_legend(Svg& svg) const {
    double x = picture_margin;
    const double y = height_ - 16;
    svg.text({x, y}, "load of links:", Anchor::start, Class{"label"});
    x += 78;
    for (const LoadColour& each : steps) {
      svg.swatch({x, y - 6}, 18, 4, each.colour);
      svg.text({x + 23, y}, each.text, Anchor::start, Class{"label"});
      x += 92;
    }
    const bool has_failures =
        std::any_of(chart_.links.begin(), chart_.links.end(),
                    [](const NetworkLink& link) { return link.has_failed; }) ||
        std::any_of(chart_.nodes.begin(), chart_.nodes.end(), [](const NetworkNode& node) { return node.has_failed; });
    if (has_failures) svg.text({x + 14, y}, "red: failed in this run", Anchor::start, Class{"label"});
  }

  const NetworkChart& chart_;
  std::vector<std::optional<Point>> at_;  // by node; nothing: it is left out
  std::size_t shown_ = 0;
  double scale_ = 1;
  double height_ = 2 * picture_margin;
};

}  // namespace

std::vector<std::optional<Point>> places(const NetworkChart& chart) {
  const std::vector<bool> shown = shown_nodes(chart);
  std::vector<std::size_t> number(chart.nodes.size());  // of those that are shown
  Graph graph;
  for (std::size_t n = 0; n < chart.nodes.size(); ++n)
    if (shown[n]) {
      number[n] = graph.is_hub.size();
      graph.is_hub.push_back(chart.nodes[n].kind != NetworkNode::Kind::host);
    }
  for (const NetworkLink& link : chart.links)
    if (shown[link.a] && shown[link.b] && link.a != link.b) graph.edges.emplace_back(number[link.a], number[link.b]);
  const std::vector<Point> points = layout(graph);
  std::vector<std::optional<Point>> found(chart.nodes.size());
  for (std::size_t n = 0; n < found.size(); ++n)
    if (shown[n]) found[n] = points[number[n]];
  return found;
}

std::span<const LoadColour> load_colours() { return steps; }

std::string_view colour_of_load(double share) {
  return std::find_if(steps.begin(), steps.end() - 1, [&](const LoadColour& each) { return share < each.below; })
      ->colour;
}

std::string draw(const NetworkChart& chart) { return Drawing(chart).take(); }

}  // namespace takt::chart
