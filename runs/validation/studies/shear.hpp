// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/jobs/study_place.hpp"
#include "runs/scene/choices.hpp"
#include "runs/virtual_tests/sample.hpp"

#include <vector>

/// Direct shear box, which measures the friction angle of a bed of grains.
namespace grouser::studies {

/// A row in the table of a test.
struct ShearRow {
  double displacement = 0; ///< displacement of the upper half [m]
  double shear = 0;        ///< shear force on the upper half [N]
  double normal = 0;       ///< normal force between the halves [N]
  double lid = 0;          ///< height of the lid above the shear plane [m]
};

struct ShearBox {
  double length = 16, width = 6, depth = 10; ///< inner length, width between periodic boundaries, settled depth [d]
  double travel = 0.12;                      ///< travel / length [-]
  double speed = 0.02;                       ///< speed of the upper half [m/s]
  double spread = 0.12; ///< half width of the uniform radius distribution / mean radius; prevents order [-]
  scene::ContactMethod contact = scene::ContactMethod::penalty;
};

/// Fills the box, loads the lid with `stress` [Pa], and then shears the sample.
std::vector<ShearRow> shearSample(const virtual_tests::SampleGrains& material, const ShearBox& box, double stress,
                                  std::int64_t seed);

struct ShearCommand {
  jobs::StudyPlace place;
  double friction = 0.5, rollingFriction = 0;
  ShearBox box;
  int seeds = 3;
  std::vector<double> stresses = {1000, 2000, 4000}; ///< normal stresses on the lid [Pa]
};
/// `grouser study shear`
void studyShearCommand(const ShearCommand& command);

} // namespace grouser::studies
