// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/jobs/study_place.hpp"
#include "runs/support/line_fit.hpp"
#include "runs/validation/studies/box.hpp"

#include <functional>
#include <string>
#include <vector>

/// Drift between runs of different precision: distances of single grains first, then macroscopic quantities.
namespace grouser::studies {

/// Distances of the same grains in two runs.
struct DriftSample {
  double time = 0;         ///< [s]
  double max = 0, rms = 0; ///< [m]
};

/// Two runs from one state.
struct Drift {
  std::string scene, pair; ///< "gas", "single - double"
  std::vector<DriftSample> samples;
  double collisionTime = 0; ///< mean time between collisions [s]; 0: unknown
  support::LineFit growth;  ///< growth of ln rms while rms is small [1/s]
  double toDiameter = -1;   ///< time until the maximum distance is one diameter [s]; negative: not reached
  double rmsToDiameter = -1;
};

/// A macroscopic quantity at one time, over runs whose initial states differ by a few units of length.
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
  int runs = 8;                        ///< runs per precision
  int threads = 0;                     ///< 0: all
};
using DriftProgress = std::function<void(double fraction, const std::string& what)>;
/// A gas of elastic grains and a dropped bed: single against double precision, and double against double with all
/// grains displaced by up to a unit of length.
std::vector<Drift> studyDrift(const DriftStudy& study, const DriftProgress& progress);
/// Many runs of the dropped bed in both precisions: heights, kinetic energy, coordination.
std::vector<MacroRow> studyMacroscopic(const DriftStudy& study, const DriftProgress& progress);

std::string driftTable(const std::vector<Drift>& drifts);
std::string driftCsv(const std::vector<Drift>& drifts);
std::string macroTable(const std::vector<MacroRow>& rows, int runs);
std::string macroCsv(const std::vector<MacroRow>& rows);

} // namespace grouser::studies
