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
  std::vector<double> stresses = {10e3, 30e3, 60e3}; ///< normal stresses [Pa]
  int seeds = 8;
};
/// `grouser study shear-angle`
void studyShearAngleCommand(const ShearAngleCommand& command);

/// Angle of internal friction and cohesion of one soil, from a line tau = c + sigma tan phi for each seed.
struct ShearAngle {
  support::Estimate angle;       ///< from the residual strength [deg]
  support::Estimate peakAngle;   ///< from the peak strength [deg]
  support::Estimate mohrCoulomb; ///< from the stress in the core, mean over the loads [deg]
  support::Estimate cohesion;    ///< from the residual strength [Pa]
};
/// `runs`: [seed][stress]. Fits one line per seed; with a single stress, the line passes through the origin.
ShearAngle shearAngle(const std::vector<std::vector<virtual_tests::ShearStrength>>& runs);

} // namespace grouser::studies
