// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/math.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <string_view>

/// The height-maps of the project as functions: brightness in [0, 1] at (u, v), both in [0, 1]; u runs along x (left to
/// right in the picture), v along y (bottom to top). The scene sets size and heights in metres. Dimensions in brackets
/// are for a terrain of 20 m x 8 m and heights from 0 to 0.4 m.
namespace grouser::heightmaps {

/// Level ground at half height (in 8 bits the level above, 128).
inline double flat(double, double) { return 0.5; }

/// Gentle hills: four waves with wavelengths of 4 to 13 m that run in different directions [slopes up to 14 %,
/// hollows of 5 m radius].
inline double hills(double u, double v) {
  constexpr double k = 2 * base::kPi;
  const double sum = 0.36 * base::sin(k * (1.5 * u + 0.3)) + 0.26 * base::sin(k * (2.6 * u + 0.7 * v)) +
                     0.22 * base::sin(k * (0.9 * u - 1.3 * v + 0.15)) + 0.14 * base::sin(k * (4.3 * u + 1.1 * v + 0.6));
  return 0.5 + 0.5 * sum;
}

/// A ditch across the path at u = 0.6: one cosine wave, 0.16 wide [3.2 m wide, 0.28 m deep, slopes up to 28 %].
inline double ditch(double u, double) {
  const double along = (u - 0.6) / 0.16;
  const double depth = std::fabs(along) < 0.5 ? 0.5 + 0.5 * base::cos(2 * base::kPi * along) : 0.0;
  return 0.85 - 0.7 * depth;
}

/// Level at the start, then a side slope that grows over 0.2 < u < 0.4 [from 0 to 5 %, up to the left].
inline double sideSlope(double u, double v) {
  const double t = u < 0.2 ? 0.0 : u > 0.4 ? 1.0 : (u - 0.2) / 0.2;
  return 0.5 + (v - 0.5) * t * t * (3 - 2 * t);
}

/// A platform across the path: a step up at u = 0.45 and a step down at u = 0.7, each over 0.01 [0.24 m high over
/// 0.2 m, on top 4.8 m long].
inline double step(double u, double) {
  const auto risen = [u](double at) {
    const double t = u < at ? 0.0 : u > at + 0.01 ? 1.0 : (u - at) / 0.01;
    return t * t * (3 - 2 * t);
  };
  return 0.2 + 0.6 * (risen(0.45) - risen(0.7));
}

/// One picture: name, size in pixels, depth in bits, shape, and description.
struct Picture {
  std::string_view name;
  int columns, rows, bits;
  double (*shape)(double, double);
  std::string_view help;

  /// Value of a pixel, rounded to the nearest of 2^bits levels. Row 0 is the far edge, v = 1; the outermost ones are on
  /// the edges.
  std::uint16_t pixel(int column, int row) const {
    const double u = double(column) / (columns - 1), v = 1 - double(row) / (rows - 1);
    return static_cast<std::uint16_t>(std::floor(shape(u, v) * ((1 << bits) - 1) + 0.5));
  }
};

inline constexpr std::array<Picture, 6> kPictures{
    {{"flat", 17, 9, 8, flat, "level, at half height"},
     {"hills", 257, 129, 16, hills, "gentle hills; slopes up to 14 %"},
     {"hills8", 257, 129, 8, hills, "the same hills in 8 bits, for comparison"},
     {"ditch", 257, 9, 16, ditch, "level, with a ditch across the path, 3.2 m wide and 0.28 m deep"},
     {"side_slope", 129, 65, 16, sideSlope, "level, then rising to the left by up to 5 %"},
     {"step", 513, 9, 16, step, "level, with a platform across the path, 0.24 m high"}}};

} // namespace grouser::heightmaps
