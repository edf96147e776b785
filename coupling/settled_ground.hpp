// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/settling.hpp"

namespace grouser::coupling {

/// Creates grains and walls. Only a tile to be copied settles here (observed by `progress`). If objects are placed on
/// the settled bed (placed_on_bed.hpp), the ground contains only the bed. Each rank has the grains of its subdomain.
/// `found`: as in frictionFor().
LaidGround buildGround(
    const GroundSetup& setup, const base::Exec& exec, const base::Comm& comm = {},
    const SettleProgress& progress = [](double, double) {}, const FoundFrictions* found = nullptr);

/// Ground with a settled bed.
struct SettledGround {
  LaidGround ground;
  SettleReport report;
};
/// Builds the ground, and settles its bed if the scene specifies a time limit for it.
SettledGround settledGround(const GroundSetup& setup, const base::Exec& exec, const SettleProgress& progress,
                            const base::Comm& comm = {});

} // namespace grouser::coupling
