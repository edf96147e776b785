// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/array.hpp"
#include "base/position.hpp"

#include <cstdint>

namespace grouser::bench {

/// Equal spheres for the contact detection benchmark. They occupy `count` sites of a nearly cubic block of a cubic
/// lattice with a spacing of kSpacing diameters, with uniform random displacements of up to kJitter diameters along
/// each axis. A sphere inside the block has 6.0 contacts on average (0 to 12).
///
/// Spheres with consecutive ids are far apart, so that the input is not sorted: id i has the site (i * step) mod count.
/// The step is near 0.618 count and coprime to count.
struct ContactSpheres {
  static constexpr double kSpacing = 0.8365, kJitter = 0.2; ///< [diameters]
  static constexpr std::int64_t kDiameter = 150'000'000;    ///< [units]

  /// Generates the spheres on the device; the positions depend only on `seed` and id.
  static base::Array<base::Position> make(const base::Exec& exec, std::int64_t count, std::uint64_t seed);
};

} // namespace grouser::bench
