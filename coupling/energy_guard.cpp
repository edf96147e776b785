// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/energy_guard.hpp"

#include "base/error.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace grouser::coupling {

namespace {

/// Energy error that never raises an alarm [J]: rounding, a small fraction of all energy exchanged so far, and errors
/// hidden by springs.
double neverAlarms(const Ledger& now, double held, double hidden) {
  return EnergyGuard::kRounding * held + EnergyGuard::kQuiet * (now.turnover + std::fabs(now.dissipated.total())) +
         hidden;
}

} // namespace

EnergyGuard::Exchange EnergyGuard::since(const Ledger& now, double held) const {
  Exchange x;
  const double taken = now.dissipated.total() - last_.dissipated;
  x.lost = now.integrationError - last_.error;
  x.gained = std::min(-x.lost, -x.lost - taken);
  x.given = std::min(-taken, -taken - x.lost);
  x.taken = taken;
  x.heat = taken - std::min(0.0, now.dissipated.ofGrains() - last_.ofGrains);
  x.moved = now.turnover - last_.turnover + std::fabs(taken) + std::fabs(now.driveWork - last_.driveWork);
  x.neverAlarms = neverAlarms(now, held, kSpringShare * std::fabs(now.elastic - last_.elastic));
  return x;
}

std::string EnergyGuard::judge(const Ledger& now, double held, std::optional<double> implicit) const {
  Exchange x = since(now, held);
  x.neverAlarms += implicit.value_or(0);
  if (!std::isfinite(x.lost) || !std::isfinite(x.moved)) return "the energies are not finite";
  const auto found = [&](const char* what, double energy) {
    return fmt::format("{} {:.3g} J since the last check (at most {} steps ago), of {:.3g} J exchanged", what, energy,
                       kInterval, x.moved);
  };
  if (!implicit && x.lost > kMaxLost * x.moved + x.neverAlarms) return found("time integration lost", x.lost);
  if (x.gained > kMaxMade * x.moved + x.neverAlarms || -x.lost > kMaxSpuriousDissipation * x.moved + x.neverAlarms)
    return found("time integration created", -x.lost);
  if (x.given > kMaxGiven * x.moved + x.neverAlarms)
    return found("the time step is too long: dampers created", x.given);
  return judgeHeat(now, held, implicit.value_or(0));
}

std::string EnergyGuard::judgeHeat(const Ledger& now, double held, double solver) const {
  if (now.dissipated.ofParts() <= now.dissipated.ofGrains()) return {}; // sliding dissipates energy created by steps
  if (now.dissipated.ofParts() <= 0) return {}; // grains only; their elastic impacts may dissipate a little less than 0
  Exchange x = since(now, held);
  x.neverAlarms += solver;
  // The elastic energy of a large bed varies before a vehicle has dissipated much; the dashpots of the bed then seem to
  // create the energy that parts dissipate.
  if (-x.lost > kMaxMade * (x.heat + x.lost) + x.neverAlarms)
    return fmt::format("time integration created {:.3g} J of the {:.3g} J dissipated since the last check (at most {} "
                       "steps ago)",
                       -x.lost, x.heat, kInterval);
  const double all = now.dissipated.total() - std::min(0.0, now.dissipated.ofGrains()), made = -now.integrationError;
  const double bed = std::max(maxInGrains_, std::fabs(now.grainElastic));
  const double hidden = std::clamp(kMaxHidden * now.dissipated.ofParts(), kElasticTolerance * bed, kSpringShare * bed);
  if (std::max(all, made) <= kAtTheStart * held) return {};
  if (made > kMaxMade * (all - made) + neverAlarms(now, held, hidden) + solver)
    return fmt::format("time integration created {:.3g} J of the {:.3g} J dissipated since the start", made, all);
  return {};
}

void EnergyGuard::look(const Ledger& now) {
  last_ = {now.integrationError, now.turnover, now.dissipated.total(),
           now.driveWork,        now.elastic,  now.dissipated.ofGrains()};
  maxInGrains_ = std::max(maxInGrains_, std::fabs(now.grainElastic));
}

void EnergyGuard::restore(const std::vector<double>& saved) {
  if (saved.size() != 7)
    throw base::InputError(
        "the checkpoint's energy check has a different layout; resume with the program version that wrote it");
  last_ = {saved[0], saved[1], saved[2], saved[3], saved[4], saved[5]};
  maxInGrains_ = saved[6];
}

} // namespace grouser::coupling
