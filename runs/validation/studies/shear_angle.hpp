// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/jobs/estimate.hpp"
#include "runs/virtual_tests/shear_cell.hpp"

namespace grouser::studies {

struct ShearAngleCommand {
  jobs::StudyPlace place;
  jobs::PieceOptions pieces;
  double friction = 0.5, preparationFriction = 0.5;
  std::vector<double> rollingFrictions = {0, 0.2};
  std::vector<double> stresses = {10e3, 30e3, 60e3}; ///< [Pa]
  int seeds = 8;
};
/// `grouser study shear-angle`
void studyShearAngleCommand(const ShearAngleCommand& command);

/// Angle of internal friction and cohesion of one soil, from the lines tau = c + sigma tan phi of the seeds.
struct ShearAngle {
  support::Estimate angle;       ///< residual [deg]
  support::Estimate peakAngle;   ///< peak [deg]
  support::Estimate mohrCoulomb; ///< core, mean over the stresses [deg]
  support::Estimate cohesion;    ///< residual [Pa]
};
/// `runs`: [seed][stress]; one line fit per seed, through the origin with fewer than two stresses.
ShearAngle shearAngle(const std::vector<std::vector<virtual_tests::ShearStrength>>& runs);

} // namespace grouser::studies
