// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"

#include <array>
#include <cstdint>

namespace grouser::render {

/// Colour in linear RGB, each component from 0 to 1.
using Colour = base::Vec3f;

/// Linear colour of an sRGB triple 0 to 255.
Colour srgb(int red, int green, int blue);
/// sRGB triple of a linear colour.
std::array<std::uint8_t, 3> toSrgb(const Colour& colour);

/// Colour of rigid ground and of undisturbed deformable soil.
Colour groundColour();

/// Perceptually uniform colour map from dark violet over green to yellow; `value` is clamped to 0 to 1.
Colour heightColour(float value);
/// Colour map of soil, from dark brown (0: deep) to light brown (1: surface); `value` is clamped.
Colour soilColour(float value);

} // namespace grouser::render
