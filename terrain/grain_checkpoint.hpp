// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "terrain/grain_system.hpp"

namespace grouser::terrain {

/// Saves and restores the state of the grains on the host, independent of slots, devices and lists. All functions are
/// collective.
class GrainCheckpoint {
public:
  /// Returns the state of all grains; on several ranks, only of this rank's block of ids.
  static GrainState state(const GrainSystem& system);
  /// Writes x, y, z [m] of this rank's grains, sorted by id, to memory for three numbers each.
  static void readPositions(const GrainSystem& system, double* xyz);
  static GrainSnapshot snapshot(const GrainSystem& system, const SnapshotOptions& options);

  /// Sends each row to the rank that owns its grain. Throws InputError if the rows belong to other grains. `grows`: the
  /// state may have more grains than the scene.
  GrainCheckpoint(const GrainState& saved, const GrainSystem& system, bool grows);

  // The neighbour list is built at the positions of the saved run's last list, so that it expires at the same step. The
  // state is therefore loaded in two parts, with the listing in between.
  void loadAsListed(GrainSystem& system) const;
  /// Returns true if the list is valid for the next step. Throws InputError if it lacks saved contacts.
  bool loadAsSaved(GrainSystem& system) const;

private:
  base::Position placeAtList(const GrainState& rows, std::size_t k) const;
  void loadBoundarySprings(GrainSystem& system) const;
  bool loadPlaces(GrainSystem& system, const std::vector<std::uint32_t>& id) const;
  void loadContacts(GrainSystem& system, const std::vector<std::uint32_t>& id) const;
  std::size_t rowOf(std::uint32_t id) const;

  bool asThen_;    ///< same skin as the saved run: the list is built at the positions of its last rebuild
  GrainState own_; ///< rows of this rank's grains, sorted by id
};

} // namespace grouser::terrain
