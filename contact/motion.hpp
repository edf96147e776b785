// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"

namespace grouser::contact {

/// How a grain moves, in one record: a contact reads all of its neighbour's, and a GPU fetches 32 bytes at a time.
struct alignas(32) Motion {
  base::Vec4f velocity; ///< [m/s]; w: radius [m], where radii differ; of a fixed grain the opposite, or -1
  base::Vec4f spin;     ///< [rad/s]; w: material, where there are several
};

} // namespace grouser::contact
