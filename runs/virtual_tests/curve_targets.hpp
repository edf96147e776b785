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

/// Measured curves of plates, and an angle of repose, as targets of a calibration.
namespace grouser::virtual_tests {

/// Sections [plates] and [search] of a file of targets.
struct CurveTargets {
  std::vector<MeasuredPlate> plates;
  double bin = 0.3, depth = 0.12; ///< [m] side and depth of the bed
  /// [Pa] pressure at which simulated sinkage equals the mean measured sinkage of that plate, as tests are zeroed at
  /// contact and coarse grains protrude from the mean surface; 0: sinkage from the mean surface.
  double contactPressure = 0;
  std::vector<SearchRange> ranges;
  std::size_t mostTrials = 16;
  std::optional<double> repose;      ///< [deg]
  double reposeTolerance = 1;        ///< [deg] counts as a standard deviation
  std::optional<double> bulkDensity; ///< [kg/m3] bulk density of the bed; sets the density of the solid

  /// The plates and their bed of this depth [m], for a plan.
  MeasuredPlatesBed bed(double depthOfBed) const;
};

/// Reads [plates] and [search]; `start`: initial soil of the search. Throws base::InputError: file:line and
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
  double deviations() const;   ///< simulated less measured mean, in standard deviations of a measured test [-]
  std::string name() const;    ///< "60 mm at 5 mm"
};
/// Curve of a plate test with the sinkage used for comparison; empty if it never reaches the contact pressure.
SinkageCurve comparedCurve(const jobs::Table& run, const CurveTargets& targets, const MeasuredPlate& plate);
/// The finished tests of plates beside the measured points; means over the plates.
struct CurveComparison {
  std::vector<CurvePoint> points;
  double porosity = 0;      ///< porosity of the beds [-]
  double zeroOfSinkage = 0; ///< [m] height above the bed's mean surface from which sinkage counts
};
/// Simulated pressures are averaged over 90 to 110 % of the sinkage, at least over 2 mm. A plate that never reaches the
/// contact pressure has zero pressure.
CurveComparison compareCurves(const TestPlan& plan, const jobs::Pieces& pieces, const CurveTargets& targets);

/// For the search: ln(simulated / measured) of every point over its measured relative deviation, at least
/// `kLeastScatter`; then (repose - target) over its tolerance, if it is a target.
inline constexpr double kLeastScatter = 0.05; ///< [-] scatter of a simulated bed
std::vector<double> curveResiduals(const std::vector<CurvePoint>& points, const std::optional<double>& repose,
                                   const CurveTargets& targets);

/// Tables: a text, a row for each measured test and point, and all curves.
std::string curvesText(const std::vector<CurvePoint>& points);
std::string curvePointsCsv(const std::vector<CurvePoint>& points);
std::string curvesCsv(const TestPlan& plan, const jobs::Pieces& pieces, const CurveTargets& targets);

} // namespace grouser::virtual_tests
