// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/settling.hpp"

namespace grouser::coupling {

/// Lays the grains and places the walls. Only a tile to be copied settles here, observed by `progress`. If things are
/// placed on the settled bed (placed_on_bed.hpp), the ground is the bed alone. Each rank takes the grains of its
/// subdomain. `found`: as in frictionFor().
LaidGround buildGround(
    const GroundSetup& setup, const base::Exec& exec, const base::Comm& comm = {},
    const SettleProgress& progress = [](double, double) {}, const FoundFrictions* found = nullptr);

/// A ground with a settled bed.
struct SettledGround {
  LaidGround ground;
  SettleReport report;
};
/// Builds the ground, and settles its bed if the scene has a time limit for it.
SettledGround settledGround(const GroundSetup& setup, const base::Exec& exec, const SettleProgress& progress,
                            const base::Comm& comm = {});

} // namespace grouser::coupling
