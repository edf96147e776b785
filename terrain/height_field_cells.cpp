// SPDX-License-Identifier: BSD-3-Clause
#include "terrain/height_field_cells.hpp"

#include "base/math.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace grouser::terrain {

namespace {

constexpr int kMaxCells = 256;                           ///< larger boxes are not tested cell by cell
constexpr double kSameHeight = 1e-10, kSameSlope = 1e-9; // [m], [-]

/// Height and slopes of a planar cell at one of its corners.
struct Slopes {
  double h, hx, hy;
};

/// True if heights, slopes and mixed derivatives of the four corners of a bicubic patch are those of a plane.
std::optional<Slopes> planarCell(const HeightFieldView& v, int i, int j) {
  const bool smooth = v.interpolation == Interpolation::smooth;
  std::optional<Slopes> first;
  for (int b = 0; b < 2; ++b)
    for (int a = 0; a < 2; ++a) {
      const double x = v.xMin + (i + a) * v.dx, y = v.yMin + (j + b) * v.dy;
      const SurfaceJet s = smooth ? v.jet(x, y) : v.jetInCell(i, j, x, y);
      if (!first) first = {s.h, s.hx, s.hy};
      const double rise = s.h - first->h - first->hx * a * v.dx - first->hy * b * v.dy;
      if (std::fabs(rise) > kSameHeight || std::fabs(s.hx - first->hx) > kSameSlope ||
          std::fabs(s.hy - first->hy) > kSameSlope || std::fabs(s.hxy) * (v.dx + v.dy) > kSameSlope)
        return {};
    }
  return first;
}

} // namespace

HeightFieldCells::HeightFieldCells(const HeightField& field)
    : area_(field.area()), columns_(field.columns() - 1), rows_(field.rows() - 1), highest_(field.bounds().highest),
      inverseDx_(columns_ / area_.width()), inverseDy_(rows_ / area_.length()) {
  const HeightFieldView v = field.view();
  const std::size_t cells = static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_);
  tops_.reserve(cells), curvatures_.reserve(cells), planeOf_.reserve(cells);
  for (int j = 0; j < rows_; ++j)
    for (int i = 0; i < columns_; ++i) {
      const HeightFieldBounds bounds = field.boundsOfCell(i, j);
      tops_.push_back(bounds.highest), curvatures_.push_back(bounds.valleyCurvature);
      const std::optional<Slopes> s = planarCell(v, i, j);
      planeOf_.push_back(s ? listed({v.xMin + i * v.dx, v.yMin + j * v.dy, s->h}, s->hx, s->hy) : -1);
    }
}

/// Returns the index of the plane through `corner` with these slopes; -1 if the list is full.
std::int32_t HeightFieldCells::listed(const Vec3d& corner, double hx, double hy) {
  constexpr std::size_t kMaxPlanes = 64;
  const Vec3d normal = base::normalized(Vec3d{-hx, -hy, 1});
  for (std::size_t k = 0; k < planes_.size(); ++k)
    if (norm(planes_[k].normal - normal) <= kSameSlope &&
        std::fabs(dot(planes_[k].normal, corner) - planes_[k].height) <= kSameHeight)
      return static_cast<std::int32_t>(k);
  if (planes_.size() == kMaxPlanes) return -1;
  planes_.push_back({normal, dot(normal, corner)});
  return static_cast<std::int32_t>(planes_.size() - 1);
}

bool HeightFieldCells::contains(double x0, double x1, double y0, double y1) const {
  return x0 >= area_.xMin && y0 >= area_.yMin && x1 <= area_.xMax && y1 <= area_.yMax;
}

/// Range of cells covered by a rectangle within the border.
HeightFieldCells::Range HeightFieldCells::rangeOf(double x0, double x1, double y0, double y1) const {
  const auto cell = [](double x, double from, double inverse, int cells) {
    return std::min(static_cast<int>((x - from) * inverse), cells - 1);
  };
  return {cell(x0, area_.xMin, inverseDx_, columns_), cell(x1, area_.xMin, inverseDx_, columns_),
          cell(y0, area_.yMin, inverseDy_, rows_), cell(y1, area_.yMin, inverseDy_, rows_)};
}

std::int32_t HeightFieldCells::commonPlane(const Range& r) const {
  if (r.cells() > kMaxCells) return -1;
  const std::int32_t first = planeOf_[cell(r.i0, r.j0)];
  for (int j = r.j0; first >= 0 && j <= r.j1; ++j)
    for (int i = r.i0; i <= r.i1; ++i)
      if (planeOf_[cell(i, j)] != first) return -1;
  return first;
}

bool HeightFieldCells::near(const Vec3d& low, const Vec3d& high) const {
  if (!contains(low.x, high.x, low.y, high.y)) return true;
  if (low.z > highest_) return false;
  const Range r = rangeOf(low.x, high.x, low.y, high.y);
  if (r.cells() > kMaxCells) return true;
  for (int j = r.j0; j <= r.j1; ++j)
    for (int i = r.i0; i <= r.i1; ++i)
      if (low.z <= tops_[cell(i, j)]) return true;
  return false;
}

HeightFieldCells::Under HeightFieldCells::under(const Vec3d& low, const Vec3d& high) const {
  if (!contains(low.x, high.x, low.y, high.y)) return {nullptr, base::kInfinity};
  const Range r = rangeOf(low.x, high.x, low.y, high.y);
  if (r.cells() > kMaxCells) return {nullptr, base::kInfinity};
  const std::int32_t index = commonPlane(r);
  if (index < 0) {
    double curvature = 0;
    for (int j = r.j0; j <= r.j1; ++j)
      for (int i = r.i0; i <= r.i1; ++i) curvature = std::max(curvature, curvatures_[cell(i, j)]);
    return {nullptr, curvature};
  }
  const Plane& plane = planes_[static_cast<std::size_t>(index)];
  // A point at the depth d below the plane may be nearer to other parts of the surface, up to d away.
  double depth = 0;
  for (const double x : {low.x, high.x})
    for (const double y : {low.y, high.y})
      depth = std::max(depth, plane.height - dot(plane.normal, Vec3d{x, y, low.z}));
  const double x0 = low.x - depth, x1 = high.x + depth, y0 = low.y - depth, y1 = high.y + depth;
  const bool planar = depth == 0 || (contains(x0, x1, y0, y1) && commonPlane(rangeOf(x0, x1, y0, y1)) == index);
  return {planar ? &plane : nullptr, 0};
}

} // namespace grouser::terrain
