// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace grouser::spheredecomp::detail {

/// Rejects content that assimp misreads in a PLY file: a header without its end, on which it never returns, and text
/// vertices with another count of numbers than in the header, for which it reads from the next line. Throws
/// base::InputError with file and line.
void checkPly(const std::string& path);

} // namespace grouser::spheredecomp::detail
