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
  /// Of scenes with more grains, or of runs that would write more lines, it is not written unless asked for.
  static constexpr std::int64_t kMostGrains = 1000, kMostLines = 1'000'000;
  static constexpr double kLineBytes = 220; ///< about, at most
  /// Whether a run of `grains`, those that are poured in later among them, writes the file. `asked`:
  /// output.grains_csv.
  static bool isWanted(std::optional<bool> asked, std::int64_t grains, double duration, double outputInterval);

  /// Begins the file anew, or goes on with it: then what came after the last row that is `kept` of the time series [its
  /// step; -1: none is] is cut off. Throws support::NotWritten. On several ranks all of them have one, and the first
  /// writes.
  GrainsCsv(const std::filesystem::path& folder, std::optional<std::int64_t> kept, const base::Comm& comm);

  void add(std::int64_t step, double time, const terrain::Grains& grains);

private:
  void check();

  std::filesystem::path path_;
  base::Comm comm_;
  std::ofstream file_;
};

} // namespace grouser::output
