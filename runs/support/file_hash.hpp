// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace grouser::support {

/// 16 hexadecimal digits of a hash of its bytes.
std::string hashOfText(std::string_view text);

/// The same of a file's bytes. Throws base::InputError where it cannot be read.
std::string hashOfFile(const std::filesystem::path& path);

} // namespace grouser::support
