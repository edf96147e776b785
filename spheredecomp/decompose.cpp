// SPDX-License-Identifier: BSD-3-Clause
#include "spheredecomp/decompose.hpp"

#include "base/bits.hpp"
#include "base/error.hpp"
#include "base/hash.hpp"
#include "base/math.hpp"
#include "spheredecomp/detail/fit.hpp"
#include "spheredecomp/detail/point_grid.hpp"
#include "spheredecomp/detail/rounded_disc.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace grouser::spheredecomp {
namespace {

using base::SetSphere;
using base::Vec3d;
using detail::OuterSurface;
using detail::PointGrid;
using detail::SurfaceSample;

/// Maximum radius of a disc: slightly more than half the diagonal of a lattice square [spacing].
constexpr double kFlatReach = 0.74;
/// Distance below which lattice spheres are merged after they have moved to the surface [spacing].
constexpr double kMerge = 0.5;
/// Distance between surface samples [spacing].
constexpr double kSampleStep = 0.33;
/// Sample distance for thin parts, in which a gap between discs is a hole [spacing].
constexpr double kThinSampleStep = 0.2;

/// Number of samples per block; the spheres of a block are fitted in parallel.
constexpr std::size_t kBlock = 2048;
/// Block size for thin parts, which require expensive fits.
constexpr std::size_t kThinBlock = 128;

/// Runs body(i) for i in [0, count) on all threads; each i writes only entry i, so the order has no effect.
template <class Body> void parallel(std::size_t count, Body&& body) {
#pragma omp parallel for schedule(dynamic, 32)
  for (std::int64_t i = 0; i < static_cast<std::int64_t>(count); ++i) body(static_cast<std::size_t>(i));
}

/// Cubic lattice centred on the mesh's bounding box, with its outer planes at depths of `radius` to `radius +
/// spacing/2`.
struct Lattice {
  Vec3d first;
  double spacing;
  std::array<std::int64_t, 3> count;

  Lattice(const TriangleMesh& mesh, double radius, double step) : spacing(step) {
    const auto [low, high] = bounds(mesh);
    for (int k = 0; k < 3; ++k) {
      const double extent = high[k] - low[k], room = extent - 2 * radius;
      // 1e-9 of the spacing absorbs the rounding of extents that are whole multiples.
      const double intervals = room > 0 ? std::floor(room / step + 1e-9) : 0;
      first[k] = low[k] + 0.5 * (extent - intervals * step);
      count[static_cast<std::size_t>(k)] = static_cast<std::int64_t>(intervals) + 1;
    }
  }
  double points() const {
    return static_cast<double>(count[0]) * static_cast<double>(count[1]) * static_cast<double>(count[2]);
  }
};

/// Inner lattice point, with the nearest surface point if this point is near.
struct LatticePoint {
  Vec3d point;
  ClosestPoint near;
};

std::vector<LatticePoint> pointsInside(const OuterSurface& outer, const Lattice& lattice, double shell) {
  const std::size_t columns = static_cast<std::size_t>(lattice.count[0] * lattice.count[1]);
  std::vector<std::vector<LatticePoint>> found(columns);
  parallel(columns, [&](std::size_t column) {
    const auto i = static_cast<std::int64_t>(column) / lattice.count[1],
               j = static_cast<std::int64_t>(column) % lattice.count[1];
    Vec3d p = lattice.first + Vec3d{static_cast<double>(i), static_cast<double>(j), 0} * lattice.spacing;
    std::vector<Crossing> crossings;
    outer.solid().column(p.x, p.y, crossings);
    for (std::int64_t k = 0; k < lattice.count[2]; ++k) {
      p.z = lattice.first.z + static_cast<double>(k) * lattice.spacing;
      int winding = 0;
      for (const Crossing& c : crossings) winding += c.z > p.z ? c.step : 0;
      if (winding != 0) found[column].push_back({p, outer.surface().closest(p, shell)});
    }
  });
  std::vector<LatticePoint> points;
  for (const auto& column : found) points.insert(points.end(), column.begin(), column.end());
  return points;
}

/// Builds the surface spheres of a set, and tests the coverage of the surface.
class SurfaceBuilder {
public:
  SurfaceBuilder(const OuterSurface& outer, double radius, double spacing, const DecompositionOptions& options)
      : outer_(outer), radius_(radius), spacing_(spacing), options_(options), centres_(spacing) {}

