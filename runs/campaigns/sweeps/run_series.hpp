// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

/// Time series of a run, read from its text files.
namespace grouser::sweeps {

/// Rows of a run; missing numbers are NaN.
struct RunSeries {
  std::vector<std::string> columns;        ///< names with units as in timeseries.csv: "vehicle.left.slip [-]"
  std::vector<double> time;                ///< [s]
  std::vector<std::vector<double>> values; ///< [columns][rows]

  /// Values of a column by name; null if missing.
  const std::vector<double>* of(const std::string& column) const;
  /// Discards all rows except the last.
  void keepEnd();
};

/// Up to this number of grains, each grain has separate columns: "grain.3.position.z [m]".
inline constexpr std::size_t kGrainsWithSeries = 20;

/// Reads timeseries.csv of a run's folder; also grains.csv, if it has at most kGrainsWithSeries grains, for grains that
/// are present in all rows. Throws base::InputError for an invalid line.
RunSeries readSeries(const std::filesystem::path& folder);

} // namespace grouser::sweeps
