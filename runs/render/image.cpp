// SPDX-License-Identifier: BSD-3-Clause
#include "runs/render/image.hpp"

#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#include <stb/stb_image_write.h>

#include <stdexcept>

namespace grouser::render {

void writePng(const Image& image, const std::filesystem::path& path) {
  const int written = stbi_write_png(path.c_str(), image.width, image.height, 3, image.rgb.data(), 3 * image.width);
  if (!written) throw std::runtime_error(path.string() + ": could not be written; is the disk full?");
}

} // namespace grouser::render
