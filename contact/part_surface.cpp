// SPDX-License-Identifier: BSD-3-Clause
#include "contact/part_surface.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace grouser::contact {

using base::Vec3d;
using base::Vec3f;

namespace {

constexpr float kSamePlane = 0.98f; // cosine between the normals of discs that count as coplanar
constexpr double kMaxCells = 6e5;

/// Disc of one cell, with the data for pruning.
struct Candidate {
  std::uint32_t disc;
  DiscDistance at;
  double clear; ///< distance of the surface from the cell's centre [m]
};

/// Selects the candidates of one cell, omitting those that are farther than another disc of the same plane everywhere
/// within `reach` of its centre.
///
/// Over the cell the difference of two distances changes by at most reach * |difference of their gradients|; the
/// gradients are the unit directions, which turn by at most reach / distance each.
class Pruning {
public:
  Pruning(const std::vector<Disc>& discs, double reach) : discs_(discs), reach_(reach) {}

  /// Appends the discs of the selected candidates to `kept`.
  void run(const std::vector<Candidate>& candidates, std::vector<std::uint32_t>& kept) {
    best_.clear();
    for (const Candidate& c : candidates) {
      const Vec3f& normal = discs_[c.disc].normal;
      const auto same =
          std::find_if(best_.begin(), best_.end(), [&](const Best& b) { return dot(b.normal, normal) >= kSamePlane; });
      if (same == best_.end())
        best_.push_back({normal, c});
      else if (c.clear < same->at.clear)
        *same = {normal, c};
    }
    for (const Candidate& c : candidates)
      if (!beaten(c)) kept.push_back(c.disc);
  }

private:
  struct Best {
    Vec3f normal;
    Candidate at;
  };

  bool beaten(const Candidate& c) const {
    const Vec3f& normal = discs_[c.disc].normal;
    return std::any_of(best_.begin(), best_.end(), [&](const Best& b) {
      const double behind = c.clear - b.at.clear;
      if (behind <= 0 || dot(b.normal, normal) < kSamePlane) return false;
      const double room = std::min(b.at.at.distance, c.at.distance) - reach_;
      if (room <= 0) return false;
      const double approach = 2 * reach_ / room;
      if (behind <= reach_ * approach) return false; // for all directions
      return behind > reach_ * (norm((c.at.normal - b.at.at.normal).as<double>()) + approach);
    });
  }

  const std::vector<Disc>& discs_;
  double reach_;
  std::vector<Best> best_; ///< nearest disc of each plane
};

/// Finds the discs that may touch a ball centred in each cell of a table, one x layer at a time.
class GridSlab {
public:
  GridSlab(const std::vector<Disc>& discs, const Vec3d& low, double edge, double ballRadius, const base::Vec3i& cells)
      : discs_(discs), low_(low), edge_(edge), ballRadius_(ballRadius), cells_(cells),
        reach_(0.5 * std::sqrt(3.0) * edge * (1 + 1e-9)), pruning_(discs, reach_),
        row_(static_cast<std::size_t>(cells.y)), near_(static_cast<std::size_t>(cells.z)) {}

  /// Disc indices, ascending within a cell, cells ordered by y, then z; number per cell at `count`.
  std::vector<std::uint32_t> of(int x, std::uint32_t* count) {
    for (auto& row : row_) row.clear();
    for (std::uint32_t k = 0; k < discs_.size(); ++k) {
      const auto [from, to] = cellsOf(discs_[k]);
      if (x < from.x || x > to.x) continue;
      for (int y = from.y; y <= to.y; ++y) row_[static_cast<std::size_t>(y)].push_back({k, from.z, to.z});
    }
    std::vector<std::uint32_t> entry;
    for (int y = 0; y < cells_.y; ++y) {
      gather(x, y);
      for (const auto& candidates : near_) {
        const std::size_t before = entry.size();
        pruning_.run(candidates, entry);
        *count++ = static_cast<std::uint32_t>(entry.size() - before);
      }
    }
    return entry;
  }

private:
  /// Disc with the range of cells along z that it may reach.
  struct Reaching {
    std::uint32_t disc;
    int from, to;
  };

  static int clamped(double v, int n) { return std::clamp(static_cast<int>(std::floor(v)), 0, n - 1); }
  std::pair<base::Vec3i, base::Vec3i> cellsOf(const Disc& d) const {
    const double r = ballRadius_ + d.radius + d.flat, perEdge = 1 / edge_;
    const Vec3d from = (d.centre.as<double>() - Vec3d{r, r, r} - low_) * perEdge;
    const Vec3d to = (d.centre.as<double>() + Vec3d{r, r, r} - low_) * perEdge;
    return {{clamped(from.x, cells_.x), clamped(from.y, cells_.y), clamped(from.z, cells_.z)},
            {clamped(to.x, cells_.x), clamped(to.y, cells_.y), clamped(to.z, cells_.z)}};
  }

