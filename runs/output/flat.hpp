// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"

#include <vector>

namespace grouser::output {

/// Components of all vectors in sequence, in single precision.
template <class T> std::vector<float> flat(const std::vector<base::Vec3<T>>& vectors) {
  std::vector<float> numbers;
  numbers.reserve(3 * vectors.size());
  for (const base::Vec3<T>& v : vectors)
    for (int a = 0; a < 3; ++a) numbers.push_back(static_cast<float>(v[a]));
  return numbers;
}

} // namespace grouser::output
