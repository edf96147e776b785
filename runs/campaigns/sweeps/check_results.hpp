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

/// What the runs of a check tell of the scene's figures.
namespace grouser::sweeps {

/// The runs of a check: those of a case with the seeds that were chosen for it.
struct CheckRuns {
  SweepPlan plan;                   ///< keys: kCaseKey, kSeedKey
  std::vector<std::size_t> caseOf;  ///< [runs] index into CheckCases::cases
  std::vector<std::int64_t> seedOf; ///< [runs]
  std::vector<RunSeries>
      series; ///< [runs] of those that have finished; all rows where hasPartInSeries(), else the last
};

/// The runs of each case in the order of their seeds.
class RunsByCase {
public:
  /// Of `cases` cases.
  RunsByCase(const CheckRuns& runs, std::size_t cases);
  /// All runs of a case.
  std::vector<std::size_t> of(std::size_t aCase) const;
  /// For each seed that all of these cases have their runs with it, in the order of the cases: found in one pass.
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
  support::Estimate change;    ///< from the base to the better or other setting, in the figure's unit; of the step
                               ///< extrapolated to nothing where an order is seen
  std::optional<double> order; ///< of the step, where one is seen
  int seeds = 0;               ///< pairs of runs behind it
  double bar = 0;              ///< what the figure may be wrong by: |change| + half width; of the step see check_errors
  jobs::Verdict verdict = jobs::Verdict::notShown; ///< against the bar
};

struct CheckFigure {
  std::string name;        ///< with its unit: "sinkage mean [m]"
  support::Estimate value; ///< of the base; half width over the seeds, 0 where seeds make no difference
  double scale = 0;        ///< largest value of all figures of its unit, by which rounding is told
  int seeds = 0;           ///< runs behind it
  std::vector<AxisError> errors;
  /// totalBar() of all but precision where seeds count; infinite where seeds make no difference and no run with a finer
  /// step is there.
  double bar = 0;
  /// Beside each run of the step axis and the base: its error bar, in the figure's unit, NaN where it has none.
  std::vector<double> barOfStep;
};

/// Sameness of bits, which skin must not change.
enum class SameBits { yes, no, notRun };

struct CheckResults {
  bool seeded = false;
  double percent = 5; ///< of a figure's mean: the bar of the verdicts
  SeedLevels levels;  ///< of all intervals
  std::vector<CheckFigure> figures;
  std::vector<std::size_t> stepCases; ///< those of barOfStep: finished cases of the step axis and the base
  SameBits skin = SameBits::notRun;
  std::string doubt; ///< why all figures are inconclusive, as where no run drove two teeth; empty where they are not
};

/// "m" of "depth [m] at the end"; empty where there is none.
std::string unitOf(const std::string& figure);

/// `folder`: that of the runs' folders. A figure is kept where a base run has it.
CheckResults checkResults(const CheckCases& cases, const CheckRuns& runs, const std::vector<SweepOutcome>& outcomes,
                          const std::filesystem::path& folder, double percent, const SeedLevels& levels = {});
/// One figure of it, but for its scale: a column that a run of the base has.
CheckFigure checkFigure(const CheckCases& cases, const RunsByCase& runs, const SweepFigures& figures,
                        std::size_t column, const CheckResults& asked);

} // namespace grouser::sweeps
