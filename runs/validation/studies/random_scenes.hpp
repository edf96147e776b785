// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <string>

namespace grouser::studies {

/// A random scene.
struct RandomScene {
  int number = 0;
  std::string kind;       ///< "heap", "gas": one of kRandomKinds
  std::string toml;       ///< complete scene; time step "auto"
  int grains = 0;         ///< number
  double contacts = 0;    ///< duration in shortest contact times [-]
  double speed = 0;       ///< maximum physical speed: initial or fall speed, times the root of the mass ratio (small
                          ///< grains hit by large ones) [m/s]
  double energy = 0;      ///< initial kinetic energy, and potential energy above z = 0 [J]
  double restitution = 1; ///< minimum of its materials [-]
  double friction = 0;    ///< maximum of its materials [-]
  bool hertz = false, rolls = false, sticks = false, single = false; ///< law, rolling friction, cohesion, precision
};

/// Heap in a box; heap of two materials with radius ratios up to four; heap under high gravity; gas in a closed box;
/// loose grains above a plane, above a tilted box, in a pipe; two to four grains.
inline constexpr std::array<const char*, 8> kRandomKinds = {"heap",  "mixture", "pressed", "gas",
                                                            "plane", "box",     "pipe",    "few"};

/// Scene `number` of `seed`. Uniform in the logarithm: linear stiffness 1e3 to 1e9 N/m, Young's modulus 1e5 to 1e11
/// Pa, smallest radius 1 to 100 mm, density 250 to 25,000 kg/m3. Uniform: restitution 0.05 to 1, friction up to 1,
/// tangential ratios; sometimes no friction, rolling friction, cohesion, attractive dashpots. Speeds and gravity are
/// chosen such that overlaps are at most some percent of the radius and grains collide many times.
RandomScene randomScene(std::uint64_t seed, int number);

} // namespace grouser::studies
