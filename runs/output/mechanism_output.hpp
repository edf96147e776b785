// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/mechanism.hpp"
#include "runs/output/channels.hpp"
#include "runs/output/records.hpp"

#include <string>
#include <vector>

/// Output of a mechanism.
namespace grouser::output {

/// A mechanism, or the bodies besides a vehicle, at the time of a row. Loads on the bodies are computed during a step
/// and are NaN before the first step.
struct MechanismReading {
  explicit MechanismReading(const coupling::BodiesInContact& bodies, const coupling::Mechanism::Drift& drift = {});
  explicit MechanismReading(const coupling::Mechanism& m) : MechanismReading(m, m.drift()) {}
  const coupling::BodiesInContact& mechanism;
  std::vector<multibody::JointReaction> reactions;
  multibody::Totals now;
  coupling::Mechanism::Drift drift;  ///< zero for bodies besides a vehicle
  std::vector<base::Vec3d> contacts; ///< [body] [N]
};
/// `record`: names of the bodies, joints, springs and drives to write; empty: all. `touching`: [body] whether contacts
/// act on it. `ofVehicle`: numbers of vehicle parts at the start of the model; these parts have no columns, and with a
/// vehicle, the mechanism as a whole has no columns either.
Columns<MechanismReading> mechanismColumns(const multibody::Model& model, const std::vector<bool>& touching,
                                           const std::vector<std::string>& record,
                                           const multibody::PartCounts& ofVehicle = {});

/// Columns for the mass of the grains in the probes of bodies. `names`: names of the bodies. Source: masses [kg].
Columns<std::vector<double>> probeColumns(const std::vector<std::string>& names);

/// "RATTLE of order 2, springs implicit".
std::string integratorText(const multibody::SolverOptions& options);

/// Lines about the size of a mechanism: bodies, joints, degrees of freedom, redundant constraints.
std::string mechanismSize(const coupling::Mechanism& mechanism);

/// Meshes of all bodies, except those of a vehicle, for pictures and ParaView: the shapes of a body, or else a box with
/// thin bars to its joints.
std::vector<FramePart> mechanismParts(const coupling::MechanismSetup& setup);

} // namespace grouser::output
