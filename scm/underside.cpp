// SPDX-License-Identifier: BSD-3-Clause
#include "scm/underside.hpp"

#include "scm/node_contact.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace grouser::scm {

namespace {

constexpr double kUpright = 1e-6;   // cosine of a facet below which its projection is negligible
constexpr double kSliver = 1e-9;    // share of a node's square below which an area is due to rounding
constexpr double kShortest = 1e-10; // length below which an edge has no direction [m]
constexpr double kSame = 1e-9;      // difference of depths below which facets count as equally deep [m]
constexpr double kRise = 2.5;       // height above the soil up to which pieces are kept [node spacing]

/// Cuts the part of `piece` inside `cover` where `cover` is deeper, or equally deep and `first`; appends the rest.
/// Areas up to `sliver` [m2] count as none, so that roundings do not multiply pieces.
void subtract(const Piece& piece, const Piece& cover, bool first, double sliver, std::vector<Piece>& rest) {
  Polygon deeper, one, other;
  const double margin = first ? kSame : -kSame;
  clip(
      cover.outline, [&](const Vec3d& p) { return cover.depthAt(p) - piece.depthAt(p) + margin; }, one);
  for (const Vec3d& p : one)
    if (deeper.empty() || std::fabs(p.x - deeper.back().x) + std::fabs(p.y - deeper.back().y) > kShortest)
      deeper.push_back(p);
  double twice = 0; // signed area
  for (std::size_t k = 0; k < deeper.size(); ++k) {
    const Vec3d &a = deeper[k], &b = deeper[(k + 1) % deeper.size()];
    twice += a.x * b.y - a.y * b.x;
  }
  if (std::fabs(twice) <= 2 * sliver) {
    rest.push_back(piece);
    return;
  }
  const double side = twice < 0 ? -1 : 1;
  const auto inside = [&](std::size_t k) {
    return [side, a = deeper[k], b = deeper[(k + 1) % deeper.size()]](const Vec3d& p) {
      return side * ((b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x));
    };
  };
  one = piece.outline;
  for (std::size_t k = 0; k < deeper.size(); ++k) clip(one, inside(k), other), std::swap(one, other);
  if (meanOf(one).area <= sliver) {
    rest.push_back(piece);
    return;
  }
  one = piece.outline;
  for (std::size_t k = 0; k < deeper.size() && one.size() > 2; ++k) {
    clip(
        one, [&](const Vec3d& p) { return -inside(k)(p); }, other);
    if (meanOf(other).area > sliver) {
      rest.push_back(piece);
      rest.back().outline = other;
    }
    clip(one, inside(k), other);
    std::swap(one, other);
  }
}

struct Box {
  double x0 = 1e300, x1 = -1e300, y0 = 1e300, y1 = -1e300;
  explicit Box(const Polygon& polygon) {
    for (const Vec3d& p : polygon)
      x0 = std::min(x0, p.x), x1 = std::max(x1, p.x), y0 = std::min(y0, p.y), y1 = std::max(y1, p.y);
  }
  bool overlaps(const Box& b) const { return x0 < b.x1 && b.x0 < x1 && y0 < b.y1 && b.y0 < y1; }
};

} // namespace

void Underside::cut(SoilMap& map, const Solid* solids, std::size_t count, const contact::PartMotion* motion) {
  recycle();
  const double h = map.spacing();
  Vec3d low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
  for (std::size_t s = 0; s < count; ++s) {
    const contact::PartMotion& m = motion[solids[s].part];
    Vec3d half;
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b) half[a] += std::fabs(m.rotation.m[a][b]) * solids[s].half[b];
    low = min(low, m.origin - half), high = max(high, m.origin + half);
  }
  // Along an inclined normal, a point at a depth belongs to a node beside it.
  const terrain::SurfaceJet jet = map.jetAt(0.5 * (low.x + high.x), 0.5 * (low.y + high.y));
  const double slope = ::sqrt(jet.hx * jet.hx + jet.hy * jet.hy);
  const double aside = 2 * slope * std::max(0.0, std::min(jet.h + 0.5 * slope * norm(high - low), high.z) - low.z);
  firstI_ = static_cast<std::int32_t>(std::ceil((low.x - aside) / h - 0.5));
  firstJ_ = static_cast<std::int32_t>(std::ceil((low.y - aside) / h - 0.5));
  columns_ = static_cast<std::int32_t>(std::floor((high.x + aside) / h + 0.5)) - firstI_ + 1;
  rows_ = static_cast<std::int32_t>(std::floor((high.y + aside) / h + 0.5)) - firstJ_ + 1;
  if (low.z > map.topOf(firstI_, firstI_ + columns_ - 1, firstJ_, firstJ_ + rows_ - 1) + kNear) return;
  grid_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
  double leastUp = 1, top = -1e300; // over the cells
  lowest_ = 1e300;
  for (std::int32_t j = 0; j < rows_; ++j)
    for (std::int32_t i = 0; i < columns_; ++i) {
      Cell& c = grid_[static_cast<std::size_t>(j) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(i)];
      c.i = firstI_ + i, c.j = firstJ_ + j, c.node = &map.at(c.i, c.j), c.normal = map.normalAt(c.i, c.j);
      leastUp = std::min(leastUp, c.normal.z), top = std::max(top, c.node->height + c.node->looseThickness());
      lowest_ = std::min(lowest_, c.node->height);
    }
  leastTurned_ = -::sqrt(std::max(0.0, 1 - leastUp * leastUp)), highest_ = top + (kRise * h + kNear) / leastUp;
  for (std::size_t s = 0; s < count; ++s)
    for (const Facet& f : solids[s].facets) add(f, s, motion[solids[s].part], h);
  const bool covers = count > 1 || !solids[0].isConvex;
  for (Cell& c : grid_) {
    if (c.pieces.empty()) continue;
    if (covers) removeCovered(c, solids, kSliver * h * h);
    cells_.push_back(std::move(c));
    c = {};
  }
}

