// SPDX-License-Identifier: BSD-3-Clause
#include "runs/scene/detail/section_checks.hpp"

#include "base/error.hpp"
#include "runs/scene/soil.hpp"
#include "runs/support/locations.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace grouser::scene::detail {

using base::Section;

void requireMaterial(const Scene& scene, const Section& section, const std::string& key, const std::string& name) {
  std::vector<std::string> names;
  for (const Material& m : scene.materials) names.push_back(m.name);
  if (std::find(names.begin(), names.end(), name) != names.end()) return;
  const std::string quoted = key.empty() ? fmt::format(" (\"{}\")", name) : "";
  const auto soils = knownSoils(scene.file);
  if (name.find('/') != std::string::npos || name.ends_with(".toml"))
    section.fail(
        key, fmt::format(
                 "is not a material of this scene{}; set soil = \"{}\" in a section [material.NAME], and use NAME here",
                 quoted, name));
  std::vector<std::string> known = names;
  for (const auto& [soil, file] : soils) known.push_back(soil);
  const std::string nearest =
      known.empty() ? "" : fmt::format("did you mean \"{}\"? Or ", base::nearestWord(name, known));
  std::string list;
  for (const auto& [soil, file] : soils) list += (list.empty() ? "" : ", ") + soil;
  section.fail(key, fmt::format("is not a material of this scene{}; {}add a section [material.{}]{}", quoted, nearest,
                                name, list.empty() ? "" : fmt::format(" (soils by name: {})", list)));
}

void resolveFile(const Scene& scene, const Section& section, const std::string& key, std::string& name) {
  if (name.empty()) section.fail(key, "is empty; set the path of a file");
  std::vector<std::filesystem::path> tried;
  std::filesystem::path found;
  try {
    found = support::findInput(name, scene.file, tried);
  } catch (const base::InputError& error) { // a folder or FIFO of this name
    section.fail(key, fmt::format("cannot be used: {}", error.what()));
  }
  if (found.empty()) {
    std::string places;
    for (const auto& p : tried) places += (places.empty() ? "" : ", ") + p.string();
    std::vector<std::filesystem::path> folders;
    for (const auto& p : tried) folders.push_back(p.parent_path());
    const std::string hint = tried.empty() ? "" : support::nearestFileHint(tried.front(), folders);
    section.fail(key, fmt::format("does not exist; {}correct the path (searched {})", hint, places));
  }
  name = found.string();
}

