// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace grouser::spheredecomp::detail {

/// Rejects content that assimp misreads in a PLY file: a header without an end, for which assimp hangs, and text
/// vertices with another number of values than the header states, for which assimp continues on the next line. Throws
/// base::InputError with file and line.
void checkPly(const std::string& path);

} // namespace grouser::spheredecomp::detail
