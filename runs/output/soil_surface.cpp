// SPDX-License-Identifier: BSD-3-Clause
#include "runs/output/soil_surface.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace grouser::output {

namespace {

using coupling::GroundFields;
using coupling::SoilNode;
using Place = std::pair<std::int32_t, std::int32_t>; ///< indices j, i of a node, or of the lower corner of a cell

constexpr std::int32_t kBlock = 4; ///< node intervals along the edge of a block that is divided at node spacing
constexpr int kReliefCells = 128;  ///< minimum number of cells along the longer side of the terrain, for its relief

void sortUnique(std::vector<Place>& places) {
  std::sort(places.begin(), places.end());
  places.erase(std::unique(places.begin(), places.end()), places.end());
}

/// Quotient rounded down; `size` > 0.
std::int32_t floorDivide(std::int32_t node, std::int32_t size) {
  return node >= 0 ? node / size : -((size - 1 - node) / size);
}
std::int32_t blockOf(std::int32_t node) { return floorDivide(node, kBlock); }

/// A square with `size` node intervals per side and its lower corner at node (i, j).
struct Cell {
  std::int32_t i, j, size;
};

/// Divides the terrain into cells: a quadtree with the smallest cells at the touched nodes.
class Cells {
public:
  Cells(const GroundFields& fields, const terrain::Rectangle& area) : h_(fields.spacing), area_(area) {
    // Blocks around a touched node, plus one more block on each side, for correct normals at the edges of ruts.
    for (const SoilNode& node : fields.nodes)
      for (const std::int32_t j : {node.j - 2, node.j + 1})
        for (const std::int32_t i : {node.i - 2, node.i + 1}) fine_.emplace_back(blockOf(j), blockOf(i));
    sortUnique(fine_);
    relief_ = std::max(area.width(), area.length()) / kReliefCells;
    const auto at = [&](double place) { return static_cast<std::int32_t>(std::floor(place / h_)); };
    std::int32_t size = kBlock;
    while (h_ * size < std::max(area.width(), area.length())) size *= 2;
    // Like blocks, cells are aligned to multiples of their size.
    const auto down = [size](std::int32_t node) { return floorDivide(node, size); };
    for (std::int32_t j = down(at(area.yMin)); j <= down(at(area.yMax)); ++j)
      for (std::int32_t i = down(at(area.xMin)); i <= down(at(area.xMax)); ++i) cut({i * size, j * size, size});
  }

  const std::vector<Cell>& leaves() const { return leaves_; }
  bool isFine(const Cell& cell) const {
    return cell.size == kBlock &&
           std::binary_search(fine_.begin(), fine_.end(), Place{blockOf(cell.j), blockOf(cell.i)});
  }

private:
  bool hasFine(const Cell& cell) const {
    const std::int32_t blocks = cell.size / kBlock, first = blockOf(cell.i), row = blockOf(cell.j);
    for (auto at = std::lower_bound(fine_.begin(), fine_.end(), Place{row, first});
         at != fine_.end() && at->first < row + blocks;) {
      if (at->second >= first && at->second < first + blocks) return true;
      at =
          std::lower_bound(at, fine_.end(), at->second < first ? Place{at->first, first} : Place{at->first + 1, first});
    }
    return false;
  }

  void cut(const Cell& cell) {
    if (h_ * (cell.i + cell.size) <= area_.xMin || h_ * cell.i >= area_.xMax ||
        h_ * (cell.j + cell.size) <= area_.yMin || h_ * cell.j >= area_.yMax)
      return;
    if (cell.size == kBlock || (h_ * cell.size <= relief_ && !hasFine(cell))) {
      leaves_.push_back(cell);
      return;
    }
    const std::int32_t half = cell.size / 2;
    for (const std::int32_t j : {cell.j, cell.j + half})
      for (const std::int32_t i : {cell.i, cell.i + half}) cut({i, j, half});
  }

