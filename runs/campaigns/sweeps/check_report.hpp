// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/campaigns/sweeps/check_record.hpp"

#include <string>
#include <vector>

/// Reports of a check as text, JSON and a plot.
namespace grouser::sweeps {

/// Time step and number of seeds that keep the error of a figure within `percent` of its value at the lowest cost.
struct Cheapest {
  std::string name; ///< case; empty: no tested case suffices
  double step = 0;  ///< relative error bar of the time step [-]
  int seeds = 0;    ///< 1 without seed dependence
  double wall = 0;  ///< wall time of all runs of these seeds in sequence [s]
};
Cheapest cheapest(const CheckRecord& record, const CheckResults& results, const CheckFigure& figure, double percent);

/// Values, errors, verdicts and runs; bitwise independent of the order of the runs. Figures without a value are null.
std::string checkJson(const CheckRecord& record, const CheckResults& results);
/// Costs of the runs on this machine, and the cheapest settings for 10, 5 and 1 %.
std::string costsJson(const CheckRecord& record, const CheckResults& results);

/// Text of the main figures, for the terminal.
std::string checkText(const CheckRecord& record, const CheckResults& results);

/// Whether a figure is known and its value or bar exceeds rounding errors, 1e-12 of its scale.
bool isAboveRounding(const CheckFigure& figure);
/// Whether this is a main figure: figures of the vehicle, or else forces on surfaces, or else all figures.
bool isHeadline(const CheckResults& results, const CheckFigure& figure);

inline constexpr const char *kCheckFile = "check.json", *kCheckCosts = "costs.json", *kCheckSeries = "series.csv",
                            *kCheckPlot = "check.png", *kCheckChoice = "choice.json";

} // namespace grouser::sweeps
