// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/foundation_sums.hpp"
#include "contact/point_tree.hpp"

#include <vector>

namespace grouser::contact {

/// Parameters shared by all points of one part in contact with one fixed surface. Vectors are in the part frame;
/// moments are about its origin.
struct PointPress {
  const PatchLaw& law;
  double timeStep;               ///< [s]
  RelativeMotion<double> motion; ///< motion of the part
};

/// Adds the contact pressure of a block's points. `normal`: outward unit normals of the surface; `overlap` [m].
void pressBlock(const PointBlock& block, const PointPress& press, const Vec3P& normal, const PointLanes& overlap,
                PressureLanes& sums);
PatchPressure sumOf(const PressureLanes& sums);

/// Returns the contact pressure of several blocks of points on the plane normal . x = height.
PatchPressure pressOnPlane(const std::vector<const PointBlock*>& blocks, const PointPress& press,
                           const base::Vec3d& normal, double height);

/// The same three functions for contacts that are damped as a whole.
void addFoundation(const PointBlock& block, const FoundationPress& press, const Vec3P& normal,
                   const PointLanes& overlap, FoundationLanes& sums);
FoundationSums sumOf(const FoundationLanes& sums);
FoundationSums foundationOnPlane(const std::vector<const PointBlock*>& blocks, const FoundationPress& press,
                                 const base::Vec3d& normal, double height);

} // namespace grouser::contact