/// Keeps the memory of the outlines.
void Underside::recycle() {
  for (std::vector<Cell>* cells : {&grid_, &cells_})
    for (Cell& c : *cells) {
      for (Piece& p : c.pieces) outlines_.push_back(std::move(p.outline));
      c.pieces.clear();
    }
  cells_.clear();
}

void Underside::add(const Facet& facet, std::size_t solid, const contact::PartMotion& motion, double h) {
  const Vec3d up = motion.rotation * facet.normal * -1.0;
  if (up.z < leastTurned_) return;
  const Vec3d vertical{motion.rotation.m[2][0], motion.rotation.m[2][1], motion.rotation.m[2][2]};
  double lowest = 1e300;
  for (const Vec3d& corner : facet.corners) lowest = std::min(lowest, dot(vertical, corner));
  if (motion.origin.z + lowest > highest_) return;
  corners_.clear();
  Vec3d low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
  for (const Vec3d& corner : facet.corners) {
    corners_.push_back(motion.toWorld(corner));
    low = min(low, corners_.back()), high = max(high, corners_.back());
  }
  // Nodes whose squares the facet can reach along the steepest normal.
  const double aside = -leastTurned_ * (std::fabs(highest_ - low.z) + std::fabs(high.z - lowest_) + h);
  const auto limit = [](double x, std::int32_t most) {
    return static_cast<std::int32_t>(std::clamp(x, 0.0, static_cast<double>(most)));
  };
  const std::int32_t i0 = limit(std::ceil((low.x - aside) / h - 0.5) - firstI_, columns_ - 1);
  const std::int32_t i1 = limit(std::floor((high.x + aside) / h + 0.5) - firstI_, columns_ - 1);
  const std::int32_t j0 = limit(std::ceil((low.y - aside) / h - 0.5) - firstJ_, rows_ - 1);
  const std::int32_t j1 = limit(std::floor((high.y + aside) / h + 0.5) - firstJ_, rows_ - 1);
  for (std::int32_t j = j0; j <= j1; ++j)
    for (std::int32_t i = i0; i <= i1; ++i)
      addTo(grid_[static_cast<std::size_t>(j) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(i)], up,
            solid, h);
}

void Underside::addTo(Cell& cell, const Vec3d& up, std::size_t solid, double h) {
  const Vec3d &e = cell.normal, node{h * cell.i, h * cell.j, cell.node->height};
  const double cosine = dot(up, e);
  if (cosine < kUpright) return;
  double deepest = -1e300;
  Polygon& outline = one_;
  outline.clear();
  for (const Vec3d& corner : corners_) {
    const Vec3d from = corner - node;
    const double depth = -dot(from, e);
    deepest = std::max(deepest, depth), outline.push_back({from.x + depth * e.x, from.y + depth * e.y, depth});
  }
  const double side = 0.5 * h, top = kRise * h + kNear + cell.node->looseThickness();
  const Box box(outline);
  if (deepest < -top || box.x0 >= side || box.x1 <= -side || box.y0 >= side || box.y1 <= -side) return;
  const auto keep = [&](const auto& value) { clip(outline, value, other_), std::swap(outline, other_); };
  if (box.x0 < -side) keep([side](const Vec3d& p) { return p.x + side; });
  if (box.x1 > side) keep([side](const Vec3d& p) { return side - p.x; });
  if (box.y0 < -side) keep([side](const Vec3d& p) { return p.y + side; });
  if (box.y1 > side) keep([side](const Vec3d& p) { return side - p.y; });
  keep([top](const Vec3d& p) { return p.z + top; });
  if (outline.size() < 3 || !(meanOf(outline).area > kSliver * h * h)) return;
  Piece& piece = cell.pieces.emplace_back();
  if (!outlines_.empty()) piece.outline = std::move(outlines_.back()), outlines_.pop_back();
  piece.outline = outline, piece.up = up, piece.cosine = cosine, piece.solid = solid;
  piece.slopeX = (up.z * e.x / e.z - up.x) / -cosine, piece.slopeY = (up.z * e.y / e.z - up.y) / -cosine;
  const Vec3d& p = outline.front();
  piece.level = p.z - piece.slopeX * p.x - piece.slopeY * p.y;
}

void Underside::removeCovered(Cell& cell, const Solid* solids, double sliver) {
  std::vector<Piece> visible, left, next;
  std::vector<Box> boxes;
  boxes.reserve(cell.pieces.size());
  for (const Piece& p : cell.pieces) boxes.emplace_back(p.outline);
  for (std::size_t a = 0; a < cell.pieces.size(); ++a) {
    left = {cell.pieces[a]};
    for (std::size_t b = 0; b < cell.pieces.size() && !left.empty(); ++b) {
      const Piece &one = cell.pieces[a], &other = cell.pieces[b];
      if (a == b || (one.solid == other.solid && solids[one.solid].isConvex)) continue;
      if (!boxes[a].overlaps(boxes[b])) continue;
      next.clear();
      for (const Piece& p : left) subtract(p, cell.pieces[b], b < a, sliver, next);
      std::swap(left, next);
    }
    for (Piece& p : left) visible.push_back(std::move(p));
  }
  cell.pieces = std::move(visible);
}

} // namespace grouser::scm
