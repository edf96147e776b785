// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/validation/studies/plates.hpp"

/// Tables of the plate study. Each function returns the text of a table and sets `csv`.
namespace grouser::studies {

/// Finished runs of one case.
struct CaseRuns {
  const PlateCase* plate;
  double area, breadth; ///< [m2], [m]
  std::vector<jobs::Table> runs;

  /// Mean pressure of each run over a slice of the sinkage [Pa].
  std::vector<double> pressures(const Slice& slice) const;
  /// Mean over the runs of a column; the column must be constant within each run.
  double mean(const std::string& column) const;
  bool reaches(const Slice& slice) const { return slice[1] <= plate->test.sinkage + 1e-9; }
};
/// Finished runs of all cases; omits cases without runs.
std::vector<CaseRuns> runsThatAreThere(const std::vector<PlateCase>& cases, const virtual_tests::Soil& soil, int seeds,
                                       const jobs::Pieces& pieces);

std::string pressureTable(const std::vector<CaseRuns>& all, const std::vector<Slice>& slices, std::string& csv);
/// Comparison of each case with its reference case, with a verdict; empty if there is no such pair.
std::string differenceTable(const std::vector<CaseRuns>& all, const std::vector<Slice>& slices, std::string& csv);
/// Comparison with bearing theory at `command.angle`.
std::string bearingTable(const PlatesCommand& command, const virtual_tests::Soil& soil,
                         const std::vector<CaseRuns>& all, const std::vector<Slice>& slices, std::string& csv);
/// Number of grains, number of steps, and wall time of each case.
std::string costTable(const std::vector<CaseRuns>& all, std::string& csv);

} // namespace grouser::studies
