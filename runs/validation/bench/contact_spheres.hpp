// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/array.hpp"
#include "base/position.hpp"

#include <cstdint>

namespace grouser::bench {

/// Equal spheres for the contact detection benchmark: `count` sites of a nearly cubic block of a cubic lattice with
/// spacing kSpacing diameters; uniform random displacements up to kJitter diameters along each axis. Spheres inside the
/// block have 6.0 contacts in the mean, 0 to 12.
///
/// Consecutive ids are far apart, so that the input is not sorted: id i has site (i * step) mod count, with a step near
/// 0.618 count that is coprime to count.
struct ContactSpheres {
  static constexpr double kSpacing = 0.8365, kJitter = 0.2; ///< [diameters]
  static constexpr std::int64_t kDiameter = 150'000'000;    ///< [units]

  /// Generated on the device from `seed` and id.
  static base::Array<base::Position> make(const base::Exec& exec, std::int64_t count, std::uint64_t seed);
};

} // namespace grouser::bench
