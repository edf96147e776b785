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
  const std::uint32_t* ghost = nullptr; ///< nonzero for ghosts: their own rank computes their loads; null
                                        ///< without ghosts
};

} // namespace grouser::contact
