// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/body_foundation.hpp"

#include "base/math.hpp"
#include "contact/restitution.hpp"

#include <algorithm>
#include <cmath>

namespace grouser::coupling {

using base::Vec3d;
using contact::SurfaceGeometry;
using contact::SurfaceShape;

int FoundationTable::indexOf(const std::string& material) const {
  return static_cast<int>(std::find(materials.begin(), materials.end(), material) - materials.begin());
}

namespace {

bool isRound(const SurfaceGeometry& g) { return g.shape != SurfaceShape::box; }
bool isBall(const SurfaceGeometry& g) { return g.shape == SurfaceShape::capsule && g.half.z == 0; }

/// Minimum stiffness of a shape that rests on one of its faces, strips or caps [N/m]. Forces at the overlap x follow
/// from the indented volume: box K A x, sphere pi K R x^2, strip of a cylinder 4/3 K L sqrt(2 R) x^(3/2).
double restingStiffness(const SurfaceGeometry& g, double modulus, double load) {
  const double x = restingOverlap(g, modulus, load), r = g.half.x, length = 2 * g.half.z;
  if (!isRound(g)) return load / x;
  return isBall(g) ? 2 * base::kPi * modulus * r * x : 2 * modulus * length * std::sqrt(2 * r * x);
}

/// Geometric mean of the stiffnesses at rest on the smallest and on the largest patch [N/m], so that the damping on
/// both is close to the intended value.
double meanStiffness(const SurfaceGeometry& g, double modulus, double load) {
  const double least = restingStiffness(g, modulus, load);
  if (isBall(g)) return least;
  return std::sqrt(least * std::max(least, modulus * largestPatch(g, restingOverlap(g, modulus, load))));
}

} // namespace

double largestPatch(const SurfaceGeometry& g, double overlap) {
  const Vec3d& h = g.half;
  if (!isRound(g)) return 4 * std::max({h.x * h.y, h.x * h.z, h.y * h.z});
  const double strip = 4 * h.z * std::sqrt(2 * h.x * overlap), cap = 2 * base::kPi * h.x * overlap;
  if (g.shape == SurfaceShape::capsule) return strip + cap;
  return std::max(strip, base::kPi * h.x * h.x);
}

double restingOverlap(const SurfaceGeometry& g, double modulus, double load) {
  const Vec3d& h = g.half;
  if (!isRound(g)) return load / (4 * modulus * std::min({h.x * h.y, h.x * h.z, h.y * h.z}));
  if (isBall(g)) return std::sqrt(load / (base::kPi * modulus * h.x));
  return base::pow(0.75 * load / (modulus * 2 * h.z * std::sqrt(2 * h.x)), 2.0 / 3);
}

contact::PatchLaw patchLaw(const contact::Foundation& f, const SurfaceGeometry& shape, double mass, double gravity) {
  constexpr double kNominal = 9.81; // [m/s2] for scenes without gravity
  const double load = mass * (gravity > 0 ? gravity : kNominal);
  const double omega = std::sqrt(meanStiffness(shape, f.modulus, load) / mass);
  return {f.modulus, 2 * contact::dampingRatioFor(f.restitution, false) / omega, f.friction, f.tangentialRatio};
}

} // namespace grouser::coupling
