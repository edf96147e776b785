// SPDX-License-Identifier: BSD-3-Clause
#include "runs/commands/plan.hpp"

#include "base/counted.hpp"
#include "base/math.hpp"
#include "base/rounded.hpp"
#include "coupling/mechanism.hpp"
#include "coupling/surfaces.hpp"
#include "runs/campaigns/forecast/elastic_layer.hpp"
#include "runs/commands/bed_text.hpp"
#include "runs/output/mechanism_output.hpp"
#include "runs/scene/scene.hpp"
#include "runs/scene/soil.hpp"
#include "runs/setup/bed_alone.hpp"
#include "runs/setup/bed_options.hpp"
#include "runs/setup/complementarity_setup.hpp"
#include "runs/setup/contact_pairs.hpp"
#include "runs/setup/drive_length.hpp"
#include "runs/setup/free_surface_notes.hpp"
#include "runs/setup/grain_count.hpp"
#include "runs/setup/grain_memory.hpp"
#include "runs/setup/ground_setup.hpp"
#include "runs/setup/material_pairs.hpp"
#include "runs/setup/mechanism_setup.hpp"
#include "runs/setup/obstacles.hpp"
#include "runs/setup/placement.hpp"
#include "runs/setup/restitution_check.hpp"
#include "runs/setup/scene_surfaces.hpp"
#include "runs/setup/vehicle_surroundings.hpp"
#include "runs/storage/bed_cache.hpp"
#include "terrain/kernel_choice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace grouser::commands {

