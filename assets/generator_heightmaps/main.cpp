// SPDX-License-Identifier: BSD-3-Clause
#include "assets/generator_heightmaps/shapes.hpp"
#include "base/error.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <exception>
#include <filesystem>
#include <string>
#include <vector>

/// Writes the project's height-maps as grey PNG pictures: see grouser_heightmaps --help.
namespace grouser::heightmaps {

/// Throws InputError if the file cannot be written.
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

namespace {

using namespace grouser::heightmaps;

std::string footer() {
  std::string text = "Height-maps, with dimensions for a terrain of 20 m x 8 m and heights from 0 to 0.4 m:\n";
  for (const Picture& p : kPictures)
    text += fmt::format("  {:<11} {:>3} x {:>3}, {:>2} bit   {}\n", p.name, p.columns, p.rows, p.bits, p.help);
  return text + "The left column is x = 0, the top row the far edge (largest y). Pixels are points; the outermost "
                "are on the border of the terrain. Black and white are the limits of terrain.height_range in a scene.";
}

/// The selected height-maps in the selected size.
std::vector<Picture> chosen(const std::vector<std::string>& names, int bits, int columns, int rows) {
  std::vector<Picture> pictures;
  for (Picture p : kPictures) {
    if (!names.empty() && std::find(names.begin(), names.end(), p.name) == names.end()) continue;
    if (bits) p.bits = bits;
    if (columns) p.columns = columns;
    if (rows) p.rows = rows;
    pictures.push_back(p);
  }
  return pictures;
}

} // namespace

int main(int argc, char** argv) {
  CLI::App app("Writes the project's height-maps as grey PNG pictures.", "grouser_heightmaps");
  app.footer(footer());
  std::string folder;
  std::vector<std::string> names, known;
  int bits = 0, columns = 0, rows = 0;
  for (const Picture& p : kPictures) known.emplace_back(p.name);
  app.add_option("folder", folder, "output folder; existing files are overwritten")->required();
  app.add_option("names", names, "names of the height-maps; default: all")->check(CLI::IsMember(known));
  app.add_option("--bits", bits, "bits per pixel, 8 or 16; default: as listed below")->check(CLI::IsMember({8, 16}));
  app.add_option("--columns", columns, "pixels along x, 2 to 65536; default: as listed")->check(CLI::Range(2, 65536));
  app.add_option("--rows", rows, "pixels along y, 2 to 65536; default: as listed")->check(CLI::Range(2, 65536));
  try {
    app.parse(argc, argv);
    for (const Picture& picture : chosen(names, bits, columns, rows)) {
      const auto file = std::filesystem::path(folder) / (std::string(picture.name) + ".png");
      write(picture, file);
      fmt::print("{}: {} x {} pixels, {} bit\n", file.string(), picture.columns, picture.rows, picture.bits);
    }
    return 0;
  } catch (const CLI::Success& e) {
    return app.exit(e); // --help
  } catch (const std::exception& error) {
    fmt::print(stderr, "grouser_heightmaps: {}\n", error.what());
    return 2;
  }
}
