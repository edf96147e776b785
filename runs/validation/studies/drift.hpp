// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/jobs/study_place.hpp"
#include "runs/support/line_fit.hpp"
#include "runs/validation/studies/box.hpp"

#include <functional>
#include <string>
#include <vector>

/// Drift between runs in single and double precision: distances of single grains, and macroscopic quantities.
namespace grouser::studies {

/// Distance between the positions of the same grain in two runs, over all grains.
struct DriftSample {
  double time = 0;         ///< [s]
  double max = 0, rms = 0; ///< [m]
};

/// Two runs from the same initial state.
struct Drift {
  std::string scene, pair; ///< "gas", "single - double"
  std::vector<DriftSample> samples;
  double collisionTime = 0; ///< mean time between collisions [s]; 0: unknown
  support::LineFit growth;  ///< growth of ln rms while rms is small [1/s]
  double toDiameter = -1;   ///< time at which the maximum distance reaches one diameter [s]; negative: not reached
  double rmsToDiameter = -1;
};

/// A macroscopic quantity at one time: means over runs with initial states that differ by a few units of length.
struct MacroRow {
  std::string quantity, unit;
  double time = 0; ///< [s]
  jobs::MeanError single, double_;
  double bias() const { return single.mean - double_.mean; }
  double error() const; ///< standard error of the bias, from the scatter of the runs
};

struct DriftStudy {
  std::int64_t grains = 2000;
  double gasTime = 1.5, bedTime = 0.5; ///< [s]
  int runs = 8;                        ///< number of runs in each precision
  int threads = 0;                     ///< number of CPU threads; 0: all
};
using DriftProgress = std::function<void(double fraction, const std::string& what)>;
/// Compares pairs of runs of a gas of elastic grains and of a dropped bed: single with double precision, and two runs
/// in double precision, where all grains of one run are displaced by up to one unit of length.
std::vector<Drift> studyDrift(const DriftStudy& study, const DriftProgress& progress);
/// Compares heights, kinetic energy and coordination over many runs of the dropped bed in both precisions.
std::vector<MacroRow> studyMacroscopic(const DriftStudy& study, const DriftProgress& progress);

std::string driftTable(const std::vector<Drift>& drifts);
std::string driftCsv(const std::vector<Drift>& drifts);
std::string macroTable(const std::vector<MacroRow>& rows, int runs);
std::string macroCsv(const std::vector<MacroRow>& rows);

} // namespace grouser::studies
