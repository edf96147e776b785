// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <string>

namespace grouser::studies {

/// A random scene.
struct RandomScene {
  int number = 0;
  std::string kind;    ///< one of kRandomKinds, e.g. "gas"
  std::string toml;    ///< complete scene with time_step = "auto"
  int grains = 0;      ///< number of grains
  double contacts = 0; ///< duration of the run / shortest contact time [-]
  double speed = 0;    ///< maximum physical speed: initial speed or fall speed, times the root of the mass ratio
  ///< (large grains can hit small ones) [m/s]
  double energy = 0;      ///< initial kinetic energy plus potential energy above z = 0 [J]
  double restitution = 1; ///< minimum of the materials [-]
  double friction = 0;    ///< maximum of the materials [-]
  bool hertz = false, rolls = false, sticks = false, single = false; ///< law, rolling friction, cohesion, precision
};

/// heap: heap in a box; mixture: heap of two materials with radius ratios up to 4; pressed: heap under high gravity;
/// gas: gas in a closed box; plane, box, pipe: loose grains above a plane, above a tilted box, in a pipe; few: two to
/// four grains.
inline constexpr std::array<const char*, 8> kRandomKinds = {"heap",  "mixture", "pressed", "gas",
                                                            "plane", "box",     "pipe",    "few"};

/// Scene `number` of `seed`. Parameters with a uniform logarithm: linear stiffness 1e3 to 1e9 N/m, Young's modulus 1e5
/// to 1e11 Pa, smallest radius 1 to 100 mm, density 250 to 25,000 kg/m3. Uniform parameters: restitution 0.05 to 1,
/// friction up to 1, tangential ratios. Some scenes have no friction; some have rolling friction, cohesion or
/// attractive dashpots. Speeds and gravity limit overlaps to some percent of the radius; grains collide many times.
RandomScene randomScene(std::uint64_t seed, int number);

} // namespace grouser::studies
