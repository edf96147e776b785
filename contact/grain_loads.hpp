// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/fixed_point.hpp"
#include "base/vec.hpp"

#include <cstdint>

namespace grouser::contact {

/// Overlap / (smaller) grain radius above which a contact counts as a large overlap [-].
inline constexpr double kDeepOverlap = 0.2;

/// Load of one rigid part on one grain in one step: force in quanta (the part receives exactly the opposite) and torque
/// about the grain's centre [N m].
struct GrainLoad {
  base::Vec3l force;
  base::Vec3f torque;
  float deepest; ///< overlap [m]; negative for a grain crushed to its centre
};

/// Kernel view of the loads from rigid parts. `range[i]` packs first * 256 + count of the loads of slot i.
struct GrainLoadsView {
  const std::uint32_t* range{nullptr};
  const GrainLoad* load{nullptr};
  base::FixedPoint force;             ///< quantum of the forces [N]
  std::int64_t* received{nullptr};    ///< cumulative force on the grains, x y z [quanta]
  const std::uint32_t* slot{nullptr}; ///< grain slot of each load, ascending
  std::int64_t count{0};              ///< number of loads
};

} // namespace grouser::contact
