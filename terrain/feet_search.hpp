// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/math.hpp"
#include "terrain/height_field.hpp"

#if defined(__CUDACC__)
#define GROUSER_HD_CALL __host__ __device__ __noinline__
#else
#define GROUSER_HD_CALL
#endif

namespace grouser::terrain {

/// Cell flags in HeightFieldView::marks.
inline constexpr std::uint8_t kNearHollow = 1; ///< a hollow tighter than the sphere is within its radius
inline constexpr std::uint8_t kInHollow = 2;   ///< the cell is part of such a hollow

/// All contact points (feet) of a sphere on a height field.
struct Feet {
  static constexpr int kMax = 8;
  FootPoint foot[kMax]; ///< the first `count` are valid: at most kMax feet, those separated by the highest rises
  /// Maximum distance of the centre from the ground on the straight line between two feet [m].
  double between[kMax][kMax];
  int count{0};

  GROUSER_HD const FootPoint& nearest() const {
    int k = 0;
    for (int l = 1; l < count; ++l)
      if (foot[l].distance < foot[k].distance) k = l;
    return foot[k];
  }
};

/// Loads of the feet. Two feet are separate contacts if the ground between them leaves the sphere. If the ground stays
/// inside, they form one contact with two minima (a gentle valley, steps in an 8-bit map). Its force is the sum of both
/// forces minus the force at the overlap of the rise between them. The normal force thus derives from an energy,
/// sum of u(overlap of each foot) - sum of u(overlap where contacts merge), and is continuous.
class FeetLoads {
public:
  /// `hertz`: true if forces grow with overlap^1.5; otherwise they are linear.
  GROUSER_HD FeetLoads(const Feet& feet, double radius, bool hertz) : hertz_(hertz) {
    int contact[Feet::kMax];
    for (int k = 0; k < feet.count; ++k)
      contact[k] = k, overlap_[k] = radius - feet.foot[k].distance, force_[k] = force(overlap_[k]);
    for (;;) {
      double rise = radius;
      int a = -1, b = -1;
      for (int i = 0; i < feet.count; ++i)
        for (int j = 0; j < i; ++j)
          if (contact[i] != contact[j] && feet.between[i][j] < rise) rise = feet.between[i][j], a = j, b = i;
      if (a < 0) break;
      merge(contact, contact[a], contact[b], feet.count, radius - rise);
    }
    for (int k = 0; k < feet.count; ++k) {
      const double full = force(overlap_[k]);
      share_[k] = full > 0 ? force_[k] / full : 1;
      if (share_[k] == 1) continue;
      const double root = hertz_ ? base::cubeRoot(share_[k]) : 1;
      overlap_[k] *= hertz_ ? root * root : share_[k];
    }
  }

  GROUSER_HD double share(int foot) const {
    return share_[foot];
  } ///< force / force that this overlap would cause without other feet [-]
  GROUSER_HD double overlap(int foot) const { return overlap_[foot]; } ///< overlap that causes the shared force [m]
  GROUSER_HD int merges() const { return merges_; }
  GROUSER_HD double merged(int merge) const { return merged_[merge]; } ///< overlap at which two contacts merge [m]

private:
  GROUSER_HD double force(double overlap) const { return hertz_ && overlap > 0 ? overlap * sqrt(overlap) : overlap; }

  /// Counts the force at `overlap`, where contacts `a` and `b` merge, only once, and shares it in proportion to the
  /// roots of the excess forces: in a crease the sum points away from the bottom; a vanishing contact has no force.
  GROUSER_HD void merge(int (&contact)[Feet::kMax], int a, int b, int count, double overlap) {
    const double common = force(overlap);
    double of[2] = {};
    for (int k = 0; k < count; ++k)
      if (contact[k] == a || contact[k] == b) of[contact[k] == b] += force_[k];
    const double least = 1e-12 * (of[0] + of[1]);
    const double beyondA = of[0] > common ? of[0] - common : 0, beyondB = of[1] > common ? of[1] - common : 0;
    const double rootA = sqrt(beyondA + least), partA = rootA / (rootA + sqrt(beyondB + least));
    const double scaleA = (beyondA + partA * common) / of[0], scaleB = (beyondB + (1 - partA) * common) / of[1];
    for (int k = 0; k < count; ++k) {
      if (contact[k] == a) force_[k] *= scaleA;
      if (contact[k] == b) force_[k] *= scaleB, contact[k] = a;
    }
    merged_[merges_++] = overlap;
  }

