// SPDX-License-Identifier: BSD-3-Clause
#include "runs/session/final_figures.hpp"

#include <algorithm>
#include <optional>

namespace grouser::session {

namespace {

void noteBed(const coupling::Simulation& simulation, output::Summary& summary) {
  if (simulation.settled().steps > 0) {
    summary.figures["bed_highest_m"] = simulation.settled().highest;
    summary.figures["bed_mean_height_m"] = simulation.settled().meanHeight;
  }
  if (const auto& bed = simulation.ground().structure) {
    summary.figures["bed_porosity"] = bed->porosity;
    summary.figures["bed_order"] = bed->order;
    summary.figures["bed_thickness_in_mean_diameters"] = bed->thickness / bed->meanDiameter;
  }
}

void noteSolver(const terrain::ImpulseTotals& all, const SqueezedRecord& squeezed, output::Summary& summary) {
  summary.figures["solver_iterations_a_step"] =
      all.steps > 0 ? static_cast<double>(all.iterations) / static_cast<double>(all.steps) : 0;
  summary.figures["solver_worst_residual"] = all.worst;
  summary.figures["solver_max_overlap"] = std::max(squeezed.overlap, squeezed.share);
  summary.figures["solver_missed_steps"] = static_cast<double>(all.missed);
  summary.figures["solver_relaxed_steps"] = static_cast<double>(all.relaxed);
  summary.figures["solver_raised_steps"] = static_cast<double>(all.raised);
}

void noteDrive(const coupling::VehicleRig& rig, output::RunWriter& writer, output::Summary& summary) {
  if (const std::optional<double> start = rig.driveStart()) summary.figures["drive_start_s"] = *start;
  if (!rig.ended().empty()) writer.fact("ended_by", rig.ended());
  summary.figures["ground_force_most_over_weight"] = rig.observe().blows.most;
}

void noteCrushing(coupling::Simulation& simulation, output::Summary& summary) {
  const double cut = simulation.ledger().cutImpulse;
  if (const coupling::VehicleRig* rig = simulation.vehicle())
    summary.figures["crushing_cut_over_weight"] =
        cut / (rig->assembly().mass * norm(simulation.setup().gravity) * simulation.time());
  summary.figures["crushing_cut_impulse"] = cut;
  const coupling::CrushedGrains& gone = simulation.crushedGrains();
  summary.figures["crushed_grains"] = gone.grains, summary.figures["crushed_mass_kg"] = gone.mass;
  summary.figures["crushed_energy_J"] = gone.energy;
}

void noteSqueezed(Recorder& recorder, output::Summary& summary) {
  const SqueezedRecord& squeezed = recorder.squeezed();
  if (squeezed.text().empty()) return;
  summary.figures["squeezed_pairs_most"] = squeezed.pairs;
  summary.figures["squeezed_at_boundaries_most"] = squeezed.atBoundaries;
  summary.figures["squeezed_by_parts_most"] = squeezed.byParts;
  if (squeezed.share > 0) recorder.writer().fact("deepest_in_a_part", squeezed.deepest());
}

/// Time-integration error below which the state is at rest [J]: a ten-thousandth of m g radius of all grains, as in
/// coupling::EnergyGuard, and the work of the weight of all bodies on a nanometre.
double quietEnergy(const coupling::Simulation& simulation) {
  constexpr double kNanometre = 1e-9; // [m]
  const double g = norm(simulation.setup().gravity);
  double energy = 0;
  if (const auto& grains = simulation.ground().grains) {
    const auto moving = static_cast<double>(grains->count() - grains->system().fixedCount);
    energy += coupling::EnergyGuard::kAtTheStart * grains->model().mass * g * grains->model().radius * moving;
  }
  const auto add = [&](const multibody::Model& model) {
    for (const multibody::Body& body : model.bodies()) energy += body.fixed ? 0 : body.mass * g * kNanometre;
  };
  if (simulation.vehicle())
    add(simulation.vehicle()->model());
  else if (simulation.mechanism())
    add(simulation.mechanism()->model());
  return energy;
}

} // namespace

void noteFigures(RunSession& run, output::Summary& summary) {
  coupling::Simulation& simulation = run.simulation();
  const coupling::Ledger ledger = simulation.ledger();
  summary.figures["energy_converted_J"] = ledger.turnover, summary.figures["energy_residual_J"] = ledger.residual;
  summary.figures["integration_error_J"] = ledger.integrationError;
  summary.figures["quiet_energy_J"] = quietEnergy(simulation);
  noteBed(simulation, summary);
  if (const auto& grains = simulation.ground().grains; grains && grains->system().impulses)
    noteSolver(grains->system().impulses->totals(), run.recorder().squeezed(), summary);
  if (simulation.vehicle()) noteDrive(*simulation.vehicle(), run.writer(), summary);
  if (simulation.actingGround())
    if (const auto fields = simulation.actingGround()->fieldsNow())
      summary.figures["largest_sinkage_m"] = fields->deepest;
  if (simulation.setup().crushes()) noteCrushing(simulation, summary);
  noteSqueezed(run.recorder(), summary);
}

} // namespace grouser::session
