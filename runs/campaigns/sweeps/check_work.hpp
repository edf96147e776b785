// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/campaigns/sweeps/check_beds.hpp"
#include "runs/campaigns/sweeps/check_choice.hpp"
#include "runs/campaigns/sweeps/check_options.hpp"
#include "runs/campaigns/sweeps/check_record.hpp"
#include "runs/support/stopwatch.hpp"

#include <cstdint>
#include <string>
#include <vector>

/// Makes the runs of a check.
namespace grouser::sweeps {

class CheckWork {
public:
  /// `record` holds the cases and the scene's file, and gets runs and outcomes; `fixed`: overrides of all runs.
  CheckWork(const CheckOptions& options, const std::vector<std::string>& fixed, std::int64_t firstSeed,
            CheckRecord& record)
      : options_(options), fixed_(fixed), firstSeed_(firstSeed), record_(record) {}

  /// Makes those of so many seeds of each case [cases] that are not made yet; `what` stands before the lines of
  /// progress. Returns whether all have ended, well or not: the time of this call may be over before.
  bool make(const std::vector<int>& seeds, const std::string& what);

  /// Makes a run of the base, and returns what runs cost by it. Of the seeds that are run in any case it takes one
  /// whose bed no run has kept, so that it settles its bed as other cases will theirs.
  RunCosts pilot(CheckBeds& beds);

  /// Whether the base has a run that ended.
  bool hasBase() const;
  [[noreturn]] void throwBaseFailed() const;

private:
  void addRun(std::size_t c, int seedIndex);
  void makeAdded(const std::string& what);
  void read(std::size_t r);

  const CheckOptions& options_;
  const std::vector<std::string>& fixed_;
  std::int64_t firstSeed_;
  CheckRecord& record_;
  std::vector<int> added_; ///< [cases] seeds
  support::Stopwatch clock_;
  std::vector<std::string> made_; ///< names of runs that this call has made
};

} // namespace grouser::sweeps
