// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace grouser::spheredecomp::detail {

/// Rejects content that assimp silently drops or changes in an OBJ file, which would renumber all later vertices: lines
/// of vertices and faces that do not begin in the first column or are in capitals, coordinates that are missing, no
/// numbers, too many or begin with a point, weights other than 1, lines that end in carriage returns alone. Throws
/// base::InputError with file and line.
void checkObj(const std::string& path);

} // namespace grouser::spheredecomp::detail