  /// Candidates of the cells of one x and y.
  void gather(int x, int y) {
    for (auto& candidates : near_) candidates.clear();
    for (const Reaching& r : row_[static_cast<std::size_t>(y)]) {
      const Disc& d = discs_[r.disc];
      // Most cells in the box about a disc are out of its reach; this test, with a margin, needs no square root.
      const double most = ballRadius_ + d.radius + d.flat + reach_ + 1e-6, most2 = most * most;
      for (int z = r.from; z <= r.to; ++z) {
        const Vec3d centre = low_ + Vec3d{x + 0.5, y + 0.5, z + 0.5} * edge_;
        if (norm2(centre - d.centre.as<double>()) > most2) continue;
        const DiscDistance at = distanceTo(d, centre);
        if (at.distance - d.radius - reach_ <= ballRadius_)
          near_[static_cast<std::size_t>(z)].push_back({r.disc, at, static_cast<double>(at.distance) - d.radius});
      }
    }
  }

  const std::vector<Disc>& discs_;
  Vec3d low_;
  double edge_, ballRadius_; ///< [m]
  base::Vec3i cells_;
  double reach_; ///< distance from a cell's centre to its corners [m]
  Pruning pruning_;
  std::vector<std::vector<Reaching>> row_;   ///< one per y
  std::vector<std::vector<Candidate>> near_; ///< one per z
};

} // namespace

std::vector<Disc> discsOf(const base::SphereSet& set) {
  std::vector<Disc> discs;
  discs.reserve(set.surfaceCount);
  for (std::size_t i = 0; i < set.surfaceCount; ++i) {
    const base::SetSphere& s = set.spheres[i];
    discs.push_back(
        {s.centre.as<float>(), static_cast<float>(s.radius), s.normal.as<float>(), static_cast<float>(s.flat)});
  }
  return discs;
}

std::uint32_t mainDirection(const Vec3d& normal) {
  int axis = 0;
  for (int a = 1; a < 3; ++a)
    if (std::fabs(normal[a]) > std::fabs(normal[axis])) axis = a;
  return static_cast<std::uint32_t>(2 * axis + (normal[axis] > 0 ? 1 : 0));
}

std::vector<SurfaceSample> surfaceSamplesOf(const base::SphereSet& set) {
  std::vector<SurfaceSample> samples;
  samples.reserve(set.surfaceCount);
  for (std::size_t i = 0; i < set.surfaceCount; ++i) {
    const base::SetSphere& s = set.spheres[i];
    samples.push_back(
        {s.centre.as<float>(), static_cast<float>(s.radius), static_cast<float>(s.area), mainDirection(s.normal)});
  }
  return samples;
}

double enclosingRadius(const base::SphereSet& set) {
  double most = 0;
  for (const base::SetSphere& s : set.spheres) most = std::max(most, norm(s.centre) + s.radius + s.flat);
  return most;
}

SurfaceGrid::SurfaceGrid(const base::Exec& exec, const base::SphereSet& set, double ballRadius, double cellEdge) {
  const std::vector<Disc> discs = discsOf(set);
  Vec3d low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
  double widest = 0;
  for (const Disc& d : discs) {
    low = base::min(low, d.centre.as<double>()), high = base::max(high, d.centre.as<double>());
    widest = std::max(widest, static_cast<double>(d.radius + d.flat));
  }
  const double margin = ballRadius + widest;
  low -= {margin, margin, margin}, high += {margin, margin, margin};
  const Vec3d extent = high - low;
  double edge = cellEdge;
  while (std::ceil(extent.x / edge) * std::ceil(extent.y / edge) * std::ceil(extent.z / edge) > kMaxCells) edge *= 1.1;
  low_ = low, perEdge_ = 1 / edge;
  cells_ = {static_cast<int>(std::ceil(extent.x / edge)), static_cast<int>(std::ceil(extent.y / edge)),
            static_cast<int>(std::ceil(extent.z / edge))};
  const std::size_t perSlab = static_cast<std::size_t>(cells_.y) * static_cast<std::size_t>(cells_.z);
  std::vector<std::uint32_t> start(static_cast<std::size_t>(cells_.x) * perSlab + 1);
  std::vector<std::vector<std::uint32_t>> slabs(static_cast<std::size_t>(cells_.x));
#pragma omp parallel
  {
    GridSlab slab(discs, low, edge, ballRadius, cells_);
#pragma omp for schedule(dynamic, 1)
    for (int x = 0; x < cells_.x; ++x)
      slabs[static_cast<std::size_t>(x)] = slab.of(x, &start[static_cast<std::size_t>(x) * perSlab + 1]);
  }
  std::partial_sum(start.begin(), start.end(), start.begin());
  disc_ = base::Array<Disc>(exec, discs);
  start_ = base::Array<std::uint32_t>(exec, start);
  entry_ = base::Array<std::uint32_t>::unset(exec, start.back());
  std::uint32_t* to = entry_.data();
  for (const std::vector<std::uint32_t>& slab : slabs) {
    base::copyToDevice(exec, to, slab.data(), slab.size() * sizeof(std::uint32_t));
    to += slab.size();
  }
}

SurfaceGridView SurfaceGrid::view() const {
  return {disc_.data(), start_.data(), entry_.data(), low_, perEdge_, cells_};
}

} // namespace grouser::contact
