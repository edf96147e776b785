// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"
#include "contact/saved_contacts.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace grouser::coupling {

/// History of all contacts of the parts of a vehicle or of bodies, as saved by PartContacts.
struct ContactsState {
  contact::SavedPatches track;    ///< shoes with sprocket, wheels, rollers and idler
  contact::SavedPatches ground;   ///< feet with rigid ground; empty without it
  contact::SavedGrainPatches bed; ///< parts with grains; empty without grains
  contact::SavedPatches surfaces; ///< parts with fixed surfaces, and the hull with rigid ground
  base::Vec3l impulseOnParts;     ///< cumulative impulse / time step
  base::Vec3d angularOnParts;     ///< cumulative [N m s]

  /// Words of the state hash: the data that the next step depends on.
  std::vector<std::uint32_t> words() const;
};

/// Appends doubles to the words of a state hash.
void addWords(std::vector<std::uint32_t>& words, const double* numbers, std::size_t count);

} // namespace grouser::coupling
