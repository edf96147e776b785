// SPDX-License-Identifier: BSD-3-Clause
// Keys and checks of [terrain].
#include "runs/scene/detail/section_lists.hpp"

#include "base/rounded.hpp"
#include "runs/scene/bed_radii.hpp"
#include "runs/scene/detail/section_checks.hpp"
#include "runs/scene/soil.hpp"
#include "runs/scene/terrain_keys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace grouser::scene::detail {

namespace {

using base::Section;
using base::Table;

constexpr double kLeastPeriod = 12;     // of a tile, in radii [-]
constexpr double kLeastForPorosity = 3; // depth, in diameters [-]

/// How the grains of a bed are laid.
void addArrangement(Table<Terrain>& t) {
  using S = Terrain;
  t.add("arrangement", &S::arrangement, "",
        "how grains are laid before they settle: rained from random places, or in a lattice, which settles to a nearly "
        "regular packing");
  t.add("grain_radius", &S::grainRadius, "m",
        "in the middle of the distribution; required for a granular bed, but for radius_distribution = \"sieve\"")
      .above(0)
      .atMost(10);
  t.add("depth", &S::depth, "m", "of the bed; required for a random arrangement").above(0).atMost(1e3);
  t.add("radius_distribution", &S::radiusDistribution, "",
        "random: of the radii, by number; uniform where not given. lognormal: cut off at two standard deviations of "
        "ln r; sieve: by mass, sieve_size and sieve_passing");
  t.add("radius_spread", &S::radiusSpread, "-",
        fmt::format("uniform: half the width over grain_radius; lognormal: standard deviation of ln r; where not given "
                    "the soil's, of uniform radii of a bed of one, else {:g}",
                    S::kSpread))
      .above(0)
      .atMost(0.9);
  t.add("sieve_size", &S::sieveSize, "m", "sieve: openings (diameters), ascending").above(0).atMost(20);
  t.add("sieve_passing", &S::sievePassing, "-", "sieve: share of the mass that passes each opening, from 0 to 1")
      .atLeast(0)
      .atMost(1);
  t.add("porosity", &S::porosity, "-",
        "random: of the settled bed, reached by another friction while it settles, which is found by bisection on a "
        "small bed and then taken back; where not given the soil's, where the bed is of one that has any, else as "
        "poured")
      .atLeast(0.2)
      .atMost(0.7);
  t.add("fine_depth", &S::fineDepth, "m", "random: down to which radii are as distributed; coarser below")
      .atLeast(0)
      .atMost(1e3);
  t.add("coarsening", &S::coarsening, "-", "random: growth of grain_radius with each metre below fine_depth")
      .above(0)
      .atMost(1);
  t.add("coarsest_radius", &S::coarsestRadius, "m", "random: at which grain_radius stops to grow").above(0).atMost(10);
  t.add("layers", &S::layers, "-", "lattice: grain layers above the floor; this or depth").atLeast(1).atMost(10000);
  t.add("spacing", &S::spacing, "-",
        fmt::format("lattice: distance of grains at the start, in radii; {:g} where not given", S::kSpacing))
      .above(2)
      .atMost(10);
  t.add("jitter", &S::jitter, "-",
        fmt::format("lattice: random shift at the start, as a share of the free gap; {:g} where not given", S::kJitter))
      .atLeast(0)
      .atMost(1);
  t.add("packing", &S::packing, "-",
        fmt::format("lattice: solid fraction expected once settled; {:g} where not given", S::kPacking))
      .atLeast(0.3)
      .atMost(0.74);
}

Table<Terrain> terrainTable() {
  using S = Terrain;
  Table<S> t("terrain", "Ground from a height-map image: a bed of grains, or rigid");
  t.add("heightmap", &S::heightmap, "",
        "PNG, 8 or 16 bit; row 0 is the far edge (largest y), pixels are points; looked for in the scene's folder, the "
        "working folder, the assets folder")
      .required();
  t.add("size", &S::size, "m", "extent in x, from 0, and in y, to both sides of 0").above(0).atMost(1e5).required();
  t.add("height_range", &S::heightRange, "m", "height of black and of white").atLeast(-1e4).atMost(1e4).required();
  t.add("interpolation", &S::interpolation, "",
        "surface between the pixels: monotone never rises above or falls below the pixels around it, smooth swings "
        "beyond steps by up to 7 % of them, bilinear has edges along the lines of pixels");
  t.add("kind", &S::kind, "",
        "a bed of grains, rigid ground, or deformable soil by the relations of Bekker and Janosi ([scm])");
  t.add("material", &S::material, "",
        "of the grains or the ground; deformable soil reads its constants from the soil file of this name")
      .required();
  t.add("ground_material", &S::groundMaterial, "", "of floor and walls; the bed's own where not given");
  addArrangement(t);
  t.add("tile", &S::tile, "m",
        "x, y of a piece that is settled alone, with periodic boundaries, and copied over the terrain; needs a level "
        "floor")
      .above(0);
  t.add("floor", &S::floor, "", "rigid floor: follows the surface below the bed, or flat");
  t.add("floor_grains", &S::floorGrains, "",
        "whether fixed grains lie on the floor; on a smooth one grains roll as on the balls of a bearing");
  t.add("walls", &S::walls, "", "upright walls along the edges of the map, that hold the bed");
  t.add("wall_friction", &S::wallFriction, "-", "Coulomb coefficient of those walls; at 0 they carry no weight")
      .atLeast(0)
      .atMost(10);
  t.add("settle_time_limit", &S::settleTimeLimit, "s",
        "the bed must be at rest by then; 0 leaves settling out: a random bed then begins as the loose column that is "
        "laid, whatever its porosity is to be")
      .atLeast(0)
      .atMost(1e4);
  t.add("settle_kinetic_energy", &S::settleKineticEnergy, "-",
        "at rest: mean kinetic energy a grain, in random beds of translation, over m g radius")
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

/// The sieve curve, and the radius in its middle.
void checkSieves(const Section& section, Terrain& t) {
  for (const auto& [key, values] : {std::pair{"sieve_size", &t.sieveSize}, {"sieve_passing", &t.sievePassing}})
    if (values->empty())
      section.fail(key,
                   "is missing, which radius_distribution = \"sieve\" needs; add it, e.g. sieve_size = [0.02, 0.03, "
                   "0.05], sieve_passing = [0, 0.4, 1]");
  if (section.has("radius_spread"))
    section.fail("radius_spread", "stands beside a sieve curve, which says the same; remove one of the two");
  const std::vector<double>&size = t.sieveSize, &passing = t.sievePassing;
  if (size.size() != passing.size() || size.size() < 2)
    section.fail("sieve_passing", fmt::format("[-] has {} values, sieve_size has {}; give one a sieve, of at least two",
                                              passing.size(), size.size()));
  for (std::size_t k = 1; k < size.size(); ++k) {
    if (!(size[k] > size[k - 1])) section.fail("sieve_size", "[m] does not ascend; sort the sieves by their openings");
    if (passing[k] < passing[k - 1])
      section.fail("sieve_passing", "[-] descends: a coarser sieve passes no less; correct it");
  }
  if (passing.front() != 0 || passing.back() != 1)
    section.fail("sieve_passing", "[-] must begin with 0 (nothing is finer than the finest sieve) and end with 1 (all "
                                  "is finer than the coarsest); add these sieves");
  const terrain::RadiusDistribution curve{terrain::RadiusLaw::sieve, 0, 0, size, passing};
  const double median = curve.medianByMass();
  if (t.grainRadius && std::fabs(*t.grainRadius - median) > 1e-9 * median)
    section.fail("grain_radius",
                 fmt::format("[m] is not that of the sieve curve, {:g} m; remove it, the curve says it", median));
  t.grainRadius = median;
}

void refuseSieves(const Section& section, const Terrain& t) {
  const char* const why =
      "belongs to arrangement = \"random\" with radius_distribution = \"sieve\"; add these, or remove it";
  if (!t.sieveSize.empty()) section.fail("sieve_size", why);
  if (!t.sievePassing.empty()) section.fail("sieve_passing", why);
}

/// What belongs to the other arrangement must not stand there; what is not given gets its value.
void completeArrangement(const Section& section, Terrain& t) {
  using terrain::RadiusLaw;
  if (t.lattice()) {
    refuseSieves(section, t);
    for (const char* key :
         {"radius_distribution", "radius_spread", "porosity", "fine_depth", "coarsening", "coarsest_radius"})
      if (section.has(key))
        section.fail(key, "belongs to arrangement = \"random\"; remove it, or arrangement = \"lattice\"");
    if (t.layers && t.depth)
      section.fail("depth", "[m] stands beside layers, which says the same; remove one of the two");
    if (!t.layers && !t.depth) section.fail("layers", "is missing; give layers [-] or depth [m] of the bed");
    t.spacing = t.spacing.value_or(Terrain::kSpacing), t.jitter = t.jitter.value_or(Terrain::kJitter);
    t.packing = t.packing.value_or(Terrain::kPacking);
    return;
  }
  for (const char* key : {"layers", "spacing", "jitter", "packing"})
    if (section.has(key))
      section.fail(key, "belongs to arrangement = \"lattice\"; add that, or remove it and give depth [m]");
  if (!t.depth) section.fail("depth", "[m] is missing, which a random bed needs; add it, e.g. depth = 0.5");
  t.radiusDistribution = t.radiusDistribution.value_or(RadiusLaw::uniform);
  const bool spreads = t.radiusDistribution == RadiusLaw::uniform || t.radiusDistribution == RadiusLaw::lognormal;
  if (spreads)
    t.radiusSpread = t.radiusSpread.value_or(Terrain::kSpread);
  else if (section.has("radius_spread"))
    section.fail("radius_spread", "[-] belongs to a uniform or lognormal radius_distribution; remove it");
  if (t.radiusDistribution == RadiusLaw::sieve) return checkSieves(section, t);
  refuseSieves(section, t);
}

void checkGrading(const Section& section, const Terrain& t) {
  if (!t.fineDepth && !t.coarsening && !t.coarsestRadius) return;
  for (const char* key : {"fine_depth", "coarsening", "coarsest_radius"})
    if (!section.has(key))
      section.fail(key, "is missing: a graded bed needs fine_depth, coarsening and coarsest_radius; add it");
  if (*t.coarsestRadius <= *t.grainRadius)
    section.fail("coarsest_radius",
                 fmt::format("[m] is not above the radius at the surface, {:g} m; raise it", *t.grainRadius));
  if (*t.fineDepth >= *t.depth)
    section.fail("fine_depth", fmt::format("[m] is not above the floor, which is {:g} m deep; lower it", *t.depth));
}

void checkRandomDepth(const Section& section, const Terrain& t) {
  const double largest = bedRadii(t).largest(), least = kLeastForPorosity * 2 * *t.grainRadius;
  if (*t.depth < largest)
    section.fail("depth",
                 fmt::format("[m] is less than the radius of the largest grain; give at least {:.4g}", largest));
  if (t.porosity && *t.depth < (1 - 1e-9) * least)
    section.fail("porosity", fmt::format("[-] is measured in beds at least {:g} diameters of {:g} m deep, and this one "
                                         "is {:g} m deep; give depth = {:.3g}, or remove porosity",
                                         kLeastForPorosity, 2 * *t.grainRadius, *t.depth, least));
}

/// A bed at random of a soil lies as the soil does, unless the scene says otherwise.
void takeFromSoil(const Section& section, Terrain& t, const Soil& soil) {
  if (t.lattice()) return;
  const bool uniform = t.radiusDistribution.value_or(terrain::RadiusLaw::uniform) == terrain::RadiusLaw::uniform;
  if (uniform && !section.has("radius_spread")) t.radiusSpread = soil.grains.radiusSpread;
  const bool deepEnough = t.depth && t.grainRadius && *t.depth >= (1 - 1e-9) * kLeastForPorosity * 2 * *t.grainRadius;
  if (!section.has("porosity") && deepEnough && t.settleTimeLimit > 0) t.porosity = soil.grains.porosity;
}

void checkBed(const Section& section, Terrain& t, const Scene& scene) {
  completeArrangement(section, t);
  if (const auto soil = scene.soils.find(t.material); soil != scene.soils.end())
    takeFromSoil(section, t, *soil->second);
  if (!t.grainRadius)
    section.fail("grain_radius", "[m] is missing, which a granular bed needs; add it, or set kind = \"rigid\"");
  checkGrading(section, t);
  const double radius = t.coarsestRadius.value_or(*t.grainRadius);
  if (t.depth && *t.depth < 2 * radius)
    section.fail("depth",
                 fmt::format("[m] is less than one grain of radius {:.4g} m{}; give at least {}", radius,
                             t.sieveSize.empty() ? "" : ", the median of sieve_size", base::roundedUp(2 * radius, 4)));
  if (!t.lattice()) checkRandomDepth(section, t);
  if (t.tile && std::min((*t.tile)[0], (*t.tile)[1]) < kLeastPeriod * radius)
    section.fail("tile", fmt::format("[m] is less than {} grain radii: grains would touch their own images; give at "
                                     "least {:g}",
                                     kLeastPeriod, kLeastPeriod * radius));
  if (std::min(t.size[0], t.size[1]) < 4 * radius)
    section.fail("size", fmt::format("[m] holds less than two grains of radius {} m; enlarge it", radius));
}

void checkTerrain(const Section& section, Terrain& t, const Scene& scene) {
  requireMaterial(scene, section, "material", t.material);
  if (t.groundMaterial.empty()) t.groundMaterial = t.material;
  requireMaterial(scene, section, "ground_material", t.groundMaterial);
  if (t.heightRange[1] < t.heightRange[0])
    section.fail("height_range", "[m] has white below black; give the lower height first");
  if (t.granular()) {
    checkBed(section, t, scene);
  } else {
    refuseSieves(section, t);
    for (const char* key : kBedKeys)
      if (section.has(key))
        section.fail(key, t.deformable() ? "has no effect on deformable soil; remove it, or set kind = \"granular\""
                                         : "has no meaning on rigid ground; remove it, or set kind = \"granular\"");
  }
  resolveFile(scene, section, "heightmap", t.heightmap);
}

} // namespace

SectionList terrainSections() {
  return {optional("terrain", &Scene::terrain, terrainTable(), checkTerrain), scmSection()};
}

} // namespace grouser::scene::detail
