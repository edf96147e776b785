// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vehicle/wrap.hpp"

namespace grouser::test {

/// Shoes with both pins on the ground run: [first, last].
inline int firstGroundShoe(const vehicle::Wrap& wrap) {
  const auto& n = wrap.counts;
  return wrap.sprocketInFront ? n.top + n.idler + n.frontStrand : n.sprocket + n.rearStrand;
}
inline int lastGroundShoe(const vehicle::Wrap& wrap) { return firstGroundShoe(wrap) + wrap.counts.ground - 1; }

} // namespace grouser::test
