// SPDX-License-Identifier: BSD-3-Clause
// Keys and checks of [terrain].
#include "runs/scene/detail/section_lists.hpp"

#include "runs/scene/detail/section_checks.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace grouser::scene::detail {

namespace {

using base::Section;
using base::Table;

constexpr double kLeastPeriod = 12; // of a tile, in radii [-]

Table<Terrain> terrainTable() {
  using S = Terrain;
  Table<S> t("terrain", "Ground from a height-map image: a bed of grains, or rigid");
  t.add("heightmap", &S::heightmap, "",
        "PNG, 8 or 16 bit; row 0 is the far edge (largest y), pixels are points; looked for in the scene's folder, the "
        "working folder, the assets folder")
      .required();
  t.add("size", &S::size, "m", "extent in x, from 0, and in y, to both sides of 0").above(0).atMost(1e5).required();
  t.add("height_range", &S::heightRange, "m", "height of black and of white").atLeast(-1e4).atMost(1e4).required();
  t.add("kind", &S::kind, "", "a bed of grains or rigid ground");
  t.add("material", &S::material, "", "of the grains, or of the rigid ground").required();
  t.add("ground_material", &S::groundMaterial, "", "of floor and walls; the bed's own where not given");
  t.add("grain_radius", &S::grainRadius, "m", "of every grain; required for a granular bed").above(0).atMost(10);
  t.add("layers", &S::layers, "-", "grain layers above the floor; this or depth").atLeast(1).atMost(10000);
  t.add("depth", &S::depth, "m", "of the bed; this or layers").above(0).atMost(1e3);
  t.add("spacing", &S::spacing, "-", "of the lattice that the grains start on, in radii").above(2).atMost(10);
  t.add("jitter", &S::jitter, "-", "random shift at the start, as a share of the lattice's free gap")
      .atLeast(0)
      .atMost(1);
  t.add("packing", &S::packing, "-", "solid fraction expected once settled").atLeast(0.3).atMost(0.74);
  t.add("tile", &S::tile, "m",
        "x, y of a piece that is settled alone, with periodic boundaries, and copied over the terrain; needs a level "
        "floor")
      .above(0);
  t.add("floor", &S::floor, "", "rigid floor: follows the surface below the bed, or flat");
  t.add("walls", &S::walls, "", "upright walls along the edges of the map, that hold the bed");
  t.add("settle_time_limit", &S::settleTimeLimit, "s", "the bed must be at rest by then; 0 leaves settling out")
      .atLeast(0)
      .atMost(1e4);
  t.add("settle_kinetic_energy", &S::settleKineticEnergy, "-", "at rest: mean kinetic energy a grain over m g radius")
      .above(0)
      .atMost(1e3);
  t.add("settle_force_ratio", &S::settleForceRatio, "-",
        "at rest also: mean resultant force on a grain over its weight; \"none\" asks for the energy alone")
      .above(0)
      .atMost(1e3)
      .orWord("none");
  t.add("cache", &S::cache, "", "keep the settled bed for later runs, and take it from an earlier one; same bits");
  return t;
}

void checkTerrain(const Section& section, Terrain& t, const Scene& scene) {
  requireMaterial(scene, section, "material", t.material);
  if (t.groundMaterial.empty()) t.groundMaterial = t.material;
  requireMaterial(scene, section, "ground_material", t.groundMaterial);
  if (t.heightRange[1] < t.heightRange[0])
    section.fail("height_range", "[m] has white below black; give the lower height first");
  if (t.granular()) {
    if (!t.grainRadius)
      section.fail("grain_radius", "[m] is missing, which a granular bed needs; add it, or set kind = \"rigid\"");
    if (t.layers && t.depth)
      section.fail("depth", "[m] stands beside layers, which says the same; remove one of the two");
    if (!t.layers && !t.depth) section.fail("layers", "is missing; give layers [-] or depth [m] of the bed");
    if (t.depth && *t.depth < 2 * *t.grainRadius)
      section.fail("depth", fmt::format("[m] is less than one grain of radius {} m; give at least {}", *t.grainRadius,
                                        2 * *t.grainRadius));
    if (t.tile && std::min((*t.tile)[0], (*t.tile)[1]) < kLeastPeriod * *t.grainRadius)
      section.fail("tile", fmt::format("[m] is less than {} grain radii: grains would touch their own images; give at "
                                       "least {:g}",
                                       kLeastPeriod, kLeastPeriod * *t.grainRadius));
    if (std::min(t.size[0], t.size[1]) < 4 * *t.grainRadius)
      section.fail("size", fmt::format("[m] holds less than two grains of radius {} m; enlarge it", *t.grainRadius));
  } else {
    for (const char* key : {"grain_radius", "layers", "depth", "tile"})
      if (section.has(key)) section.fail(key, "has no meaning on rigid ground; remove it, or set kind = \"granular\"");
  }
  resolveFile(scene, section, "heightmap", t.heightmap);
}

} // namespace

SectionList terrainSections() { return {optional("terrain", &Scene::terrain, terrainTable(), checkTerrain)}; }

} // namespace grouser::scene::detail
