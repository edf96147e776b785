// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/virtual_tests/calibration.hpp"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>
#include <vector>

/// What a calibration has tried, as calibration.json: written anew after every trial.
namespace grouser::virtual_tests {

/// A quantity that a calibration wants, and what it came to.
struct TargetOutcome {
  std::string what; ///< "phi", "pressure, small plate"
  std::string unit;
  double wanted = 0;
  std::optional<double> tolerance; ///< empty: it is not sought, it follows
  support::Estimate reached;

  bool isSought() const { return tolerance.has_value(); }
  bool isReached() const; ///< the value, whatever its interval
};

/// The table of targets beside what is reached, as calibration.txt has it.
std::string outcomesText(const std::vector<TargetOutcome>& outcomes, bool coarse);

class CalibrationRecord {
public:
  /// Writes nothing yet.
  CalibrationRecord(const CalibrationCommand& command, const CalibrationTargets& targets,
                    const std::filesystem::path& folder);

  /// Whether the folder holds what a call with the same targets, care and seeds has left.
  bool isOfThisCall() const;

  /// The first trial has begun. Trials of a former call are told again as they are read.
  void begun();
  /// A trial of shear that is whole, named as its folder.
  void shear(const std::string& name, const TestedSoil& soil, const std::map<Quantity, support::Estimate>& measured);
  /// A trial of the small plate: its mean pressure at the sinkage wanted [Pa], [m].
  void plate(const std::string& name, const TestedSoil& soil, const support::Estimate& pressure, double sinkage);
  /// A trial of measured curves.
  void curves(const std::string& name, const SoilInBed& bed, const CurveComparison& curves,
              const std::map<Quantity, support::Estimate>& measured, double misfit);
  /// Time was up in a trial.
  void stopped(const std::string& name, int missingTests);
  /// All tests are there with what was found.
  void ended(const std::vector<TargetOutcome>& outcomes, const std::string& soilFile, const std::string& tests);

private:
  void add(const std::string& name, const char* kind, const TestedSoil& soil, nlohmann::ordered_json measured);
  void write() const;

  nlohmann::ordered_json json_;
  std::filesystem::path file_;
  bool isBegun_ = false;
};

} // namespace grouser::virtual_tests
