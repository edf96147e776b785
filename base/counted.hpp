// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace grouser::base {

/// Formats a number with its noun: "1 seed", "3 seeds". `many` is the plural, by default `one` with an s.
template <class Number> std::string counted(Number number, const std::string& one, const std::string& many = {}) {
  return std::to_string(number) + " " + (number == 1 ? one : many.empty() ? one + "s" : many);
}

} // namespace grouser::base
