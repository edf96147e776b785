// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "terrain/grain_bookkeeping.hpp"
#include "terrain/grain_boundaries.hpp"
#include "terrain/grain_distribution.hpp"
#include "terrain/grain_laws.hpp"
#include "terrain/impulse_solver.hpp"

#include <memory>

namespace grouser::terrain {

/// Data of the scene's grains on this rank, shared by Grains, GrainStepper, GrainCheckpoint and others.
struct GrainSystem {
  /// `start`: all grains of the scene, on every rank. Throws InputError like Grains.
  GrainSystem(const base::Exec& exec, const GrainModel& model, const Boundaries& boundaries,
              const std::vector<GrainSpec>& start, const PartitionOptions& partition);

  base::Exec exec;
  base::Comm comm;
  GrainConstants constants;
  GrainLaws laws;
  GrainArrays arrays;
  GrainEnergyAccounting accounting;
  GrainBoundaries boundaries;
  contact::NeighbourList neighbours;
  std::unique_ptr<GrainDistribution> distribution; ///< null on a single rank
  std::unique_ptr<ImpulseSolver> impulses;         ///< null with penalty contacts
  std::size_t count;                               ///< number of ids assigned so far
  std::vector<std::uint32_t> gone;                 ///< ids of removed grains, ascending
  std::size_t fixedCount{0};                       ///< number of fixed grains
  std::int64_t steps{0}, rebuilds{0};              ///< steps taken; neighbour lists built

  std::size_t present() const { return count - gone.size(); } ///< grains present in the scene
  /// By slot: nonzero for ghosts; null if there are none.
  const std::uint32_t* ghosts() const { return distribution ? distribution->subdomain().ghostMarks() : nullptr; }
  /// Host copy of ghosts(); zeros if there are none.
  std::vector<std::uint32_t> ghostsOnHost() const;
  /// Rank with the subdomain that contains this position. The position may be at most one period outside.
  int ownerOf(const base::Position& place) const {
    return distribution
               ? distribution->subdomain().partition().view().ownerOf(constants.period.wrapped(base::toUnits(place)))
               : 0;
  }
  /// Returns the entering grains of this rank; their ids follow the existing ones. Throws InputError if two have the
  /// same position (both then belong to the same owner).
  EnteringGrains entering(const std::vector<GrainSpec>& grains, const std::vector<base::Position>& places) const;
  void finishGhostUpdate() {
    if (distribution) distribution->finishGhostUpdate(exec, arrays);
  }

  /// Grain radii for the neighbour list; `sphere` is unset if all radii are equal, `fixed` if no grain is fixed.
  contact::RadiiInW radii() const;
  /// Returns the kernel data, except the flags and the loads of rigid parts.
  GrainKernelData kernelData();
  template <class Real> ForceData<Real> forceData();
  std::size_t deviceBytes() const;
};

} // namespace grouser::terrain
