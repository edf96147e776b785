// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"

namespace grouser::contact {

/// Motion of a grain in one record of 32 bytes, the size of a GPU fetch.
struct alignas(32) Motion {
  base::Vec4f velocity; ///< [m/s]; w: radius [m], if radii differ; negative for fixed grains (-radius or -1)
  base::Vec4f spin;     ///< [rad/s]; w: material, if there are several
};

} // namespace grouser::contact
