// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace grouser::commands {

/// All keys of scene, vehicle and soil files: docs/keys.md, byte by byte.
std::string keysDocument();

/// All that the files of results may hold: docs/files.md, byte by byte.
std::string filesDocument();

} // namespace grouser::commands
