// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace grouser::spheredecomp::detail {

/// Triangulates a face with any number of corners by ear clipping in the face plane, best-shaped ears first; returns
/// corner indices. Every corner, even on a straight side, is a corner of a triangle, so that neighbouring faces still
/// share all edges. A hole connected to the outline by a bridge (two coincident sides) is preserved. Empty if the
/// outline intersects itself.
std::vector<std::array<std::uint32_t, 3>> triangulate(const std::vector<base::Vec3d>& corners);

/// True if an outline is strictly convex, seen along its normal, by more than float rounding.
bool isConvex(const std::vector<base::Vec3d>& corners);

} // namespace grouser::spheredecomp::detail
