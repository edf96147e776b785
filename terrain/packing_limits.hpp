// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace grouser::terrain {

/// Porosity above which a bed at rest is not a random packing of spheres [-]: it arches, has not settled, or is too
/// thin to be measured. Random loose packings of rough spheres have 0.44 to 0.45 (Onoda and Liniger 1990, Phys. Rev.
/// Lett. 64, 2727; Jerkins et al. 2008, Phys. Rev. Lett. 100, 018001). With rolling friction, beds of up to 0.5 have
/// settled in this code (docs/soils.md#virtual-soil-tests); cohesive fine powders reach 0.5 to 0.6 (Yang, Zou and Yu
/// 2000, Phys. Rev. E 62, 3900). Each limit is 0.03 above the largest of these values.
constexpr double loosestPacking(bool rollingFriction, bool cohesion) {
  return cohesion ? 0.63 : rollingFriction ? 0.53 : 0.48;
}

/// Fraction of fixed grains above which most of a bed cannot move [-]: fewer than one layer of free grains on the rough
/// floor.
inline constexpr double kMaxFixed = 0.5;

} // namespace grouser::terrain
