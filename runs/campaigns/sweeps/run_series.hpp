// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

/// What a run wrote over time, as text.
namespace grouser::sweeps {

/// Rows of a run; a number that is missing is NaN.
struct RunSeries {
  std::vector<std::string> columns;        ///< name and unit, as in timeseries.csv: "vehicle.left.slip [-]"
  std::vector<double> time;                ///< [s]
  std::vector<std::vector<double>> values; ///< [columns][rows]

  /// Values of a column by its name; empty where there is none.
  const std::vector<double>* of(const std::string& column) const;
  /// Forgets all rows but the last.
  void keepEnd();
};

/// Of scenes with so few grains each of them is a quantity of its own: "grain.3.position.z [m]".
inline constexpr std::size_t kGrainsWithSeries = 20;

/// Reads timeseries.csv of a run's folder, and grains.csv where it has at most kGrainsWithSeries grains that are always
/// there. Throws base::InputError where a line cannot be read.
RunSeries readSeries(const std::filesystem::path& folder);

} // namespace grouser::sweeps
