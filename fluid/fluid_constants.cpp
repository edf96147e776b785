// SPDX-License-Identifier: BSD-3-Clause
#include "fluid/fluid_constants.hpp"

#include "base/error.hpp"
#include "base/math.hpp"

#include <algorithm>
#include <cmath>

namespace grouser::fluid {

namespace {

/// Quantum for which a pair term of at most `largest` is at most 2^30 quanta.
base::FixedPoint pairTerms(double largest) { return base::fixedPointFor(largest, 30); }

/// Height below all fixed walls and particles at the start [m]: one spacing below the lowest.
double lowestOf(const FluidSetup& setup) {
  if (setup.markers.empty()) return -base::kInfinity;
  double lowest = base::kInfinity;
  for (const WallMarker& m : setup.markers) lowest = std::min(lowest, m.position.z);
  for (const FluidParticle& p : setup.particles) lowest = std::min(lowest, p.position.z);
  return lowest - setup.model.spacing;
}

} // namespace

FluidConstants fluidConstants(const FluidSetup& setup) {
  const FluidModel& model = setup.model;
  const base::Vec3d &low = setup.periodLow, &high = setup.periodHigh;
  const Wendland kernel = model.kernel();
  const double h = kernel.length(), c = model.soundSpeed, volume = model.volume(), reach = kernel.support();
  FluidConstants k;
  k.scale = base::positionScale(reach);
  for (int a = 0; a < 2; ++a) {
    if (!(high[a] > low[a])) continue;
    k.period.low[a] = static_cast<std::int64_t>(std::floor(low[a] * k.scale.perMetre + 0.5));
    k.period.length[a] = static_cast<std::int64_t>(std::floor((high[a] - low[a]) * k.scale.perMetre + 0.5));
  }
  k.metresPerUnit = static_cast<float>(k.scale.unit);
  k.perLength = static_cast<float>(1 / h);
  k.slope = static_cast<float>(volume * kernel.slopeAtCentre());
  k.eta2 = static_cast<float>(0.01 * h * h);
  k.sound2 = static_cast<float>(c * c);
  k.artificial = static_cast<float>(model.artificialViscosity * h * c);
  k.laminar = static_cast<float>(2 * model.viscosity / model.density);
  k.central = model.centralViscosity ? static_cast<float>(model.dimensions + 2) : 0.0f;
  // The centre between markers of a plane layer is 0.5 spacings from the nearest in two dimensions, 0.71 in three.
  const double contact = model.dimensions == 2 ? 0.7 : 0.85; // spacings; undisturbed particles are one or more away
  k.contact = static_cast<float>(contact * model.spacing);
  k.diffusion = static_cast<float>(-2 * model.diffusion * h * c);
  k.gravityOverSound2 = (model.gravity * (1 / (c * c))).as<float>();
  const double near = kernel.value(model.spacing) / kernel.atCentre(), near2 = near * near;
  k.shiftSeed = static_cast<float>(0.2 / (near2 * near2));

  // Largest pair terms: |F| r and |F| at their maxima, compressions and speeds at their limits.
  const double steep = volume * kernel.steepest(), centre = -volume * kernel.slopeAtCentre();
  const double apart = 2 * model.greatestSpeed(), most = kMaxCompression;
  const double stress = most / ((1 - most) * (1 - most)), spread = (1 + stress) * (1 + stress);
  const double laminar = 2 * model.viscosity / model.density * (model.centralViscosity ? model.dimensions + 2 : 1);
  const double viscous = (model.artificialViscosity * h * c + 2 * laminar) * centre * apart; // walls: 2 u_w
  const double force = 2 * stress * c * c * steep + spread * viscous;
  const double hydrostatic = base::norm(model.gravity) * reach / (c * c);
  k.rate = pairTerms(steep * apart + 2 * model.diffusion * h * c * centre * (2 * most + hydrostatic));
  k.acceleration = pairTerms(force);
  k.power = pairTerms(force * apart);
  k.weight = pairTerms(1);
  k.compression = pairTerms(most);
  k.moment = pairTerms((1 + most) * reach);
  k.speed = pairTerms(model.greatestSpeed());
  k.gradient = pairTerms((1 + k.shiftSeed) * steep);
  k.divergence = pairTerms(steep * reach);
  k.greatestSpeed = model.greatestSpeed(), k.lowest = lowestOf(setup);
  return k;
}

} // namespace grouser::fluid
