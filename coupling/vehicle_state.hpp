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

/// All of a vehicle on which later bits or later output depend: what a checkpoint holds and a hash is taken of.
struct VehicleState {
  double lift{};                 ///< with which it was set down; see VehicleRig
  std::vector<double> bodies;    ///< multibody::State::save()
  std::vector<double> observers; ///< vehicle::Observer::save()
  std::vector<double> driver;    ///< vehicle::Driver::save()
  std::vector<double> asked;     ///< vehicle::Handover::save() of the last step: from which a branch goes on
  std::vector<double> hitch;     ///< vehicle::Hitch::save(); empty without one
  ContactsState contacts;

  // Sums for output and alarm, in quanta of force.
  std::vector<base::Vec3l> groundForces; ///< by part and surface, since the last row
  std::int64_t meanSteps{};              ///< of that sum
  std::vector<base::Vec3l> alarmForces;  ///< by part and surface, since the last check of the track
  std::int64_t alarmSteps{};             ///< of that sum
  std::vector<double> judged;            ///< SwingGrowth::save(), vehicle::BlowMeter::save()
  std::vector<double> hitchBooks;        ///< Towing::books()
  std::vector<double> appliedWork;       ///< AppliedLoads::save()
  std::int64_t stalledSteps{};           ///< for which driven tracks have not moved the hull

  /// For the hash: what the next step depends on.
  std::vector<std::uint32_t> words() const;
};

/// The three that have dissipated most with the shoes that touch them since the start, in words with joules: sprocket,
/// idler, wheels and rollers of each side, rigid ground.
std::string mostDissipating(const vehicle::Assembly& assembly, const VehicleState& state);

} // namespace grouser::coupling
