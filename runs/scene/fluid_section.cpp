// SPDX-License-Identifier: BSD-3-Clause
// Keys and checks of [fluid], [[fluid.box]] and [[fluid.probe]].
#include "runs/scene/detail/section_lists.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace grouser::scene::detail {

namespace {

using base::Section;

constexpr double kFarthest = 1e4; // [m]

base::Table<Fluid> fluidTable() {
  using S = Fluid;
  base::Table<S> t("fluid", "Weakly compressible particle fluid (SPH) in a tank with solid walls; the fluid acts on "
                            "planes, boxes, cylinders, meshes, rigid terrain and bodies with shapes");
  t.add("spacing", &S::spacing, "m", "initial particle spacing").plausible(1e-4, 1).required().atLeast(1e-5).atMost(10);
  t.add("dimensions", &S::dimensions, "",
        "number of dimensions, 2 or 3; with 2, the fluid is confined to the plane y = 0, and masses and forces are per "
        "metre of width")
      .atLeast(2)
      .atMost(3);
  t.add("tank_low", &S::tankLow, "m",
        "lower inner corner of the tank; default: borders and lowest point of the terrain")
      .plausible(0, 1000)
      .atLeast(-kFarthest)
      .atMost(kFarthest);
  t.add("tank_high", &S::tankHigh, "m", "upper inner corner of the tank; required with tank_low")
      .plausible(0, 1000)
      .atLeast(-kFarthest)
      .atMost(kFarthest);
  t.add("lid", &S::lid, "", "whether the tank has a lid");
  t.add("level", &S::level, "m", "z of the initial free surface; the tank is filled up to it with fluid at rest")
      .plausible(0, 1000)
      .atLeast(-kFarthest)
      .atMost(kFarthest);
  t.add("density", &S::density, "kg/m3", "fluid density at zero pressure").plausible(300, 15000).atLeast(1).atMost(1e5);
  t.add("viscosity", &S::viscosity, "Pa s",
        "dynamic viscosity (Morris operator); with values above 0, the fluid does not slip along walls")
      .plausible(1e-5, 1000, "kinematic viscosity? multiply it by the density")
      .atLeast(0)
      .atMost(1e6);
  t.add("sound_speed", &S::soundSpeed, "m/s",
        "numerical speed of sound, which should be at least 10 times the maximum flow speed; default: 10 "
        "max(expected_speed, sqrt(maximum pressure at rest / density))")
      .plausible(0.5, 2000)
      .above(0)
      .atMost(1e4);
  t.add("expected_speed", &S::expectedSpeed, "m/s",
        "expected maximum flow speed; default: sqrt(2 g depth), or twice the track speed of a vehicle if larger; the "
        "initial speed of a [[fluid.box]] replaces smaller values")
      .plausible(0.05, 100)
      .above(0)
      .atMost(1e3);
  t.add("smoothing", &S::smoothing, "-", "smoothing length / spacing").atLeast(1.2).atMost(2);
  t.add("artificial_viscosity", &S::artificialViscosity, "-",
        "coefficient alpha of the artificial viscosity of Monaghan (1992)")
      .atLeast(0)
      .atMost(1);
  t.add("diffusion", &S::diffusion, "-", "coefficient delta of the density diffusion of Fourtakas et al. (2019)")
      .atLeast(0)
      .atMost(0.5);
  t.add("shifting", &S::shifting, "-",
        "coefficient of Fickian particle shifting (Lind et al. 2012), disabled at free surfaces; 0: no shifting")
      .atLeast(0)
      .atMost(20);
  return t;
}

base::Table<FluidBox> fluidBoxTable() {
  using S = FluidBox;
  base::Table<S> t("[fluid.box]", "Box that is initially filled with fluid at hydrostatic pressure");
  t.add("low", &S::low, "m", "lower corner").plausible(0, 1000).required().atLeast(-kFarthest).atMost(kFarthest);
  t.add("high", &S::high, "m", "upper corner").plausible(0, 1000).required().atLeast(-kFarthest).atMost(kFarthest);
  t.add("velocity", &S::velocity, "m/s", "initial velocity").plausible(0, 100).atLeast(-1e3).atMost(1e3);
  return t;
}

base::Table<FluidProbe> fluidProbeTable() {
  using S = FluidProbe;
  base::Table<S> t("[fluid.probe]", "Probe that records pressure or level of the fluid in each row of the time series");
  t.add("name", &S::name, "", "name of the column in the results").required();
  t.add("kind", &S::kind, "",
        "measured quantity: pressure at the position, or level: z of the position plus the wetted length of a vertical "
        "wire that starts there");
  t.add("position", &S::position, "m", "position of the probe; for a level, the lower end of the wire")
      .plausible(0, 1000)
      .required()
      .atLeast(-kFarthest)
      .atMost(kFarthest);
  return t;
}

/// Throws InputError for sections that are incompatible with a fluid.
void checkNeighbours(const Section& section, const Scene& scene) {
  const bool grains = !scene.grains.empty() || !scene.fills.empty() || !scene.sources.empty();
  if (grains || (scene.terrain && scene.terrain->granular()))
    section.fail("", "is incompatible with grains, since their drag and buoyancy are not modelled; remove the grains "
                     "(terrain.kind = \"rigid\"), or [fluid]");
  if (scene.deformable())
    section.fail("", "is incompatible with deformable soil, since the effect of water on soil is not modelled; set "
                     "terrain.kind = \"rigid\", or remove [fluid]");
  const auto moving = [&](const char* list, const auto& surfaces) {
    for (std::size_t k = 0; k < surfaces.size(); ++k)
      if (surfaces[k].moves())
        scene.fail(list, k, "", "moves, but [fluid] does not support moving surfaces; use a [[body]] with a [[drive]]");
  };
  moving("plane", scene.planes), moving("box", scene.boxes);
  moving("cylinder", scene.cylinders), moving("mesh", scene.meshes);
  for (std::size_t k = 0; k < scene.cylinders.size(); ++k)
    if (scene.cylinders[k].hollow)
      scene.fail("cylinder", k, "hollow", "has zero thickness, which [fluid] does not support; use a closed [[mesh]]");
}

/// Throws InputError unless the corners are at least `least` [m] apart.
void checkCorners(const Section& section, const char* high, const base::Vec3d& from, const base::Vec3d& to,
                  double least, bool plane) {
  for (int a = 0; a < 3; ++a)
    if (!(plane && a == 1) && !(to[a] - from[a] >= least))
      section.fail(high,
                   fmt::format("[m] is only {:.4g} m above the lower corner along {} (minimum {:g} m); raise it, or "
                               "lower fluid.spacing",
                               to[a] - from[a], "xyz"[a], least));
}

void checkTank(const Section& section, const Fluid& fluid, const Scene& scene) {
  if (fluid.tankLow.has_value() != fluid.tankHigh.has_value())
    section.fail(fluid.tankLow ? "tank_low" : "tank_high",
                 fmt::format("[m] requires tank_{}; set both corners", fluid.tankLow ? "high" : "low"));
  if (!fluid.tankLow && !scene.terrain)
    section.fail("", "has no tank; set tank_low and tank_high, or add a rigid [terrain]");
  if (fluid.dimensions == 2 && (scene.terrain || scene.vehicle))
    section.fail("dimensions",
                 fmt::format("= 2 is incompatible with {}; use 3", scene.terrain ? "terrain" : "vehicle"));
  if (fluid.tankLow)
    checkCorners(section, "tank_high", *fluid.tankLow, *fluid.tankHigh, 4 * fluid.spacing, fluid.dimensions == 2);
  if (fluid.level && fluid.tankLow && !(*fluid.level > fluid.tankLow->z && *fluid.level <= fluid.tankHigh->z))
    section.fail("level", fmt::format("[m] is outside the tank, z in [{:g}, {:g}] m; correct it", fluid.tankLow->z,
                                      fluid.tankHigh->z));
}

void checkBox(const Section& section, const FluidBox& box, const Fluid& fluid) {
  const bool plane = fluid.dimensions == 2;
  checkCorners(section, "high", box.low, box.high, fluid.spacing, plane);
  if (!fluid.tankLow) return;
  for (int a = 0; a < 3; ++a)
    if (!(plane && a == 1) && (box.low[a] < (*fluid.tankLow)[a] || box.high[a] > (*fluid.tankHigh)[a]))
      section.fail(box.low[a] < (*fluid.tankLow)[a] ? "low" : "high",
                   fmt::format("[m] is outside the tank along {}, [{:g}, {:g}] m; correct it", "xyz"[a],
                               (*fluid.tankLow)[a], (*fluid.tankHigh)[a]));
}

void checkProbe(const Section& section, const FluidProbe& probe, const Fluid& fluid) {
  const auto usual = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '-'; };
  if (probe.name.empty() || !std::all_of(probe.name.begin(), probe.name.end(), usual))
    section.fail("name", "is used as a column name; use only letters, digits, _ and -");
  for (const FluidProbe& other : fluid.probes)
    if (other.name == probe.name) section.fail("name", "is the name of another probe; choose another name");
}

