// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/validation/studies/collapse.hpp"
#include "runs/validation/studies/features.hpp"
#include "runs/validation/studies/fluid_command.hpp"
#include "runs/validation/studies/grain_stability.hpp"
#include "runs/validation/studies/impact.hpp"
#include "runs/validation/studies/packing.hpp"
#include "runs/validation/studies/precision_command.hpp"
#include "runs/validation/studies/random_stability.hpp"
#include "runs/validation/studies/random_vehicles.hpp"
#include "runs/validation/studies/shear.hpp"
#include "runs/validation/studies/vehicle_stability.hpp"

#include <CLI/CLI.hpp>

namespace grouser::studies {

/// Options of `grouser study`, except those of `multibody`.
struct GrainStudies {
  ImpactCommand impact;
  GrainStabilityCommand stability;
  RandomStability randomStability;
  VehicleStability vehicleStability;
  std::string stabilityScene = "grains"; ///< or "vehicle"
  RandomVehicles randomVehicles;
  PrecisionCommand precision;
  PackingCommand packing;
  CollapseCommand collapse;
  ShearCommand shear;
  FeaturesCommand features;
  FluidCommand fluid;
};

/// Adds the studies of grains to the command `study`.
void addGrainStudies(CLI::App& study, GrainStudies& studies);

} // namespace grouser::studies
