// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/setup/drawn_planes.hpp"
#include "runs/setup/ground_setup.hpp"
#include "runs/setup/mechanism_setup.hpp"
#include "runs/setup/provenance.hpp"
#include "runs/setup/vehicle_setup.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace grouser::setup {

/// How long a run lasts, and when it writes.
struct RunSetup {
  double duration{};           ///< [s] after the bed has settled
  double outputInterval{};     ///< between rows [s]
  double frameInterval{};      ///< between frames [s]
  double checkpointInterval{}; ///< [s]; 0: only at the end
};

/// What a run writes.
struct OutputSetup {
  std::vector<std::string> record;   ///< bodies, joints, springs and drives of a mechanism in the rows; empty: all
  bool frames{}, contactForces{};    ///< contact forces of each grain in the frames
  std::optional<bool> grainsCsv;     ///< every grain in every row as text; empty: in small scenes
  bool shoeForces{}, gearContacts{}; ///< of a vehicle, in the rows
  bool finalSurface{};               ///< of its bed
  bool picture{};
  int pictureWidth{}; ///< [px]
};

/// Everything that a run is made of: what a scene file says, checked, with every default and every law that follows
/// from it, as plain typed values. Made once; nothing behind it knows of scene files.
struct SimulationSetup {
  Provenance provenance;
  double timeStep{};   ///< [s]
  base::Vec3d gravity; ///< [m/s2]
  GroundSetup ground;
  std::optional<VehicleSetup> vehicle;
  std::optional<MechanismSetup> mechanism;
  RunSetup run;
  OutputSetup output;
  DrawnPlanes planes;

  bool crushes() const {
    return ground.grains && ground.grains->partLaws.crush();
  } ///< whether grains do, against parts
};

/// Compiles a scene for a run on `ranks` ranks. Throws InputError with the place of what is not possible.
SimulationSetup simulationSetup(const scene::Scene& scene, int ranks = 1);
/// The same of a scene whose files have been read for its provenance, and which has passed checkFillSizes() and
/// checkBedSize().
SimulationSetup simulationSetup(const scene::Scene& scene, const Provenance& provenance, int ranks);

} // namespace grouser::setup
