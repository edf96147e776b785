// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/contacts_state.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace grouser::coupling {

/// Contacts of bodies with shapes, and what output needs of them.
struct TouchingState {
  ContactsState contacts;
  std::vector<base::Vec3l> forces; ///< sum of forces on each shape and surface since the last row, in quanta
  std::int64_t meanSteps{};        ///< steps in that sum
  std::vector<double> appliedWork; ///< AppliedLoads::save()
};

/// All of a mechanism on which later bits or later output depend: what a checkpoint holds and a hash is taken of.
struct MechanismState {
  std::vector<double> bodies; ///< multibody::State::save()
  std::vector<double> worst;  ///< what the next row says of the steps since the last one
  std::vector<double> judged; ///< what the next judgement of the pull in joints goes on from

  std::vector<double> control; ///< error-controlled steps: the next [s], how many, rejected, smallest, largest [s]

  std::optional<TouchingState> touching; ///< empty where bodies touch nothing

  /// For the hash: what the next step depends on.
  std::vector<std::uint32_t> words() const;
};

} // namespace grouser::coupling
