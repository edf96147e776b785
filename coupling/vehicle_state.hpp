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

/// State of a vehicle that later steps or later output depend on, for checkpoint and hash.
struct VehicleState {
  double lift{};                 ///< at its placement; see VehicleRig
  std::vector<double> bodies;    ///< multibody::State::save()
  std::vector<double> observers; ///< vehicle::Observer::save()
  std::vector<double> driver;    ///< vehicle::Driver::save()
  std::vector<double> asked;     ///< vehicle::Handover::save() of the last step, the start of a branch
  std::vector<double> hitch;     ///< vehicle::Hitch::save(); empty without one
  ContactsState contacts;

  // Sums for output and alarm, in quanta of force.
  std::vector<base::Vec3l> groundForces; ///< by part and surface, since the last row
  std::int64_t meanSteps{};              ///< of that sum
  std::vector<base::Vec3l> alarmForces;  ///< by part and surface, since the last check of the track
  std::int64_t alarmSteps{};             ///< of that sum
  std::vector<double> judged;            ///< SwingGrowth::save(), vehicle::BlowMeter::save()
  std::vector<double> hitchBooks;        ///< Towing::saveSums()
  std::vector<double> appliedWork;       ///< AppliedLoads::save()
  std::int64_t stalledSteps{};           ///< steps in which driven tracks have not moved the hull

  /// For the hash: the data that the next step depends on.
  std::vector<std::uint32_t> words() const;
};

/// Text of the three largest dissipations in shoe contacts since the start, with joules: sprocket, idler, wheels and
/// rollers of each side, rigid ground.
std::string mostDissipating(const vehicle::Assembly& assembly, const VehicleState& state);

} // namespace grouser::coupling
