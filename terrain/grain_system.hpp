// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "terrain/grain_bookkeeping.hpp"
#include "terrain/grain_boundaries.hpp"
#include "terrain/grain_distribution.hpp"
#include "terrain/grain_laws.hpp"
#include "terrain/impulse_solver.hpp"

#include <memory>

namespace grouser::terrain {

/// What the grains of a scene consist of on this rank. Data only: GrainStepper, GrainCheckpoint and the like work on
/// it, in the order that Grains calls them.
struct GrainSystem {
  /// `start`: all grains of the scene, on every rank. Throws InputError as Grains does.
  GrainSystem(const base::Exec& exec, const GrainModel& model, const Boundaries& boundaries,
              const std::vector<GrainSpec>& start, const PartitionOptions& partition);

  base::Exec exec;
  base::Comm comm;
  GrainConstants constants;
  GrainLaws laws;
  GrainArrays arrays;
  GrainBookkeeping books;
  GrainBoundaries boundaries;
  contact::NeighbourList neighbours;
  std::unique_ptr<GrainDistribution> distribution; ///< null on one rank
  std::unique_ptr<ImpulseSolver> impulses;         ///< null where contacts are springs
  std::size_t count;                               ///< ids given so far
  std::vector<std::uint32_t> gone;                 ///< those of grains that were taken out, ascending
  std::size_t fixedCount{0};                       ///< those of them that never move
  std::int64_t steps{0}, rebuilds{0};              ///< steps taken; neighbour lists made

  std::size_t present() const { return count - gone.size(); } ///< grains of the scene that are there
  /// By slot: not 0 for ghosts; null where there are none.
  const std::uint32_t* ghosts() const { return distribution ? distribution->subdomain().ghostMarks() : nullptr; }
  /// The same on the host, zeros where there are none.
  std::vector<std::uint32_t> ghostsOnHost() const;
  /// The rank whose subdomain holds this place; at most a period outside.
  int ownerOf(const base::Position& place) const {
    return distribution
               ? distribution->subdomain().partition().view().ownerOf(constants.period.wrapped(base::toUnits(place)))
               : 0;
  }
  /// Those of the grains that belong to this rank; their ids follow those of the grains that are here. Throws
  /// InputError when two have the same place (which have one owner).
  EnteringGrains entering(const std::vector<GrainSpec>& grains, const std::vector<base::Position>& places) const;
  void finishGhostUpdate() {
    if (distribution) distribution->finishGhostUpdate(exec, arrays);
  }

  /// Of grains that are not all alike, as the neighbour list takes them.
  contact::RadiiInW radii() const;
  /// All but loads of rigid parts, and flags.
  GrainKernelData kernelData();
  template <class Real> ForceData<Real> forceData();
  std::size_t deviceBytes() const;
};

} // namespace grouser::terrain
