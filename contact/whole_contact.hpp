// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/foundation_sums.hpp"
#include "contact/part_motion.hpp"
#include "contact/surface_geometry.hpp"

#include <vector>

/// Damping of the contact of two rigid bodies as a whole: all their patches with one normal.
///
/// U: elastic energy; (F, T): wrench of the elastic pressure; M: mass matrix of both bodies. With y = sqrt(2 U), an
/// impact along a constant direction is a linear oscillation, whatever the force law U(x) is:
///
///   omega^2 = (F, T)^T M^-1 (F, T) / (2 U)
///   y'' + 2 zeta omega y' + omega^2 y = 0, force on the bodies (F, T) (1 + 2 zeta / omega U' / (2 U)), never tensile
///
/// The restitution is therefore that of the linear dashpot without attraction (contact/restitution.hpp), at any speed,
/// on any face, edge, cap or strip, for any two masses. A round body that rolls keeps U, so it is not resisted.
/// Rocking on a face keeps U to first order, too. It is damped by the couple of the pressures -K tau (o - mean o), with
/// the opening speeds o of the points and tau = 2 zeta / omega of this couple's own omega, where the surface is flat.
namespace grouser::contact {

/// Mass properties and closed form of a part, for contacts damped as a whole.
struct PartBody {
  int body{-1};               ///< index of its body; -1: immovable
  double inverseMass{};       ///< [1/kg]
  base::Mat3d inverseInertia; ///< about the centre of mass, in the part frame [1/(kg m2)]
  SurfaceGeometry shape{SurfaceShape::box, {}};
};

/// True for solids of revolution about the z axis of their frame.
bool isRound(const SurfaceGeometry& shape);
bool isBall(const SurfaceGeometry& shape);

/// Motion of a part whose frame does not turn with a round part about its own axis, so that the same points stay below
/// it as it rolls. The frame depends on the axis only.
PartMotion withoutOwnTurn(const SurfaceGeometry& shape, const PartMotion& motion);

/// Removes the spin of a round part about its own axis, in the part frame.
base::Vec3d shapeSpin(const SurfaceGeometry& shape, const base::Vec3d& spin);

/// Removes moments about the axis of a round part: the elastic energy does not depend on its turn.
void removeOwnMoments(const SurfaceGeometry& shape, FoundationSums& sums);

/// Point of the undeformed surface of a round part at the pressure centre `p`, in its frame; `p` on other parts, and on
/// the ends of cylinders and cones. Friction acts here, so that a wheel rolls at its radius times its spin.
base::Vec3d rollingPoint(const SurfaceGeometry& shape, const base::Vec3d& p);

/// A patch of a contact: sums in world axes about the centre of mass of A, and their powers per unit modulus.
struct WholePatch {
  std::size_t patch; ///< index of its tangential spring
  int a, b;          ///< motions of part A and of B; b < 0: at rest
  int bodyA, bodyB;  ///< bodies; -1: immovable
  const PatchLaw* law;
  FoundationSums sums;
  double power;  ///< power of force and torque: -U' / modulus
  double spread; ///< sum of rocking area x o
  double rated;  ///< sum of rocking area x o^2
};

/// Damped pressure of a patch.
struct DampedPatch {
  PatchPressure pressure;
  double relaxation; ///< relaxation time of its tangential spring [s]
};

/// Computes the damped pressures of all patches of one step. `bodies`: by motion; motions beyond are at rest.
void dampWholeContacts(const std::vector<WholePatch>& patches, const std::vector<PartBody>& bodies,
                       const PartMotion* motion, double timeStep, std::vector<DampedPatch>& damped);

} // namespace grouser::contact
