// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace grouser::commands {

/// All keys of scene, vehicle and soil files: docs/keys.md, byte for byte.
std::string keysDocument();

/// All datasets and attributes of results files: docs/files.md, byte for byte.
std::string filesDocument();

} // namespace grouser::commands
