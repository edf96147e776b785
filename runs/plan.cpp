// SPDX-License-Identifier: BSD-3-Clause
#include "runs/plan.hpp"

#include "base/math.hpp"
#include "runs/bed.hpp"
#include "runs/laws.hpp"
#include "runs/mechanism.hpp"
#include "runs/mechanism_output.hpp"
#include "runs/placement.hpp"
#include "terrain/heightmap.hpp"
#include "terrain/layers.hpp"
#include "vehicle/spec.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace grouser::runs {

namespace {

/// Grains of the bed; reads the height-map, for hills may need more.
std::int64_t bedGrains(const Scene& scene) {
  const Terrain& t = *scene.terrain;
  terrain::HeightmapPlacement placement;
  placement.sizeX = t.size[0], placement.sizeY = t.size[1];
  placement.black = t.heightRange[0], placement.white = t.heightRange[1];
  return terrain::planBed(terrain::heightFieldOf(terrain::loadHeightmap(t.heightmap), placement), layerOptions(scene))
      .grains;
}

std::string onOff(bool on, const std::string& what, const std::string& why) {
  const std::string line = fmt::format("  {:<4} {}", on ? "on" : "off", what);
  return why.empty() ? line + "\n" : fmt::format("{:<33} {}\n", line, why);
}

std::string switches(const Scene& scene) {
  const Terrain* t = scene.terrain ? &*scene.terrain : nullptr;
  const bool bed = t && t->granular(), grains = bed || !scene.grains.empty() || !scene.sources.empty();
  const std::string soil = bed                     ? t->material
                           : !scene.grains.empty() ? scene.grains.front().material
                           : grains                ? scene.sources.front().material
                                                   : "";
  const bool friction = grains && pairLaw(scene, soil, soil, 1).friction > 0;
  std::string text = "switched on and off\n";
  text += onOff(grains, "grains", grains ? "" : "no [[grain]], no granular [terrain]");
  text += onOff(friction, "friction history", grains && !friction ? "friction of the grains is 0" : "");
  text += onOff(t != nullptr, t && !bed ? "rigid ground" : "floor below the bed", t ? t->heightmap : "no [terrain]");
  text += onOff(bed && t->settleTimeLimit > 0, "settling",
                bed ? fmt::format("at most {} s", t->settleTimeLimit) : "no bed");
  text += onOff(!scene.sources.empty(), "sources", fmt::format("{}", scene.sources.size()));
  text += onOff(!scene.planes.empty(), "planes", fmt::format("{}", scene.planes.size()));
  text += onOff(scene.vehicle.has_value(), "vehicle",
                scene.vehicle ? scene.vehicle->spec : "no [vehicle]: no mesh is read");
  const MechanismSections& m = scene.mechanism;
  text += onOff(!m.empty(), "mechanism", m.empty() ? "no [[body]]" : integratorText(scene.run));
  text += onOff(scene.output.frames, "frames",
                scene.output.frames ? fmt::format("{:.0f}, one each {} s",
                                                  std::floor(scene.run.duration / scene.run.frameInterval + 1e-9) + 1,
                                                  scene.run.frameInterval)
                                    : "output.frames = false");
  text += onOff(scene.output.picture, "picture", "");
  text += onOff(scene.output.plots, "plots", "");
  return text;
}

} // namespace

double shortestContact(const Scene& scene) {
  double shortest = std::numeric_limits<double>::infinity();
  const auto consider = [&](const std::string& name, double radius) {
    const double mass = sphereMass(scene.material(name).density, radius);
    const auto duration = [&](const std::string& other, double effective) {
      return base::kPi * std::sqrt(effective / pairLaw(scene, name, other, effective).stiffness);
    };
    shortest = std::min(shortest, duration(name, 0.5 * mass));
    // Against what does not give way the whole grain swings.
    if (scene.terrain) shortest = std::min(shortest, duration(scene.terrain->groundMaterial, mass));
    for (const Plane& p : scene.planes) shortest = std::min(shortest, duration(p.material, mass));
    if (scene.vehicle && !scene.vehicle->material.empty())
      shortest = std::min(shortest, duration(scene.vehicle->material, mass));
  };
  for (const Grain& g : scene.grains) consider(g.material, g.radius);
  for (const Source& s : scene.sources) consider(s.material, s.radius);
  if (scene.terrain && scene.terrain->granular()) consider(scene.terrain->material, *scene.terrain->grainRadius);
  return std::isfinite(shortest) ? shortest : 0;
}

std::int64_t plannedGrains(const Scene& scene) {
  std::int64_t grains = static_cast<std::int64_t>(scene.grains.size());
  for (const Source& s : scene.sources) grains += s.total;
  return grains + (scene.terrain && scene.terrain->granular() ? bedGrains(scene) : 0);
}

std::string planText(const Scene& scene) {
  std::string text = fmt::format("{}\n\n{}\nsize\n", scene.file.string(), switches(scene));
  const std::int64_t grains = plannedGrains(scene);
  text += fmt::format("  {:<24} {}\n", "grains", grains);
  if (grains)
    text += fmt::format("  {:<24} about {:.1f} MiB\n", "memory for grains",
                        static_cast<double>(grains) * kBytesPerGrain / 1048576.0);
  if (scene.vehicle) {
    const vehicle::VehicleSpec spec = vehicle::readVehicleSpec(scene.vehicle->spec);
    placeVehicle(scene, spec);
    text += fmt::format("  {:<24} {:.0f} kg, 2 x {} shoes, pitch radius {:.4f} m\n", "vehicle", spec.totalMass(),
                        spec.shoe.count, spec.pitchRadius());
  }
  const double step = chooseTimeStep(scene);
  if (!scene.mechanism.empty()) text += mechanismSize(Mechanism(scene, step));
  text += "\ntime\n";
  const double contact = shortestContact(scene);
  const double resolved = contact / kStepsPerContact;
  if (contact > 0) {
    text += fmt::format("  {:<24} {:.4g} s\n", "shortest grain contact", contact);
    text +=
        fmt::format("  {:<24} {:.4g} s ({:.0f} steps a contact)\n", "largest sound step", resolved, kStepsPerContact);
  }
  const double steps = std::round(scene.run.duration / step);
  text += fmt::format("  {:<24} {:.4g} s{}\n", "time step", step,
                      contact > 0 ? fmt::format(", {:.1f} a contact", contact / step) : "");
  text += fmt::format("  {:<24} {:.0f} for {} s\n", "steps", steps, scene.run.duration);
  if (grains) text += fmt::format("  {:<24} {:.3g}\n", "grain steps", steps * static_cast<double>(grains));
  if (contact > 0 && step > resolved * 1.0000001)
    text += fmt::format("\nwarning: the time step resolves a contact by {:.1f} steps only; choose {:.4g} s or less\n",
                        contact / step, resolved);
  return text;
}

} // namespace grouser::runs
