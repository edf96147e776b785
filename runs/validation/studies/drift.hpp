// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/jobs/study_place.hpp"
#include "runs/support/line_fit.hpp"
#include "runs/validation/studies/box.hpp"

#include <functional>
#include <string>
#include <vector>

/// How far two runs of different precision drift apart: grain by grain while that means something, and in what is
/// measured of many grains after.
namespace grouser::studies {

/// Distances between the same grains of two runs.
struct DriftSample {
  double time = 0;         ///< [s]
  double max = 0, rms = 0; ///< [m]
};

/// Two runs from one state.
struct Drift {
  std::string scene, pair; ///< "gas", "single - double"
  std::vector<DriftSample> samples;
  double collisionTime = 0; ///< mean time between the collisions of a grain [s]; 0: not known
  support::LineFit growth;  ///< of ln rms while it is small [1/s]
  double toDiameter = -1;   ///< time until the farthest grain is a diameter away [s]; negative: not within the run
  double rmsToDiameter = -1;
};

/// One quantity of many grains at one time, over runs that begin a few units of length apart.
struct MacroRow {
  std::string quantity, unit;
  double time = 0; ///< [s]
  jobs::MeanError single, double_;
  double bias() const { return single.mean - double_.mean; }
  double error() const; ///< standard error of the bias, from the runs' scatter
};

struct DriftStudy {
  std::int64_t grains = 2000;
  double gasTime = 1.5, bedTime = 0.5; ///< [s]
  int runs = 8;                        ///< of each precision
  int threads = 0;                     ///< 0: all
};
using DriftProgress = std::function<void(double fraction, const std::string& what)>;
/// A gas of elastic grains, and a bed that is dropped: single against double, and double against itself with all grains
/// moved by up to a unit of length.
std::vector<Drift> studyDrift(const DriftStudy& study, const DriftProgress& progress);
/// The dropped bed many times over in both precisions: heights, kinetic energy, coordination.
std::vector<MacroRow> studyMacroscopic(const DriftStudy& study, const DriftProgress& progress);

std::string driftTable(const std::vector<Drift>& drifts);
std::string driftCsv(const std::vector<Drift>& drifts);
std::string macroTable(const std::vector<MacroRow>& rows, int runs);
std::string macroCsv(const std::vector<MacroRow>& rows);

} // namespace grouser::studies
