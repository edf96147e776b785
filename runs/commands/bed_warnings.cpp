// SPDX-License-Identifier: BSD-3-Clause
#include "runs/commands/bed_warnings.hpp"

#include "base/math.hpp"
#include "runs/commands/bed_text.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/bed_options.hpp"
#include "runs/setup/grain_count.hpp"
#include "terrain/packing_limits.hpp"

#include <fmt/format.h>

namespace grouser::commands {

namespace {

constexpr double kMinCover = 0.5; // smallest share of the floor that loose grains cover without a warning [-]

/// Material properties of the scene's bed that bound its porosity.
BedQuality qualityOf(const scene::Scene& scene) {
  const scene::Material& m = scene.material(scene.terrain->material);
  BedQuality bed;
  bed.rollingFriction = m.rollingFriction > 0;
  bed.cohesion = m.cohesion > 0 || m.surfaceEnergy.value_or(0) > 0 || m.adhesionStiffness.value_or(0) > 0;
  return bed;
}

bool hasBed(const scene::Scene& scene) { return scene.terrain && scene.terrain->granular(); }

} // namespace

std::vector<std::string> bedWarnings(const BedQuality& bed) {
  std::vector<std::string> warnings;
  const double share = bed.grains > 0 ? static_cast<double>(bed.fixed) / static_cast<double>(bed.grains) : 0;
  if (share > terrain::kMaxFixed)
    warnings.push_back(
        fmt::format("{:.0f} % of the bed's grains are fixed on its floor ({} of {}), so less than one layer of soil "
                    "can move; raise terrain.depth, use smaller grains, or set terrain.floor_grains = false",
                    100 * share, bed.fixed, bed.grains));
  else if (bed.cover < kMinCover)
    warnings.push_back(fmt::format("the bed has {} loose grains, which cover only {:.0f} % of its floor (less than one "
                                   "layer); raise terrain.depth or terrain.layers, or use smaller grains",
                                   bed.grains - bed.fixed, 100 * bed.cover));
  const double loosest = terrain::loosestPacking(bed.rollingFriction, bed.cohesion);
  if (bed.measured > 0 && bed.porosity - 3 * bed.porosityError > loosest)
    warnings.push_back(fmt::format("the bed has a porosity of {:.2f}, but random packings of {} do not exceed {:.2f}: "
                                   "the bed is too thin or not settled; raise terrain.depth, or use smaller grains",
                                   bed.porosity,
                                   bed.cohesion          ? "cohesive spheres"
                                   : bed.rollingFriction ? "spheres with rolling friction"
                                                         : "spheres",
                                   loosest));
  return warnings;
}

std::vector<std::string> bedWarnings(const scene::Scene& scene, const coupling::Simulation& simulation) {
  const auto& grains = simulation.ground().grains;
  if (!hasBed(scene) || !grains) return {};
  BedQuality bed = qualityOf(scene);
  bed.grains = static_cast<std::int64_t>(grains->count());
  bed.fixed = static_cast<std::int64_t>(grains->system().fixedCount);
  if (const auto& structure = simulation.ground().structure)
    bed.measured = structure->grains, bed.porosity = structure->porosity, bed.porosityError = structure->porosityError;
  std::vector<std::string> warnings = bedWarnings(bed);
  if (const std::string porosity = porosityWarning(simulation); !porosity.empty()) warnings.push_back(porosity);
  return warnings;
}

std::vector<std::string> plannedBedWarnings(const scene::Scene& scene) {
  if (!hasBed(scene)) return {};
  BedQuality bed = qualityOf(scene);
  const setup::BedGrains planned = setup::bedGrains(scene);
  bed.grains = planned.loose + planned.fixed, bed.fixed = planned.fixed;
  const scene::Terrain& t = *scene.terrain;
  const double radius = setup::bedOptions(scene).meanRadius();
  bed.cover = static_cast<double>(planned.loose) * base::kPi * radius * radius / (t.size[0] * t.size[1]);
  if (scene.terrain->porosity) bed.measured = bed.grains, bed.porosity = *scene.terrain->porosity;
  return bedWarnings(bed);
}

} // namespace grouser::commands
