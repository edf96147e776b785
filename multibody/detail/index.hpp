// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

namespace grouser::multibody::detail {

/// Converts an int index to size_t: bodies, joints and rows have int indices (-1: no element); containers use size_t.
constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }

} // namespace grouser::multibody::detail
