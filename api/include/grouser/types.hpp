// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace grouser {

/// World axes: x and y level, z up. SI units and radians throughout.
struct Vec3 {
  double x = 0, y = 0, z = 0;
};

/// Unit quaternion of a rotation from the body's axes to the world's.
struct Quaternion {
  double w = 1, x = 0, y = 0, z = 0;
};

/// A rigid body of the vehicle ("chassis", "left shoe 0", ...) or of a mechanism.
struct Body {
  std::string name;
  double mass = 0;        ///< [kg]
  Vec3 position;          ///< position of the centre of mass [m]
  Quaternion orientation; ///< body to world
  Vec3 velocity;          ///< velocity of the centre of mass [m/s]
  Vec3 spin;              ///< angular velocity, world axes [rad/s]
};

/// All grains, sorted by id. With MPI, each rank holds a contiguous block of ids.
struct Grains {
  std::vector<Vec3> position;        ///< [m]
  std::vector<float> velocity, spin; ///< x, y, z of each grain [m/s], [rad/s]
  std::vector<float> radius;         ///< [m], one per grain
  std::vector<unsigned> id;
};

/// Energies since the first step [J]. For a finite time step
///   kinetic + potential + elastic + dissipated + integrationError = work + residual.
struct Energies {
  double kinetic = 0, potential = 0, elastic = 0, dissipated = 0;
  double work = 0;             ///< work of drives, hitch and applied loads
  double integrationError = 0; ///< decreases with the time step
  double residual = 0;         ///< rounding
};

} // namespace grouser
