// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

namespace grouser::support {

/// 16 hexadecimal digits of a hash of the file's bytes. Throws base::InputError where it cannot be read.
std::string hashOfFile(const std::filesystem::path& path);

} // namespace grouser::support
