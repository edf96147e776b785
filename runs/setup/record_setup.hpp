// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/setup/drawn_planes.hpp"
#include "runs/setup/provenance.hpp"

#include <optional>
#include <string>
#include <vector>

namespace grouser::setup {

/// Duration of a run, and its output intervals.
struct RunSetup {
  double duration{};           ///< [s] simulated time after the bed has settled
  double outputInterval{};     ///< time between rows [s]
  double frameInterval{};      ///< time between frames [s]
  double checkpointInterval{}; ///< [s]; 0: only at the end
};

/// A column that [[output.plot]] draws.
struct PlottedColumn {
  std::string column; ///< "bodies.cone.position.z"
  std::string place;  ///< place of the key, for messages: "scene.toml:14: output.plot.0.x"
};

/// Output of a run.
struct OutputSetup {
  std::vector<std::string> record;   ///< bodies, joints, springs and drives of a mechanism in the rows; empty: all
  bool frames{}, contactForces{};    ///< contact forces of each grain in the frames
  std::optional<bool> grainsCsv;     ///< every grain in every row as text; empty: in small scenes
  bool shoeForces{}, gearContacts{}; ///< shoe forces, grain-part contacts, in the rows
  bool finalSurface{};               ///< bed surface at the end
  bool picture{};
  int pictureWidth{};                               ///< [px]
  std::optional<double> fieldsCell;                 ///< [m] cell edge of the soil fields; empty: no fields
  std::optional<base::Vec3d> fieldsLow, fieldsHigh; ///< [m] corners of the field box; empty: around the grains
  std::vector<PlottedColumn> plots;
};

/// Settings of a run, in addition to the simulation's.
struct RecordSetup {
  Provenance provenance;
  RunSetup run;
  OutputSetup output;
  DrawnPlanes planes;
};
RecordSetup recordSetup(const scene::Scene& scene, Provenance provenance);

} // namespace grouser::setup
