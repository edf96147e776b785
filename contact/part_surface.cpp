// SPDX-License-Identifier: BSD-3-Clause
#include "contact/part_surface.hpp"

#include <algorithm>
#include <cmath>

namespace grouser::contact {

using base::Vec3d;
using base::Vec3f;

namespace {

constexpr float kSamePlane = 0.98f; // cosine between the normals of discs that count as one plane
constexpr double kMostCells = 6e5;

/// Discs of one cell, with what pruning needs.
struct Candidate {
  std::uint32_t disc;
  DiscDistance at;
  double clear; ///< distance of the surface from the cell's centre [m]
};

/// Drops candidates that a disc of the same plane beats everywhere within `reach` of the cell's centre.
///
/// Over the cell the difference of two distances changes by at most reach * |difference of their gradients|; the
/// gradients are the unit directions, which turn by at most reach / distance each.
void prune(std::vector<Candidate>& candidates, const std::vector<Disc>& discs, double reach,
           std::vector<std::uint32_t>& best) {
  best.clear();
  for (std::uint32_t c = 0; c < candidates.size(); ++c) {
    const Vec3f& normal = discs[candidates[c].disc].normal;
    bool placed = false;
    for (std::uint32_t& b : best) {
      if (dot(discs[candidates[b].disc].normal, normal) < kSamePlane) continue;
      placed = true;
      if (candidates[c].clear < candidates[b].clear) b = c;
      break;
    }
    if (!placed) best.push_back(c);
  }
  const auto beaten = [&](const Candidate& c) {
    for (const std::uint32_t b : best) {
      const Candidate& near = candidates[b];
      if (near.disc == c.disc || dot(discs[near.disc].normal, discs[c.disc].normal) < kSamePlane) continue;
      const double room = std::min(near.at.distance, c.at.distance) - reach;
      if (room <= 0) continue;
      const double turn = norm((c.at.normal - near.at.normal).as<double>()) + 2 * reach / room;
      if (c.clear - near.clear > reach * turn) return true;
    }
    return false;
  };
  std::vector<Candidate> kept;
  for (const Candidate& c : candidates)
    if (!beaten(c)) kept.push_back(c);
  candidates.swap(kept);
}

/// Which discs may touch a ball centred in which cell of a table.
struct GridCells {
  const std::vector<Disc>& discs;
  Vec3d low;
  double edge, ballRadius; ///< [m]
  base::Vec3i cells;

  /// Disc indices, ascending within a cell; cells by x, then y, then z.
  std::vector<std::vector<std::uint32_t>> all() const {
    std::vector<std::vector<std::uint32_t>> near(static_cast<std::size_t>(cells.x) * cells.y * cells.z);
#pragma omp parallel for schedule(dynamic, 1)
    for (int x = 0; x < cells.x; ++x) {
      gather(x, near);
      pruneAll(x, near);
    }
    return near;
  }

private:
  double reach() const { return 0.5 * std::sqrt(3.0) * edge * (1 + 1e-9); }
  Vec3d centreOf(int x, int y, int z) const { return low + Vec3d{x + 0.5, y + 0.5, z + 0.5} * edge; }
  std::size_t indexOf(int x, int y, int z) const { return (static_cast<std::size_t>(x) * cells.y + y) * cells.z + z; }
  static int clamped(double v, int n) { return std::clamp(static_cast<int>(std::floor(v)), 0, n - 1); }

  /// Into the cells of one x.
  void gather(int x, std::vector<std::vector<std::uint32_t>>& near) const {
    const double perEdge = 1 / edge;
    for (std::uint32_t k = 0; k < discs.size(); ++k) {
      const Disc& d = discs[k];
      const double r = ballRadius + d.radius + d.flat;
      const Vec3d from = (d.centre.as<double>() - Vec3d{r, r, r} - low) * perEdge;
      const Vec3d to = (d.centre.as<double>() + Vec3d{r, r, r} - low) * perEdge;
      if (x < clamped(from.x, cells.x) || x > clamped(to.x, cells.x)) continue;
      for (int y = clamped(from.y, cells.y); y <= clamped(to.y, cells.y); ++y)
        for (int z = clamped(from.z, cells.z); z <= clamped(to.z, cells.z); ++z)
          if (distanceTo(d, centreOf(x, y, z)).distance - d.radius - reach() <= ballRadius)
            near[indexOf(x, y, z)].push_back(k);
    }
  }

  void pruneAll(int x, std::vector<std::vector<std::uint32_t>>& near) const {
    std::vector<std::uint32_t> best;
    std::vector<Candidate> candidates;
    for (int y = 0; y < cells.y; ++y)
      for (int z = 0; z < cells.z; ++z) {
        std::vector<std::uint32_t>& here = near[indexOf(x, y, z)];
        candidates.clear();
        for (const std::uint32_t k : here) {
          const DiscDistance at = distanceTo(discs[k], centreOf(x, y, z));
          candidates.push_back({k, at, static_cast<double>(at.distance) - discs[k].radius});
        }
        prune(candidates, discs, reach(), best);
        here.clear();
        for (const Candidate& c : candidates) here.push_back(c.disc);
      }
  }
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

std::vector<SurfaceSample> surfaceSamplesOf(const base::SphereSet& set) {
  std::vector<SurfaceSample> samples;
  samples.reserve(set.surfaceCount);
  for (std::size_t i = 0; i < set.surfaceCount; ++i) {
    const base::SetSphere& s = set.spheres[i];
    int axis = 0;
    for (int a = 1; a < 3; ++a)
      if (std::fabs(s.normal[a]) > std::fabs(s.normal[axis])) axis = a;
    const auto cluster = static_cast<std::uint32_t>(2 * axis + (s.normal[axis] > 0 ? 1 : 0));
    samples.push_back({s.centre.as<float>(), static_cast<float>(s.radius), static_cast<float>(s.area), cluster});
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
  while (std::ceil(extent.x / edge) * std::ceil(extent.y / edge) * std::ceil(extent.z / edge) > kMostCells) edge *= 1.1;
  low_ = low, perEdge_ = 1 / edge;
  cells_ = {static_cast<int>(std::ceil(extent.x / edge)), static_cast<int>(std::ceil(extent.y / edge)),
            static_cast<int>(std::ceil(extent.z / edge))};
  const std::vector<std::vector<std::uint32_t>> near = GridCells{discs, low, edge, ballRadius, cells_}.all();
  std::vector<std::uint32_t> start(near.size() + 1), entry;
  for (std::size_t cell = 0; cell < near.size(); ++cell) {
    start[cell] = static_cast<std::uint32_t>(entry.size());
    entry.insert(entry.end(), near[cell].begin(), near[cell].end());
  }
  start.back() = static_cast<std::uint32_t>(entry.size());
  disc_ = base::Array<Disc>(exec, discs);
  start_ = base::Array<std::uint32_t>(exec, start);
  entry_ = base::Array<std::uint32_t>(exec, entry);
}

SurfaceGridView SurfaceGrid::view() const {
  return {disc_.data(), start_.data(), entry_.data(), low_, perEdge_, cells_};
}

} // namespace grouser::contact
