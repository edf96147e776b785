// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "terrain/grain_system.hpp"

namespace grouser::terrain {

/// Saves and restores the state of the grains on the host, free of slots, devices and lists. On several ranks all of
/// them call everything here.
class GrainCheckpoint {
public:
  /// On several ranks this rank's block of ids.
  static GrainState state(const GrainSystem& system);
  /// x, y, z [m] of this rank's grains in the order of their ids, to memory for three numbers each.
  static void readPositions(const GrainSystem& system, double* xyz);
  static GrainSnapshot snapshot(const GrainSystem& system, const SnapshotOptions& options);

  /// Sends each row to the rank that owns its grain. Throws InputError when they are of other grains.
  /// `grows`: there may be more than the scene has.
  GrainCheckpoint(const GrainState& saved, const GrainSystem& system, bool grows);

  // The neighbour list is built at the places where the saved run built its last one, so that it ends at the same step.
  // So the state is loaded in two parts, and the neighbours are listed in between.
  void loadAsListed(GrainSystem& system) const;
  /// Returns whether the list is valid for the next step. Throws InputError where it lacks contacts that were saved.
  bool loadAsSaved(GrainSystem& system) const;

private:
  base::Position placeAtList(const GrainState& rows, std::size_t k) const;
  void loadBoundarySprings(GrainSystem& system) const;
  bool loadPlaces(GrainSystem& system, const std::vector<std::uint32_t>& id) const;
  void loadContacts(GrainSystem& system, const std::vector<std::uint32_t>& id) const;
  std::size_t rowOf(std::uint32_t id) const;

  bool asThen_;    ///< same skin as the saved run: the list is built at the places of its last rebuild
  GrainState own_; ///< rows of this rank's grains, in the order of their ids
};

} // namespace grouser::terrain
