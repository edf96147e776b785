// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "terrain/grains.hpp"
#include "vehicle/assembly.hpp"

namespace grouser::coupling {

/// Extra lift of an assembled vehicle so that no grain overlaps a downward shoe [m]; 0 if none does. The surface of a
/// bed, on which it is placed, is smooth: single stones reach above it. The highest point of each grain counts, and of
/// one beside a pad the part under it, so that the lift may be some tenths of a millimetre too large. The same on all
/// ranks.
double liftOffGrains(const vehicle::Assembly& assembly, const terrain::Grains& grains);

} // namespace grouser::coupling