  /// Adds one sphere per lattice point of the shell, unless it coincides with an existing sphere.
  void addLattice(const std::vector<LatticePoint>& points) {
    std::vector<SetSphere> fitted(points.size());
    parallel(points.size(), [&](std::size_t i) {
      if (points[i].near.triangle != kNone)
        fitted[i] =
            detail::fitSphere(outer_, points[i].near.point, outer_.normal(points[i].near.triangle), radius_, fit());
    });
    for (const SetSphere& s : fitted)
      if (s.radius > 0 && !centreWithin(s.centre, kMerge * spacing_)) add(s);
    parallel(spheres_.size(), [&](std::size_t i) { setFlat(spheres_[i]); });
  }

  /// Adds spheres under samples with a dip above the limit, in blocks of fixed size: the spheres of a block are fitted
  /// in parallel, then added in order, so that the next block needs fewer fits.
  void closeHoles(const std::vector<SurfaceSample>& samples) {
    std::vector<SetSphere> fitted;
    const std::size_t block = options_.thin ? kThinBlock : kBlock;
    for (std::size_t begin = 0; begin < samples.size(); begin += block) {
      const std::size_t count = std::min(block, samples.size() - begin);
      fitted.assign(count, SetSphere{});
      parallel(count, [&](std::size_t i) {
        const SurfaceSample& sample = samples[begin + i];
        if (!coveredBeneath(sample) && !covered(sample.point))
          fitted[i] = detail::fitSphere(outer_, sample.point, sample.normal, radius_, fit());
      });
      if (beyondLimit()) return;
      for (SetSphere& s : fitted) {
        // Near an edge the sphere cannot reach the sample: test the highest point of the sphere.
        if (s.radius == 0 || covered(s.centre + s.normal * s.radius)) continue;
        setFlat(s);
        add(s);
      }
    }
  }

  /// Assigns the area of each sample to the sphere with the nearest surface, preferably of similar normal.
  void shareArea(const std::vector<SurfaceSample>& samples) {
    std::vector<std::uint32_t> owner(samples.size());
    parallel(samples.size(), [&](std::size_t i) { owner[i] = ownerOf(samples[i]); });
    for (std::size_t i = 0; i < samples.size(); ++i) spheres_[owner[i]].area += samples[i].area;
  }

