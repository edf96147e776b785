// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/simd_rows.hpp"

/// Types for four bodies or joints of one kind, one per lane. The formulas are as in base/vec.hpp, with Lanes
/// instead of double.
namespace grouser::multibody::detail {

inline constexpr int kLanes = 4;
using Lanes = base::Simd<double, kLanes>;
using Vec3L = base::Vec3<Lanes>;
using Mat3L = base::Mat3<Lanes>;
using LaneMask = decltype(Lanes{} < Lanes{});

using base::gatherRows;
using base::squareRoot;

GROUSER_SIMD Lanes all(double x) { return base::broadcast<Lanes>(x); }
GROUSER_SIMD Vec3L all(const base::Vec3<double>& v) { return base::broadcast<Lanes>(v); }

} // namespace grouser::multibody::detail
