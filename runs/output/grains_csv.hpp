// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/comm.hpp"
#include "terrain/grains.hpp"

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>

namespace grouser::output {

inline constexpr const char* kGrainsCsvName = "grains.csv";

/// Every grain at every output time as text, for scenes small enough to be looked at grain by grain: step, time [s],
/// id, position [m], velocity [m/s], spin [rad/s] and radius [m]. Reals are written so that they read back to the same
/// bits.
class GrainsCsv {
public:
  /// Limits above which the file is written only on request.
  static constexpr std::int64_t kMostGrains = 1000, kMostLines = 1'000'000;
  static constexpr double kLineBytes = 220; ///< approximate upper bound
  /// Whether a run of `grains`, those that are poured in later among them, writes the file. `asked`:
  /// output.grains_csv.
  static bool isWanted(std::optional<bool> asked, std::int64_t grains, double duration, double outputInterval);

  /// Starts a new file, or continues it: then lines after the last `kept` row of the time series [its step; -1: none]
  /// are removed. Throws support::NotWritten. On several ranks all of them have one, and the first writes.
  GrainsCsv(const std::filesystem::path& folder, std::optional<std::int64_t> kept, const base::Comm& comm);

  void add(std::int64_t step, double time, const terrain::Grains& grains);

private:
  void check();

  std::filesystem::path path_;
  base::Comm comm_;
  std::ofstream file_;
};

} // namespace grouser::output
