// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/virtual_tests/calibration.hpp"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>
#include <vector>

/// Writes the trials of a calibration to calibration.json, again after every trial.
namespace grouser::virtual_tests {

/// A target quantity of a calibration, and its result.
struct TargetOutcome {
  std::string what; ///< "phi", "pressure, small plate"
  std::string unit;
  double wanted = 0;
  std::optional<double> tolerance; ///< empty: not fitted
  support::Estimate reached;

  bool isSought() const { return tolerance.has_value(); }
  bool isReached() const; ///< compares only the value with the tolerance, not its interval
};

/// Table of targets and results for calibration.txt.
std::string outcomesText(const std::vector<TargetOutcome>& outcomes, bool coarse);

class CalibrationRecord {
public:
  /// Does not write the file.
  CalibrationRecord(const CalibrationCommand& command, const CalibrationTargets& targets,
                    const std::filesystem::path& folder);

  /// True if the folder contains a calibration with the same targets, settings (coarse or full) and seeds.
  bool isOfThisCall() const;

  /// Call this when the first trial starts. Reused trials of an earlier call are recorded again.
  void begun();
  /// Adds a complete shear trial. `name`: its folder.
  void shear(const std::string& name, const TestedSoil& soil, const std::map<Quantity, support::Estimate>& measured);
  /// Adds a trial of the small plate: mean pressure [Pa] at the target sinkage [m].
  void plate(const std::string& name, const TestedSoil& soil, const support::Estimate& pressure, double sinkage);
  /// Adds a trial of a calibration to measured curves.
  void curves(const std::string& name, const SoilInBed& bed, const CurveComparison& curves,
              const std::map<Quantity, support::Estimate>& measured, double misfit);
  /// Call this if the time limit is reached during a trial.
  void stopped(const std::string& name, int missingTests);
  /// Call this when all tests with the final parameters are complete.
  void ended(const std::vector<TargetOutcome>& outcomes, const std::string& soilFile, const std::string& tests);

private:
  void add(const std::string& name, const char* kind, const TestedSoil& soil, nlohmann::ordered_json measured);
  void write() const;

  nlohmann::ordered_json json_;
  std::filesystem::path file_;
  bool isBegun_ = false;
};

} // namespace grouser::virtual_tests
