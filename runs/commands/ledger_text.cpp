// SPDX-License-Identifier: BSD-3-Clause
#include "runs/commands/ledger_text.hpp"

#include "coupling/simulation.hpp"

#include <fmt/format.h>

#include <string>

namespace grouser::commands {

void describeLedger(coupling::Simulation& simulation) {
  const coupling::Ledger l = simulation.ledger();
  const coupling::VehicleRig* rig = simulation.vehicle();
  const std::string hitch =
      rig && rig->towing() ? fmt::format(" (of the hitch {:.4g})", rig->towing()->work()) : std::string();
  fmt::print(
      "ledger    since the start [J]: drive work {:.4g}{} = kinetic {:+.4g}, potential {:+.4g}, elastic {:+.4g}, "
      "dissipated {:+.4g}, integration error {:+.3g}; left over {:.2g}\n",
      l.driveWork, hitch, l.kinetic, l.potential, l.elastic, l.dissipated.total(), l.integrationError, l.residual);
  std::string causes;
  for (const coupling::DissipationCause& cause : coupling::kDissipationCauses)
    if (const double heat = l.dissipated.*cause.heat; heat != 0)
      causes += fmt::format("{}{} {:.4g}", causes.empty() ? "" : ", ", cause.word, heat);
  if (!causes.empty()) fmt::print("          dissipated by {}\n", causes);
  const auto shown = [](const base::Vec3d& v) { return fmt::format("({:.2g}, {:.2g}, {:.2g})", v.x, v.y, v.z); };
  fmt::print("momentum  left over {} N s, angular {} N m s\n", shown(l.momentumResidual), shown(l.angularResidual));
  if (simulation.vehicle() && simulation.ground().grains)
    fmt::print("impulse   on vehicle plus on bed: ({:g}, {:g}, {:g}) N s\n", l.impulseResidual.x, l.impulseResidual.y,
               l.impulseResidual.z);
}

} // namespace grouser::commands
