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

/// Load of walls and floor on one grain in one step.
template <class Real> struct BoundaryLoad {
  base::Vec3<Real> force, torque; ///< [N], [N m] about the centre
  Real deepest;                   ///< overlap [m]
  Real unused;                    ///< of a record of whole 16 bytes
};
/// The same with contact moments, for field measurements.
template <class Real> struct MeasuredBoundaryLoad : BoundaryLoad<Real> { contact::ContactMoment moment; };

/// Whether a grain with this velocity is fixed.
GROUSER_HD bool isFixed(const Vec4f& velocity) { return velocity.w < 0; }

/// Net number of times a grain left through the upper side along x and y and entered through the lower one: its total
/// displacement is that many periods more than its position shows.
struct Crossings {
  std::int32_t x, y;
};

/// Faults that stop a run; the smallest key (code, then grain id) is kept.
enum class Fault : std::uint64_t { notANumber = 1, through = 2, overlap = 3, speed = 4, range = 5, none = 255 };
inline constexpr std::uint64_t kNoFault = ~std::uint64_t{0}; ///< in StepFlags

/// Raised by the kernels of a step, read by the next step of a batch and by the host after the last one.
struct StepFlags {
  std::uint64_t fault; ///< Fault << 56 | grain id
  std::uint32_t stale; ///< a grain has moved half the skin
  std::uint32_t padding;
  bool raised() const { return stale != 0 || fault != kNoFault; }
};
// PeerReduction works on two words of 64 bits: the minimum of `fault`, and the bits of what follows it.
static_assert(sizeof(StepFlags) == 16 && offsetof(StepFlags, fault) == 0 && offsetof(StepFlags, stale) == 8);
inline constexpr StepFlags kNoFlags{kNoFault, 0, 0};

} // namespace grouser::terrain
