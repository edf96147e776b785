// SPDX-License-Identifier: BSD-3-Clause
#include "runs/commands/ledger_text.hpp"

#include "coupling/simulation.hpp"

#include <fmt/format.h>

#include <string>
#include <utility>

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
  const coupling::Dissipated& d = l.dissipated;
  std::string causes;
  for (const auto& [cause, loss] : {std::pair{"damping", d.damping},
                                    {"friction", d.friction},
                                    {"micro-slip", d.microSlip},
                                    {"rolling", d.rolling},
                                    {"yielding", d.yielding},
                                    {"crushing", d.crushing},
                                    {"parts", d.parts},
                                    {"joints", d.joints}})
    if (loss != 0) causes += fmt::format("{}{} {:.4g}", causes.empty() ? "" : ", ", cause, loss);
  if (!causes.empty()) fmt::print("          dissipated by {}\n", causes);
  const auto shown = [](const base::Vec3d& v) { return fmt::format("({:.2g}, {:.2g}, {:.2g})", v.x, v.y, v.z); };
  fmt::print("momentum  left over {} N s, angular {} N m s\n", shown(l.momentumResidual), shown(l.angularResidual));
  if (simulation.vehicle() && simulation.ground().grains)
    fmt::print("impulse   on vehicle plus on bed: ({:g}, {:g}, {:g}) N s\n", l.impulseResidual.x, l.impulseResidual.y,
               l.impulseResidual.z);
}

} // namespace grouser::commands