  bool hertz_;
  int merges_{0};
  double overlap_[Feet::kMax], force_[Feet::kMax], share_[Feet::kMax], merged_[Feet::kMax];
};

/// Finds the local minima, below the radius, of the distance between a sphere centre and the surface. Away from hollows
/// tighter than the sphere there is only one, found by HeightFieldView::closestPoint(). Near such hollows every cell in
/// reach is searched by damped Newton steps that stay near the cell: from four points in cells inside a hollow, from
/// the centre in other cells. For a sphere centre below the surface only the nearest point is used.
class FeetSearch {
public:
  GROUSER_HD FeetSearch(const HeightFieldView& surface, const Vec3d& centre, double radius)
      : v_(surface), p_(centre), radius_(radius), same_(0.01 * smaller(surface.dx, surface.dy)) {}

  /// Not inlined on a GPU: keeps the register count low in kernels for ground without such hollows.
  GROUSER_HD_CALL void run(Feet& feet) {
    const bool near = v_.marks && v_.marks[cell(v_.cellX(p_.x), v_.cellY(p_.y))] & kNearHollow;
    const FootPoint first = v_.closestPoint(p_);
    if (!near) {
      if (first.distance < radius_) feet.foot[feet.count++] = first;
      return;
    }
    // Where other feet are possible, only true minima count.
    const Vec3d aside = p_ - first.point - first.normal * first.distance;
    if (v_.interpolation != Interpolation::bilinear && first.distance < radius_ && base::norm(aside) < same_)
      put(first, feet.count++, feet);
    side_ = p_.z < v_.height(p_.x, p_.y) ? -1 : 1;
    const int i0 = v_.cellX(p_.x - radius_), i1 = v_.cellX(p_.x + radius_);
    const int j0 = v_.cellY(p_.y - radius_), j1 = v_.cellY(p_.y + radius_);
    for (int j = j0; j <= j1; ++j)
      for (int i = i0; i <= i1; ++i)
        if (reaches(i, j)) searchCell(i, j, feet);
    if (feet.count == 0) keep(first, feet);
  }

private:
  struct Range {
    double low, high;
  };
  static constexpr double kFar = 1e30; // [m]

  /// An overlapping sphere counts as in contact even if it sank by more than its radius: the run must then stop.
  GROUSER_HD void keep(FootPoint foot, Feet& feet) const {
    const Vec3d gap = p_ - foot.point;
    const double away = base::norm(gap);
    if ((side_ > 0 && away >= radius_) || away == 0) return;
    foot.distance = side_ * away, foot.normal = gap * (1 / foot.distance);
    feet.foot[feet.count++] = foot;
  }

  GROUSER_HD static double smaller(double a, double b) { return a < b ? a : b; }
  GROUSER_HD std::int64_t cell(int i, int j) const { return static_cast<std::int64_t>(j) * (v_.columns - 1) + i; }
  /// Extent of a cell along one axis; the outermost cells extend to infinity.
  GROUSER_HD static Range rangeOf(int i, int cells, double from, double d) {
    return {i == 0 ? -kFar : from + i * d, i == cells - 1 ? kFar : from + (i + 1) * d};
  }
  GROUSER_HD static double clamped(double x, const Range& r) { return x < r.low ? r.low : x > r.high ? r.high : x; }

  /// True if a point of the cell may be inside the sphere.
  GROUSER_HD bool reaches(int i, int j) const {
    const Range x = rangeOf(i, v_.columns - 1, v_.xMin, v_.dx), y = rangeOf(j, v_.rows - 1, v_.yMin, v_.dy);
    const double awayX = p_.x - clamped(p_.x, x), awayY = p_.y - clamped(p_.y, y);
    const bool open = p_.x - radius_ < v_.xMin || p_.x + radius_ > v_.xMin + (v_.columns - 1) * v_.dx ||
                      p_.y - radius_ < v_.yMin || p_.y + radius_ > v_.yMin + (v_.rows - 1) * v_.dy;
    const bool outermost = i == 0 || j == 0 || i == v_.columns - 2 || j == v_.rows - 2;
    // Beyond the border the tangent may rise above the cell.
    const double over = (open && outermost) || side_ < 0 ? 0 : p_.z - v_.tops[cell(i, j)];
    const double awayZ = over > 0 ? over : 0;
    return awayX * awayX + awayY * awayY + awayZ * awayZ < radius_ * radius_;
  }

