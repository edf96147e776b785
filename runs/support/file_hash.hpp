// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace grouser::support {

/// Hash of the bytes of `text`, as 16 hexadecimal digits.
std::string hashOfText(std::string_view text);

/// The same for the bytes of a file. Throws base::InputError if the file cannot be read.
std::string hashOfFile(const std::filesystem::path& path);

} // namespace grouser::support
