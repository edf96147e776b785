// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "terrain/grains.hpp"
#include "vehicle/assembly.hpp"

namespace grouser::coupling {

/// Additional lift of an assembled vehicle so that no grain overlaps a downward shoe [m]; 0 if none does. The bed
/// surface that supports the vehicle is smooth: single stones protrude from it. Uses the highest point of each grain,
/// or for a grain beside a pad the part under it, so the lift may be some tenths of a millimetre too large. Equal on
/// all ranks.
double liftOffGrains(const vehicle::Assembly& assembly, const terrain::Grains& grains);

} // namespace grouser::coupling
