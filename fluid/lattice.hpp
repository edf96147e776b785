// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"
#include "fluid/fluid_setup.hpp"

#include <functional>
#include <vector>

namespace grouser::fluid {

/// Cubic lattice with points (i + 1/2, j + 1/2, k + 1/2) spacings from its origin. In two dimensions y = 0.
struct Lattice {
  double spacing; ///< [m]
  int dimensions = 3;
  base::Vec3d origin{}; ///< [m]

  /// Calls visit for all points of the box [low, high), with a tolerance of 1e-9 spacings.
  void each(const base::Vec3d& low, const base::Vec3d& high,
            const std::function<void(const base::Vec3d&)>& visit) const;
};

/// Signed distance of a point from the surface of solids [m], negative inside.
using Distance = std::function<double(const base::Vec3d&)>;

/// Wall markers: lattice points in the box that are inside a solid, in layers down to the kernel support. For surfaces
/// midway between two lattice layers the first markers are half a spacing inside.
std::vector<WallMarker> wallMarkers(const FluidModel& model, const Distance& distance, const base::Vec3d& low,
                                    const base::Vec3d& high, const base::Vec3d& origin = {});

/// Particles at rest in the box and outside all solids, below `level` [m], with the hydrostatic pressure of the model's
/// gravity along z.
std::vector<FluidParticle> stillFluid(const FluidModel& model, const Distance& distance, const base::Vec3d& low,
                                      const base::Vec3d& high, double level, const base::Vec3d& origin = {});

/// Returns the particles at least `distance` [m] away from all points.
std::vector<FluidParticle> awayFrom(std::vector<FluidParticle> particles, const std::vector<base::Vec3d>& points,
                                    double distance);

/// Distance function of a tank with solid walls: the box [low, high], without a lid if `open`.
Distance tank(const base::Vec3d& low, const base::Vec3d& high, bool open = true);

} // namespace grouser::fluid
