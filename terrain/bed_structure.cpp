// SPDX-License-Identifier: BSD-3-Clause
#include "terrain/bed_structure.hpp"

#include "base/math.hpp"
#include "base/random.hpp"
#include "base/sphere.hpp"
#include "terrain/grains.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace grouser::terrain {

namespace {

using base::Vec3d;

constexpr std::uint64_t kPoints = base::purpose("terrain.bed_structure.points");
constexpr int kPointsInBulk = 200'000, kProfileBins = 40, kPointsABin = 8'000;
constexpr double kOff = 2;         // excluded margin at floor, surface and walls, in mean diameters
constexpr double kFarthest = 3;    // range of the radial distribution, in mean diameters
constexpr int kDistances = 60;     // bins of the radial distribution
constexpr double kNear = 1.4;      // maximum distance of neighbours / sum of their radii
constexpr double kAlike = 0.7;     // two grains are alike if the normalised product of their order vectors exceeds this
constexpr int kAlikeOfCrystal = 7; // minimum number of connected neighbours of a crystalline grain
constexpr double kMaxGrains = 60'000;

/// Bins grains into cells, to find the grains near a point.
class NearGrains {
public:
  NearGrains(const std::vector<LyingGrain>& grains, double edge) : grains_(grains), edge_(edge) {
    low_ = high_ = grains.empty() ? Vec3d{} : grains.front().centre;
    for (const LyingGrain& g : grains)
      for (int a = 0; a < 3; ++a) low_[a] = std::min(low_[a], g.centre[a]), high_[a] = std::max(high_[a], g.centre[a]);
    for (int a = 0; a < 3; ++a) count_[a] = static_cast<int>(std::floor((high_[a] - low_[a]) / edge)) + 1;
    start_.assign(static_cast<std::size_t>(count_.x) * static_cast<std::size_t>(count_.y) *
                          static_cast<std::size_t>(count_.z) +
                      1,
                  0);
    for (const LyingGrain& g : grains) ++start_[indexOf(cellOf(g.centre)) + 1];
    for (std::size_t k = 1; k < start_.size(); ++k) start_[k] += start_[k - 1];
    std::vector<std::size_t> next(start_.begin(), start_.end() - 1);
    sorted_.resize(grains.size());
    for (std::size_t g = 0; g < grains.size(); ++g) sorted_[next[indexOf(cellOf(grains[g].centre))]++] = g;
  }
  /// Calls visit(grain) for every grain with a centre that may be nearer than `reach`, until a call returns false.
  template <class Visit> void visit(const Vec3d& p, double reach, const Visit& visit) const {
    base::Vec3<int> from, to;
    for (int a = 0; a < 3; ++a) {
      from[a] = std::max(0, static_cast<int>(std::floor((p[a] - reach - low_[a]) / edge_)));
      to[a] = std::min(count_[a] - 1, static_cast<int>(std::floor((p[a] + reach - low_[a]) / edge_)));
    }
    for (int z = from.z; z <= to.z; ++z)
      for (int y = from.y; y <= to.y; ++y)
        for (int x = from.x; x <= to.x; ++x) {
          const std::size_t c = indexOf({x, y, z});
          for (std::size_t k = start_[c]; k < start_[c + 1]; ++k)
            if (!visit(sorted_[k])) return;
        }
  }
  bool covers(const Vec3d& p, double largest) const {
    bool covered = false;
    visit(p, largest, [&](std::size_t g) {
      const Vec3d d = grains_[g].centre - p;
      covered = dot(d, d) < grains_[g].radius * grains_[g].radius;
      return !covered;
    });
    return covered;
  }

private:
  base::Vec3<int> cellOf(const Vec3d& p) const {
    base::Vec3<int> c;
    for (int a = 0; a < 3; ++a) c[a] = static_cast<int>(std::floor((p[a] - low_[a]) / edge_));
    return c;
  }
  std::size_t indexOf(const base::Vec3<int>& c) const {
    return (static_cast<std::size_t>(c.z) * static_cast<std::size_t>(count_.y) + static_cast<std::size_t>(c.y)) *
               static_cast<std::size_t>(count_.x) +
           static_cast<std::size_t>(c.x);
  }

