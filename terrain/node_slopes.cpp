// SPDX-License-Identifier: BSD-3-Clause
#include "terrain/node_slopes.hpp"

#include <algorithm>
#include <cmath>

namespace grouser::terrain {

namespace {

/// Grid of heights.
struct Nodes {
  const std::vector<double>& heights;
  int columns, rows;

  double at(int i, int j) const { return heights[static_cast<std::size_t>(j) * static_cast<std::size_t>(columns) + i]; }
  bool has(int i, int j) const { return i >= 0 && i < columns && j >= 0 && j < rows; }
};

/// Slope at a node from the differences to the node before and behind it.
double limited(double before, double behind) {
  return before * behind > 0 ? 2 * before * behind / (before + behind) : 0;
}

/// Slope at a border node, where the surface is extrapolated by its last difference.
double slopeAt(double before, double here, double behind, int k, int n) {
  if (k == 0) return behind - here;
  if (k == n - 1) return here - before;
  return limited(here - before, behind - here);
}

/// Mixed Catmull-Rom slope: central difference along both axes; one-sided at the border.
double mixed(const Nodes& n, int i, int j) {
  const int i0 = std::max(i - 1, 0), i1 = std::min(i + 1, n.columns - 1);
  const int j0 = std::max(j - 1, 0), j1 = std::min(j + 1, n.rows - 1);
  return (n.at(i1, j1) - n.at(i1, j0) - n.at(i0, j1) + n.at(i0, j0)) / ((i1 - i0) * (j1 - j0));
}

/// The inner point of a cell's Bezier net next to the node is h + share (sx X + sy Y) / 3 + sx sy XY / 9. The range of
/// the cell limits XY to low + share lowRise <= XY <= high + share highRise.
struct Room {
  double low, lowRise, high, highRise;
};
Room roomIn(const Nodes& n, int i, int j, int sx, int sy, const NodeSlopes& m) {
  const auto [least, most] = std::minmax({n.at(i, j), n.at(i + sx, j), n.at(i, j + sy), n.at(i + sx, j + sy)});
  const double below = 9 * (least - n.at(i, j)), above = 9 * (most - n.at(i, j)), rise = 3 * (sx * m.x + sy * m.y);
  if (sx * sy > 0) return {below, -rise, above, -rise};
  return {-above, rise, -below, rise};
}

NodeSlopes limitedSlopes(const Nodes& n, int i, int j) {
  const auto near = [&](int a, int b) { return n.has(a, b) ? n.at(a, b) : n.at(i, j); };
  NodeSlopes m{slopeAt(near(i - 1, j), n.at(i, j), near(i + 1, j), i, n.columns),
               slopeAt(near(i, j - 1), n.at(i, j), near(i, j + 1), j, n.rows), mixed(n, i, j)};
  Room rooms[4];
  int count = 0;
  for (const int sx : {-1, 1})
    for (const int sy : {-1, 1})
      if (n.has(i + sx, j + sy)) rooms[count++] = roomIn(n, i, j, sx, sy, m);
  // Largest share of the slopes for which all four limits are compatible; at 0 they contain XY = 0.
  double share = 1;
  for (int a = 0; a < count; ++a)
    for (int b = 0; b < count; ++b)
      if (const double closes = rooms[a].lowRise - rooms[b].highRise; closes > 0)
        share = std::min(share, (rooms[b].high - rooms[a].low) / closes);
  double low = -1e300, high = 1e300;
  for (int a = 0; a < count; ++a) {
    low = std::max(low, rooms[a].low + share * rooms[a].lowRise);
    high = std::min(high, rooms[a].high + share * rooms[a].highRise);
  }
  return {share * m.x, share * m.y, std::max(low, std::min(high, share * m.xy))};
}

} // namespace

std::vector<NodeSlopes> monotoneSlopes(const std::vector<double>& heights, int columns, int rows) {
  const Nodes nodes{heights, columns, rows};
  std::vector<NodeSlopes> slopes;
  slopes.reserve(heights.size());
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) slopes.push_back(limitedSlopes(nodes, i, j));
  return slopes;
}

bool isPlane(const std::vector<double>& heights, int columns, int rows) {
  const Nodes n{heights, columns, rows};
  double most = 0;
  for (const double h : heights) most = std::max(most, std::fabs(h));
  const double slopeX = (n.at(columns - 1, 0) - n.at(0, 0)) / (columns - 1),
               slopeY = (n.at(0, rows - 1) - n.at(0, 0)) / (rows - 1);
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i)
      if (std::fabs(n.at(0, 0) + slopeX * i + slopeY * j - n.at(i, j)) > 1e-13 * most) return false;
  return true;
}

} // namespace grouser::terrain