  GROUSER_HD void searchCell(int i, int j, Feet& feet) {
    const int starts = v_.marks[cell(i, j)] & kInHollow ? 2 : 1;
    for (int b = 0; b < starts; ++b)
      for (int a = 0; a < starts; ++a) {
        const double x = v_.xMin + (i + (a + 0.5) / starts) * v_.dx, y = v_.yMin + (j + (b + 0.5) / starts) * v_.dy;
        FootPoint foot;
        if (descend(i, j, x, y, 1.0 / starts, foot)) add(foot, feet);
      }
  }

  /// Search range from `x` along one axis. Bilinear ground: the cell. Smooth ground: twice the searched width, which is
  /// `share` of the cell. Unlimited beyond the border.
  GROUSER_HD Range rangeAbout(double x, int i, int cells, double from, double d, double share) const {
    const Range cell = rangeOf(i, cells, from, d);
    if (v_.interpolation == Interpolation::bilinear) return cell;
    const double low = x - share * d, high = x + share * d;
    return {cell.low == -kFar && low < from ? -kFar : low, cell.high == kFar && high > from + cells * d ? kFar : high};
  }

  GROUSER_HD SurfaceJet jet(int i, int j, double x, double y) const {
    return v_.interpolation == Interpolation::bilinear ? v_.jetInCell(i, j, x, y) : v_.jet(x, y);
  }
  GROUSER_HD double squaredDistance(double x, double y, double z) const {
    return (x - p_.x) * (x - p_.x) + (y - p_.y) * (y - p_.y) + (z - p_.z) * (z - p_.z);
  }
  /// True if a coordinate is at an end of its range and descent would move it beyond that end.
  GROUSER_HD static bool held(double x, double slope, const Range& r) {
    return (x <= r.low && slope > 0) || (x >= r.high && slope < 0);
  }

  /// Newton step of HeightFieldView::closestPoint(), restricted to the free coordinates.
  GROUSER_HD void newtonStep(const SurfaceJet& s, double gx, double gy, bool heldX, bool heldY, double& stepX,
                             double& stepY) const {
    const double e = s.h - p_.z;
    double a = 1 + s.hx * s.hx + e * s.hxx, b = s.hx * s.hy + e * s.hxy, c = 1 + s.hy * s.hy + e * s.hyy;
    if (!(a > 1e-6 && c > 1e-6 && a * c - b * b > 1e-6 * a * c))
      a = 1 + s.hx * s.hx, b = s.hx * s.hy, c = 1 + s.hy * s.hy;
    if (heldX || heldY) b = 0;
    const double det = a * c - b * b;
    stepX = heldX ? 0 : (b * gy - c * gx) / det, stepY = heldY ? 0 : (b * gx - a * gy) / det;
  }

  /// Descends from a point in cell (i, j) to a minimum. Returns false if the cell has no minimum, or it is too far.
  GROUSER_HD bool descend(int i, int j, double x, double y, double share, FootPoint& foot) const {
    constexpr int kIterations = 40;
    const bool bilinear = v_.interpolation == Interpolation::bilinear;
    const double converged = 1e-6 * smaller(v_.dx, v_.dy);
    const Range rangeX = rangeAbout(x, i, v_.columns - 1, v_.xMin, v_.dx, share),
                rangeY = rangeAbout(y, j, v_.rows - 1, v_.yMin, v_.dy, share);
    SurfaceJet s = jet(i, j, x, y);
    double stepX = 0, stepY = 0;
    bool fresh = true, heldX = false, heldY = false, done = false;
    for (int k = 0; k < kIterations && !done; ++k) {
      if (fresh) {
        const double gx = x - p_.x + (s.h - p_.z) * s.hx, gy = y - p_.y + (s.h - p_.z) * s.hy;
        heldX = held(x, gx, rangeX), heldY = held(y, gy, rangeY);
        if ((heldX || heldY) && !bilinear) return false; // minima beyond are found from another cell
        newtonStep(s, gx, gy, heldX, heldY, stepX, stepY);
      }
      done = stepX * stepX + stepY * stepY <= converged * converged;
      const double nextX = clamped(x + stepX, rangeX), nextY = clamped(y + stepY, rangeY);
      const SurfaceJet next = jet(i, j, nextX, nextY);
      fresh = done || squaredDistance(nextX, nextY, next.h) < squaredDistance(x, y, s.h);
      if (fresh)
        x = nextX, y = nextY, s = next;
      else
        stepX *= 0.25, stepY *= 0.25;
    }
    // At the edge of the range a smooth surface has no minimum; a creased surface has one only if no adjacent cell
    // descends from this point.
    const bool atEdge = heldX || heldY;
    if (atEdge && (!bilinear || !isLowestAround(i, j, x, y))) return false;
    return measure(x, y, s, atEdge, foot);
  }

