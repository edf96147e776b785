// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"
#include "fluid/wendland.hpp"

namespace grouser::fluid {

/// Constants of a weakly compressible fluid of particles. SI units.
///
/// The state of a particle is its velocity and its compression s = rho/rho0 - 1. All particles have the mass
/// rho0 spacing^d. Pressure p = c^2 (rho - rho0) = c^2 rho0 s.
struct FluidModel {
  int dimensions = 3;     ///< 2: all particles have the same y coordinate, and masses are per metre
  double spacing = 0;     ///< initial particle spacing [m]
  double smoothing = 1.3; ///< smoothing length / spacing [-]
  double density = 1000;  ///< at zero pressure [kg/m3]
  double soundSpeed = 0;  ///< numerical sound speed, far below the sound speed of water [m/s]
  double viscosity = 0;   ///< dynamic [Pa s]
  /// true: central viscosity operator of Monaghan and Gingold (1983), which conserves angular momentum and is correct
  /// at free surfaces (Colagrossi et al. 2011); false: Morris operator (1997), more accurate at walls.
  bool centralViscosity = false;
  double artificialViscosity = 0.02; ///< alpha of Monaghan (1992) between approaching fluid particles [-]
  double diffusion = 0.1;            ///< delta of the density diffusion of Fourtakas et al. (2019) [-]
  double shifting = 0;               ///< factor of Fickian shifting (Lind et al. 2012) away from free surfaces; 0: off
  base::Vec3d gravity{};             ///< [m/s2]
  double attraction = 0;             ///< acceleration -attraction * r towards the origin [1/s2]
  double timeStep = 0;               ///< [s]

  Wendland kernel() const { return {smoothing * spacing, dimensions}; }
  double volume() const; ///< particle volume V0 at zero pressure [m^d]
  double mass() const;   ///< particle mass [kg], per metre in two dimensions
  double skin() const;   ///< extension of the neighbour lists beyond the kernel support [m]
  double greatestSpeed() const { return soundSpeed; } ///< a higher particle speed is a fault [m/s]
};

/// Compression magnitude beyond which a fault is raised [-]; integer sums are scaled for it. Jets that hit a wall at v
/// are compressed by v/c, more than the 1 % of the bulk flow.
inline constexpr double kMaxCompression = 0.3;
/// Maximum compression beside bodies that touch other bodies [-]: twice that of the flow. The energy of compression
/// above it counts as a loss to walls.
inline constexpr double kPinchedCompression = 0.02;

/// Stability limits of the explicit time step by cause [s].
struct StepLimits {
  double sound;   ///< h/4 / (sound speed + expected speed)
  double force;   ///< sqrt(h/acceleration)/4
  double viscous; ///< h^2/8 / kinematic viscosity; infinite without viscosity
  double least() const;
};

/// `speed`: maximum expected speed [m/s]; `acceleration`: maximum expected acceleration [m/s2], at least gravity.
StepLimits stepLimits(const FluidModel& model, double speed, double acceleration);

/// Sound speed [m/s] for a flow with this maximum speed [m/s] and pressure [Pa], so that density varies by about 1 %.
double soundSpeedFor(double speed, double pressure, double density);

/// Pressure [Pa] at a compression [-], and the inverse function.
double pressureAt(const FluidModel& model, double compression);
double compressionAt(const FluidModel& model, double pressure);
/// Compression energy per mass, c^2 (ln(1 + s) + 1/(1 + s) - 1) [J/kg]; `sound2`: c^2 [m2/s2].
GROUSER_HD double internalEnergy(double sound2, double compression) {
  // Series of -ln(1 - u) - u with u = s/(1 + s): the closed form suffers cancellation for small u.
  const double u = compression / (1 + compression);
  double sum = 0;
  for (int n = 18; n >= 2; --n) sum = sum * u + 1.0 / n;
  return sound2 * u * u * sum;
}

} // namespace grouser::fluid
