// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/settled_ground.hpp"

#include "base/error.hpp"
#include "coupling/tiled_bed.hpp"

#include <algorithm>

namespace grouser::coupling {

namespace {

/// Settled grains of a tile. Throws SimulationError if they do not settle. Every rank has all of them.
std::unique_ptr<terrain::Grains> settledTile(const TileSetup& tile, const base::Exec& exec,
                                             const SettleProgress& progress, const FoundFrictions* found) {
  LaidGround ground = buildGround(*tile.ground, exec);
  const BedSetup& bed = *tile.ground->grains->bed;
  if (bed.settle.timeLimit > 0) settle(bed, ground, SettleProgress(progress.report), found);
  return std::move(ground.grains);
}

std::vector<terrain::GrainSpec> tiledGrains(const GroundSetup& setup, const BedSetup& bed, const TiledBed& tiles) {
  std::vector<terrain::GrainSpec> start = tiles.start(bed.material);
  if (std::any_of(start.begin(), start.end(),
                  [&](const auto& g) { return !g.fixed && isTaken(setup, g.position, g.radius); }))
    throw base::InputError(bed.tile->inTheWay);
  return start;
}

} // namespace

LaidGround buildGround(const GroundSetup& setup, const base::Exec& exec, const base::Comm& comm,
                       const SettleProgress& progress, const FoundFrictions* found) {
  const BedSetup* bed = setup.grains && setup.grains->bed ? &*setup.grains->bed : nullptr;
  if (bed && bed->alone) return buildGround(*bed->alone, exec, comm, progress, found);
  if (!bed || !bed->tile) return layGround(setup, exec, comm);
  const TiledBed tiles(*bed->tile, *settledTile(*bed->tile, exec, progress, found), *setup.surface);
  const std::vector<terrain::GrainSpec> start = tiledGrains(setup, *bed, tiles);
  LaidGround ground = layGround(setup, exec, comm, &start);
  tiles.bringToRest(*ground.grains, setup.grains->boundaries.walls.size()); // the floor is listed after the walls
  return ground;
}

SettledGround settledGround(const GroundSetup& setup, const base::Exec& exec, const SettleProgress& progress,
                            const base::Comm& comm) {
  SettledGround settled{buildGround(setup, exec, comm, progress), {}};
  const BedSetup& bed = *setup.grains->bed;
  if (bed.settle.timeLimit > 0) settled.report = settle(bed, settled.ground, progress);
  return settled;
}

} // namespace grouser::coupling
