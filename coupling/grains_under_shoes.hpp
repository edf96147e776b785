// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "terrain/grains.hpp"
#include "vehicle/assembly.hpp"

namespace grouser::coupling {

/// By how much an assembled vehicle must be lifted so that no grain stands in a shoe that looks down [m]; 0 where none
/// does. The surface of a bed, on which it is set down, is smooth: single stones reach above it. Of each grain the
/// highest point counts, and beside a pad what reaches under it, so that the lift may be some tenths of a millimetre
/// more than is needed. The same on all ranks.
double liftOffGrains(const vehicle::Assembly& assembly, const terrain::Grains& grains);

} // namespace grouser::coupling
