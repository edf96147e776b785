// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

namespace grouser::multibody::detail {

/// Bodies, joints and rows are numbered by int, -1 for none; containers by size_t.
constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }

} // namespace grouser::multibody::detail