  std::vector<SetSphere>& spheres() { return spheres_; }
  bool beyondLimit() const { return options_.most > 0 && spheres_.size() > options_.most; }

private:
  void add(const SetSphere& s) {
    centres_.add(s.centre, static_cast<std::uint32_t>(spheres_.size()));
    spheres_.push_back(s);
  }
  void setFlat(SetSphere& s) const {
    s.flat = detail::flatRadius(outer_, s, kFlatReach * spacing_, options_.flatTolerance, options_.thin);
  }
  detail::Fit fit() const { return {options_.smallest, options_.thin}; }
  bool centreWithin(const Vec3d& p, double distance) const {
    return centres_.any(p, distance,
                        [&](std::uint32_t i) { return norm2(spheres_[i].centre - p) < distance * distance; });
  }
  /// Tests only spheres near the sample's own sphere, which is sufficient in most cases at a fraction of the cost.
  bool coveredBeneath(const SurfaceSample& sample) const {
    return centres_.any(sample.point - sample.normal * radius_, 0.5 * spacing_, [&](std::uint32_t i) {
      return detail::discDistance(spheres_[i], sample.point) <= options_.maxDip * radius_;
    });
  }
  bool covered(const Vec3d& p) const {
    const double dip = options_.maxDip * radius_;
    return centres_.any(p, radius_ + dip + kFlatReach * spacing_,
                        [&](std::uint32_t i) { return detail::discDistance(spheres_[i], p) <= dip; });
  }
  std::uint32_t ownerOf(const SurfaceSample& sample) const {
    std::uint32_t best = 0;
    double bestScore = 1e300;
    auto consider = [&](std::uint32_t i) {
      const SetSphere& s = spheres_[i];
      // Penalty for different normals, larger than any distance in the part.
      const double unlike = dot(s.normal, sample.normal) < 0.5 ? 1e6 : 0;
      const double score = norm2(s.centre + s.normal * s.radius - sample.point) + unlike;
      if (score < bestScore || (score == bestScore && i < best)) bestScore = score, best = i;
    };
    // The search radius grows until a sphere of similar normal is found.
    const Vec3d beneath = sample.point - sample.normal * radius_;
    for (const double reach : {0.75 * spacing_, 2 * spacing_, 2 * (radius_ + spacing_)}) {
      centres_.each(beneath, reach, consider);
      if (bestScore < 1e6) return best;
    }
    if (bestScore == 1e300)
      for (std::uint32_t i = 0; i < spheres_.size(); ++i) consider(i);
    return best;
  }

  const OuterSurface& outer_;
  double radius_, spacing_;
  const DecompositionOptions& options_;
  PointGrid centres_;
  std::vector<SetSphere> spheres_;
};

SphereSet decomposeAt(const TriangleMesh& mesh, const std::string& name, const DecompositionOptions& options,
                      double radius) {
  const double spacing = radius * options.spacingRatio;
  const Lattice lattice(mesh, radius, spacing);
  if (!(lattice.points() <= kMaxLatticePoints))
    throw base::InputError(
        fmt::format("{}: radius = {:.3g} m requires {:.3g} lattice points, more than {:.0e}; use a larger radius", name,
                    radius, lattice.points(), kMaxLatticePoints));
  const OuterSurface outer(mesh, spacing / 6);
  const double shell = radius + 0.5 * spacing;
  const std::vector<LatticePoint> inside = pointsInside(outer, lattice, shell);
  const std::vector<SurfaceSample> samples = outer.samples((options.thin ? kThinSampleStep : kSampleStep) * spacing);

  SurfaceBuilder builder(outer, radius, spacing, options);
  builder.addLattice(inside);
  builder.closeHoles(samples);
  if (!builder.beyondLimit()) builder.shareArea(samples);

  SphereSet set;
  set.name = name;
  set.spheres = std::move(builder.spheres());
  set.surfaceCount = set.spheres.size();
  if (options.interior)
    for (const LatticePoint& p : inside)
      if (p.near.triangle == kNone) {
        SetSphere s;
        s.centre = p.point;
        s.radius = radius;
        set.spheres.push_back(s);
      }
  set.spacing = spacing;
  set.radius = radius;
  set.meshVolume = outer.volume();
  set.meshArea = outer.area();
  return set;
}

/// Finds the largest radius with at least the target count: first from count ~ radius^-2.5, then by bisection of
/// log(radius). The count is not monotonic in the radius, so the result is within a few per cent.
SphereSet decomposeToCount(const TriangleMesh& mesh, const std::string& name, const DecompositionOptions& options) {
  constexpr int kTrials = 12;
  constexpr double kEnough = 1.02;
  const auto wanted = static_cast<double>(options.targetCount);
  double radius = base::pow(signedVolume(mesh) / wanted, 1.0 / 3) / options.spacingRatio;
  double fine = 0, coarse = 0; // radii with enough spheres, and with too few
  SphereSet best;
  for (int trial = 0; trial < kTrials; ++trial) {
    SphereSet set = decomposeAt(mesh, name, options, radius);
    const auto count = static_cast<double>(set.spheres.size());
    if (count >= wanted) {
      fine = radius;
      if (best.spheres.empty() || set.spheres.size() < best.spheres.size()) best = std::move(set);
      if (count <= kEnough * wanted) break;
    } else {
      coarse = radius;
    }
    radius = fine > 0 && coarse > 0 ? std::sqrt(fine * coarse) : radius * base::pow(count / wanted, 0.4);
  }
  if (best.spheres.empty())
    throw base::InputError(
        fmt::format("{}: targetCount = {} cannot be reached; set a radius instead", name, options.targetCount));
  return best;
}

void check(const std::string& name, const DecompositionOptions& o) {
  auto range = [&](const char* key, double value, double low, double high, const char* unit) {
    if (!(value >= low && value <= high))
      throw base::InputError(fmt::format("{}: {} = {} {} is outside [{}, {}]", name, key, value, unit, low, high));
  };
  range("spacingRatio", o.spacingRatio, 0.2, 1.5, "[-]");
  range("maxDip", o.maxDip, 0.001, 0.5, "[radius]");
  range("flatTolerance", o.flatTolerance, 0.001, 0.2, "[radius]");
  range("smallest", o.smallest, 1e-6, 1, "[radius]");
  if (o.radius == 0 && o.targetCount == 0) throw base::InputError(name + ": set radius [m] or targetCount");
  if (o.radius != 0) range("radius", o.radius, kSmallestRadius, kLargestRadius, "m");
}

/// Rejects spheres wider than the longest side of the part.
void checkFits(const TriangleMesh& mesh, const std::string& name, double radius) {
  const auto [low, high] = bounds(mesh);
  const double half = 0.5 * std::max({high.x - low.x, high.y - low.y, high.z - low.z});
  // A relative 1e-6 absorbs the rounding of coordinates read as floats.
  if (radius > half * (1 + 1e-6))
    throw base::InputError(fmt::format("{}: radius = {:.6g} m is above {:.6g} m, half the part's longest side; use a "
                                       "smaller radius (and check that the mesh is in metres)",
                                       name, radius, half));
}

} // namespace

