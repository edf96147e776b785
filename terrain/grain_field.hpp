// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/array.hpp"
#include "contact/exchange.hpp"
#include "terrain/grain_state.hpp"

#include <cstdint>
#include <vector>

namespace grouser::terrain {

/// Uses of a grain field. A field without uses is rebuilt with each neighbour or boundary list.
enum FieldUse : unsigned {
  kSorted = 1u << 0,   ///< permuted when the grains are sorted in space
  kMigrates = 1u << 1, ///< transferred with the grain to another rank
  kGhosted = 1u << 2,  ///< copied from the master to a new ghost
  kUpdated = 1u << 3,  ///< also copied after every step
  kBuffered = 1u << 4, ///< double-buffered: a step reads `now`, as neighbours do, and writes `next`
};

/// Grain field: `width` values of T per slot, on the device.
template <class T> struct GrainField {
  using StateMember = std::vector<T> GrainState::*;
  /// `as`: member of GrainState for checkpoints and the state hash; null if GrainCheckpoint converts the values, or
  /// they can be recomputed.
  explicit GrainField(unsigned uses, StateMember as = nullptr) : use(uses), savedAs(as) {}

  unsigned use; ///< sum of FieldUse
  StateMember savedAs;
  std::size_t width{1}; ///< values per slot; 0: not used in this scene
  base::Array<T> now;
  base::Array<T> next; ///< kBuffered: values written by the step; between steps, the previous state

  bool has(FieldUse which) const { return width > 0 && (use & which) != 0; }
  /// Field for an exchange between ranks: `now`, or `next` if `written`. The step that writes `next` may still be
  /// running: packing follows it in stream order.
  contact::ExchangeField exchanged(bool written = false) {
    contact::ExchangeField field = contact::fieldOf(written ? next : now);
    field.words *= static_cast<std::uint32_t>(width);
    return field;
  }
};

} // namespace grouser::terrain
