// SPDX-License-Identifier: BSD-3-Clause
#include "assets/generator_heightmaps/shapes.hpp"
#include "base/error.hpp"

#include <png.h>

#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>
#include <vector>

/// Writes the project's height-maps as grey PNG pictures: grouser_heightmaps FOLDER
namespace grouser::heightmaps {

/// InputError: the file cannot be written.
void write(const Picture& picture, const std::filesystem::path& file) {
  std::vector<std::uint8_t> bytes8;
  std::vector<std::uint16_t> bytes16;
  for (int row = 0; row < picture.rows; ++row)
    for (int column = 0; column < picture.columns; ++column)
      if (picture.bits == 8)
        bytes8.push_back(static_cast<std::uint8_t>(picture.pixel(column, row)));
      else
        bytes16.push_back(picture.pixel(column, row));

  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(picture.columns);
  image.height = static_cast<png_uint_32>(picture.rows);
  image.format = picture.bits == 8 ? PNG_FORMAT_GRAY : PNG_FORMAT_LINEAR_Y;
  const void* pixels = picture.bits == 8 ? static_cast<const void*>(bytes8.data()) : bytes16.data();
  const int asGiven = 0; // 16 bits stay 16 bits
  if (!png_image_write_to_file(&image, file.c_str(), asGiven, pixels, 0, nullptr))
    throw base::InputError(file.string() + ": cannot be written (" + image.message + "); check folder and permissions");
}

} // namespace grouser::heightmaps

int main(int argc, char** argv) {
  using namespace grouser::heightmaps;
  if (argc != 2 || std::string(argv[1]) == "--help") {
    std::printf("usage: grouser_heightmaps FOLDER\nWrites the project's height-maps as PNG pictures into FOLDER.\n");
    return argc == 2 ? 0 : 2;
  }
  try {
    for (const Picture& picture : kPictures) {
      const auto file = std::filesystem::path(argv[1]) / (std::string(picture.name) + ".png");
      write(picture, file);
      std::printf("%s: %d x %d pixels, %d bit\n", file.c_str(), picture.columns, picture.rows, picture.bits);
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "grouser_heightmaps: %s\n", error.what());
    return 2;
  }
}
