// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/contact_moment.hpp"
#include "contact/motion.hpp"
#include "terrain/compensated_sum.hpp"

#include <cstddef>
#include <cstdint>

namespace grouser::terrain {

using base::Vec4f;
using contact::Motion;

/// Load of walls, floor and surfaces on one grain in one step.
template <class Real> struct BoundaryLoad {
  base::Vec3<Real> force, torque; ///< [N], [N m] about the centre
  Real deepest;                   ///< overlap [m]
  Real unused;                    ///< pads the record to a multiple of 16 bytes
};
/// Boundary load with contact moments, for field measurements.
template <class Real> struct MeasuredBoundaryLoad : BoundaryLoad<Real> { contact::ContactMoment moment; };

/// True if a grain with this velocity record is fixed.
GROUSER_HD bool isFixed(const Vec4f& velocity) { return velocity.w < 0; }

/// Net number of crossings of the upper periodic boundary along x and y: the total displacement of the grain exceeds
/// the change of its position by this many periods.
struct Crossings {
  std::int32_t x, y;
};

/// Faults that stop a run; the smallest key (code, then grain id) is kept.
enum class Fault : std::uint64_t { notANumber = 1, through = 2, overlap = 3, speed = 4, range = 5, none = 255 };
inline constexpr std::uint64_t kNoFault = ~std::uint64_t{0}; ///< value of StepFlags::fault without a fault

/// Flags raised by the kernels of a step, read by the next step of a batch and by the host after the last one.
struct StepFlags {
  std::uint64_t fault; ///< Fault << 56 | grain id
  std::uint32_t stale; ///< a grain has moved half the skin
  std::uint32_t padding;
  bool raised() const { return stale != 0 || fault != kNoFault; }
};
// PeerReduction uses two 64-bit words: the minimum of `fault`, and the bitwise OR of the second word.
static_assert(sizeof(StepFlags) == 16 && offsetof(StepFlags, fault) == 0 && offsetof(StepFlags, stale) == 8);
inline constexpr StepFlags kNoFlags{kNoFault, 0, 0};

} // namespace grouser::terrain
