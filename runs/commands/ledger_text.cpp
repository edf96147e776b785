// SPDX-License-Identifier: BSD-3-Clause
#include "runs/commands/ledger_text.hpp"

#include "coupling/simulation.hpp"

#include <fmt/format.h>

#include <string>

namespace grouser::commands {

namespace {

/// Energies of deformable soil: elastic, then dissipated.
std::string soilText(const scm::SoilEnergy& soil) {
  std::string text = "elastic energy [J]:";
  std::size_t number = 0;
  for (const coupling::SoilEnergyEntry& entry : coupling::kSoilEnergies) {
    if (number == coupling::kElasticSoilEnergies) text += "; dissipated:";
    const bool begins = number == 0 || number == coupling::kElasticSoilEnergies;
    std::string word = entry.word;
    if (word.starts_with("elastic_")) word.erase(0, 8);
    text += fmt::format("{}{} {:.4g}", begins ? " " : ", ", word, soil.*entry.energy);
    ++number;
  }
  return text;
}

} // namespace

void describeLedger(coupling::Simulation& simulation) {
  const coupling::Ledger l = simulation.ledger();
  const coupling::VehicleRig* rig = simulation.vehicle();
  const std::string hitch =
      rig && rig->towing() ? fmt::format(" (hitch {:.4g})", rig->towing()->work()) : std::string();
  fmt::print(
      "ledger    since the start [J]: drive work {:.4g}{} = kinetic {:+.4g}, potential {:+.4g}, elastic {:+.4g}, "
      "dissipated {:+.4g}, integration error {:+.3g}; residual {:.2g}\n",
      l.driveWork, hitch, l.kinetic, l.potential, l.elastic, l.dissipated.total(), l.integrationError, l.residual);
  std::string causes;
  for (const coupling::DissipationCause& cause : coupling::kDissipationCauses)
    if (const double heat = l.dissipated.*cause.heat; heat != 0)
      causes += fmt::format("{}{} {:.4g}", causes.empty() ? "" : ", ", cause.word, heat);
  const coupling::Ground* ground = simulation.actingGround();
  const bool deforms = ground && ground->traits().deforms;
  if (deforms) causes += fmt::format("{}soil {:.4g}", causes.empty() ? "" : ", ", l.dissipated.soil);
  if (const double heat = l.dissipated.stabilisation; heat != 0)
    causes += fmt::format("{}stabilisation {:.4g}", causes.empty() ? "" : ", ", heat);
  if (!causes.empty()) fmt::print("          dissipated by {}\n", causes);
  if (deforms) fmt::print("soil      {}\n", soilText(l.soil));
  const auto shown = [](const base::Vec3d& v) { return fmt::format("({:.2g}, {:.2g}, {:.2g})", v.x, v.y, v.z); };
  fmt::print("momentum  residual {} N s, angular {} N m s\n", shown(l.momentumResidual), shown(l.angularResidual));
  if (simulation.vehicle() && simulation.ground().grains)
    fmt::print("impulse   on vehicle plus on bed: ({:g}, {:g}, {:g}) N s\n", l.impulseResidual.x, l.impulseResidual.y,
               l.impulseResidual.z);
}

} // namespace grouser::commands
