// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/for_each.cuh"

#include <cstdint>

namespace grouser::base {

/// Kernel body: to[i] = from[order[i]] for records of `width` elements.
template <class T> struct Gather {
  const std::uint32_t* order;
  const T* from;
  T* to;
  int width = 1;
  GROUSER_HD void operator()(int i) const {
    const std::int64_t source = static_cast<std::int64_t>(order[i]) * width,
                       target = static_cast<std::int64_t>(i) * width;
    for (int w = 0; w < width; ++w) to[target + w] = from[source + w];
  }
};

} // namespace grouser::base
