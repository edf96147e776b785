// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "terrain/height_field.hpp"

#include <filesystem>
#include <vector>

namespace grouser::terrain {

/// Grey-scale image of heights. Each pixel is a sample point, not an area.
struct Heightmap {
  std::filesystem::path file;
  int columns{}, rows{}; ///< >= 2
  int bits{};            ///< bits per channel: 8 or 16
  bool colour{};         ///< some pixels are not grey
  bool transparent{};    ///< some pixels are not opaque
  std::vector<double>
      brightness; ///< [columns * rows] [-], 0 = black, 1 = white of the format; row 0 is the top of the image

  double at(int column, int row) const { return brightness[static_cast<std::size_t>(row) * columns + column]; }
};

/// Reads an image: PNG with 8 or 16 bits (converts 1, 2 and 4 bits and palettes to 8), or JPEG (8 bit, lossy: not
/// recommended). Colour is converted to luminance Y = 0.2126 R + 0.7152 G + 0.0722 B of the stored values
/// (weights of ITU-R BT.709); alpha is ignored. No gamma correction: height is proportional to the pixel value.
/// Throws InputError for a missing file, a file that is not an image, a damaged image (PNG: checksums, number of
/// pixels, and colours beyond the palette), a truncated file, fewer than 2 pixels per side, or more than 2^28
/// pixels.
Heightmap loadHeightmap(const std::filesystem::path& file);

/// Position of a height map in the world.
struct HeightmapPlacement {
  double sizeX{}, sizeY{}; ///< [m] > 0; the outermost pixels are on the border, so `columns` pixels span exactly sizeX
  double black{}, white{}; ///< heights [m] of the darkest and brightest value of the format, not of this image
  Interpolation interpolation{Interpolation::monotone};
};

/// Returns the surface through the pixels of a height map: x in [0, sizeX], y in [-sizeY / 2, sizeY / 2], centred
/// on the x axis. The image is the plan view with x to the right: its left edge is x = 0, its top row is the far
/// edge y = sizeY / 2. Throws InputError for a size that is not positive and finite, or a height that is not
/// finite.
HeightField heightFieldOf(const Heightmap& map, const HeightmapPlacement& placement);

} // namespace grouser::terrain