  const std::vector<LyingGrain>& grains_;
  double edge_;
  Vec3d low_, high_;
  base::Vec3<int> count_{};
  std::vector<std::size_t> start_, sorted_;
};

/// Legendre polynomial of degree 6.
double legendre6(double x) {
  const double s = x * x;
  return (((231 * s - 315) * s + 105) * s - 5) / 16;
}

/// Part of the bed at least `off` away from all walls, but no less than the middle fifth of each side.
Rectangle inset(const BedExtent& e, double off) {
  const Rectangle& r = e.walls;
  const double x = e.periodic[0] ? 0 : std::min(off, 0.4 * r.width()),
               y = e.periodic[1] ? 0 : std::min(off, 0.4 * r.length());
  return {r.xMin + x, r.xMax - x, r.yMin + y, r.yMax - y};
}

/// Central part of the bed.
struct Core {
  const BedExtent& extent;
  double off; ///< [m] excluded margin at floor and surface
  Rectangle inside;
  bool contains(const Vec3d& p) const {
    return p.x >= inside.xMin && p.x <= inside.xMax && p.y >= inside.yMin && p.y <= inside.yMax &&
           p.z >= extent.floor(p.x, p.y) + off && p.z <= extent.surface(p.x, p.y) - off;
  }
};

/// Appends the images of grains within `reach` of periodic boundaries.
std::vector<LyingGrain> withImages(std::vector<LyingGrain> grains, const BedExtent& e, double reach) {
  for (const int a : {0, 1}) {
    if (!e.periodic[static_cast<std::size_t>(a)]) continue;
    const double low = a == 0 ? e.walls.xMin : e.walls.yMin, high = a == 0 ? e.walls.xMax : e.walls.yMax;
    const std::size_t there = grains.size();
    for (std::size_t g = 0; g < there; ++g)
      for (const double shift : {low - high, high - low}) {
        LyingGrain image = grains[g];
        image.centre[a] += shift;
        if (image.centre[a] > low - reach && image.centre[a] < high + reach) grains.push_back(image);
      }
  }
  return grains;
}

/// Fraction of `points` random points, at heights given by height(x, y, number), that are outside all grains.
template <class Height> double voids(const NearGrains& near, const Rectangle& area, double largest, int points,
                                     std::uint64_t id, const Height& height) {
  int empty = 0;
  for (int k = 0; k < points; ++k) {
    const auto number = [&](std::uint64_t which) {
      return base::uniform(1, kPoints, id, 3 * static_cast<std::uint64_t>(k) + which);
    };
    const double x = area.xMin + number(0) * area.width(), y = area.yMin + number(1) * area.length();
    empty += !near.covers({x, y, height(x, y, number(2))}, largest);
  }
  return static_cast<double>(empty) / points;
}

void measurePorosity(const NearGrains& near, const Core& core, double largest, BedStructure& s) {
  const BedExtent& e = core.extent;
  s.porosity = voids(near, core.inside, largest, kPointsInBulk, 0, [&](double x, double y, double u) {
    const double low = e.floor(x, y) + core.off, high = std::max(low, e.surface(x, y) - core.off);
    return low + u * (high - low);
  });
  s.porosityError = std::sqrt(s.porosity * (1 - s.porosity) / kPointsInBulk);
  for (int k = 0; k < kProfileBins; ++k) {
    const double width = s.thickness / kProfileBins, top = k * width;
    s.depth.push_back(top + 0.5 * width);
    s.porosityAtDepth.push_back(voids(near, core.inside, largest, kPointsABin, 1 + static_cast<std::uint64_t>(k),
                                      [&](double x, double y, double u) { return e.surface(x, y) - top - u * width; }));
  }
}

/// Contacts, radial distribution and order of the grains in the core.
class Pairs {
public:
  /// The first `count` grains belong to the bed, the others are images. `far`: part in which grains have the whole
  /// range of their radial distribution inside the bed.
  Pairs(const std::vector<LyingGrain>& grains, std::size_t count, const NearGrains& near, const Core& core,
        const Core& far, double largest)
      : grains_(grains), near_(near), far_(far), largest_(largest), bonds_(grains.size()), own_(grains.size(), -1) {
    for (std::size_t g = 0; g < count; ++g)
      if (!grains[g].fixed && core.contains(grains[g].centre)) inside_.push_back(g);
  }

