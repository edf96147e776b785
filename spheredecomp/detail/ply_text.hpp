// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace grouser::spheredecomp::detail {

/// Refuses what assimp reads wrongly or not at all from a PLY file: a header without its end, on which it never
/// returns, and vertices of a text file with other numbers than the header lists, for which it takes those of the next
/// line. Throws base::InputError with file and line.
void checkPly(const std::string& path);

} // namespace grouser::spheredecomp::detail
