// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace grouser::commands {

/// Text of docs/keys.md: all keys of scene, vehicle and soil files.
std::string keysDocument();

/// Text of docs/files.md: all datasets and attributes of results files.
std::string filesDocument();

} // namespace grouser::commands
