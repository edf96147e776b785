// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/validation/studies/plates.hpp"
#include "runs/validation/studies/preparation.hpp"
#include "runs/validation/studies/shear_angle.hpp"

#include <CLI/CLI.hpp>

namespace grouser::studies {

/// Options of the soil studies of `grouser study`.
struct SoilStudies {
  ShearAngleCommand shearAngle;
  PlatesCommand plates;
  PreparationCommand preparation;
};
void addSoilStudies(CLI::App& study, SoilStudies& studies);

} // namespace grouser::studies
