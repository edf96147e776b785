// SPDX-License-Identifier: BSD-3-Clause
#include "runs/commands/bed_text.hpp"

#include "base/math.hpp"
#include "runs/scene/scene.hpp"
#include "runs/session/preparation.hpp"
#include "runs/setup/bed_options.hpp"
#include "runs/setup/placement.hpp"
#include "runs/support/print_stderr.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <variant>

namespace grouser::commands {

namespace {

constexpr double kDeep = 1.6, kWide = 9.6; // [pad widths]
constexpr double kGrainsInPad = 20;

/// Mean diameter of the grains under a pad [m]. In a graded bed: grains of the surface layer, if it is deep enough for
/// a plate to sink as in a uniform bed (docs/soils.md#virtual-soil-tests).
double pressedDiameter(const coupling::Simulation& simulation, double padWidth) {
  constexpr double kFine = 0.1; // [pad widths]
  const std::optional<coupling::GrainsSetup>& grains = simulation.setup().ground.grains;
  const auto* random =
      grains && grains->bed ? std::get_if<terrain::RandomBedOptions>(&grains->bed->options.grains) : nullptr;
  return random && random->grading.any() && random->grading.fineDepth >= kFine * padWidth
             ? 2 * random->radii.meanPower(1)
             : simulation.ground().structure->meanDiameter;
}

} // namespace

std::string grainsText(const terrain::Grains& grains) {
  const terrain::GrainSystem& system = grains.system();
  const double smallest = system.constants.smallestRadius, largest = grains.model().radius;
  std::string text = fmt::format("{} of radius {:g}", grains.count(), smallest);
  if (largest > smallest) text += fmt::format(" to {:g}", largest);
  return text + (system.fixedCount > 0 ? fmt::format(" m, {} fixed", system.fixedCount) : " m");
}

std::string bedText(const coupling::Simulation& simulation) {
  const coupling::SettleReport& settled = simulation.settled();
  std::string text;
  if (settled.steps > 0)
    text = fmt::format(
        "settled   in {:.2f} s of simulated time; kinetic energy ratio {:.2g} (mean per grain / (m g radius)){}\n",
        settled.time, settled.energyRatio,
        settled.friction > 0 ? fmt::format("; prepared with friction {:.4g}", settled.friction) : "");
  if (const std::optional<terrain::BedStructure>& bed = simulation.ground().structure; bed && bed->grains > 0)
    text += fmt::format(
        "packing   porosity {:.4f} +- {:.4f}, {:.2f} contacts per grain, {:.1f} % rattlers, {:.1f} % crystalline\n"
        "surface   mean height {:.4f} m, range {:.4f} to {:.4f} m; bed thickness {:.4f} m, {:.1f} mean diameters\n",
        bed->porosity, bed->porosityError, bed->coordination, 100 * bed->rattlers, 100 * bed->order, bed->settledHeight,
        bed->lowest, bed->highest, bed->thickness, bed->thickness / bed->meanDiameter);
  if (settled.highest != 0) text += fmt::format("          top of the highest grain at {:.6g} m\n", settled.highest);
  return text;
}

std::vector<std::string> bedNotes(const TrackOnBed& t) {
  std::vector<std::string> notes;
  const double deep = kDeep * t.padWidth, wide = t.gauge + kWide * t.padWidth, fine = t.padWidth / kGrainsInPad;
  if (t.thickness + 0.5 * t.meanDiameter < deep) // beds settle to at most this much below terrain.depth
    notes.push_back(fmt::format(
        "the bed is {:.2f} m deep, but tracks {:.2f} m wide load it to a depth of {:.2f} m: sinkage and traction "
        "depend on the floor; use terrain.depth >= {:.2g} m plus sinkage to remove the floor effect",
        t.thickness, t.padWidth, deep, deep));
  if (t.walls && t.width < wide)
    notes.push_back(fmt::format("the bed is {:.2f} m wide, but both tracks load a width of {:.2f} m: the walls confine "
                                "the soil; set the width in terrain.size to {:.2g} m or more to remove the wall effect",
                                t.width, wide, wide));
  if (t.pressedDiameter > fine)
    notes.push_back(fmt::format(
        "track pads are only {:.1f} mean grain diameters wide (at least {:g} recommended): coarse grains overestimate "
        "bearing capacity; use terrain.grain_radius <= {:.2g} m, or a finer terrain.sieve_size",
        t.padWidth / t.pressedDiameter, kGrainsInPad, 0.5 * fine));
  if (!t.roughFloor)
    notes.emplace_back(
        "grains roll without resistance on the smooth floor; set terrain.floor_grains = true for a rough floor");
  return notes;
}

std::vector<std::string> bedNotes(const scene::Scene& scene) {
  if (!scene.vehicle || !scene.terrain || !scene.terrain->granular()) return {};
  const scene::Terrain& t = *scene.terrain;
  const vehicle::VehicleSpec spec = setup::vehicleSpec(scene);
  const double diameter = 2 * setup::bedOptions(scene).meanRadius();
  return bedNotes({2 * spec.shoe.padHalfWidth, 2 * spec.trackOffset, t.depth.value_or(diameter * t.layers.value_or(0)),
                   t.size[1], diameter, !scene.run.periodic[1], t.floorGrains, diameter});
}

std::vector<std::string> bedNotes(const coupling::Simulation& simulation) {
  const coupling::VehicleRig* rig = simulation.vehicle();
  const std::optional<terrain::BedStructure>& bed = simulation.ground().structure;
  if (!rig || !bed || bed->grains == 0) return {};
  const terrain::GrainSystem& grains = simulation.ground().grains->system();
  const vehicle::VehicleSpec& spec = rig->assembly().spec;
  const double padWidth = 2 * spec.shoe.padHalfWidth;
  return bedNotes({padWidth, 2 * spec.trackOffset, bed->thickness, simulation.ground().walls->length(),
                   bed->meanDiameter, !grains.constants.period.along(1), grains.fixedCount > 0,
                   pressedDiameter(simulation, padWidth)});
}

double leanOf(const base::Vec3d& gravity) {
  const double across = std::hypot(gravity.x, gravity.y);
  return across > 0 ? std::atan2(across, -gravity.z) * 180 / base::kPi : 0;
}

std::string porosityWarning(double wanted, const terrain::BedStructure& bed, const base::Vec3d& gravity) {
  constexpr double kOff = 0.01, kErrors = 3; // five times the tolerance of the preparation [-]; standard errors
  if (bed.grains == 0 || std::fabs(bed.porosity - wanted) <= std::max(kOff, kErrors * bed.porosityError)) return "";
  const double lean = leanOf(gravity);
  return fmt::format(
      "the settled bed has a porosity of {:.3f}, but terrain.porosity = {:g}: {}", bed.porosity, wanted,
      lean > 0
          ? fmt::format(
                "it settled under vertical gravity and shifted under the tilted run.gravity ({:.1f} degrees); raise "
                "the material's friction or rolling_friction, reduce the tilt, or report the measured porosity",
                lean)
          : "small or shallow beds pack differently from the wide bed used to tune the settling friction; enlarge "
            "terrain.size or depth, or report the measured porosity");
}

std::string porosityWarning(const coupling::Simulation& simulation) {
  const coupling::PreparationSetup* preparation = session::preparationOf(simulation.setup().ground);
  const std::optional<terrain::BedStructure>& bed = simulation.ground().structure;
  return preparation && bed ? porosityWarning(preparation->porosity, *bed, simulation.setup().gravity) : "";
}

void warnOfTerrain(const scene::Scene& scene) {
  const setup::TerrainRemarks remarks = setup::terrainRemarks(scene);
  for (const std::string& warning : remarks.warnings) support::printStderr("WARNING: {}\n", warning);
  for (const std::string& note : remarks.notes) support::printStderr("grouser: note: {}\n", note);
}

} // namespace grouser::commands
