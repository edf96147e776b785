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
  double thickness = 24;                     ///< [d] of a strip's bed
  double fineBreadth = 32;                   ///< [d] of the strips on a fine and on a graded bed
  double fineThickness = 16;                 ///< [d] of their beds
  double fineDepth = 0.1;                    ///< [breadths] down to which the graded one is as the fine one
  double coarsening = 0.0265;                ///< [-] growth of its mean radius with depth below that
  double young = 5e8;                        ///< [Pa] of their grains
  double sinkage = 0.3, inertialNumber = 1.8e-3;
  double friction = 0.5, rollingFriction = 0, preparationFriction = 0.5;
  double angle = 0, angleError = 0; ///< [deg] of internal friction as measured, half width of its interval; 0: none
  bool keepBeds = false;
};
/// `grouser study plates`
void studyPlatesCommand(const PlatesCommand& command);

struct PlateCase {
  std::string name, title;
  virtual_tests::PlateTest test;
  std::string comparedWith{};             ///< name of the case that it should equal; empty: none
  bool bears = false;                     ///< compared with theory
  double timesDeeper = 1, timesWider = 1; ///< than the options say [-]
};
std::string nameOf(const PlateCase& plate, int seed); ///< of a run
/// The first is the strip that others are compared with.
std::vector<PlateCase> plateCases(const PlatesCommand& command);
/// Throws InputError, with option and range, for the first case whose bed or plate cannot be.
void checkPlates(const std::vector<PlateCase>& cases, const virtual_tests::Soil& soil);

using Slice = std::array<double, 2>; ///< of the sinkage, from and to [breadths]
/// Those that tables compare: the last is all of them but the first, in which the plate meets single grains.
std::vector<Slice> sinkageSlices(double sinkage);

} // namespace grouser::studies
