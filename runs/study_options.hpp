// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/study_collapse.hpp"
#include "runs/study_grain_stability.hpp"
#include "runs/study_impact.hpp"
#include "runs/study_packing.hpp"
#include "runs/study_precision_command.hpp"
#include "runs/study_shear.hpp"

#include <CLI/CLI.hpp>

namespace grouser::runs {

/// What `grouser study` was asked for, beside `multibody`.
struct GrainStudies {
  ImpactCommand impact;
  GrainStabilityCommand stability;
  PrecisionCommand precision;
  PackingCommand packing;
  CollapseCommand collapse;
  ShearCommand shear;
};

/// Adds the studies of grains to the command `study`.
void addGrainStudies(CLI::App& study, GrainStudies& studies);

} // namespace grouser::runs
