// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/position.hpp"
#include "contact/motion.hpp"

#include <cstddef>
#include <cstdint>

namespace grouser::contact {

/// State of the grains for load computations: device arrays by slot.
struct GrainsView {
  const base::Position* position;
  const Motion* motion;
  const std::uint32_t* id;
  std::size_t count;                    ///< slots
  const std::uint32_t* ghost = nullptr; ///< not 0 for grains of other ranks, whose loads are theirs to compute; null
                                        ///< where there are none
};

} // namespace grouser::contact