namespace {

std::string onOff(bool on, const std::string& what, const std::string& why) {
  const std::string line = fmt::format("  {:<4} {}", on ? "on" : "off", what);
  return why.empty() ? line + "\n" : fmt::format("{:<33} {}\n", line, why);
}

/// Memory of the grains by use.
std::string memoryText(const scene::Scene& scene, double grains) {
  const setup::GrainMemory m = setup::grainMemory(scene);
  std::string text = fmt::format("  {:<24} about {:.1f} MiB, {:.0f} bytes per grain:\n", "memory for grains",
                                 grains * m.total() / 1048576.0, m.total());
  const auto part = [&](const char* what, double bytes) { text += fmt::format("    {:<22} {:.0f}\n", what, bytes); };
  part("state", m.state), part("neighbour lists", m.lists), part("contact history", m.history);
  part("planes and floor", m.boundaries);
  part("extra during list builds", m.rebuild);
  return text;
}

/// Obstacles that the vehicle can touch.
std::string obstaclesLine(const scene::Scene& scene) {
  std::string names;
  for (const coupling::Obstacle& o : setup::obstaclesOf(scene)) names += (names.empty() ? "" : ", ") + o.surface.name;
  const std::string hull = setup::hullTouches(scene) ? "hull contact on" : "hull contact off";
  return onOff(!names.empty(), "obstacles", (names.empty() ? "none can touch the vehicle" : names) + "; " + hull);
}

/// Reason why soil does not adhere to the vehicle.
std::string whyNothingSticks(const scene::Scene& scene, bool cohere, bool yield) {
  if (!cohere)
    return yield ? "surface_energy and adhesion_stiffness act only between grains" : "grains have no cohesion";
  const std::string& material = scene.vehicle->material;
  if (material.empty()) return fmt::format("vehicle.adhesion = {:g}", scene.vehicle->adhesion);
  return scene.material(material).cohesion > 0 ? "the material pair has no cohesion"
                                               : "material." + material + " has no cohesion";
}

/// Adhesion of soil to the vehicle.
std::string stickingLine(const scene::Scene& scene) {
  bool meet = false, cohere = false, yield = false;
  double pull = 0;
  for (const setup::MaterialPair& p : setup::materialPairs(scene)) {
    if (p.touched == setup::ContactPartner::Kind::grains && p.grain == p.partner) {
      cohere |= p.cohesion > 0;
      yield |= p.law.plastic.pull > 0 || p.law.plastic.pullGrowth > 0 || p.law.plastic.adhesion > 0;
    }
    if (p.touched == setup::ContactPartner::Kind::vehicle) meet = true, pull = std::max(pull, p.cohesion);
  }
  if (!meet)
    return scene.vehicle && scene.vehicle->adhesion > 0
               ? onOff(false, "soil adhesion to vehicle", "no grains: vehicle.adhesion has no effect")
               : "";
  return onOff(pull > 0, "soil adhesion to vehicle",
               pull > 0 ? fmt::format("cohesion of {:.4g} J/m2", pull) : whyNothingSticks(scene, cohere, yield));
}

/// "3: drum, lifter, lid; 2 move, 1 free".
std::string surfacesLine(const scene::Scene& scene) {
  std::string names;
  int moved = 0, freed = 0, both = 0;
  for (const setup::SceneSurface& s : setup::surfacesOf(scene)) {
    names += (names.empty() ? "" : ", ") + s.name;
    s.free ? ++freed : moved += s.moves ? 1 : 0;
    both += s.free && (s.section.velocity || s.section.spin || s.section.amplitude) ? 1 : 0;
  }
  if (names.empty())
    return onOff(false, "surfaces", "no [[box]], [[cylinder]] or [[mesh]], and no moving or named [[plane]]");
  return onOff(true, "surfaces",
               fmt::format("{}; {} moved, {} free{}", names, moved, freed,
                           both > 0 ? fmt::format(", {} of these also driven", both) : ""));
}

/// "plate, 12 grains; the bed settles without them".
std::string putOnBedLine(const scene::Scene& scene) {
  if (!setup::isPutOnBed(scene))
    return onOff(false, "placed on settled bed", "no bed with grains, meshes or moving surfaces on top");
  std::string names;
  for (const setup::SceneSurface& s : setup::surfacesOf(scene))
    if (s.placedLater) names += (names.empty() ? "" : ", ") + s.name;
  if (const std::int64_t grains = setup::placedCount(scene); grains > 0)
    names += (names.empty() ? "" : ", ") + base::counted(grains, "grain");
  return onOff(true, "placed on settled bed", names);
}

/// Height of the settled bed, if it is in the cache.
std::string bedHeightText(const scene::Scene& scene) {
  if (!scene.terrain || !scene.terrain->granular() || scene.terrain->settleTimeLimit <= 0) return "";
  std::optional<coupling::SettleReport> settled;
  if (const std::string origin = setup::originOfBed(scene); !origin.empty())
    if (const auto beds = storage::BedCache::ofUser()) settled = beds->find(origin);
  return fmt::format("  {:<24} {}\n", "settled bed",
                     settled ? fmt::format("mean height {:.5g} m, top of the highest grain {:.6g} m (in the cache)",
                                           settled->meanHeight, settled->highest)
                             : "height unknown before the bed has settled in a run");
}

/// Settlement of an elastic layer as deep as the bed under the tracks, over that of an elastic half-space.
std::string depthText(const scene::Scene& scene, const vehicle::VehicleSpec& spec) {
  if (!scene.terrain || !scene.terrain->granular() || !scene.terrain->depth) return "";
  constexpr double kPoisson = 0.25; // Poisson's ratio of loose soil [-]
  const double half = 0.5 * spec.groundRun(), depth = *scene.terrain->depth;
  std::vector<forecast::LoadedRectangle> tracks;
  for (const double y : {spec.trackOffset, -spec.trackOffset}) // a single track: the same ratio
    tracks.push_back({0, y, half > 0 ? half : spec.shoe.halfLength, spec.shoe.padHalfWidth});
  const auto settles = [&](double d) { return forecast::layerSettlement(tracks, d, kPoisson); };
  const double whole = settles(base::kInfinity);
  return fmt::format("  {:<24} {:g} m: an elastic layer settles {:.0f} % as much as a half-space under these tracks; "
                     "{:g} m: {:.0f} %\n",
                     "bed depth", depth, 100 * settles(depth) / whole, 2 * depth, 100 * settles(2 * depth) / whole);
}

/// Features of the bed; `t` is null if the scene has no bed.
std::string bedLines(const scene::Terrain* t, const base::Vec3d& gravity) {
  const std::string none = "no bed";
  const bool random = t && !t->lattice();
  std::string text = onOff(random, "random arrangement",
                           !t       ? none
                           : random ? fmt::format("radii {}", base::wordOf(*t->radiusDistribution))
                                    : "terrain.arrangement = \"lattice\"");
  text += onOff(
      t && t->porosity, "preparation",
      !t ? none
      : t->porosity
          ? fmt::format(
                "to a porosity of {:g}{}", *t->porosity,
                leanOf(gravity) > 0
                    ? fmt::format(" under vertical gravity; the tilted run.gravity ({:.1f} degrees) may loosen the bed",
                                  leanOf(gravity))
                    : "")
          : "terrain.porosity is not set: as poured");
  text += onOff(t && t->coarsening, "grading by depth",
                !t              ? none
                : t->coarsening ? fmt::format("radius {:g} m to a depth of {:g} m, {:g} m below", *t->grainRadius,
                                              *t->fineDepth, *t->coarsestRadius)
                                : "terrain.coarsening is not set");
  text += onOff(t && t->floorGrains, "fixed grains on the floor",
                !t               ? none
                : t->floorGrains ? "rough"
                                 : "terrain.floor_grains = false: smooth");
  text += onOff(t && t->tile, "tile", !t ? none : t->tile ? "settled once and copied" : "terrain.tile is not set");
  return text;
}

const char* groundWord(const scene::Terrain* terrain) {
  if (!terrain || terrain->granular()) return "floor below the bed";
  return terrain->deformable() ? "deformable soil" : "rigid ground";
}

} // namespace

