// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace grouser::spheredecomp::detail {

/// Cuts a face of any number of corners into triangles, as indices of its corners: ears are clipped in the face's own
/// plane, the best-shaped first. Every corner stays a corner of some triangle, also where it lies on a straight side,
/// so that neighbouring faces still share all edges. A hole that a bridge (two coinciding sides) joins to the outline
/// is kept. Empty where the outline crosses itself.
std::vector<std::array<std::uint32_t, 3>> triangulate(const std::vector<base::Vec3d>& corners);

/// True if an outline is strictly convex, seen along its normal, beyond float rounding.
bool isConvex(const std::vector<base::Vec3d>& corners);

} // namespace grouser::spheredecomp::detail
