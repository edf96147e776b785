// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/array.hpp"
#include "base/position.hpp"

#include <cstdint>

namespace grouser::bench {

/// Equal spheres for the bench of contact detection: `count` sites of a cubic lattice, as nearly a cube as can be, of
/// spacing kSpacing diameters; each sphere is moved from its site by up to kJitter diameters along each axis, evenly at
/// random. So they overlap, and inside the block a sphere touches 6.0 others in the mean, 0 to 12.
///
/// Ids that follow each other lie far apart: id i has site (i * step) mod count, with a step near 0.618 count that has
/// no divisor in common with it. What sorting finds is not sorted before.
struct ContactSpheres {
  static constexpr double kSpacing = 0.8365, kJitter = 0.2; ///< [diameters]
  static constexpr std::int64_t kDiameter = 150'000'000;    ///< [units]

  /// Generated on the device, from `seed` and id alone.
  static base::Array<base::Position> make(const base::Exec& exec, std::int64_t count, std::uint64_t seed);
};

} // namespace grouser::bench
