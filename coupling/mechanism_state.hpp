// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/contacts_state.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace grouser::coupling {

/// Contacts of bodies with shapes, and sums for output.
struct TouchingState {
  ContactsState contacts;
  std::vector<base::Vec3l> forces; ///< sum of forces on each shape and surface since the last row, in quanta
  std::int64_t meanSteps{};        ///< steps in that sum
  std::vector<double> appliedWork; ///< AppliedLoads::save()
};

/// State of a mechanism that later steps or later output depend on, for checkpoint and hash.
struct MechanismState {
  std::vector<double> bodies; ///< multibody::State::save()
  std::vector<double> worst;  ///< constraint errors since the last row
  std::vector<double> judged; ///< state of the tension check

  std::vector<double> control; ///< error-controlled steps: the next [s], how many, rejected, smallest, largest [s]

  std::optional<TouchingState> touching; ///< empty where bodies touch nothing

  /// For the hash: the data that the next step depends on.
  std::vector<std::uint32_t> words() const;
};

} // namespace grouser::coupling