  void measure(BedStructure& s) {
    s.grains = static_cast<std::int64_t>(inside_.size());
    if (inside_.empty()) return;
    const double farthest = kFarthest * s.meanDiameter, bin = farthest / kDistances;
    std::vector<double> counted(kDistances, 0);
    double contacts = 0, rattlers = 0, crystal = 0, evenly = 0;
    for (const std::size_t g : inside_) {
      int touching = 0;
      const bool even = far_.contains(grains_[g].centre);
      evenly += even;
      near_.visit(grains_[g].centre, std::max(farthest, 2 * largest_), [&](std::size_t other) {
        if (other == g) return true;
        const double distance = norm(grains_[other].centre - grains_[g].centre);
        touching += distance < grains_[g].radius + grains_[other].radius;
        if (even && distance < farthest && !grains_[other].fixed) ++counted[static_cast<std::size_t>(distance / bin)];
        return true;
      });
      contacts += touching, rattlers += touching < 2;
      crystal += isCrystalline(g);
    }
    const auto n = static_cast<double>(inside_.size());
    s.coordination = contacts / n, s.rattlers = rattlers / n, s.order = crystal / n;
    if (evenly == 0) return;
    const double density = (1 - s.porosity) / meanVolume();
    for (int k = 0; k < kDistances; ++k) {
      const double from = k * bin, to = from + bin;
      s.distance.push_back((from + 0.5 * bin) / s.meanDiameter);
      s.radialDistribution.push_back(counted[static_cast<std::size_t>(k)] / evenly /
                                     (density * (base::sphereVolume(to) - base::sphereVolume(from))));
    }
  }

private:
  double meanVolume() const {
    double sum = 0;
    for (const std::size_t g : inside_) sum += base::sphereVolume(grains_[g].radius);
    return sum / static_cast<double>(inside_.size());
  }
  /// Directions to the neighbours of a grain, computed once.
  struct Bonds {
    std::vector<std::size_t> to;
    std::vector<Vec3d> direction;
  };
  const Bonds& bondsOf(std::size_t g) {
    Bonds& b = bonds_[g];
    if (own_[g] >= 0) return b;
    near_.visit(grains_[g].centre, kNear * (grains_[g].radius + largest_), [&](std::size_t other) {
      const Vec3d d = grains_[other].centre - grains_[g].centre;
      const double distance = norm(d);
      if (other != g && distance < kNear * (grains_[g].radius + grains_[other].radius))
        b.to.push_back(other), b.direction.push_back(d * (1 / distance));
      return true;
    });
    own_[g] = product(b, b);
    return b;
  }
  /// Scalar product q6 . q6 of two grains, by the addition theorem of spherical harmonics.
  static double product(const Bonds& a, const Bonds& b) {
    double sum = 0;
    for (const Vec3d& u : a.direction)
      for (const Vec3d& v : b.direction) sum += legendre6(dot(u, v));
    return a.direction.empty() || b.direction.empty()
               ? 0
               : sum / (static_cast<double>(a.direction.size()) * static_cast<double>(b.direction.size()));
  }
  bool isCrystalline(std::size_t g) {
    const Bonds& own = bondsOf(g);
    int alike = 0;
    for (const std::size_t other : own.to) {
      const Bonds& theirs = bondsOf(other);
      alike += product(own, theirs) > kAlike * std::sqrt(own_[g] * own_[other]);
    }
    return alike >= kAlikeOfCrystal;
  }

