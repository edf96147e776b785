// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

namespace grouser::scene {

/// Keys of [terrain] that apply to beds of grains only, except the keys of a sieve curve.
inline constexpr std::array kBedKeys = {"grain_radius",  "layers",   "depth",      "tile",       "radius_distribution",
                                        "radius_spread", "porosity", "fine_depth", "coarsening", "coarsest_radius",
                                        "spacing",       "jitter",   "packing"};
inline constexpr std::array kSieveKeys = {"sieve_size", "sieve_passing"};

} // namespace grouser::scene