std::string switchesText(const scene::Scene& scene) {
  const scene::Terrain* t = scene.terrain ? &*scene.terrain : nullptr;
  const setup::ContactPairs pairs(scene);
  const setup::GrainKinds& kinds = pairs.kinds;
  const bool bed = t && t->granular(), grains = kinds.any();
  std::string text =
      onOff(grains, "grains", grains ? "" : "no [[grain]], [[grains]], [[source]] or granular [terrain]");
  if (grains) {
    const setup::KernelTraits traits = setup::kernelTraits(scene, pairs);
    const auto has = [&](unsigned feature) { return (traits.features & feature) != 0; };
    text += onOff(has(contact::kFriction), "friction history", has(contact::kFriction) ? "" : "friction is 0");
    text += onOff(has(contact::kRollingFriction), "rolling history",
                  has(contact::kRollingFriction) ? "" : "rolling_friction is 0");
    text += onOff(has(contact::kCohesion), "cohesion", has(contact::kCohesion) ? "" : "cohesion is 0");
    text += onOff(has(contact::kPlastic), "plastic contacts",
                  has(contact::kPlastic) ? "" : "no law is eepa, eepa_linear or luding");
    text += onOff(has(terrain::kManyRadii), "radius of each grain",
                  kinds.manyRadii() ? fmt::format("{:g} to {:g} m", kinds.smallest, kinds.largest)
                                    : fmt::format("all {:g} m", kinds.largest));
    text += onOff(kinds.manyMaterials(), "material of each grain", fmt::format("{} in total", kinds.material.size()));
    const bool implicit = setup::hasComplementarity(scene);
    if (implicit)
      text += onOff(true, "complementarity contacts", "no scene-specific kernel");
    else
      text += fmt::format("       {:<26} {}\n", "kernel of the grains",
                          terrain::stepKernelText(traits.features, traits.model));
    if (has(terrain::kBoundaries) && !implicit)
      text += fmt::format("       {:<26} {}\n", "kernel of walls and floor",
                          terrain::boundaryKernelText(traits.features, traits.model));
  }
  text += onOff(t != nullptr, groundWord(t), t ? t->heightmap : "no [terrain]");
  text += bedLines(bed ? t : nullptr, scene.run.gravity);
  text += onOff(bed && t->settleTimeLimit > 0, "settling",
                bed ? fmt::format("at most {} s", t->settleTimeLimit) : "no bed");
  text += putOnBedLine(scene);
  const auto [alongX, alongY] = scene.run.periodic;
  text += onOff(alongX || alongY, "periodic boundaries",
                alongX && alongY ? "x and y"
                : alongX         ? "x"
                : alongY         ? "y"
                                 : "run.periodic is false");
  text += onOff(!scene.sources.empty(), "sources", fmt::format("{}", scene.sources.size()));
  text += onOff(!scene.planes.empty(), "planes", fmt::format("{}", scene.planes.size()));
  text += surfacesLine(scene);
  text += onOff(scene.vehicle.has_value(), "vehicle",
                scene.vehicle ? scene.vehicle->spec : "no [vehicle]: no mesh is read");
  if (scene.vehicle) text += obstaclesLine(scene);
  const bool shoesAlone = scene.vehicle && bed && scene.vehicle->soilContact == scene::SoilContact::shoes;
  text += onOff(shoesAlone, "soil contact: shoes only", shoesAlone ? "vehicle.soil_contact = \"shoes\"" : "");
  if (scene.vehicle) text += stickingLine(scene);
  const bool crush = setup::crushes(scene, kinds);
  text += onOff(crush, "crushing grains", crush ? "against parts" : "no crushing_strength");
  const scene::MechanismSections& m = scene.mechanism;
  text += onOff(!m.empty(), "mechanism",
                m.empty() ? "no [[body]]" : output::integratorText(setup::solverOptions(scene.run)));
  text += onOff(scene.fluid.has_value(), "fluid",
                scene.fluid ? fmt::format("spacing {:g} m", scene.fluid->spacing) : "no [fluid]");
  text += onOff(scene.output.frames, "frames",
                scene.output.frames ? fmt::format("{:.0f}, one every {} s",
                                                  std::floor(scene.run.duration / scene.run.frameInterval + 1e-9) + 1,
                                                  scene.run.frameInterval)
                                    : "output.frames = false");
  text += onOff(scene.output.picture, "picture", "");
  text += onOff(scene.output.plots, "plots", "");
  return text;
}

