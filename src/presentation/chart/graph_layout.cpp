// SPDX-License-Identifier: Apache-2.0
#include "chart/graph_layout.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace takt::chart {
namespace {

constexpr double pi = std::numbers::pi;
constexpr std::size_t unknown = std::numeric_limits<std::size_t>::max();

using Neighbours = std::vector<std::vector<std::size_t>>;

Neighbours neighbours_of(std::size_t nodes, const std::vector<std::pair<std::size_t, std::size_t>>& edges) {
  Neighbours all(nodes);
  for (const auto& [a, b] : edges) {
    all[a].push_back(b);
    all[b].push_back(a);
  }
  for (std::vector<std::size_t>& each : all) {
    std::sort(each.begin(), each.end());
    each.erase(std::unique(each.begin(), each.end()), each.end());
  }
  return all;
}

std::vector<std::size_t> distances_from(const Neighbours& graph, std::size_t start) {
  std::vector<std::size_t> distance(graph.size(), unknown);
  std::vector<std::size_t> queue = {start};
  distance[start] = 0;
  for (std::size_t i = 0; i < queue.size(); ++i)
    for (const std::size_t next : graph[queue[i]])
      if (distance[next] == unknown) {
        distance[next] = distance[queue[i]] + 1;
        queue.push_back(next);
      }
  return distance;
}

double length(Point p) { return std::sqrt(p.x * p.x + p.y * p.y); }

// Of one part of the graph, whose nodes are all joined.

bool is_path_or_ring(const Neighbours& part) {
  return std::all_of(part.begin(), part.end(), [](const auto& each) { return each.size() <= 2; });
}

/// From one end of a path to the other, or once round a ring.
std::vector<std::size_t> walk(const Neighbours& part) {
  std::size_t at = 0;
  for (std::size_t n = 0; n < part.size(); ++n)
    if (part[n].size() < 2) {
      at = n;
      break;
    }
  std::vector<std::size_t> order = {at};
  std::vector<bool> seen(part.size());
  seen[at] = true;
  for (bool goes_on = true; goes_on;) {
    goes_on = false;
    for (const std::size_t next : part[order.back()])
      if (!seen[next]) {
        seen[next] = true;
        order.push_back(next);
        goes_on = true;
        break;
      }
  }
  return order;
}

/// Long lines go to and fro.
std::vector<Point> line_layout(const Neighbours& part) {
  const std::vector<std::size_t> order = walk(part);
  constexpr std::size_t widest = 14;
  const std::size_t rows = (order.size() + widest - 1) / widest;
  const std::size_t a_row = (order.size() + rows - 1) / rows;
  std::vector<Point> points(part.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const std::size_t row = i / a_row;
    const std::size_t column = row % 2 == 0 ? i % a_row : a_row - 1 - i % a_row;
    points[order[i]] = {static_cast<double>(column), 1.6 * static_cast<double>(row)};
  }
  return points;
}

std::vector<Point> ring_layout(const Neighbours& part) {
  const std::vector<std::size_t> order = walk(part);
  const double radius = std::max(0.6, static_cast<double>(order.size()) / (2 * pi));
  std::vector<Point> points(part.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const double angle = 2 * pi * static_cast<double>(i) / static_cast<double>(order.size()) - pi / 2;
    points[order[i]] = {radius * std::cos(angle), radius * std::sin(angle)};
  }
  return points;
}

/// From the node whose farthest one is nearest, as layers; each subtree as wide as its leaves.
std::vector<Point> tree_layout(const Neighbours& part) {
  const auto farthest = [](const std::vector<std::size_t>& distance) {
    return static_cast<std::size_t>(std::max_element(distance.begin(), distance.end()) - distance.begin());
  };
  const std::size_t end = farthest(distances_from(part, 0));
  const std::vector<std::size_t> from_end = distances_from(part, end);
  std::size_t root = farthest(from_end);
  for (std::size_t steps = from_end[root] / 2; steps > 0; --steps)
    root = *std::find_if(part[root].begin(), part[root].end(),
                         [&](std::size_t next) { return from_end[next] + 1 == from_end[root]; });
  const std::vector<std::size_t> depth = distances_from(part, root);
  std::vector<std::size_t> order = {root};
  for (std::size_t i = 0; i < order.size(); ++i)
    for (const std::size_t next : part[order[i]])
      if (depth[next] == depth[order[i]] + 1) order.push_back(next);
  std::vector<double> width(part.size(), 0);
  for (auto node = order.rbegin(); node != order.rend(); ++node) {
    for (const std::size_t next : part[*node])
      if (depth[next] == depth[*node] + 1) width[*node] += width[next];
    width[*node] = std::max(width[*node], 1.0);
  }
  std::vector<Point> points(part.size());
  std::vector<double> left(part.size(), 0);
  for (const std::size_t node : order) {
    points[node] = {left[node] + width[node] / 2, 1.3 * static_cast<double>(depth[node])};
    double at = left[node];
    for (const std::size_t next : part[node])
      if (depth[next] == depth[node] + 1) {
        left[next] = at;
        at += width[next];
      }
  }
  return points;
}

/// Distances from some far apart nodes, the pivots, to all others.
std::vector<std::vector<std::size_t>> pivot_distances(const Neighbours& part, std::vector<std::size_t>& pivots) {
  constexpr std::size_t most = 40;
  std::vector<std::vector<std::size_t>> all;
  std::vector<std::size_t> nearest(part.size(), unknown);
  std::size_t next = 0;
  while (all.size() < std::min(most, part.size())) {
    pivots.push_back(next);
    all.push_back(distances_from(part, next));
    for (std::size_t n = 0; n < part.size(); ++n) nearest[n] = std::min(nearest[n], all.back()[n]);
    next = static_cast<std::size_t>(std::max_element(nearest.begin(), nearest.end()) - nearest.begin());
  }
  return all;
}

/// The greatest eigenvector of the products of columns that is perpendicular to those known already, by iteration.
std::vector<double> main_direction(const std::vector<std::vector<double>>& columns,
                                   const std::vector<std::vector<double>>& known) {
  const std::size_t k = columns.size();
  std::vector<double> direction(k);
  for (std::size_t i = 0; i < k; ++i) direction[i] = 1.0 + static_cast<double>((i * 7919) % 101) / 100;
  for (int round = 0; round < 60; ++round) {
    std::vector<double> row(columns.front().size(), 0);
    for (std::size_t c = 0; c < k; ++c)
      for (std::size_t n = 0; n < row.size(); ++n) row[n] += columns[c][n] * direction[c];
    for (std::size_t c = 0; c < k; ++c) {
      direction[c] = 0;
      for (std::size_t n = 0; n < row.size(); ++n) direction[c] += columns[c][n] * row[n];
    }
    for (const std::vector<double>& other : known) {
      double along = 0;
      for (std::size_t c = 0; c < k; ++c) along += other[c] * direction[c];
      for (std::size_t c = 0; c < k; ++c) direction[c] -= along * other[c];
    }
    double norm = 0;
    for (const double value : direction) norm += value * value;
    norm = std::sqrt(norm);
    if (norm == 0) return direction;
    for (double& value : direction) value /= norm;
  }
  return direction;
}

/// Multidimensional scaling by pivots (Brandes and Pich 2006), then each node goes where its pivots and neighbours want
/// it.
std::vector<Point> mesh_layout(const Neighbours& part) {
  std::vector<std::size_t> pivots;
  const auto distance = pivot_distances(part, pivots);
  const std::size_t n = part.size();
  std::vector<std::vector<double>> columns(pivots.size(), std::vector<double>(n));
  std::vector<double> row_mean(n, 0);
  double mean = 0;
  for (std::size_t p = 0; p < pivots.size(); ++p) {
    double column_mean = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const auto d = static_cast<double>(distance[p][i]);
      columns[p][i] = d * d;
      column_mean += d * d / static_cast<double>(n);
      row_mean[i] += d * d / static_cast<double>(pivots.size());
    }
    mean += column_mean / static_cast<double>(pivots.size());
    for (double& value : columns[p]) value -= column_mean;
  }
  for (std::vector<double>& column : columns)
    for (std::size_t i = 0; i < n; ++i) column[i] = -0.5 * (column[i] - row_mean[i] + mean);
  std::vector<std::vector<double>> directions;
  for (int axis = 0; axis < 2; ++axis) directions.push_back(main_direction(columns, directions));
  std::vector<Point> points(n);
  for (std::size_t p = 0; p < pivots.size(); ++p)
    for (std::size_t i = 0; i < n; ++i) {
      points[i].x += columns[p][i] * directions[0][p];
      points[i].y += columns[p][i] * directions[1][p];
    }
  // Scaled so that links are about 1 long, with a grain of disorder: nodes with the same distances to all pivots would
  // never part.
  double sum = 0;
  std::size_t links = 0;
  for (std::size_t i = 0; i < n; ++i)
    for (const std::size_t other : part[i]) {
      sum += length({points[i].x - points[other].x, points[i].y - points[other].y});
      ++links;
    }
  const double scale = sum > 0 ? static_cast<double>(links) / sum : 1;
  for (std::size_t i = 0; i < n; ++i) {
    points[i].x = points[i].x * scale + 0.02 * static_cast<double>((i * 2654435761U) % 97) / 97;
    points[i].y = points[i].y * scale + 0.02 * static_cast<double>((i * 40503U) % 89) / 89;
  }
  for (int round = 0; round < 80; ++round)
    for (std::size_t i = 0; i < n; ++i) {
      Point wanted;
      double weights = 0;
      const auto pull = [&](std::size_t other, double d) {
        if (other == i) return;
        const Point away{points[i].x - points[other].x, points[i].y - points[other].y};
        const double far = std::max(length(away), 1e-6);
        const double weight = 1 / (d * d);
        wanted.x += weight * (points[other].x + d * away.x / far);
        wanted.y += weight * (points[other].y + d * away.y / far);
        weights += weight;
      };
      for (std::size_t p = 0; p < pivots.size(); ++p)
        pull(pivots[p], std::max(1.0, static_cast<double>(distance[p][i])));
      for (const std::size_t other : part[i]) pull(other, 1);
      if (weights > 0) points[i] = {wanted.x / weights, wanted.y / weights};
    }
  return points;
}

