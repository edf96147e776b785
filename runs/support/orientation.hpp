// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"

#include <optional>
#include <vector>

namespace grouser::support {

/// From the keys `axis` with `angle` [deg], or `orientation` = w, x, y, z instead (empty: not given); identity without
/// any of them. Throws SectionFault.
base::Quat orientationOf(const std::optional<base::Vec3d>& axis, const std::optional<double>& angle,
                         const std::vector<double>& orientation);

/// The smallest rotation from z to `direction`, which is not zero.
base::Quat turnFromZ(const base::Vec3d& direction);

} // namespace grouser::support
