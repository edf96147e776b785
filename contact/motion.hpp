// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"

namespace grouser::contact {

/// Motion of a grain in a 32-byte record, the size of a GPU memory transaction.
struct alignas(32) Motion {
  base::Vec4f velocity; ///< [m/s]; w: radius [m] if radii differ; negative for fixed grains (-radius or -1)
  base::Vec4f spin;     ///< [rad/s]; w: material index if there are several
};

} // namespace grouser::contact