std::vector<Point> layout_of_part(const Neighbours& part) {
  std::size_t ends = 0;
  for (const auto& each : part) ends += each.size();
  const std::size_t links = ends / 2;
  if (is_path_or_ring(part)) return links < part.size() ? line_layout(part) : ring_layout(part);
  if (links + 1 == part.size() && part.size() <= 60) return tree_layout(part);
  return mesh_layout(part);
}

/// Leaves stand within the widest free angle around their hub.
void place_around(const std::vector<std::size_t>& leaves, Point hub, std::vector<double> taken,
                  std::vector<Point>& points) {
  std::sort(taken.begin(), taken.end());
  double from = pi / 2 - pi;  // nothing is taken: all around
  double widest = 2 * pi;
  if (!taken.empty()) {
    widest = 0;
    for (std::size_t i = 0; i < taken.size(); ++i) {
      const double gap = i + 1 < taken.size() ? taken[i + 1] - taken[i] : taken.front() + 2 * pi - taken.back();
      if (gap > widest + 1e-9) {
        widest = gap;
        from = taken[i];
      }
    }
  }
  const double distance = leaves.size() <= 6 ? 0.5 : std::min(0.9, 0.5 * static_cast<double>(leaves.size()) / 6);
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    const double angle =
        from + widest * static_cast<double>(i + 1) / static_cast<double>(leaves.size() + (taken.empty() ? 0 : 1));
    points[leaves[i]] = {hub.x + distance * std::cos(angle), hub.y + distance * std::sin(angle)};
  }
}

}  // namespace