std::string cutOrigin(const TriangleMesh& mesh, const DecompositionOptions& options) {
  // Omit the sphere limit: sets within the limit do not depend on it, and larger sets are not stored.
  [[maybe_unused]] const auto& [radius, targetCount, spacingRatio, maxDip, flatTolerance, smallest, thin, most,
                                interior] = options;
  base::StateHash hash;
  for (const Vec3d& v : mesh.vertices)
    for (int k = 0; k < 3; ++k) hash.add(base::bitsAs<std::uint64_t>(v[k]));
  hash.add(mesh.indices);
  return fmt::format("sphere set, version {}\nradius {}\ntargetCount {}\nspacingRatio {}\nmaxDip {}\nflatTolerance {}\n"
                     "smallest {}\nthin {}\ninterior {}\nmesh of {} vertices, {} triangles, hash {}\n",
                     kCutVersion, radius, targetCount, spacingRatio, maxDip, flatTolerance, smallest, thin, interior,
                     mesh.vertices.size(), mesh.indices.size() / 3, hash.hex());
}

double latticePoints(const TriangleMesh& mesh, double radius) {
  const auto [low, high] = bounds(mesh);
  double points = 1; // as in Lattice, but not limited to integers
  for (int k = 0; k < 3; ++k)
    points *= 1 + std::max(0.0, high[k] - low[k] - 2 * radius) / (radius * DecompositionOptions{}.spacingRatio);
  return points;
}

SphereSet decompose(const TriangleMesh& mesh, const std::string& name, const DecompositionOptions& options) {
  check(name, options);
  checkClosed(mesh, name);
  if (options.radius > 0) checkFits(mesh, name, options.radius);
  return options.radius > 0 ? decomposeAt(mesh, name, options, options.radius) : decomposeToCount(mesh, name, options);
}

} // namespace grouser::spheredecomp
