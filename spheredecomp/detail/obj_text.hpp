// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace grouser::spheredecomp::detail {

/// Throws base::InputError, with the line, for a vertex of an OBJ file that the reader behind would drop or change
/// without a word: one of fewer than three coordinates, of words, or with a weight other than 1.
void checkObjVertices(const std::string& path);

} // namespace grouser::spheredecomp::detail
