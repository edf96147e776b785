// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/campaigns/sweeps/check_record.hpp"

#include <string>
#include <vector>

/// What a check leaves: as text, as files, and as a page.
namespace grouser::sweeps {

/// Of a figure the cheapest step, with so many seeds, that keeps its error by both within `percent` of its value.
struct Cheapest {
  std::string name; ///< of the case; empty: none of those run
  double step = 0;  ///< error bar by the step [-]
  int seeds = 0;    ///< 1 where they make no difference
  double wall = 0;  ///< of all these runs, one after the other [s]
};
Cheapest cheapest(const CheckRecord& record, const CheckResults& results, const CheckFigure& figure, double percent);

/// Values, errors, verdicts and what was run: the same bytes whenever and however the runs were made. Figures without a
/// number are null.
std::string checkJson(const CheckRecord& record, const CheckResults& results);
/// What each run took on this machine, and the cheapest settings for 10, 5 and 1 %.
std::string costsJson(const CheckRecord& record, const CheckResults& results);

/// The figures one asks for first, to read in a terminal.
std::string checkText(const CheckRecord& record, const CheckResults& results);

/// Whether a figure says more than that something is zero: it is known, and itself or its bar is above rounding, 1e-12
/// of its scale.
bool isTold(const CheckFigure& figure);
/// Of a vehicle the figures one asks for first, of surfaces forces, else all.
bool isHeadline(const CheckResults& results, const CheckFigure& figure);

inline constexpr const char *kCheckFile = "check.json", *kCheckCosts = "costs.json", *kCheckSeries = "series.csv",
                            *kCheckPlot = "check.png", *kCheckChoice = "choice.json";

} // namespace grouser::sweeps
