// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "terrain/grains.hpp"
#include "vehicle/assembly.hpp"

namespace grouser::coupling {

/// Additional lift of an assembled vehicle so that no grain overlaps a downward shoe [m]; 0 if no grain does. Single
/// stones protrude from the smooth bed surface on which the vehicle is placed. Uses the highest point of each grain;
/// for a grain beside a pad, its highest point under the pad. The lift may be some tenths of a millimetre too large.
/// Equal on all ranks.
double liftOffGrains(const vehicle::Assembly& assembly, const terrain::Grains& grains);

} // namespace grouser::coupling
