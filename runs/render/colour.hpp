// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"

#include <array>
#include <cstdint>

namespace grouser::render {

/// Linear colour, each 0 to 1.
using Colour = base::Vec3f;

/// Linear colour of an sRGB triple 0 to 255.
Colour srgb(int red, int green, int blue);
/// The sRGB triple of a linear colour.
std::array<std::uint8_t, 3> toSrgb(const Colour& colour);

/// Colour of rigid ground and of undisturbed deformable soil.
Colour groundColour();

/// A perceptually even colour map from dark violet over green to yellow; `value` 0 to 1, clamped.
Colour heightColour(float value);
/// Colours of soil, from dark (0: deep) to light brown (1: the surface), clamped.
Colour soilColour(float value);

} // namespace grouser::render
