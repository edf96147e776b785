// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/part_motion.hpp"
#include "scm/facets.hpp"

#include <cstddef>
#include <vector>

namespace grouser::scm {

/// Width b of Bekker's relation in the current orientation [m]: smaller horizontal side, or radius of a round area.
double breadthOf(const Solid& solid, const contact::PartMotion& motion);

/// The same for each of `count` solids of one body; `motion`: indexed by part. Solids that touch each other and have
/// their undersides at one level, within a twentieth of their smaller width, are one plate: its width is the smaller
/// side of the rectangle around them, along the axes of the largest.
std::vector<double> breadthsOf(const Solid* solids, std::size_t count, const contact::PartMotion* motion);

} // namespace grouser::scm
