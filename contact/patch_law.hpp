// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/fixed_point.hpp"
#include "base/vec.hpp"

namespace grouser::contact {

/// Contact of extended surfaces: an elastic (Winkler) foundation with relaxation, so the force does not depend on the
/// number of spheres of a part.
///
///   pressure = modulus (overlap + relaxation * closing speed), never tensile
///   friction = -k_t shear - relaxation k_t slip on each patch, k_t = ratio * modulus * area, within Coulomb's cone
struct PatchLaw {
  double modulus{};         ///< [N/m3], > 0
  double relaxation{};      ///< [s], >= 0
  double friction{};        ///< [-], >= 0
  double tangentialRatio{}; ///< [-], >= 0
  /// Damping ratio of the contact as a whole (contact/whole_contact.hpp), which then replaces `relaxation` [-]; < 0:
  /// the relaxation acts at each point.
  double dampingRatio{-1};
  double largestOverlap{1e300}; ///< limit of the overlap of a contact as a whole [m]

  GROUSER_HD bool isWhole() const { return dampingRatio >= 0; }
};

/// Quanta of the sums over samples; they depend on the scene only.
struct PatchQuanta {
  base::FixedPoint force, torque, energy, area, moment; ///< [N], [N m], [J], [m2], [N m] (moment of `place`)
};

/// Sums over the samples of one patch in one step, in quanta; order-independent.
struct PatchSums {
  std::int64_t area, weight; ///< contact area; sum of normal force magnitudes
  base::Vec3l place;         ///< sum of magnitude * (position - centre of part A)
  base::Vec3l normalForce;   ///< on A
  std::int64_t elastic, dissipated;
};

/// History of a patch: the tangential spring in world axes.
struct PatchState {
  base::Vec3d shear; ///< [m]
  double stiffness;  ///< spring stiffness k_t [N/m], proportional to the contact area
  double dissipated; ///< cumulative [J]
};

/// Normal contact force at one point in one step.
template <class T> struct PointPressure {
  T size;                ///< magnitude of the normal force [N]
  T elastic, dissipated; ///< [J]
};

/// Returns the pressure on an `area` [m2]; `overlap` [m], >= 0 unless the area is zero; `opening`: separation speed of
/// the surfaces [m/s]. T is a number or a SIMD vector.
template <class T> GROUSER_HD PointPressure<T> pressureAt(const PatchLaw& law, double timeStep, const T& area,
                                                          const T& overlap, const T& opening) {
  const T stiffness = area * law.modulus, pressed = stiffness * (overlap - opening * law.relaxation);
  const T size = pressed < T{} ? T{} : pressed;
  return {size, stiffness * overlap * overlap * 0.5, (stiffness * overlap - size) * opening * timeStep};
}

/// Friction of a patch in one step.
struct PatchSlide {
  base::Vec3d force;   ///< on A [N]
  double elastic{};    ///< in the tangential spring [J]
  double dissipated{}; ///< [J] in this step
};

/// Advances the tangential spring of a touching patch. `normal`: outward unit normal of B; `relative`: velocity of A
/// relative to B at the centre of pressure [m/s]; `weight`: sum of normal force magnitudes [N]; `area`: contact area
/// [m2].
GROUSER_HD PatchSlide slide(const PatchLaw& law, PatchState& state, const base::Vec3d& normal,
                            const base::Vec3d& relative, double weight, double area, double timeStep) {
  const base::Vec3d slip = relative - normal * dot(relative, normal);
  base::Vec3d shear = state.shear - normal * dot(state.shear, normal);
  const double stiffness = law.tangentialRatio * law.modulus * area;
  // The contact area has changed: new area is unstrained, so the force is unchanged; lost area dissipates its strain
  // energy. Neither adds energy.
  const double storedBefore = state.stiffness * dot(state.shear, state.shear);
  if (stiffness > state.stiffness) shear *= state.stiffness / stiffness;
  shear += slip * timeStep;
  const double dashpot = law.relaxation * stiffness;
  base::Vec3d force = shear * -stiffness - slip * dashpot;
  const double limit = law.friction * weight, size = norm(force), spring = stiffness * norm(shear);
  if (size > limit) {
    force *= limit / size;
    // Including the dashpot's force would stretch the spring without work.
    if (spring > limit) shear *= limit / spring;
  }
  state.shear = shear, state.stiffness = stiffness;
  const double stored = stiffness * dot(shear, shear);
  // Work input minus energy gain of the spring.
  return {force, 0.5 * stored, -(dot(force, slip) * timeStep + 0.5 * (stored - storedBefore))};
}

/// Ends the contact of a patch and dissipates the energy of its spring.
GROUSER_HD void endContact(PatchState& state) {
  state.dissipated += 0.5 * state.stiffness * dot(state.shear, state.shear);
  state.shear = {}, state.stiffness = 0;
}

} // namespace grouser::contact
