// SPDX-License-Identifier: BSD-3-Clause
#include "terrain/impulse_solver.hpp"

#include "base/bits.hpp"

#include <algorithm>

namespace grouser::terrain {

void ImpulseTotals::add(const ImpulseReport& report) {
  ++steps, iterations += report.iterations;
  missed += !report.met, relaxed += report.relaxed;
  worst = std::max(worst, report.residual);
}

std::vector<std::int64_t> ImpulseTotals::words() const {
  return {steps, iterations, missed, relaxed, base::bitsAs<std::int64_t>(worst)};
}

void ImpulseTotals::setWords(const std::int64_t* words) {
  steps = words[0], iterations = words[1], missed = words[2], relaxed = words[3];
  worst = base::bitsAs<double>(words[4]);
}

} // namespace grouser::terrain
