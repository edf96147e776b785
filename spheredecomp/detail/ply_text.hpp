// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace grouser::spheredecomp::detail {

/// Rejects content that assimp misreads in a PLY file: a header without an end, on which it hangs, and text vertices
/// with a different number of values than in the header, for which it continues on the next line. Throws
/// base::InputError with file and line.
void checkPly(const std::string& path);

} // namespace grouser::spheredecomp::detail