  /// True if no cell adjacent to an edge point of cell (i, j) descends from that point.
  GROUSER_HD bool isLowestAround(int i, int j, double x, double y) const {
    const double u = (x - v_.xMin) / v_.dx - i, w = (y - v_.yMin) / v_.dy - j, slack = 1e-6 * same_;
    const int acrossX = u < 1e-9 ? -1 : u > 1 - 1e-9 ? 1 : 0, acrossY = w < 1e-9 ? -1 : w > 1 - 1e-9 ? 1 : 0;
    for (int b = 0; b < (acrossY ? 2 : 1); ++b)
      for (int a = 0; a < (acrossX ? 2 : 1); ++a) {
        const int ci = i + a * acrossX, cj = j + b * acrossY;
        if ((a == 0 && b == 0) || ci < 0 || cj < 0 || ci > v_.columns - 2 || cj > v_.rows - 2) continue;
        const SurfaceJet s = v_.jetInCell(ci, cj, x, y);
        const double gx = x - p_.x + (s.h - p_.z) * s.hx, gy = y - p_.y + (s.h - p_.z) * s.hy;
        // Slopes into that cell.
        if ((a ? acrossX : -acrossX) * gx < -slack || (b ? acrossY : -acrossY) * gy < -slack) return false;
      }
    return true;
  }

  GROUSER_HD bool measure(double x, double y, const SurfaceJet& s, bool atEdge, FootPoint& foot) const {
    foot.point = {x, y, s.h};
    foot.normal = base::normalized(Vec3d{-s.hx, -s.hy, 1.0});
    const Vec3d gap = p_ - foot.point;
    foot.distance = base::dot(gap, foot.normal);
    if (!(side_ * foot.distance > 0)) return false;
    if (atEdge) {
      foot.distance = side_ * base::norm(gap);
      foot.normal = gap * (1 / foot.distance);
    } else if (base::norm(gap - foot.normal * foot.distance) > same_) {
      return false;
    }
    return side_ * foot.distance < radius_;
  }

  /// Squared distance [m2] at the fraction `share` of the line between two points.
  GROUSER_HD double squaredDistanceAt(const Vec3d& from, const Vec3d& way, double share) const {
    const Vec3d at = from + way * share;
    return squaredDistance(at.x, at.y, v_.height(at.x, at.y));
  }

  /// Samples points along the line, then refines the maximum by ternary search.
  GROUSER_HD double largestBetween(const FootPoint& a, const FootPoint& b) const {
    constexpr int kPlaces = 16, kThirds = 12;
    const Vec3d way = b.point - a.point;
    const double farther = a.distance > b.distance ? a.distance : b.distance;
    double most = farther * farther, at = -1;
    for (int k = 1; k < kPlaces; ++k)
      if (const double here = squaredDistanceAt(a.point, way, 1.0 / kPlaces * k); here > most)
        most = here, at = 1.0 / kPlaces * k;
    if (at < 0) return farther;
    double low = at - 1.0 / kPlaces, high = at + 1.0 / kPlaces;
    for (int k = 0; k < kThirds; ++k) {
      const double third = (high - low) / 3, below = squaredDistanceAt(a.point, way, low + third),
                   above = squaredDistanceAt(a.point, way, high - third);
      most = below > most ? below : most, most = above > most ? above : most;
      (below < above ? low : high) = below < above ? low + third : high - third;
    }
    return sqrt(most);
  }

  /// Keeps the nearer of two coincident feet; below the ground keeps only the nearest foot.
  GROUSER_HD void add(const FootPoint& found, Feet& feet) const {
    for (int k = 0; k < feet.count; ++k)
      if (side_ < 0 || base::norm(found.point - feet.foot[k].point) < same_) {
        if (side_ * (found.distance - feet.foot[k].distance) < -1e-6 * radius_) put(found, k, feet);
        return;
      }
    if (feet.count < Feet::kMax)
      put(found, feet.count++, feet);
    else
      replaceLeast(found, feet);
  }

