// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/settling.hpp"

namespace grouser::coupling {

/// Lays the grains and places the walls. Nothing moves yet, but a tile that is to be copied
/// settles, which `progress` watches. Where more is put
/// on a bed once it has settled (placed_on_bed.hpp), the ground is the bed alone.
/// On several ranks each takes the grains of its subdomain. `found`: as frictionFor() has it.
LaidGround buildGround(
    const GroundSetup& setup, const base::Exec& exec, const base::Comm& comm = {},
    const SettleProgress& progress = [](double, double) {}, const FoundFrictions* found = nullptr);

/// A ground whose bed has come to rest.
struct SettledGround {
  LaidGround ground;
  SettleReport report;
};
/// Builds it, and lets its bed settle where the scene gives that time.
SettledGround settledGround(const GroundSetup& setup, const base::Exec& exec, const SettleProgress& progress,
                            const base::Comm& comm = {});

} // namespace grouser::coupling
