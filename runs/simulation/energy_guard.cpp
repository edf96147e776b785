// SPDX-License-Identifier: BSD-3-Clause
#include "runs/simulation/energy_guard.hpp"

#include "base/error.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace grouser::simulation {

std::string EnergyGuard::judge(const Ledger& now, double held) const {
  const double lost = now.integrationError - last_.error, taken = now.dissipated.total() - last_.dissipated;
  const double moved = now.turnover - last_.turnover + std::fabs(taken) + std::fabs(now.driveWork - last_.driveWork);
  const double quiet = kRounding * held + kQuiet * (now.turnover + std::fabs(now.dissipated.total())) +
                       kSpringShare * std::fabs(now.elastic - last_.elastic);
  if (!std::isfinite(lost) || !std::isfinite(moved)) return "the energies are no numbers any more";
  const auto since = [&](const char* what, double energy) {
    return fmt::format("{} {:.3g} J since the last look {} steps ago at most, in which {:.3g} J were exchanged", what,
                       energy, kInterval, moved);
  };
  if (lost > kMostLost * moved + quiet) return since("the steps have lost", lost);
  if (-lost > kMostMade * moved + quiet) return since("the steps have made", -lost);
  // Where dampers give what the steps lose, nothing is made.
  const double given = std::min(-taken, -taken - lost);
  if (given > kMostGiven * moved + quiet) return since("steps too long for dampers have let these make", given);
  return {};
}

void EnergyGuard::look(const Ledger& now) {
  last_ = {now.integrationError, now.turnover, now.dissipated.total(), now.driveWork, now.elastic};
}

void EnergyGuard::restore(const std::vector<double>& saved) {
  if (saved.size() != 5)
    throw base::InputError("the checkpoint keeps another energy guard; resume with the program that was run");
  last_ = {saved[0], saved[1], saved[2], saved[3], saved[4]};
}

} // namespace grouser::simulation
