// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/table.hpp"
#include "vehicle/spec.hpp"

namespace grouser::vehicle {

/// Field tables for the sections of a vehicle spec file; used to read, check and document them.
base::Table<VehicleSpec> vehicleTable();
base::Table<ChassisSpec> chassisTable();
base::Table<ShoeSpec> shoeTable();
base::Table<SprocketSpec> sprocketTable();
base::Table<RoadWheelSpec> roadWheelTable();
base::Table<ArmSpec> armTable();
base::Table<RollerSpec> rollerTable();
base::Table<IdlerSpec> idlerTable();
base::Table<ContactSpec> contactTable();
base::Table<EngineSpec> engineTable();
base::Table<GearShapes> shapesTable();

} // namespace grouser::vehicle
