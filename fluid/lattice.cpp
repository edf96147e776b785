// SPDX-License-Identifier: BSD-3-Clause
#include "fluid/lattice.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>

namespace grouser::fluid {

void Lattice::each(const base::Vec3d& low, const base::Vec3d& high,
                   const std::function<void(const base::Vec3d&)>& visit) const {
  constexpr double kRounding = 1e-9; // spacings
  std::int64_t first[3], last[3];
  for (int a = 0; a < 3; ++a) {
    first[a] = static_cast<std::int64_t>(std::ceil((low[a] - origin[a]) / spacing - 0.5 - kRounding));
    last[a] = static_cast<std::int64_t>(std::ceil((high[a] - origin[a]) / spacing - 0.5 - kRounding));
  }
  const bool plane = dimensions == 2;
  if (plane) first[1] = 0, last[1] = 1;
  const auto at = [this](int axis, std::int64_t k) { return origin[axis] + (static_cast<double>(k) + 0.5) * spacing; };
  for (std::int64_t i = first[0]; i < last[0]; ++i)
    for (std::int64_t j = first[1]; j < last[1]; ++j)
      for (std::int64_t k = first[2]; k < last[2]; ++k) visit({at(0, i), plane ? 0 : at(1, j), at(2, k)});
}

std::vector<WallMarker> wallMarkers(const FluidModel& model, const Distance& distance, const base::Vec3d& low,
                                    const base::Vec3d& high, const base::Vec3d& origin) {
  const double depth = std::ceil(model.kernel().support() / model.spacing) * model.spacing;
  std::vector<WallMarker> markers;
  Lattice{model.spacing, model.dimensions, origin}.each(low, high, [&](const base::Vec3d& p) {
    const double d = distance(p);
    if (d < 0 && d > -depth) markers.push_back({p});
  });
  return markers;
}

std::vector<FluidParticle> stillFluid(const FluidModel& model, const Distance& distance, const base::Vec3d& low,
                                      const base::Vec3d& high, double level, const base::Vec3d& origin) {
  std::vector<FluidParticle> particles;
  Lattice{model.spacing, model.dimensions, origin}.each(low, high, [&](const base::Vec3d& p) {
    if (!(p.z < level) || distance(p) < 0) return;
    particles.push_back({p, {}, compressionAt(model, -model.density * model.gravity.z * (level - p.z))});
  });
  return particles;
}

std::vector<FluidParticle> awayFrom(std::vector<FluidParticle> particles, const std::vector<base::Vec3d>& points,
                                    double distance) {
  using Cell = std::array<std::int64_t, 3>;
  const auto cellOf = [distance](const base::Vec3d& p) {
    const auto along = [distance](double x) { return static_cast<std::int64_t>(std::floor(x / distance)); };
    return Cell{along(p.x), along(p.y), along(p.z)};
  };
  const auto hash = [](const Cell& c) {
    return static_cast<std::size_t>(c[0] * 73856093 ^ c[1] * 19349663 ^ c[2] * 83492791);
  };
  std::unordered_map<Cell, std::vector<base::Vec3d>, decltype(hash)> cells(points.size(), hash);
  for (const base::Vec3d& p : points) cells[cellOf(p)].push_back(p);
  std::erase_if(particles, [&](const FluidParticle& particle) {
    const Cell own = cellOf(particle.position);
    for (int n = 0; n < 27; ++n) {
      const auto found = cells.find({own[0] + n % 3 - 1, own[1] + n / 3 % 3 - 1, own[2] + n / 9 - 1});
      if (found == cells.end()) continue;
      for (const base::Vec3d& p : found->second)
        if (norm2(p - particle.position) < distance * distance) return true;
    }
    return false;
  });
  return particles;
}

Distance tank(const base::Vec3d& low, const base::Vec3d& high, bool open) {
  return [low, high, open](const base::Vec3d& p) {
    const double across[] = {p.x - low.x,  high.x - p.x, p.y - low.y,
                             high.y - p.y, p.z - low.z,  open ? HUGE_VAL : high.z - p.z};
    const double inside = *std::min_element(std::begin(across), std::end(across));
    if (inside >= 0) return inside;
    double outside2 = 0;
    for (const double d : across) outside2 += d < 0 ? d * d : 0;
    return -std::sqrt(outside2);
  };
}

} // namespace grouser::fluid