  GROUSER_HD void put(const FootPoint& found, int place, Feet& feet) const {
    feet.foot[place] = found;
    for (int k = 0; k < feet.count; ++k)
      if (k != place) feet.between[k][place] = feet.between[place][k] = largestBetween(found, feet.foot[k]);
  }

  /// Drops the foot with the lowest rise between it and a nearer foot; this may be the new foot.
  GROUSER_HD void replaceLeast(const FootPoint& found, Feet& feet) const {
    double toFound[Feet::kMax], least = 1e300;
    int dropped = -1; // the new foot
    for (int k = 0; k < feet.count; ++k) {
      toFound[k] = largestBetween(found, feet.foot[k]);
      if (feet.foot[k].distance <= found.distance && toFound[k] - found.distance < least)
        least = toFound[k] - found.distance;
    }
    for (int k = 0; k < feet.count; ++k)
      for (int l = -1; l < feet.count; ++l) {
        const double other = l < 0 ? found.distance : feet.foot[l].distance;
        const double rise = (l < 0 ? toFound[k] : feet.between[k][l]) - feet.foot[k].distance;
        if (k != l && other <= feet.foot[k].distance && rise < least) least = rise, dropped = k;
      }
    if (dropped < 0) return;
    feet.foot[dropped] = found;
    for (int k = 0; k < feet.count; ++k)
      if (k != dropped) feet.between[k][dropped] = feet.between[dropped][k] = toFound[k];
  }

  const HeightFieldView& v_;
  Vec3d p_;
  double radius_, same_;
  double side_{1}; ///< side of the surface that contains the centre
};

/// Finds the nearest surface point to a sphere; returns true if they are in contact.
GROUSER_HD bool deepestFoot(const HeightFieldView& surface, const Vec3d& centre, double radius, FootPoint& foot) {
  if (!surface.marks) {
    foot = surface.closestPoint(centre);
    return foot.distance < radius;
  }
  Feet feet;
  FeetSearch(surface, centre, radius).run(feet);
  if (feet.count == 0) return false;
  foot = feet.nearest();
  return true;
}

/// Bit mask of the contact entries of a floor.
inline constexpr std::uint32_t kFloorBits = (1u << Feet::kMax) - 1;

/// Assigns feet to the contact entries of the floor, so that a contact keeps its springs between steps: pairs with the
/// least difference of normals first, at most 60 degrees. `held`: bit mask of entries with a foot in the last step,
/// with normals `normals` [3 * entry]; null without springs. Returns the bit mask of continuing contacts.
GROUSER_HD std::uint32_t takePlaces(const Feet& feet, std::uint32_t held, const float* normals,
                                    int (&place)[Feet::kMax]) {
  std::uint32_t taken = 0;
  for (int k = 0; k < feet.count; ++k) place[k] = -1;
  for (int round = 0; normals && round < feet.count; ++round) {
    double best = 0.5;
    int foot = -1, at = -1;
    for (int k = 0; k < feet.count; ++k)
      for (int q = 0; q < Feet::kMax; ++q) {
        if (place[k] >= 0 || !(held >> q & 1) || taken >> q & 1) continue;
        const float* n = normals + 3 * q;
        const double along = base::dot(feet.foot[k].normal, Vec3d{double(n[0]), double(n[1]), double(n[2])});
        if (along > best) best = along, foot = k, at = q;
      }
    if (foot < 0) break;
    place[foot] = at, taken |= 1u << at;
  }
  const std::uint32_t goOn = taken;
  for (int k = 0; k < feet.count; ++k) {
    if (place[k] >= 0) continue;
    int free = 0;
    while (taken >> free & 1) ++free;
    place[k] = free, taken |= 1u << free;
  }
  return goOn;
}

/// Feet of a sphere with the entries assigned by takePlaces(). `goOn`: bit mask of entries with a continuing contact.
struct PlacedFeet {
  Feet feet;
  int place[Feet::kMax];
  std::uint32_t goOn;

  GROUSER_HD PlacedFeet(const HeightFieldView& floor, const Vec3d& centre, double radius, std::uint32_t held,
                        const float* normals) {
    FeetSearch(floor, centre, radius).run(feet);
    goOn = takePlaces(feet, held & kFloorBits, normals, place);
  }
};

} // namespace grouser::terrain
