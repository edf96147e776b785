// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"

#include <optional>
#include <vector>

namespace grouser::support {

/// Rotation from the keys `axis` with `angle` [deg], or from `orientation` = w, x, y, z (empty: not given); identity if
/// no key is given. Throws SectionFault.
base::Quat orientationOf(const std::optional<base::Vec3d>& axis, const std::optional<double>& angle,
                         const std::vector<double>& orientation);

/// The smallest rotation from the z axis to `direction`, which must not be zero.
base::Quat turnFromZ(const base::Vec3d& direction);

} // namespace grouser::support
