// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <string>

namespace grouser::studies {

/// A scene drawn at random, as a user could have written it.
struct RandomScene {
  int number = 0;
  std::string kind;       ///< "heap", "gas": one of kRandomKinds
  std::string toml;       ///< the whole scene; its time step is "auto"
  int grains = 0;         ///< in all
  double contacts = 0;    ///< how many of its shortest contacts it lasts [-]
  double speed = 0;       ///< that a grain can fall or start with; times the root of the ratio of masses, which is what
                          ///< large ones can drive small ones to [m/s]
  double energy = 0;      ///< kinetic at the start, and potential above z = 0 [J]
  double restitution = 1; ///< the smallest of its materials [-]
  double friction = 0;    ///< the largest [-]
  bool hertz = false, rolls = false, sticks = false, single = false; ///< law, rolling friction, cohesion, precision
};

/// Heaps in a box, the same with two materials and radii up to four times as large, heaps pressed by much gravity,
/// gases in a closed box, loose grains over a plane, over a tilted box, in a pipe; two to four grains alone.
inline constexpr std::array<const char*, 8> kRandomKinds = {"heap",  "mixture", "pressed", "gas",
                                                            "plane", "box",     "pipe",    "few"};

/// Scene `number` of `seed`. Drawn evenly over their logarithms: linear stiffness from 1e3 to 1e9 N/m, Young's modulus
/// from 1e5 to 1e11 Pa, the smallest radius from 1 to 100 mm, density from 250 to 25,000 kg/m3. Evenly: restitution
/// from 0.05 to 1, friction up to 1, tangential ratios; now and then none of these, rolling friction, cohesion,
/// dashpots that pull. Speeds and gravity follow from these, so that grains overlap by percents of their radius at most
/// and meet many times.
RandomScene randomScene(std::uint64_t seed, int number);

} // namespace grouser::studies
