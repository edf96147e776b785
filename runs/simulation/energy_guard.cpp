// SPDX-License-Identifier: BSD-3-Clause
#include "runs/simulation/energy_guard.hpp"

#include "base/error.hpp"

#include <cmath>
#include <fmt/format.h>

namespace grouser::simulation {

namespace {

/// Without the work of drives, which has a sign.
double exchanged(const Ledger& l) { return l.turnover + l.dissipated.total(); }

} // namespace

std::string EnergyGuard::judge(const Ledger& now, double held) const {
  const double lost = now.integrationError - integrationError_;
  const double moved = exchanged(now) - exchanged_ + std::fabs(now.driveWork - driveWork_);
  const double quiet = kRounding * held + kQuiet * exchanged(now);
  if (lost <= kMostLost * moved + quiet && -lost <= kMostMade * moved + quiet) return {};
  if (!std::isfinite(lost) || !std::isfinite(moved)) return "the energies are no numbers any more";
  return fmt::format("the steps have {} {:.3g} J since the last look {} steps ago at most, in which {:.3g} J were "
                     "exchanged",
                     lost > 0 ? "lost" : "made", std::fabs(lost), kInterval, moved);
}

void EnergyGuard::look(const Ledger& now) {
  integrationError_ = now.integrationError, exchanged_ = exchanged(now), driveWork_ = now.driveWork;
}

void EnergyGuard::restore(const std::vector<double>& saved) {
  if (saved.size() != 3)
    throw base::InputError("the checkpoint keeps another energy guard; resume with the program that was run");
  integrationError_ = saved[0], exchanged_ = saved[1], driveWork_ = saved[2];
}

} // namespace grouser::simulation
