// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

/// Pressure-sinkage tests of circular plates that somebody has measured on a soil.
namespace grouser::virtual_tests {

/// Pressure of one test at a sinkage, between its rows.
struct MeasuredTrial {
  int number = 0;      ///< as in the file
  double pressure = 0; ///< [Pa]
};

/// The tests of one plate at one sinkage.
struct MeasuredPressure {
  double sinkage = 0;                ///< [m]
  std::vector<MeasuredTrial> trials; ///< those that reach it
  double mean = 0;                   ///< [Pa]
  /// Standard deviation of a single test over the mean [-]; of one test alone that of all others, root mean square.
  double deviation = 0;
};

struct MeasuredPlate {
  double diameter = 0; ///< [m]
  std::vector<MeasuredPressure> points;
  double deepest() const { return points.back().sinkage; } ///< [m]
};

/// Reads comma-separated rows with the columns trial, plate_diameter_mm, sinkage_mm and pressure_kPa behind lines of
/// comment (#), and interpolates every trial at `sinkages` [m]. Plates by ascending diameter. Throws base::InputError
/// with file:line: no such file, a missing column, a cell that is no number, a trial of two diameters, a sinkage that
/// no trial reaches.
std::vector<MeasuredPlate> readMeasuredPlates(const std::filesystem::path& file, const std::vector<double>& sinkages);

} // namespace grouser::virtual_tests
