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
  std::vector<MeasuredTrial> trials; ///< the trials that reach this sinkage
  double mean = 0;                   ///< [Pa]
  /// Relative standard deviation of a test [-]; for a single test, the root mean square of all other deviations.
  double deviation = 0;
};

struct MeasuredPlate {
  double diameter = 0; ///< [m]
  std::vector<MeasuredPressure> points;
  double contact = 0; ///< [m] mean sinkage at which the tests of this plate first reach the contact pressure
  double deepest() const { return points.back().sinkage; } ///< [m]
};

/// Reads comma-separated rows with the columns trial, plate_diameter_mm, sinkage_mm and pressure_kPa after comment
/// lines (#), and interpolates every trial at `sinkages` [m]. Sorts the plates by diameter. MeasuredPlate::contact is 0
/// if `contactPressure` [Pa] is 0. Throws base::InputError if the file or a column is missing, a cell is not a number,
/// a trial has two diameters, no trial reaches one of the sinkages, or a trial starts above the contact pressure or
/// never reaches it.
std::vector<MeasuredPlate> readMeasuredPlates(const std::filesystem::path& file, const std::vector<double>& sinkages,
                                              double contactPressure = 0);

} // namespace grouser::virtual_tests
