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

/// Performs the runs of a check.
namespace grouser::sweeps {

class CheckWork {
public:
  /// `record`: contains cases and scene file, receives runs and outcomes. `fixed`: overrides of all runs.
  CheckWork(const CheckOptions& options, const std::vector<std::string>& fixed, std::int64_t firstSeed,
            CheckRecord& record)
      : options_(options), fixed_(fixed), firstSeed_(firstSeed), record_(record) {}

  /// Performs the missing runs up to these numbers of seeds [cases]. `what`: label of the progress lines. Returns true
  /// if all runs have ended or failed, false if this call reached its time limit.
  bool make(const std::vector<int>& seeds, const std::string& what);

  /// Performs a base run and estimates the costs of all runs from it. Prefers a seed without a cached bed, so that the
  /// costs include settling.
  RunCosts pilot(CheckBeds& beds);

  /// Whether the base has a finished run.
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
  std::vector<std::string> made_; ///< names of runs performed by this call
};

} // namespace grouser::sweeps
