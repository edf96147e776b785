// SPDX-License-Identifier: BSD-3-Clause
#include "runs/render/colour.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace grouser::render {

Colour srgb(int red, int green, int blue) {
  const auto linear = [](int c) {
    const float v = static_cast<float>(c) / 255;
    return v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f);
  };
  return {linear(red), linear(green), linear(blue)};
}

std::array<std::uint8_t, 3> toSrgb(const Colour& colour) {
  // 4096 steps are finer than the 255 levels of a picture.
  static const std::array<std::uint8_t, 4097> kCurve = [] {
    std::array<std::uint8_t, 4097> curve;
    for (std::size_t i = 0; i < curve.size(); ++i) {
      const float linear = static_cast<float>(i) / 4096;
      const float v = linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1 / 2.4f) - 0.055f;
      curve[i] = static_cast<std::uint8_t>(std::lround(255 * v));
    }
    return curve;
  }();
  std::array<std::uint8_t, 3> c;
  for (int k = 0; k < 3; ++k)
    c[static_cast<std::size_t>(k)] =
        kCurve[static_cast<std::size_t>(std::lround(4096 * std::clamp(colour[k], 0.0f, 1.0f)))];
  return c;
}

Colour groundColour() { return srgb(168, 152, 128); }

namespace {

/// Colour at `value` in a map of evenly spaced points; `value` is clamped to 0 to 1.
template <std::size_t kPoints> Colour mapped(const int (&map)[kPoints][3], float value) {
  constexpr int kLast = static_cast<int>(kPoints) - 1;
  const float x = kLast * std::clamp(value, 0.0f, 1.0f);
  const int i = std::min(kLast - 1, static_cast<int>(x));
  const float t = x - static_cast<float>(i);
  const auto mixed = [&](int c) {
    return static_cast<int>(std::lround((1 - t) * float(map[i][c]) + t * float(map[i + 1][c])));
  };
  return srgb(mixed(0), mixed(1), mixed(2));
}

} // namespace

Colour heightColour(float value) {
  // Ten points of the viridis map (van der Walt and Smith, 2015; public domain).
  static constexpr int kMap[10][3] = {{68, 1, 84},    {72, 40, 120},  {62, 74, 137},  {49, 104, 142}, {38, 130, 142},
                                      {31, 158, 137}, {53, 183, 121}, {110, 206, 88}, {181, 222, 43}, {253, 231, 37}};
  return mapped(kMap, value);
}

Colour soilColour(float value) {
  static constexpr int kMap[4][3] = {{58, 42, 30}, {104, 80, 58}, {160, 132, 98}, {216, 194, 154}};
  return mapped(kMap, value);
}

} // namespace grouser::render
