// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"

#include <cmath>
#include <vector>

namespace grouser::output {

/// Whether a number in a file is a possible coordinate or radius [m]: finite, and within the largest space.
inline bool isLength(float x) { return std::fabs(x) <= 1e7f; }

/// Components of all vectors in sequence, in single precision.
template <class T> std::vector<float> flat(const std::vector<base::Vec3<T>>& vectors) {
  std::vector<float> numbers;
  numbers.reserve(3 * vectors.size());
  for (const base::Vec3<T>& v : vectors)
    for (int a = 0; a < 3; ++a) numbers.push_back(static_cast<float>(v[a]));
  return numbers;
}

} // namespace grouser::output
