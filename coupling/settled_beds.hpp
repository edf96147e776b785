// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/comm.hpp"
#include "coupling/settled_ground.hpp"

namespace grouser::coupling {

/// Source of stored settled beds.
class SettledBeds {
public:
  SettledBeds() = default;
  SettledBeds(const SettledBeds&) = default;
  SettledBeds(SettledBeds&&) = default;
  SettledBeds& operator=(const SettledBeds&) = default;
  SettledBeds& operator=(SettledBeds&&) = default;
  virtual ~SettledBeds() = default;
  /// Returns the same ground as settledGround(), bit for bit. Collective.
  virtual SettledGround settle(const GroundSetup& setup, const base::Exec& exec, const SettleProgress& progress,
                               const base::Comm& comm) = 0;
};

} // namespace grouser::coupling