  double h_, relief_{};
  terrain::Rectangle area_;
  std::vector<Place> fine_; ///< blocks: row, column
  std::vector<Cell> leaves_;
};

/// Vertices of all cells; they are the corners of the triangles.
class Vertices {
public:
  explicit Vertices(const Cells& cells) {
    for (const Cell& c : cells.leaves()) {
      const std::int32_t step = cells.isFine(c) ? 1 : c.size;
      for (std::int32_t j = c.j; j <= c.j + c.size; j += step)
        for (std::int32_t i = c.i; i <= c.i + c.size; i += step) byRow_.emplace_back(j, i);
      if (step != 1) byRow_.emplace_back(c.j + c.size / 2, c.i + c.size / 2);
    }
    sortUnique(byRow_);
    for (const auto& [j, i] : byRow_) byColumn_.emplace_back(i, j);
    std::sort(byColumn_.begin(), byColumn_.end());
  }

  const std::vector<Place>& places() const { return byRow_; }
  std::uint32_t number(std::int32_t i, std::int32_t j) const {
    return static_cast<std::uint32_t>(std::lower_bound(byRow_.begin(), byRow_.end(), Place{j, i}) - byRow_.begin());
  }
  /// Vertices around a cell, counter-clockwise from its lower corner: its corners, and corners of neighbours in
  /// between.
  std::vector<std::uint32_t> around(const Cell& c) const {
    std::vector<std::uint32_t> ring;
    const std::int32_t right = c.i + c.size, top = c.j + c.size;
    const auto side = [&](const std::vector<Place>& sorted, std::int32_t line, std::int32_t from, std::int32_t to,
                          bool isColumn, bool backwards) {
      std::vector<std::uint32_t> found;
      for (auto at = std::lower_bound(sorted.begin(), sorted.end(), Place{line, from});
           at != sorted.end() && *at <= Place{line, to}; ++at)
        found.push_back(isColumn ? number(line, at->second) : number(at->second, line));
      if (backwards) std::reverse(found.begin(), found.end());
      ring.insert(ring.end(), found.begin(), found.end() - 1); // the last vertex is the first of the next side
    };
    side(byRow_, c.j, c.i, right, false, false), side(byColumn_, right, c.j, top, true, false);
    side(byRow_, top, c.i, right, false, true), side(byColumn_, c.i, c.j, top, true, true);
    return ring;
  }

private:
  std::vector<Place> byRow_, byColumn_; ///< (j, i) and (i, j)
};

} // namespace

SoilSurface soilSurface(const GroundFields& fields, const terrain::HeightField& undisturbed) {
  const terrain::Rectangle& area = undisturbed.area();
  const Cells cells(fields, area);
  const Vertices vertices(cells);
  SoilSurface surface;
  auto node = fields.nodes.begin();
  for (const auto& [j, i] : vertices.places()) {
    while (node != fields.nodes.end() && Place{node->j, node->i} < Place{j, i}) ++node;
    const bool isTouched = node != fields.nodes.end() && node->i == i && node->j == j;
    const SoilNode now = isTouched ? *node : SoilNode{};
    const double x = std::clamp(fields.spacing * i, area.xMin, area.xMax);
    const double y = std::clamp(fields.spacing * j, area.yMin, area.yMax);
    surface.mesh.vertices.push_back({x, y, undisturbed.height(x, y) - now.sinkage});
    surface.sinkage.push_back(static_cast<float>(now.sinkage));
    surface.pressure.push_back(static_cast<float>(now.pressure));
    surface.maxPressure.push_back(static_cast<float>(now.maxPressure));
    surface.shear.push_back(now.shear.as<float>());
  }
  std::vector<std::uint32_t>& corners = surface.mesh.indices;
  for (const Cell& c : cells.leaves()) {
    if (!cells.isFine(c)) {
      const std::vector<std::uint32_t> ring = vertices.around(c);
      const std::uint32_t middle = vertices.number(c.i + c.size / 2, c.j + c.size / 2);
      for (std::size_t k = 0; k < ring.size(); ++k)
        corners.insert(corners.end(), {middle, ring[k], ring[(k + 1) % ring.size()]});
      continue;
    }
    for (std::int32_t j = c.j; j < c.j + c.size; ++j)
      for (std::int32_t i = c.i; i < c.i + c.size; ++i) {
        const std::uint32_t low = vertices.number(i, j), high = vertices.number(i, j + 1);
        corners.insert(corners.end(), {low, low + 1, high + 1, low, high + 1, high});
      }
  }
  return surface;
}

} // namespace grouser::output
