// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/grain_part_contacts.hpp"
#include "coupling/ground_setup.hpp"
#include "terrain/grains.hpp"

namespace grouser::coupling {

/// Constants of the contacts between grains and rigid parts made of spheres. `margin`: maximum travel of parts between
/// two pair searches [m].
contact::GrainPartModel grainPartModel(const GrainsSetup& setup, const terrain::Grains& grains, double margin);

} // namespace grouser::coupling
