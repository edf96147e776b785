// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/table.hpp"
#include "runs/support/line_fit.hpp"
#include "runs/virtual_tests/curve_search.hpp"
#include "runs/virtual_tests/measured_plates.hpp"
#include "runs/virtual_tests/plan.hpp"
#include "runs/virtual_tests/pressure_sinkage.hpp"

#include <optional>
#include <string>
#include <vector>

/// Measured pressure-sinkage curves of plates, and an angle of repose, as targets of a calibration.
namespace grouser::virtual_tests {

/// Sections [plates] and [search] of a target file.
struct CurveTargets {
  std::vector<MeasuredPlate> plates;
  double bin = 0.3, depth = 0.12; ///< [m] side and depth of the bed
  /// [Pa] pressure at which the simulated sinkage is set to the mean measured sinkage of the same plate: measurements
  /// start at contact, but coarse grains protrude from the mean surface. 0: sinkage from the mean surface.
  double contactPressure = 0;
  std::vector<SearchRange> ranges;
  std::size_t maxTrials = 16;
  std::optional<double> repose;      ///< [deg]
  double reposeTolerance = 1;        ///< [deg] used as standard deviation of the angle of repose
  std::optional<double> bulkDensity; ///< [kg/m3] bulk density of the bed; sets the density of the solid

  /// The plates and their bed with the depth `depthOfBed` [m], for a plan.
  MeasuredPlatesBed bed(double depthOfBed) const;
};

/// Reads [plates] and [search]; `start`: initial soil of the search. Throws base::InputError with file:line,
/// key, range and remedy.
CurveTargets readCurveTargets(const base::Section& root, const std::filesystem::path& file, const TestedSoil& start);

/// A soil and the depth of its bed.
struct SoilInBed {
  TestedSoil soil;
  double depth = 0; ///< [m]
};
/// Sets a parameter of the search: a key of the material, porosity, or depth.
void setParameter(SoilInBed& bed, const std::string& key, double value);
/// Sets the parameters of a trial, in the order of the ranges, and the density of the solid from the bulk density.
void setParameters(SoilInBed& bed, const CurveTargets& targets, const std::vector<double>& values);
/// Present value of a parameter; NaN if it is not set.
double parameterOf(const SoilInBed& bed, const std::string& key);

/// A measured point and its simulated value.
struct CurvePoint {
  double diameter = 0;         ///< [m]
  MeasuredPressure measured;   ///< with its sinkage
  support::Estimate simulated; ///< [Pa] mean over the seeds
  double deviations() const;   ///< (simulated - measured mean) / standard deviation of a measured test [-]
  std::string name() const;    ///< "60 mm at 5 mm"
};
/// Curve of a plate test with the sinkage used for comparison; empty if the test never reaches the contact pressure.
SinkageCurve comparedCurve(const jobs::Table& run, const CurveTargets& targets, const MeasuredPlate& plate);
/// Finished plate tests compared with the measured points; `porosity` and `zeroOfSinkage` are means over all tests.
struct CurveComparison {
  std::vector<CurvePoint> points;
  double porosity = 0;      ///< porosity of the beds [-]
  double zeroOfSinkage = 0; ///< [m] height of zero sinkage above the bed's mean surface
};
/// Averages simulated pressures over 90 to 110 % of the sinkage, but at least over 2 mm. Uses zero pressure for a plate
/// that never reaches the contact pressure.
CurveComparison compareCurves(const TestPlan& plan, const jobs::Pieces& pieces, const CurveTargets& targets);

/// Residuals for the search: for every point ln(simulated / measured) / its measured relative deviation, which is at
/// least `kMinScatter`; then (repose - target) / tolerance, if the angle of repose is a target.
inline constexpr double kMinScatter = 0.05; ///< [-] scatter of a simulated bed
std::vector<double> curveResiduals(const std::vector<CurvePoint>& points, const std::optional<double>& repose,
                                   const CurveTargets& targets);

/// Tables: printed comparison; CSV with a row for each measured test and point; CSV of all simulated curves.
std::string curvesText(const std::vector<CurvePoint>& points);
std::string curvePointsCsv(const std::vector<CurvePoint>& points);
std::string curvesCsv(const TestPlan& plan, const jobs::Pieces& pieces, const CurveTargets& targets);

} // namespace grouser::virtual_tests