namespace {

void checkMeshes(const Section& root, const Scene& scene) {
  const std::vector<Section> sections = root.list("mesh");
  for (std::size_t k = 0; k < sections.size(); ++k) {
    const bool grains = (scene.terrain && scene.terrain->granular()) || !scene.grains.empty() || !scene.fills.empty() ||
                        !scene.sources.empty();
    if (scene.vehicle && grains)
      sections[k].fail(
          "", "is incompatible with [vehicle] on grains; use boxes and cylinders, or rigid ground without grains");
    if (scene.terrain && scene.terrain->granular() && scene.terrain->settleTimeLimit > 0 &&
        scene.meshes[k].placed == PlacedWhen::before)
      sections[k].fail("placed", "is \"before\", but meshes are not supported during settling; use boxes and "
                                 "cylinders, remove placed, or set terrain.settle_time_limit = 0");
    if (scene.meshes[k].material != scene.meshes.front().material)
      sections[k].fail("material",
                       fmt::format("differs from that of the first mesh, \"{}\"; use one material for all meshes",
                                   scene.meshes.front().material));
  }
}

/// Checks of placed and above_bed.
void checkPlaced(const Section& root, const Scene& scene) {
  const bool bed = scene.terrain && scene.terrain->granular();
  const auto needsBed = [&](const Section& section, const char* key) {
    if (!bed && section.has(key))
      section.fail(key, "has no effect without a bed of grains; add a granular [terrain], or remove it");
  };
  const auto check = [&](const char* list, const auto& surfaces) {
    const std::vector<Section> sections = root.list(list);
    for (std::size_t k = 0; k < surfaces.size(); ++k) {
      needsBed(sections[k], "placed"), needsBed(sections[k], "above_bed");
      if (surfaces[k].aboveBed && surfaces[k].placed == PlacedWhen::before)
        sections[k].fail("above_bed", "[m] is mutually exclusive with placed = \"before\", since the bed height is "
                                      "known only after settling; remove one");
    }
  };
  check("plane", scene.planes), check("box", scene.boxes);
  check("cylinder", scene.cylinders), check("mesh", scene.meshes);
  for (std::size_t k = 0; k < scene.planes.size(); ++k) {
    const base::Vec3d& n = scene.planes[k].normal;
    if (scene.planes[k].aboveBed && !(n.z < 0 && std::max(std::fabs(n.x), std::fabs(n.y)) <= 1e-9 * -n.z))
      root.list("plane")[k].fail(
          "above_bed",
          "[m] requires a horizontal plane above the bed; set normal = [0, 0, -1], or set point instead of above_bed");
  }
  const std::vector<Section> grains = root.list("grain"), fills = root.list("grains");
  for (const Section& section : grains) needsBed(section, "above_bed");
  for (const Section& section : fills) needsBed(section, "above_bed");
}

/// Checks positions of the periodic boundaries, and that the scene supports them.
void checkPeriodic(const Section& section, const Scene& scene) {
  const RunSettings& run = scene.run;
  const std::optional<std::array<double, 2>>* domains[] = {&run.domainX, &run.domainY};
  for (std::size_t a = 0; a < 2; ++a) {
    const auto& domain = *domains[a];
    const std::string key = std::string("domain_") + "xy"[a];
    if (domain && !run.periodic[a])
      section.fail(key, fmt::format("[m] has no effect without periodic boundaries along {}; remove it, or set "
                                    "run.periodic to true along this axis",
                                    "xy"[a]));
    if (domain && scene.terrain)
      section.fail(key, "[m] is incompatible with [terrain], since the borders of the terrain are the periodic "
                        "boundaries; remove it");
    if (domain && !((*domain)[1] > (*domain)[0])) section.fail(key, "[m] must be [min, max]; put the lower side first");
    if (run.periodic[a] && !domain && !scene.terrain)
      section.fail("periodic", fmt::format("requires positions of the boundaries along {}; set run.{} = [from, to] [m]",
                                           "xy"[a], key));
  }
  if (!run.periodic[0] && !run.periodic[1]) return;
  if (scene.vehicle) section.fail("periodic", "is incompatible with [vehicle]; set it to [false, false]");
  if (scene.mechanism.touches())
    section.fail("periodic",
                 "is not supported with [[body.shape]], which has no periodic images; set it to [false, false]");
  if (scene.grains.empty() && scene.fills.empty() && scene.sources.empty() &&
      !(scene.terrain && scene.terrain->granular()))
    section.fail("periodic", "has no effect without grains; remove it");
}

/// A plane must be identical at both periodic boundaries.
void checkPlanesAcross(const std::vector<Section>& sections, const Scene& scene) {
  for (std::size_t k = 0; k < scene.planes.size(); ++k)
    for (int a = 0; a < 2; ++a)
      if (scene.run.periodic[static_cast<std::size_t>(a)] &&
          std::fabs(scene.planes[k].normal[a]) > 1e-9 * norm(scene.planes[k].normal))
        sections[k].fail("normal", fmt::format("[-] is inclined along {}, where boundaries are periodic; set this "
                                               "entry to 0, or run.periodic to false along this axis",
                                               "xy"[a]));
}

void checkSettling(const Section& run, const Scene& scene) {
  if (scene.terrain && scene.terrain->granular() && scene.terrain->settleTimeLimit > 0 && !(scene.run.gravity.z < 0))
    run.fail("gravity",
             "[m/s2] must point down for the bed to settle; set z below 0, or terrain.settle_time_limit = 0");
}

void checkSomethingMoves(const Scene& scene) {
  if (scene.grains.empty() && scene.fills.empty() && scene.sources.empty() && !scene.terrain && !scene.vehicle &&
      scene.mechanism.empty() && !scene.fluid)
    throw base::InputError(fmt::format(
        "{}: nothing to simulate; add [terrain], [vehicle], [fluid], [[grain]], [[grains]], [[source]] or [[body]]",
        scene.file.string()));
}

} // namespace

namespace {

/// Rejects a material that only an override defines: its name is probably mistyped.
void checkMaterialsOfOverrides(const Section& root, const Scene& scene) {
  std::vector<std::string> names;
  for (const auto& [name, section] : root.named("material"))
    if (section.origin() != "--set") names.push_back(name);
  for (const auto& [name, section] : root.named("material"))
    if (section.origin() == "--set")
      section.fail("", names.empty()
                           ? fmt::format("is not a material of {}, which defines no materials", scene.file.string())
                           : fmt::format("is not a material of {}; did you mean {}? (materials: {})",
                                         scene.file.string(), base::nearestWord(name, names), fmt::join(names, ", ")));
}

/// Rejects names equal to the default name (list and number) of another surface.
void checkNamesOfSurfaces(const Section& root, const Scene& scene) {
  std::vector<std::string> called;
  const auto call = [&](const char* list, const auto& surfaces) {
    for (std::size_t k = 0; k < surfaces.size(); ++k)
      if (!surfaces[k].name) called.push_back(fmt::format("{}{}", list, k));
  };
  call("plane", scene.planes), call("box", scene.boxes);
  call("cylinder", scene.cylinders), call("mesh", scene.meshes);
  const auto judge = [&](const char* list, const auto& surfaces) {
    for (std::size_t k = 0; k < surfaces.size(); ++k)
      if (surfaces[k].name && std::find(called.begin(), called.end(), *surfaces[k].name) != called.end())
        root.list(list)[k].fail("name", "is the default name of another surface in the results; choose another name");
  };
  judge("plane", scene.planes), judge("box", scene.boxes);
  judge("cylinder", scene.cylinders), judge("mesh", scene.meshes);
}

} // namespace

void checkTogether(const Scene& scene) {
  const Section root = scene.document->root(), run = root.section("run");
  checkMaterialsOfOverrides(root, scene);
  checkMeshes(root, scene);
  checkPlaced(root, scene);
  checkPeriodic(run, scene);
  checkPlanesAcross(root.list("plane"), scene);
  checkNamesOfSurfaces(root, scene);
  checkSettling(run, scene);
  checkSomethingMoves(scene);
}

} // namespace grouser::scene::detail
