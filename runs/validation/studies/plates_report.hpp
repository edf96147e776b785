// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/validation/studies/plates.hpp"

/// Tables of the plate study: each returns its text and fills in the CSV.
namespace grouser::studies {

/// Finished runs of one case.
struct CaseRuns {
  const PlateCase* plate;
  double area, breadth; ///< [m2], [m]
  std::vector<jobs::Table> runs;

  /// Mean pressure over a slice of the sinkage for each run [Pa].
  std::vector<double> pressures(const Slice& slice) const;
  /// Mean over the runs of a column that is constant within each run.
  double mean(const std::string& column) const;
  bool reaches(const Slice& slice) const { return slice[1] <= plate->test.sinkage + 1e-9; }
};
/// Without cases that have no runs.
std::vector<CaseRuns> runsThatAreThere(const std::vector<PlateCase>& cases, const virtual_tests::Soil& soil, int seeds,
                                       const jobs::Pieces& pieces);

std::string pressureTable(const std::vector<CaseRuns>& all, const std::vector<Slice>& slices, std::string& csv);
/// Each case against its reference case, with a verdict; empty if there is no such pair.
std::string differenceTable(const std::vector<CaseRuns>& all, const std::vector<Slice>& slices, std::string& csv);
/// Comparison with theory at the angle of the command.
std::string bearingTable(const PlatesCommand& command, const virtual_tests::Soil& soil,
                         const std::vector<CaseRuns>& all, const std::vector<Slice>& slices, std::string& csv);
/// Grains, steps and wall time.
std::string costTable(const std::vector<CaseRuns>& all, std::string& csv);

} // namespace grouser::studies