  const std::vector<LyingGrain>& grains_;
  const NearGrains& near_;
  const Core& far_;
  double largest_;
  std::vector<Bonds> bonds_;
  std::vector<double> own_; ///< squared norm of the order vector; negative: not computed yet
  std::vector<std::size_t> inside_;
};

void take(const BedHeights& heights, BedStructure& s) {
  s.settledHeight = heights.mean, s.highest = heights.highest, s.lowest = heights.lowest;
  s.thickness = heights.thickness;
}

} // namespace

BedHeights heightsOf(const BedExtent& e) {
  constexpr int kNodes = 64;
  BedHeights h{0, -1e300, 1e300, 0};
  for (int j = 0; j < kNodes; ++j)
    for (int i = 0; i < kNodes; ++i) {
      const double x = e.walls.xMin + (i + 0.5) / kNodes * e.walls.width(),
                   y = e.walls.yMin + (j + 0.5) / kNodes * e.walls.length(), z = e.surface(x, y);
      h.mean += z / (kNodes * kNodes), h.thickness += (z - e.floor(x, y)) / (kNodes * kNodes);
      h.highest = std::max(h.highest, z), h.lowest = std::min(h.lowest, z);
    }
  return h;
}

BedStructure measureBed(const std::vector<LyingGrain>& grains, const BedExtent& extent) {
  BedStructure s;
  take(heightsOf(extent), s);
  double largest = 0, loose = 0;
  for (const LyingGrain& g : grains) {
    largest = std::max(largest, g.radius);
    if (!g.fixed) s.meanDiameter += 2 * g.radius, ++loose;
  }
  if (loose == 0) return s;
  s.meanDiameter /= loose;
  const double off = kOff * s.meanDiameter;
  const Core core{extent, std::min(off, 0.3 * s.thickness), inset(extent, off)};
  const double reach = kFarthest * s.meanDiameter;
  const Core far{extent, reach, inset(extent, reach)};
  const std::vector<LyingGrain> all = withImages(grains, extent, reach + 2 * largest);
  const NearGrains near(all, 2 * largest);
  measurePorosity(near, core, largest, s);
  Pairs(all, grains.size(), near, core, far, largest).measure(s);
  return s;
}

BedStructure measureBed(const Grains& grains, const BedExtent& extent) {
  // Restricts the measurement to a column through the middle.
  const double share =
      std::min(1.0, std::sqrt(kMaxGrains / static_cast<double>(std::max<std::size_t>(1, grains.count()))));
  BedExtent part = extent;
  if (share < 1) part.periodic = {};
  const double x = 0.5 * (1 - share) * extent.walls.width(), y = 0.5 * (1 - share) * extent.walls.length();
  part.walls = {extent.walls.xMin + x, extent.walls.xMax - x, extent.walls.yMin + y, extent.walls.yMax - y};
  const GrainSnapshot own = grains.snapshot();
  std::vector<LyingGrain> mine;
  for (std::size_t g = 0; g < own.position.size(); ++g) {
    const Vec3d& p = own.position[g];
    if (p.x < part.walls.xMin || p.x > part.walls.xMax || p.y < part.walls.yMin || p.y > part.walls.yMax) continue;
    const double radius = own.radius.empty() ? grains.model().radius : static_cast<double>(own.radius[g]);
    mine.push_back({p, radius, !own.fixed.empty() && own.fixed[g] != 0});
  }
  std::vector<LyingGrain> all;
  for (const std::vector<LyingGrain>& some : grains.system().comm.gatherAll(mine))
    all.insert(all.end(), some.begin(), some.end());
  BedStructure s = measureBed(all, part);
  take(heightsOf(extent), s); // heights of the whole bed
  return s;
}

} // namespace grouser::terrain
