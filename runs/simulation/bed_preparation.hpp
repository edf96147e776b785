// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/simulation/ground.hpp"

namespace grouser::simulation {

/// Lets the grains rest as `wanted`: until the mean kinetic energy a grain is below that share of m g radius, and the
/// mean resultant force below that share of the weight where one is named, for a whole tenth of a second, but at least
/// for the time that a grain takes to fall `fall` [m]. Adds to `report`. Throws SimulationError when the time limit
/// passes first, or when the grains meet a fault.
void settleUntilRest(const setup::BedSetup& bed, const setup::SettleSetup& wanted, terrain::Grains& grains, double fall,
                     const SettleProgress& progress, SettleReport& report);

/// Lets a loose bed come to rest with `friction` [-] between its grains, and then with their own.
void settleWithFriction(const setup::BedSetup& bed, terrain::Grains& grains, double friction,
                        const SettleProgress& progress, SettleReport& report);

/// The friction that has to act while a bed settles for it to have the porosity wanted: by bisection on small beds,
/// until one is within 0.002 of it. The same on every device and rank, each of which does all of it. Throws InputError
/// with the porosities that can be reached where the one wanted cannot.
double frictionFor(const setup::PreparationSetup& preparation, const base::Exec& exec, const SettleProgress& progress);

} // namespace grouser::simulation