std::string planText(const scene::Scene& scene, const forecast::CountedGrains* counted) {
  setup::checkRestitutions(scene);
  setup::checkComplementarity(scene);
  std::string text;
  if (const std::string warning = setup::shortDriveWarning(scene); !warning.empty())
    text = fmt::format("WARNING: {}\n\n", warning);
  text += fmt::format("{}\n\nactive features\n{}\nsize\n", scene.file.string(), switchesText(scene));
  const std::int64_t grains = counted ? counted->grains : setup::plannedGrains(scene);
  const std::string doubt = counted && !counted->exact ? fmt::format(" ({})", counted->doubt) : "";
  text += fmt::format("  {:<24} {}{}\n", "grains", grains, doubt);
  if (grains) text += memoryText(scene, static_cast<double>(grains));
  if (scene.vehicle) {
    const vehicle::VehicleSpec spec = setup::vehicleSpec(scene);
    setup::placeVehicle(scene, spec);
    const int tracks = scene.vehicle->tracks == scene::Tracks::single ? 1 : 2;
    text += fmt::format("  {:<24} {:.0f} kg, {} x {} shoes, pitch radius {:.4f} m\n", "vehicle",
                        spec.chassis.mass + 0.5 * tracks * (spec.totalMass() - spec.chassis.mass), tracks,
                        spec.shoe.count, spec.pitchRadius());
    setup::checkParts(scene);
    text += depthText(scene, spec);
  }
  const double step = setup::chooseTimeStep(scene);
  setup::checkGround(scene, step);
  text += fluidText(scene, step);
  if (!scene.mechanism.empty())
    text += output::mechanismSize(coupling::Mechanism(setup::contactFreeSetup(scene), step));
  text += bedHeightText(scene);
  for (const support::SoilUse& use : scene::soilUses(scene))
    text += fmt::format("  {:<24} {}\n", "soil", scene::soilLine(use, !scene.deformable()));
  text += pairsText(scene);
  const setup::StepLimit limit = setup::stepLimit(scene);
  text += timeText(scene, limit, step, static_cast<double>(grains));
  const bool implicit = setup::hasComplementarity(scene);
  if (const double calm = limit.calm;
      grains && !implicit && (scene.mechanism.empty() || scene.mechanism.touches()) && step > calm)
    text += fmt::format("\nWARNING: with time steps above {} s, strong contact damping makes resting grains vibrate; "
                        "reduce run.time_step (docs/steps.md#choice-of-the-time-step)\n",
                        base::roundedDown(calm, 4));
  const setup::TerrainRemarks remarks = setup::terrainRemarks(scene);
  for (const std::string& warning : remarks.warnings) text += fmt::format("\nWARNING: {}\n", warning);
  for (const std::string& note : remarks.notes) text += fmt::format("\nnote: {}\n", note);
  for (const std::string& warning : setup::vehicleWarnings(scene)) text += fmt::format("\nWARNING: {}\n", warning);
  for (const std::string& note : setup::meshNotes(scene)) text += fmt::format("\nnote: {}\n", note);
  for (const std::string& note : bedNotes(scene)) text += fmt::format("\nnote: {}\n", note);
  for (const std::string& note : setup::freeSurfaceNotes(scene)) text += fmt::format("\nnote: {}\n", note);
  if (!scene.mechanism.empty()) {
    if (const std::string warning = setup::movingSurfacesWarning(scene); !warning.empty())
      text += fmt::format("\nWARNING: {}\n", warning);
    if (const std::string note = setup::bedWallsNote(scene); !note.empty()) text += fmt::format("\nnote: {}\n", note);
    if (const std::string warning = setup::tensionStepWarningAtStart(scene, step); !warning.empty())
      text += fmt::format("\nWARNING: {}\n", warning);
    if (const std::string note = setup::springStepNote(scene); !note.empty()) text += fmt::format("\nnote: {}\n", note);
  }
  return text;
}

} // namespace grouser::commands
