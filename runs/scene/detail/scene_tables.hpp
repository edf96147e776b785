// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/table.hpp"
#include "runs/scene/scene.hpp"

namespace grouser::scene::detail {

base::Table<RunSettings> runTable();
base::Table<Material> materialTable();
base::Table<ContactPair> contactTable();
base::Table<Grain> grainTable();
base::Table<GrainFill> fillTable();
base::Table<Source> sourceTable();
base::Table<Plane> planeTable();
base::Table<BoxSection> boxTable();
base::Table<CylinderSection> cylinderTable();
base::Table<MeshSection> meshTable();
base::Table<Terrain> terrainTable();
base::Table<BodySection> bodyTable();
base::Table<JointSection> jointTable();
base::Table<SpringSection> springTable();
base::Table<BushingSection> bushingTable();
base::Table<DriveSection> driveTable();
base::Table<CouplingSection> couplingTable();
base::Table<Vehicle> vehicleTable();
base::Table<Driver> driverTable();
base::Table<SpeedTable> speedTable();
base::Table<Output> outputTable();
base::Table<Parallel> parallelTable();

} // namespace grouser::scene::detail
