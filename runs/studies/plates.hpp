// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/studies/estimate.hpp"
#include "runs/studies/plate_test.hpp"

namespace grouser::studies {

struct PlatesCommand {
  StudyPlace place;
  PieceOptions pieces;
  std::vector<std::string> cases; ///< names of plateCases(); empty: all
  int seeds = 8;
  double breadth = 12;                       ///< [d]
  double stripBin = 8, stripDepth = 2;       ///< [breadths]
  double circularBin = 5, circularDepth = 2; ///< [breadths]
  double thickness = 12;                     ///< [d] of a strip's bed
  double sinkage = 0.3, inertialNumber = 9e-4;
  double friction = 0.5, rollingFriction = 0, preparationFriction = 0.5;
  double angle = 0, angleError = 0; ///< [deg] of internal friction as measured, half width of its interval; 0: none
  bool keepBeds = false;
};
/// `grouser study plates`
void studyPlatesCommand(const PlatesCommand& command);

struct PlateCase {
  std::string name, title;
  PlateTest test;
};
/// The first is the strip that others are compared with.
std::vector<PlateCase> plateCases(const PlatesCommand& command);

/// Slices of the sinkage that tables compare [breadths]: the last is all of them but the first, in which the plate
/// meets single grains.
std::vector<std::array<double, 2>> sinkageSlices(double sinkage);

} // namespace grouser::studies
