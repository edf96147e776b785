// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/validation/studies/plates.hpp"

/// Tables of the study of plates: each returns its text and fills in the same as CSV.
namespace grouser::studies {

/// Runs of one case that are there.
struct CaseRuns {
  const PlateCase* plate;
  double area, breadth; ///< [m2], [m]
  std::vector<jobs::Table> runs;

  /// Means over a slice of the sinkage [Pa], a run each.
  std::vector<double> pressures(const Slice& slice) const;
  /// Over the runs, of a column that is the same in all rows.
  double mean(const std::string& column) const;
  bool reaches(const Slice& slice) const { return slice[1] <= plate->test.sinkage + 1e-9; }
};
/// Without the cases of which none is there.
std::vector<CaseRuns> runsThatAreThere(const std::vector<PlateCase>& cases, const virtual_tests::Soil& soil, int seeds,
                                       const jobs::Pieces& pieces);

std::string pressureTable(const std::vector<CaseRuns>& all, const std::vector<Slice>& slices, std::string& csv);
/// Each case to the one that it is compared with, and whether both are equal; empty where there is no such pair.
std::string differenceTable(const std::vector<CaseRuns>& all, const std::vector<Slice>& slices, std::string& csv);
/// Against theory, at the angle that the command names.
std::string bearingTable(const PlatesCommand& command, const virtual_tests::Soil& soil,
                         const std::vector<CaseRuns>& all, const std::vector<Slice>& slices, std::string& csv);
/// Grains, steps and wall time.
std::string costTable(const std::vector<CaseRuns>& all, std::string& csv);

} // namespace grouser::studies
