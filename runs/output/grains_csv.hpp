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

/// All grains at all output times as text, for small scenes: step, time [s], id, position [m], velocity [m/s], spin
/// [rad/s] and radius [m]. Real numbers have enough digits to be read back bitwise identical.
class GrainsCsv {
public:
  /// Limits above which the file is written only if requested.
  static constexpr std::int64_t kMaxGrains = 1000, kMaxLines = 1'000'000;
  static constexpr double kLineBytes = 220; ///< approximate upper bound of the length of a line
  /// Whether a run writes the file. `grains`: number of grains, including those from sources. `asked`:
  /// output.grains_csv.
  static bool isRequested(std::optional<bool> asked, std::int64_t grains, double duration, double outputInterval);

  /// Creates a new file. With `kept`, continues an existing file and removes lines after this step, that of the last
  /// kept row (-1: no row). Throws support::NotWritten. Each rank has an object; only the first rank writes.
  GrainsCsv(const std::filesystem::path& folder, std::optional<std::int64_t> kept, const base::Comm& comm);

  void add(std::int64_t step, double time, const terrain::Grains& grains);

private:
  void check();

  std::filesystem::path path_;
  base::Comm comm_;
  std::ofstream file_;
};

} // namespace grouser::output
