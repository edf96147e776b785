// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/contacts_state.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace grouser::vehicle {
struct Assembly;
} // namespace grouser::vehicle

namespace grouser::coupling {

/// Vehicle state that later steps or output depend on, for checkpoint and hash.
struct VehicleState {
  double lift{};                 ///< lift at its placement; see VehicleRig
  std::vector<double> bodies;    ///< multibody::State::save()
  std::vector<double> observers; ///< vehicle::Observer::save()
  std::vector<double> driver;    ///< vehicle::Driver::save()
  std::vector<double> asked;     ///< vehicle::Handover::save() of the last step, used by a branch
  std::vector<double> hitch;     ///< vehicle::Hitch::save(); empty without one
  ContactsState contacts;

  // Sums for output and alarm, in quanta of force.
  std::vector<base::Vec3l> groundForces; ///< sums by part and surface, since the last output row
  std::int64_t meanSteps{};              ///< number of steps in groundForces
  std::vector<base::Vec3l> alarmForces;  ///< sums by part and surface, since the last alarm check
  std::int64_t alarmSteps{};             ///< number of steps in alarmForces
  std::vector<double> judged;            ///< SwingGrowth::save(), vehicle::BlowMeter::save()
  std::vector<double> hitchSums;         ///< Towing::saveSums()
  std::vector<double> appliedWork;       ///< AppliedLoads::save()
  std::int64_t stalledSteps{};           ///< steps in which driven tracks have not moved the hull

  /// Words of the state hash: the data that the next step depends on.
  std::vector<std::uint32_t> words() const;
};

/// Message with the three largest dissipations in shoe contacts since the start [J], by sprocket, idler, wheels and
/// rollers of each side, and rigid ground.
std::string mostDissipatingPart(const vehicle::Assembly& assembly, const VehicleState& state);

} // namespace grouser::coupling
