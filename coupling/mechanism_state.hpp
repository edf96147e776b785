// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/contacts_state.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace grouser::coupling {

/// State of contacts of bodies with shapes, and sums for output.
struct TouchingState {
  ContactsState contacts;
  std::vector<base::Vec3l> forces; ///< sum of forces on each shape and surface since the last output row, in quanta
  std::int64_t meanSteps{};        ///< number of steps in that sum
  std::vector<double> appliedWork; ///< AppliedLoads::save()
};

/// Mechanism state that later steps or output depend on, for checkpoint and hash.
struct MechanismState {
  std::vector<double> bodies; ///< multibody::State::save()
  std::vector<double> worst;  ///< maximum constraint errors since the last output row
  std::vector<double> judged; ///< state of the tension check

  std::vector<double> control; ///< error-controlled steps: next step [s], number, rejected, minimum, maximum [s]

  std::optional<TouchingState> touching; ///< empty if bodies have no contacts

  /// Words of the state hash: the data that the next step depends on.
  std::vector<std::uint32_t> words() const;
};

} // namespace grouser::coupling
