// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace grouser::runs {

/// Device memory that a grain of a scene will take, by what it is for [bytes]: sizes of the records times the places
/// that are kept, before anything is allocated.
struct GrainMemory {
  double state{};      ///< places, velocities, spins of this step and the next, remainders, id
  double lists{};      ///< neighbours, of this rebuild and the last, and the search for them
  double history{};    ///< springs and rolling angles of contacts between grains
  double boundaries{}; ///< touch with planes and floor, and history there
  double ledger{};     ///< dissipated energy
  double total() const { return state + lists + history + boundaries + ledger; }
};

/// `historyWidth`: numbers of history of a contact, 0 without friction, 3 with, 6 with rolling resistance.
/// `boundaries`: planes and floor. Lists that have grown, for very unlike radii, take more.
GrainMemory grainMemory(int historyWidth, int boundaries, bool ledger = true);

} // namespace grouser::runs
