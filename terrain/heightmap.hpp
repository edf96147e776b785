// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "terrain/height_field.hpp"

#include <filesystem>
#include <vector>

namespace grouser::terrain {

/// A picture of heights. Each pixel is a point, not an area.
struct Heightmap {
  std::filesystem::path file;
  int columns{}, rows{}; ///< >= 2
  int bits{};            ///< of a channel: 8 or 16
  bool colour{};         ///< some pixel is not grey
  bool transparent{};    ///< some pixel is not opaque
  std::vector<double>
      brightness; ///< [columns * rows] [-], 0 = black, 1 = white of the format; row 0 is the picture's top

  double at(int column, int row) const { return brightness[static_cast<std::size_t>(row) * columns + column]; }
};

/// Reads a picture: PNG with 8 or 16 bits (1, 2 and 4 bits and palettes are taken as 8), also JPEG (8 bit,
/// lossy: for lack of a better source).
/// Colour becomes luminance Y = 0.2126 R + 0.7152 G + 0.0722 B of the stored values (weights of ITU-R BT.709); alpha is
/// ignored. No gamma is applied: the value of a pixel is proportional to height.
/// InputError: no such file, not a picture, damaged (of a PNG: checksums, amount of pixels and colours beyond the
/// palette), cut short, fewer than 2 pixels a side, or more than 2^28 pixels.
Heightmap loadHeightmap(const std::filesystem::path& file);

/// Position of a height-map in the world.
struct HeightmapPlacement {
  double sizeX{}, sizeY{}; ///< [m] > 0; the outermost pixels lie on the border, so columns pixels span sizeX exactly
  double black{}, white{}; ///< heights [m] of the format's darkest and brightest value, not of this picture's
  Interpolation interpolation{Interpolation::monotone};
};

/// The surface through a height-map's pixels. The terrain starts at x = 0 and is centred on the x axis:
/// x in [0, sizeX], y in [-sizeY / 2, sizeY / 2]. The picture's left edge is x = 0, its top row is the far edge,
/// y = sizeY / 2: the picture is the view from above with x to the right.
/// InputError: a size that is not positive and finite, a height that is not finite.
HeightField heightFieldOf(const Heightmap& map, const HeightmapPlacement& placement);

} // namespace grouser::terrain
