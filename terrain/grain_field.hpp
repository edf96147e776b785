// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/array.hpp"
#include "contact/exchange.hpp"
#include "terrain/grain_state.hpp"

#include <cstdint>
#include <vector>

namespace grouser::terrain {

/// Uses of a field of the grains. A field without any is rebuilt with each list of neighbours or boundaries.
enum FieldUse : unsigned {
  kSorted = 1u << 0,   ///< moves when the grains are sorted in space
  kMigrates = 1u << 1, ///< moves with the grain to another rank
  kGhosted = 1u << 2,  ///< copied from the master to a new ghost
  kUpdated = 1u << 3,  ///< ... and again after every step
  kBuffered = 1u << 4, ///< a step reads `now` and writes `next`, for neighbours still read `now`
};

/// One field of the grains: `width` values of T by slot, on the device.
template <class T> struct GrainField {
  using StateMember = std::vector<T> GrainState::*;
  /// `as`: member of GrainState for checkpoints and the state hash; null if GrainCheckpoint converts the values, or if
  /// they can be recomputed.
  explicit GrainField(unsigned uses, StateMember as = nullptr) : use(uses), savedAs(as) {}

  unsigned use; ///< sum of FieldUse
  StateMember savedAs;
  std::size_t width{1}; ///< 0: this scene has no such field
  base::Array<T> now;
  base::Array<T> next; ///< of kBuffered: what the step writes; between steps, the state before the last step

  bool has(FieldUse which) const { return width > 0 && (use & which) != 0; }
  /// For an exchange between ranks of `now`, or of `next` if `written`. The step that writes `next` may still be
  /// running: the exchange packs behind it in stream order.
  contact::ExchangeField exchanged(bool written = false) {
    contact::ExchangeField field = contact::fieldOf(written ? next : now);
    field.words *= static_cast<std::uint32_t>(width);
    return field;
  }
};

} // namespace grouser::terrain
