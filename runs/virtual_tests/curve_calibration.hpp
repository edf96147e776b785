// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/virtual_tests/calibration_trials.hpp"

/// `grouser soil --calibrate` for measured pressure-sinkage curves of plates and an angle of repose as targets.
namespace grouser::virtual_tests {

class CurveCalibration {
public:
  CurveCalibration(const CalibrationCommand& command, const CalibrationTargets& targets, std::filesystem::path folder,
                   CalibrationRecord& record)
      : command_(command), curves_(*targets.curves),
        folder_(std::move(folder)), bed_{targets.start, targets.curves->depth}, record_(record),
        trials_(command, folder_, record) {}

  /// Runs the search, collects the tests of the best trial in the folder `final`, and writes the tables, a plot and the
  /// soil file. Throws Unfinished if the time limit is reached.
  void run();

private:
  struct Trial {
    CurveComparison curves;
    SoilResults results;
  };
  /// Runs the tests of the present soil and bed depth, and compares them with the targets.
  Trial tried(const std::string& name, const CalibrationTrials::WhenDone& whenDone = {});
  void printTrial(const std::string& name, const Trial& trial, double misfit) const;
  void finish();
  std::optional<double> reposeOf(const Trial& trial) const;
  std::vector<TargetOutcome> outcomes(const Trial& trial) const;

  const CalibrationCommand& command_;
  const CurveTargets& curves_;
  std::filesystem::path folder_;
  SoilInBed bed_;
  CalibrationRecord& record_;
  CalibrationTrials trials_;
};

} // namespace grouser::virtual_tests
