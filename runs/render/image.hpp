// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace grouser::render {

/// 8-bit sRGB picture; row 0 is the top.
struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb; ///< [height * width * 3]

  const std::uint8_t* at(int x, int y) const { return &rgb[3 * (static_cast<std::size_t>(y) * width + x)]; }
};

/// Throws support::NotWritten if the file cannot be written.
void writePng(const Image& image, const std::filesystem::path& path);

} // namespace grouser::render
