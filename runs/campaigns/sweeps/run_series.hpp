// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

/// Time series of a run, from its text files.
namespace grouser::sweeps {

/// Rows of a run; a number that is missing is NaN.
struct RunSeries {
  std::vector<std::string> columns;        ///< name and unit, as in timeseries.csv: "vehicle.left.slip [-]"
  std::vector<double> time;                ///< [s]
  std::vector<std::vector<double>> values; ///< [columns][rows]

  /// Values of a column by name; null if missing.
  const std::vector<double>* of(const std::string& column) const;
  /// Discards all rows except the last.
  void keepEnd();
};

/// Up to this number, each grain has its own columns: "grain.3.position.z [m]".
inline constexpr std::size_t kGrainsWithSeries = 20;

/// Reads timeseries.csv of a run's folder, and grains.csv with at most kGrainsWithSeries grains that are always
/// present. Throws base::InputError for an invalid line.
RunSeries readSeries(const std::filesystem::path& folder);

} // namespace grouser::sweeps
