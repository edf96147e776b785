// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/campaigns/sweeps/check_cases.hpp"
#include "runs/campaigns/sweeps/check_errors.hpp"
#include "runs/campaigns/sweeps/run_series.hpp"
#include "runs/campaigns/sweeps/sweep_summary.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

/// Figures of a scene with error bars, computed from the runs of a check.
namespace grouser::sweeps {

/// Runs of a check: each case with its selected seeds.
struct CheckRuns {
  SweepPlan plan;                   ///< with the keys kCaseKey and kSeedKey
  std::vector<std::size_t> caseOf;  ///< [runs] index into CheckCases::cases
  std::vector<std::int64_t> seedOf; ///< [runs]
  std::vector<RunSeries> series;    ///< [runs] series of finished runs; if not hasPartInSeries(), only the last row
};

/// Runs of each case, ordered by seed.
class RunsByCase {
public:
  /// `cases`: number of cases.
  RunsByCase(const CheckRuns& runs, std::size_t cases);
  /// All runs of a case.
  std::vector<std::size_t> of(std::size_t aCase) const;
  /// For each seed that these cases have in common, the runs in the order of the cases.
  std::vector<std::vector<std::size_t>> sharing(const std::vector<std::size_t>& cases) const;

private:
  struct Member {
    std::int64_t seed;
    std::size_t run;
  };
  std::vector<std::vector<Member>> members_; ///< [cases]
};

/// Error of a figure by one axis.
struct AxisError {
  CheckAxis axis = CheckAxis::step;
  support::Estimate change;    ///< change from the base to the other setting, in the figure's unit; if an order is
                               ///< observed, extrapolated to zero step
  std::optional<double> order; ///< observed order of the step
  int seeds = 0;               ///< number of seeds with runs of both cases
  double bar = 0;              ///< error bar: |change| + half width; for the step see check_errors
  jobs::Verdict verdict = jobs::Verdict::inconclusive; ///< compares the change with the bar
};

struct CheckFigure {
  std::string name;        ///< with its unit: "sinkage mean [m]"
  support::Estimate value; ///< value of the base; half width over seeds, 0 without seed dependence
  double scale = 0;        ///< largest value of all figures in the same unit, for the rounding threshold
  int seeds = 0;           ///< number of runs
  std::vector<AxisError> errors;
  /// totalBar() of all axes (with seed dependence except precision). Without seed dependence infinite if there are
  /// none, or if the time step is an axis without a finished run.
  double bar = 0;
  /// Error bar at each step of the step axis and the base, in the figure's unit; NaN if unknown.
  std::vector<double> barOfStep;
};

/// Whether results with another skin are bitwise equal.
enum class SameBits { yes, no, notRun };

struct CheckResults {
  bool seeded = false;
  bool hitched = false; ///< whether the scene has [hitch]: drawbar pull is then a main figure
  double percent = 5;   ///< percentage of a figure's mean: tolerance of the verdicts
  SeedLevels levels;    ///< levels of all intervals
  std::vector<CheckFigure> figures;
  std::vector<std::size_t> stepCases; ///< cases of barOfStep: the base, and finished cases of the step axis
  SameBits skin = SameBits::notRun;
  std::string doubt; ///< reason why all figures are inconclusive, e.g. no run passed two teeth; else empty
};

/// Unit in the name of a figure: "m" of "depth [m] at the end"; empty if there is none.
std::string unitOf(const std::string& figure);

/// `folder` contains the folders of the runs. The base runs define the list of figures.
CheckResults checkResults(const CheckCases& cases, const CheckRuns& runs, const std::vector<SweepOutcome>& outcomes,
                          const std::filesystem::path& folder, double percent, const SeedLevels& levels = {});
/// One figure, without its scale. `column`: column of a base run.
CheckFigure checkFigure(const CheckCases& cases, const RunsByCase& runs, const SweepFigures& figures,
                        std::size_t column, const CheckResults& asked);

} // namespace grouser::sweeps
