// SPDX-License-Identifier: BSD-3-Clause
#include "runs/setup/size_checks.hpp"

#include "runs/scene/bed_radii.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/bed_options.hpp"
#include "runs/setup/grain_kinds.hpp"
#include "runs/setup/grain_memory.hpp"

#include <fmt/format.h>
#include <unistd.h>

namespace grouser::setup {

namespace {

constexpr double kGiB = 1073741824.0; // [bytes]

double memoryOfMachine() { // [bytes]
  return static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
}

} // namespace

void checkFillSizes(const scene::Scene& scene) {
  if (scene.fills.empty()) return;
  const double bytes = grainMemory(scene).most();
  for (std::size_t k = 0; k < scene.fills.size(); ++k) {
    const auto grains = static_cast<double>(placedCount(scene.fills[k]));
    if (grains * bytes > memoryOfMachine())
      scene.fail("grains", k, scene.fills[k].form == scene::FillForm::random ? "number" : "radius",
                 fmt::format("{} results in {:.3g} grains, which require {:.3g} GiB, but this machine has {:.3g} GiB; "
                             "use fewer or larger grains",
                             scene.fills[k].form == scene::FillForm::random ? "[-]" : "[m]", grains,
                             grains * bytes / kGiB, memoryOfMachine() / kGiB));
  }
}

void checkBedSize(const scene::Scene& scene) {
  if (!scene.terrain || !scene.terrain->granular()) return;
  const terrain::BedOptions options = bedOptions(scene);
  const double bytes = grainMemory(scene).most();
  const scene::Terrain& t = *scene.terrain;
  const double volume = options.meanVolume();
  double solid = t.size[0] * t.size[1] * t.depth.value_or(0) * (1 - t.porosity.value_or(scene::Terrain::kPoured));
  if (t.layers)
    solid = t.size[0] * t.size[1] * *t.layers * volume / (*t.spacing * *t.grainRadius * *t.spacing * *t.grainRadius);
  const double grains = t.coarsening ? 0 : solid / volume; // for a graded bed, planBed() checks the size
  const double memory = memoryOfMachine();
  if (grains * bytes > memory || grains > 4e9)
    scene.fail("terrain", scene::radiiKey(t),
               fmt::format("[m] results in about {:.3g} grains, which require {:.3g} GiB, but this machine has {:.3g} "
                           "GiB; use larger grains, a thinner bed or a smaller terrain.size",
                           grains, grains * bytes / kGiB, memory / kGiB));
}

} // namespace grouser::setup
