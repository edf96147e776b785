// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/virtual_tests/calibration.hpp"
#include "runs/virtual_tests/calibration_record.hpp"

#include <chrono>
#include <functional>
#include <string>
#include <utility>
#include <vector>

/// The trials of a calibration. A trial consists of tests of one soil, in a folder of its own.
namespace grouser::virtual_tests {

/// Thrown if the time limit is reached before all tests of a trial are done.
struct Unfinished {
  std::string trial;
  int missing;
};

class CalibrationTrials {
public:
  using Wanted = std::function<bool(const PlannedTest&)>;
  using WhenDone = std::function<void(const TestPlan&, const jobs::Pieces&)>;

  CalibrationTrials(const CalibrationCommand& command, std::filesystem::path folder, CalibrationRecord& record)
      : command_(command), folder_(std::move(folder)), record_(record) {}

  /// Runs the wanted tests of a soil in the folder `name`; reuses the tests of an earlier trial of the same soil. Calls
  /// `whenDone` when all tests are done. Throws Unfinished, or base::SimulationError if a test fails.
  TestPlan tested(const TestedSoil& soil, const std::string& name, const PlanOptions& options, const Wanted& wanted,
                  SoilResults& results, const WhenDone& whenDone = {});

private:
  void takeOver(const TestedSoil& soil, const TestPlan& plan, jobs::Pieces& pieces) const;
  double spent() const;

  struct Done {
    decltype(TestedSoil::keys) keys;
    nlohmann::ordered_json recipe;
    jobs::Pieces pieces;
  };

  const CalibrationCommand& command_;
  std::filesystem::path folder_;
  CalibrationRecord& record_;
  std::vector<Done> done_; ///< finished trials
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

} // namespace grouser::virtual_tests
