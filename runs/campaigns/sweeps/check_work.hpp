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
  /// `record` contains the cases and the scene file, and receives runs and outcomes; `fixed`: overrides of all runs.
  CheckWork(const CheckOptions& options, const std::vector<std::string>& fixed, std::int64_t firstSeed,
            CheckRecord& record)
      : options_(options), fixed_(fixed), firstSeed_(firstSeed), record_(record) {}

  /// Performs missing runs up to these seeds of each case [cases]; `what`: label of the progress lines. Returns whether
  /// all have ended or failed; false if the time limit of this call was reached.
  bool make(const std::vector<int>& seeds, const std::string& what);

  /// Performs a base run and returns the costs of runs estimated from it. Prefers a seed without cached bed, so that
  /// the costs include settling.
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
