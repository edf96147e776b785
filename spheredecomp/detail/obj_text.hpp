// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace grouser::spheredecomp::detail {

/// Rejects content that assimp silently drops or changes in an OBJ file, which would renumber all later vertices:
/// vertex and face lines that are indented or in capitals; coordinates that are missing, not numeric, too many, or
/// start with a point; weights other than 1; lines that end in a bare carriage return. Also rejects material libraries
/// that are no regular files. Throws base::InputError with file and line.
void checkObj(const std::string& path);

} // namespace grouser::spheredecomp::detail
