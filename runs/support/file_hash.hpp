// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace grouser::support {

/// Checksum CRC-32 of gzip and zlib; detects every single flipped bit. `before`: checksum of the preceding bytes.
std::uint32_t crc32(std::string_view bytes, std::uint32_t before = 0);

/// Hash of the bytes of `text`, as 16 hexadecimal digits.
std::string hashOfText(std::string_view text);

/// The same for the bytes of a file. Throws base::InputError if the file cannot be read.
std::string hashOfFile(const std::filesystem::path& path);

} // namespace grouser::support
