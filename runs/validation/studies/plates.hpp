// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/jobs/estimate.hpp"
#include "runs/virtual_tests/plate_test.hpp"

#include <array>

namespace grouser::studies {

struct PlatesCommand {
  jobs::StudyPlace place;
  jobs::PieceOptions pieces;
  std::vector<std::string> cases; ///< names of plateCases(); empty: all
  int seeds = 8;
  double breadth = 12;                       ///< [d] width of the strip, and diameter of the circular plate
  double stripBin = 8, stripDepth = 2;       ///< [breadths] width and depth of the strip's bed
  double circularBin = 5, circularDepth = 2; ///< [breadths] width and depth of the circular plate's bed
  double thickness = 24;                     ///< [d] length of a strip and its bed
  double fineBreadth = 32;                   ///< [d] width of the strips on a fine and on a graded bed
  double fineThickness = 16;                 ///< [d] length of the fine and the graded bed
  double fineDepth = 0.1;                    ///< [breadths] depth of the fine layer of the graded bed
  double coarsening = 0.0265;                ///< [-] increase of the mean radius per depth below the fine layer
  double young = 5e8;                        ///< [Pa] Young's modulus of the grains in the fine and the graded bed
  double sinkage = 0.3, inertialNumber = 1.8e-3;
  double friction = 0.5, rollingFriction = 0, preparationFriction = 0.5;
  double angle = 0, angleError = 0; ///< [deg] measured angle of internal friction (0: none), half width of its interval
  bool keepBeds = false;
};
/// `grouser study plates`
void studyPlatesCommand(const PlatesCommand& command);

struct PlateCase {
  std::string name, title;
  virtual_tests::PlateTest test;
  std::string comparedWith{};             ///< name of the case with which the pressure should agree; empty: none
  bool bears = false;                     ///< compare the pressure with bearing theory
  double timesDeeper = 1, timesWider = 1; ///< factors on the depth and width of the options [-]
};
std::string nameOf(const PlateCase& plate, int seed); ///< name of a run
/// The first case is the reference strip.
std::vector<PlateCase> plateCases(const PlatesCommand& command);
/// Throws InputError with option and range if a case has an impossible bed or plate.
void checkPlates(const std::vector<PlateCase>& cases, const virtual_tests::Soil& soil);

using Slice = std::array<double, 2>; ///< range of sinkage [breadths]
/// Slices in the tables. The last slice is the whole sinkage without the first slice, where the plate touches only
/// single grains.
std::vector<Slice> sinkageSlices(double sinkage);

} // namespace grouser::studies
