// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"
#include "fluid/fluid_setup.hpp"

#include <functional>
#include <vector>

namespace grouser::fluid {

/// Points of a cubic lattice, (i + 1/2, j + 1/2, k + 1/2) spacings from its origin. In two dimensions y = 0.
struct Lattice {
  double spacing; ///< [m]
  int dimensions = 3;
  base::Vec3d origin{}; ///< [m]

  /// Calls visit for all points of the box [low, high), which count as inside within 1e-9 spacings.
  void each(const base::Vec3d& low, const base::Vec3d& high,
            const std::function<void(const base::Vec3d&)>& visit) const;
};

/// Signed distance of a point from the surface of solids, negative inside [m].
using Distance = std::function<double(const base::Vec3d&)>;

/// Markers of a wall: points of the lattice in the box that lie inside a solid, in layers down to the kernel's support.
/// Surfaces between two layers of the lattice have their first markers half a spacing inside.
std::vector<WallMarker> wallMarkers(const FluidModel& model, const Distance& distance, const base::Vec3d& low,
                                    const base::Vec3d& high, const base::Vec3d& origin = {});

/// Particles at rest in the box and outside all solids, under hydrostatic pressure below `level` [m] by the model's
/// gravity along z; above the level there are none.
std::vector<FluidParticle> stillFluid(const FluidModel& model, const Distance& distance, const base::Vec3d& low,
                                      const base::Vec3d& high, double level, const base::Vec3d& origin = {});

/// The particles at least `distance` [m] away from all points.
std::vector<FluidParticle> awayFrom(std::vector<FluidParticle> particles, const std::vector<base::Vec3d>& points,
                                    double distance);

/// Distance from the inside of a tank whose walls are solid: the box [low, high], open above where `open`.
Distance tank(const base::Vec3d& low, const base::Vec3d& high, bool open = true);

} // namespace grouser::fluid
