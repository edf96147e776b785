// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace grouser::commands {

/// All keys of scene, vehicle and soil files: docs/keys.md, byte by byte.
std::string keysDocument();

} // namespace grouser::commands
