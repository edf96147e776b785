// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace grouser {

/// A vector in world axes (x and y horizontal, z up). The interface uses SI units and radians throughout.
struct Vec3 {
  double x = 0, y = 0, z = 0;
};

/// Unit quaternion of the rotation from body axes to world axes.
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
  Vec3 spin;              ///< angular velocity in world axes [rad/s]
};

/// All grains, sorted by id. With MPI, each rank returns a contiguous block of ids.
struct Grains {
  std::vector<Vec3> position;        ///< [m]
  std::vector<float> velocity, spin; ///< x, y, z of each grain [m/s], [rad/s]
  std::vector<float> radius;         ///< [m], one per grain
  std::vector<unsigned> id;
};

/// Energy ledger since the first step [J]:
///   kinetic + potential + elastic + dissipated + integrationError = work + residual.
struct Energies {
  double kinetic = 0, potential = 0, elastic = 0, dissipated = 0;
  double work = 0;             ///< work of drives, hitch and applied loads
  double integrationError = 0; ///< error of the finite time step; tends to 0 with it
  double residual = 0;         ///< rounding errors
};

} // namespace grouser
