// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

/// Measured pressure-sinkage tests of circular plates on a soil.
namespace grouser::virtual_tests {

/// Pressure of one test at a sinkage, interpolated between its rows.
struct MeasuredTrial {
  int number = 0;      ///< as in the file
  double pressure = 0; ///< [Pa]
};

/// The tests of one plate at one sinkage.
struct MeasuredPressure {
  double sinkage = 0;                ///< [m]
  std::vector<MeasuredTrial> trials; ///< trials that reach it
  double mean = 0;                   ///< [Pa]
  /// Relative standard deviation of a test [-]. A test without repetition has the root mean square of all others.
  double deviation = 0;
};

struct MeasuredPlate {
  double diameter = 0; ///< [m]
  std::vector<MeasuredPressure> points;
  double contact = 0; ///< [m] mean sinkage at which its tests first reach the contact pressure
  double deepest() const { return points.back().sinkage; } ///< [m]
};

/// Reads comma-separated rows with the columns trial, plate_diameter_mm, sinkage_mm and pressure_kPa after comment
/// lines (#), and interpolates every trial at `sinkages` [m]. Plates are sorted by diameter. Contact is where trials
/// first reach `contactPressure` [Pa]; 0 if that is 0. Throws base::InputError with file:line: no such file, a missing
/// column, a cell that is not a number, a trial with two diameters, a sinkage that no trial reaches, a contact pressure
/// that a trial starts with or never reaches.
std::vector<MeasuredPlate> readMeasuredPlates(const std::filesystem::path& file, const std::vector<double>& sinkages,
                                              double contactPressure = 0);

} // namespace grouser::virtual_tests
