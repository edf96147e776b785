// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "coupling/mechanism.hpp"
#include "runs/output/channels.hpp"
#include "runs/output/records.hpp"

#include <string>
#include <vector>

/// Output of a mechanism.
namespace grouser::output {

/// A mechanism, or the bodies beside a vehicle, at the time of a row. Loads on its bodies are computed in a step, and
/// NaN before the first.
struct MechanismReading {
  explicit MechanismReading(const coupling::BodiesInContact& bodies, const coupling::Mechanism::Drift& drift = {});
  explicit MechanismReading(const coupling::Mechanism& m) : MechanismReading(m, m.drift()) {}
  const coupling::BodiesInContact& mechanism;
  std::vector<multibody::JointReaction> reactions;
  multibody::Totals now;
  coupling::Mechanism::Drift drift;  ///< zero for bodies beside a vehicle
  std::vector<base::Vec3d> contacts; ///< [body] [N]
};
/// `record`: names of the bodies, joints, springs and drives that are written; empty: all.
/// `touching`: [body] whether contacts act on it. `ofVehicle`: parts of a vehicle with which the model begins; they
/// have no columns, nor has the mechanism as a whole then.
Columns<MechanismReading> mechanismColumns(const multibody::Model& model, const std::vector<bool>& touching,
                                           const std::vector<std::string>& record,
                                           const multibody::PartCounts& ofVehicle = {});

/// Mass of the grains in the probes of bodies, `names` those of the bodies; the source has the masses [kg].
Columns<std::vector<double>> probeColumns(const std::vector<std::string>& names);

/// "RATTLE of order 2, springs implicit".
std::string integratorText(const multibody::SolverOptions& options);

/// Lines about the size of a mechanism: bodies, joints, degrees of freedom, redundant constraints.
std::string mechanismSize(const coupling::Mechanism& mechanism);

/// Each body as its shapes, or a box and thin bars to its joints, for pictures and ParaView; without those of a
/// vehicle.
std::vector<FramePart> mechanismParts(const coupling::MechanismSetup& setup);

} // namespace grouser::output
