// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "runs/validation/studies/multibody.hpp"

#include <string>
#include <vector>

/// The tables of `grouser study multibody`, as text and as CSV.
namespace grouser::studies {

/// Maximum errors for the low and the high precision of the IFToMM benchmark [-].
inline constexpr double kLowPrecision = 1e-1, kHighPrecision = 1e-3;

struct StudyResult {
  StudyCase study;
  std::vector<StudyPoint> points;
};
std::string caseTable(const StudyResult& result);
std::string pointsCsv(const std::vector<StudyResult>& results);

/// The point with the smallest CPU time among those with an error of at most `threshold`; null if there is none.
const StudyPoint* cheapest(const StudyResult& result, double threshold);
std::string cheapestTable(const std::vector<StudyResult>& results);
std::string cheapestCsv(const std::vector<StudyResult>& results);

std::string reactionTable(const std::vector<ReactionResult>& results);
std::string reactionsCsv(const std::vector<ReactionResult>& results);

} // namespace grouser::studies
