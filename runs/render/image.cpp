// SPDX-License-Identifier: BSD-3-Clause
#include "runs/render/image.hpp"

#include "runs/support/not_written.hpp"

#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#include <stb/stb_image_write.h>

#include <fstream>
#include <stdexcept>
#include <system_error>

namespace grouser::render {

void writePng(const Image& image, const std::filesystem::path& path) {
  // The file functions of the image library do not report a full disk.
  std::ofstream file(path, std::ios::binary);
  const auto take = [](void* to, void* bytes, int count) {
    static_cast<std::ofstream*>(to)->write(static_cast<const char*>(bytes), count);
  };
  const int made = stbi_write_png_to_func(take, &file, image.width, image.height, 3, image.rgb.data(), 3 * image.width);
  file.close();
  if (made && file) return;
  std::error_code error;
  if (std::filesystem::is_regular_file(path, error)) std::filesystem::remove(path, error); // no partial picture
  throw support::notWritten(path);
}

} // namespace grouser::render
