// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "spheredecomp/mesh_query.hpp"

#include <optional>

namespace grouser::spheredecomp {

/// Part of a closed mesh where integrals over its triangles (volume, moments) are not those of its solid.
struct ShellFault {
  enum class Kind { overlap, inverted };
  Kind kind{};
  Vec3d place;    ///< centre of the largest piece of surface with this fault [m]
  double share{}; ///< area of all such pieces / area of the mesh [-]
};

/// Checks the winding number on both sides of the surface, at points up to a fortieth of the diagonal apart. Just
/// inside each face it must be 1. Above 1, overlapping, nested or repeated shells count their common volume more than
/// once, even if one repeats the other with a small offset. Just outside it must not be below 0, or a shell with inward
/// faces, outside all others, counts as a negative volume. A hollow mesh, i.e. an inner shell with inward faces,
/// passes. Returns nothing if at most a thousandth of the area is at fault.
std::optional<ShellFault> shellFault(const MeshQuery& query);

} // namespace grouser::spheredecomp