std::vector<Point> layout(const Graph& graph) {
  const std::size_t nodes = graph.is_hub.size();
  const Neighbours all = neighbours_of(nodes, graph.edges);
  // Leaves hang on a hub; everything else is laid out.
  std::vector<bool> is_leaf(nodes);
  for (std::size_t n = 0; n < nodes; ++n)
    is_leaf[n] = !graph.is_hub[n] && all[n].size() == 1 && graph.is_hub[all[n].front()];
  std::vector<Point> points(nodes);
  std::vector<bool> is_done(nodes);
  double right = 0;  // parts stand beside one another
  for (std::size_t start = 0; start < nodes; ++start) {
    if (is_done[start] || is_leaf[start]) continue;
    std::vector<std::size_t> members = {start};
    std::vector<std::size_t> number(nodes, unknown);
    number[start] = 0;
    for (std::size_t i = 0; i < members.size(); ++i)
      for (const std::size_t next : all[members[i]])
        if (!is_leaf[next] && number[next] == unknown) {
          number[next] = members.size();
          members.push_back(next);
        }
    Neighbours part(members.size());
    for (std::size_t i = 0; i < members.size(); ++i) {
      is_done[members[i]] = true;
      for (const std::size_t next : all[members[i]])
        if (!is_leaf[next]) part[i].push_back(number[next]);
    }
    const std::vector<Point> placed = layout_of_part(part);
    double least = placed.front().x;
    double greatest = placed.front().x;
    for (const Point& point : placed) {
      least = std::min(least, point.x);
      greatest = std::max(greatest, point.x);
    }
    for (std::size_t i = 0; i < members.size(); ++i) points[members[i]] = {placed[i].x - least + right, placed[i].y};
    right += greatest - least + 2;
  }
  for (std::size_t hub = 0; hub < nodes; ++hub) {
    std::vector<std::size_t> leaves;
    std::vector<double> taken;
    for (const std::size_t next : all[hub]) {
      if (is_leaf[next])
        leaves.push_back(next);
      else
        taken.push_back(std::atan2(points[next].y - points[hub].y, points[next].x - points[hub].x));
    }
    if (!leaves.empty() && !is_leaf[hub]) place_around(leaves, points[hub], std::move(taken), points);
  }
  return points;
}

}  // namespace takt::chart
