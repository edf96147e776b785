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
  double breadth = 12;                       ///< [d]
  double stripBin = 8, stripDepth = 2;       ///< [breadths]
  double circularBin = 5, circularDepth = 2; ///< [breadths]
  double thickness = 24;                     ///< [d] length of a strip and its bed
  double fineBreadth = 32;                   ///< [d] width of the strips on a fine and on a graded bed
  double fineThickness = 16;                 ///< [d] length of their beds
  double fineDepth = 0.1;                    ///< [breadths] depth of the fine layer of the graded bed
  double coarsening = 0.0265;                ///< [-] increase of its mean radius with depth below that layer
  double young = 5e8;                        ///< [Pa] Young's modulus of their grains
  double sinkage = 0.3, inertialNumber = 1.8e-3;
  double friction = 0.5, rollingFriction = 0, preparationFriction = 0.5;
  double angle = 0, angleError = 0; ///< [deg] measured angle of internal friction, half width of its interval; 0: none
  bool keepBeds = false;
};
/// `grouser study plates`
void studyPlatesCommand(const PlatesCommand& command);

struct PlateCase {
  std::string name, title;
  virtual_tests::PlateTest test;
  std::string comparedWith{};             ///< name of the case it should equal; empty: none
  bool bears = false;                     ///< compared with bearing theory
  double timesDeeper = 1, timesWider = 1; ///< factors on the options [-]
};
std::string nameOf(const PlateCase& plate, int seed); ///< name of a run
/// The first one is the reference strip.
std::vector<PlateCase> plateCases(const PlatesCommand& command);
/// Throws InputError with option and range for the first case with an impossible bed or plate.
void checkPlates(const std::vector<PlateCase>& cases, const virtual_tests::Soil& soil);

using Slice = std::array<double, 2>; ///< range of sinkage [breadths]
/// Slices of the tables; the last one is all but the first, where the plate touches single grains.
std::vector<Slice> sinkageSlices(double sinkage);

} // namespace grouser::studies