void checkFluid(const Section& section, Fluid& fluid, const Scene& scene) {
  checkNeighbours(section, scene);
  checkTank(section, fluid, scene);
  if (fluid.soundSpeed && fluid.expectedSpeed)
    section.fail("expected_speed", "[m/s] has no effect with sound_speed; remove one of them");
  for (const Section& box : section.list("box")) {
    fluid.boxes.push_back(box.read(fluidBoxTable()));
    checkBox(box, fluid.boxes.back(), fluid);
  }
  for (const Section& one : section.list("probe")) {
    const FluidProbe probe = one.read(fluidProbeTable());
    checkProbe(one, probe, fluid);
    fluid.probes.push_back(probe);
  }
  if (!fluid.level && fluid.boxes.empty())
    section.fail("level", "is missing and there is no [[fluid.box]], so the scene contains no fluid; add one of them");
}

} // namespace

SectionList fluidSections() {
  const base::Table<FluidBox> boxes = fluidBoxTable();
  const base::Table<FluidProbe> probes = fluidProbeTable();
  SectionEntry entry = optional("fluid", &Scene::fluid, fluidTable(), checkFluid, {"box", "probe"});
  entry.write = [boxes, probes, write = std::move(entry.write)](const Scene& scene) {
    std::string text = write(scene);
    if (!scene.fluid) return text;
    for (const FluidBox& box : scene.fluid->boxes) text += written<FluidBox>("[[fluid.box]]", boxes, box);
    for (const FluidProbe& probe : scene.fluid->probes) text += written<FluidProbe>("[[fluid.probe]]", probes, probe);
    return text;
  };
  entry.describe = [boxes, probes, describe = std::move(entry.describe)] {
    return describe() + "\n" + base::describe(boxes) + "\n" + base::describe(probes);
  };
  for (const std::string& key : fullKeys("fluid.box", boxes)) entry.keys.push_back(key);
  for (const std::string& key : fullKeys("fluid.probe", probes)) entry.keys.push_back(key);
  return {entry};
}

} // namespace grouser::scene::detail
