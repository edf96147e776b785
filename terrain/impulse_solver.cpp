// SPDX-License-Identifier: BSD-3-Clause
#include "terrain/impulse_solver.hpp"

#include "base/bits.hpp"
#include "base/error.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace grouser::terrain {

void checkReport(const ImpulseReport& report, const contact::ComplementarityOptions& options, std::int64_t step) {
  constexpr double kMax = 1e30; // m/s
  if (report.residual > kMax)
    throw base::SimulationError(
        fmt::format("step {}: contact velocities of grains are not finite; use a smaller time_step", step),
        base::Cause::noNumber);
  if (!options.strict || (report.met && !report.relaxed)) return;
  if (report.met)
    throw base::SimulationError(fmt::format("step {}: Coulomb's law did not converge; use complementarity.friction = "
                                            "\"associated\", a smaller time_step, or strict = false",
                                            step));
  throw base::SimulationError(
      fmt::format("step {}: contact residual {:.3g} m/s after {} iterations exceeds run.residual "
                  "= {:.3g} m/s; raise complementarity.iterations or run.residual, or use a "
                  "smaller time_step",
                  step, report.residual, report.iterations, options.residual));
}

void ImpulseTotals::add(const ImpulseReport& report) {
  ++steps, iterations += report.iterations;
  missed += !report.met, relaxed += report.relaxed, raised += report.raised;
  worst = std::max(worst, report.residual);
}

std::vector<std::int64_t> ImpulseTotals::words() const {
  return {steps, iterations, missed, relaxed, base::bitsAs<std::int64_t>(worst), base::bitsAs<std::int64_t>(tau),
          raised};
}

void ImpulseTotals::setWords(const std::int64_t* words) {
  steps = words[0], iterations = words[1], missed = words[2], relaxed = words[3];
  worst = base::bitsAs<double>(words[4]), tau = base::bitsAs<double>(words[5]);
  raised = words[6];
}

} // namespace grouser::terrain
