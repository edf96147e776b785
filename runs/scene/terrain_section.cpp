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

constexpr double kMinPeriod = 12;     // minimum tile edge / radius [-]
constexpr double kMinForPorosity = 3; // minimum depth / diameter [-]

/// Keys of the initial arrangement of a bed's grains.
void addArrangement(Table<Terrain>& t) {
  using S = Terrain;
  t.add("arrangement", &S::arrangement, "",
        "initial arrangement of the grains before settling: random (rained from random positions), or lattice (settles "
        "to a nearly regular packing)");
  t.add("grain_radius", &S::grainRadius, "m",
        "median grain radius; required for a granular bed, except with radius_distribution = \"sieve\"")
      .plausible(1e-6, 0.5)
      .above(0)
      .atMost(10);
  t.add("depth", &S::depth, "m", "depth of the bed; required for a random arrangement")
      .plausible(1e-3, 20)
      .above(0)
      .atMost(1e3);
  t.add("radius_distribution", &S::radiusDistribution, "",
        "random: grain-size distribution, which is single, uniform or lognormal by number (lognormal: truncated at two "
        "standard deviations of ln r), or sieve by mass (sieve_size, sieve_passing); default: uniform");
  t.add("radius_spread", &S::radiusSpread, "-",
        fmt::format("uniform: half width / grain_radius; lognormal: standard deviation of ln r; default: {:g}, or for "
                    "uniform radii the value of the soil if the bed material is a soil",
                    S::kSpread))
      .above(0)
      .atMost(0.9);
  t.add("sieve_size", &S::sieveSize, "m", "sieve: openings (grain diameters), in ascending order")
      .plausible(1e-6, 0.5)
      .above(0)
      .atMost(20);
  t.add("sieve_passing", &S::sievePassing, "-", "sieve: mass fraction that passes each opening, from 0 to 1")
      .atLeast(0)
      .atMost(1);
  t.add("porosity", &S::porosity, "-",
        "random: target porosity of the settled bed; grouser finds, with a small bed, the grain friction that produces "
        "this porosity, and uses it only during settling; default: porosity of the soil if it has one, otherwise as "
        "poured")
      .atLeast(0.2)
      .atMost(0.7);
  t.add("fine_depth", &S::fineDepth, "m",
        "random: depth down to which radii follow the distribution; grains are coarser below")
      .plausible(0, 20)
      .atLeast(0)
      .atMost(1e3);
  t.add("coarsening", &S::coarsening, "-", "random: increase of grain_radius per metre of depth below fine_depth")
      .above(0)
      .atMost(1);
  t.add("coarsest_radius", &S::coarsestRadius, "m", "random: maximum grain_radius of a bed graded by depth")
      .plausible(1e-6, 0.5)
      .above(0)
      .atMost(10);
  t.add("layers", &S::layers, "-", "lattice: number of grain layers above the floor, instead of depth")
      .atLeast(1)
      .atMost(10000);
  t.add("spacing", &S::spacing, "-",
        fmt::format("lattice: initial grain spacing, in grain radii; default: {:g}", S::kSpacing))
      .above(2)
      .atMost(10);
  t.add("jitter", &S::jitter, "-",
        fmt::format("lattice: maximum random initial displacement along each axis / about half the gap between grains; "
                    "default: {:g}",
                    S::kJitter))
      .atLeast(0)
      .atMost(1);
  t.add("packing", &S::packing, "-",
        fmt::format("lattice: expected solid fraction after settling; default: {:g}", S::kPacking))
      .atLeast(0.3)
      .atMost(0.74);
}

Table<Terrain> terrainTable() {
  using S = Terrain;
  Table<S> t("terrain", "Ground from a height-map image: a bed of grains, rigid ground or deformable soil");
  t.add("heightmap", &S::heightmap, "",
        "PNG, 8 or 16 bit; row 0 is the far edge (largest y), each pixel is a grid point; searched for in the scene's "
        "folder, the working folder and the assets folder")
      .required();
  t.add("size", &S::size, "m", "extent in x, from 0, and in y, centred at 0")
      .plausible(0.01, 2000)
      .above(0)
      .atMost(1e5)
      .required();
  t.add("height_range", &S::heightRange, "m", "heights of black and white pixels, [min, max]")
      .atLeast(-1e4)
      .atMost(1e4)
      .required();
  t.add("interpolation", &S::interpolation, "",
        "interpolation between pixels: monotone (no overshoot), smooth (overshoots steps by up to 7 %) or bilinear "
        "(edges along pixel lines)");
  t.add("kind", &S::kind, "",
        "kind of ground: granular (bed of grains), rigid, or scm (deformable soil with the relations of Bekker and "
        "Janosi, [scm])");
  t.add("material", &S::material, "",
        "material of the grains or the ground; for deformable soil, the soil file with its constants")
      .required();
  t.add("ground_material", &S::groundMaterial, "", "material of floor and walls; default: value of material");
  addArrangement(t);
  t.add("tile", &S::tile, "m",
        "size in x, y of a tile that settles with periodic boundaries and is then copied over the terrain; requires a "
        "level floor")
      .plausible(1e-3, 100)
      .above(0);
  t.add("floor", &S::floor, "", "shape of the rigid floor: follow (parallel to the surface, below the bed) or flat");
  t.add("floor_grains", &S::floorGrains, "",
        "whether the floor is covered with fixed grains; on a smooth floor the lowest grains roll freely");
  t.add("walls", &S::walls, "", "whether vertical walls along the edges of the map confine the bed");
  t.add("wall_friction", &S::wallFriction, "-",
        "friction coefficient of the walls; with 0, the walls carry no weight of the bed")
      .plausible(1e-3, 3, "tan of the friction angle, not the angle")
      .atLeast(0)
      .atMost(10);
  t.add("settle_time_limit", &S::settleTimeLimit, "s",
        "time limit of settling, after which the run ends with an error; 0: no settling, so a random bed starts as a "
        "loose column regardless of porosity")
      .plausible(0, 300)
      .atLeast(0)
      .atMost(1e4);
  t.add("settle_kinetic_energy", &S::settleKineticEnergy, "-",
        "settling criterion: maximum of the mean kinetic energy per grain (random beds: translational only) / (m g "
        "radius)")
      .above(0)
      .atMost(1e3);
  t.add("settle_force_ratio", &S::settleForceRatio, "-",
        "additional settling criterion: maximum of the mean resultant force on a grain / weight of the grain; "
        "\"none\": kinetic energy only")
      .above(0)
      .atMost(1e3)
      .orWord("none");
  t.add("cache", &S::cache, "",
        "store the settled bed, and reuse stored beds; results with and without cache are bitwise identical");
  return t;
}

/// Checks the sieve curve, and sets grain_radius to its median.
void checkSieves(const Section& section, Terrain& t) {
  for (const auto& [key, values] : {std::pair{"sieve_size", &t.sieveSize}, {"sieve_passing", &t.sievePassing}})
    if (values->empty())
      section.fail(key, "is missing, but radius_distribution = \"sieve\" requires it; add it, e.g. sieve_size = [0.02, "
                        "0.03, 0.05], sieve_passing = [0, 0.4, 1]");
  if (section.has("radius_spread"))
    section.fail("radius_spread", "is mutually exclusive with a sieve curve; remove one");
  const std::vector<double>&size = t.sieveSize, &passing = t.sievePassing;
  if (size.size() != passing.size() || size.size() < 2)
    section.fail(
        "sieve_passing",
        fmt::format("[-] has {} values, but sieve_size has {}; set one value per sieve, for at least two sieves",
                    passing.size(), size.size()));
  for (std::size_t k = 1; k < size.size(); ++k) {
    if (!(size[k] > size[k - 1]))
      section.fail("sieve_size", "[m] must be in ascending order; sort the sieves by opening");
    if (passing[k] < passing[k - 1])
      section.fail("sieve_passing", "[-] must not decrease, since a coarser sieve passes at least as much; correct it");
  }
  if (passing.front() != 0 || passing.back() != 1)
    section.fail("sieve_passing", "[-] must start with 0 (the finest sieve passes nothing) and end with 1 (the "
                                  "coarsest sieve passes everything); add these sieves");
  const terrain::RadiusDistribution curve{terrain::RadiusLaw::sieve, 0, 0, size, passing};
  const double median = curve.medianByMass();
  if (t.grainRadius && std::fabs(*t.grainRadius - median) > 1e-9 * median)
    section.fail("grain_radius",
                 fmt::format("[m] differs from the median of the sieve curve, {:g} m; remove it", median));
  t.grainRadius = median;
}

void refuseSieves(const Section& section, const Terrain& t) {
  const char* const why =
      "requires arrangement = \"random\" with radius_distribution = \"sieve\"; add these, or remove it";
  if (!t.sieveSize.empty()) section.fail("sieve_size", why);
  if (!t.sievePassing.empty()) section.fail("sieve_passing", why);
}

/// Rejects keys of the other arrangement and sets defaults.
void completeArrangement(const Section& section, Terrain& t) {
  using terrain::RadiusLaw;
  if (t.lattice()) {
    refuseSieves(section, t);
    for (const char* key :
         {"radius_distribution", "radius_spread", "porosity", "fine_depth", "coarsening", "coarsest_radius"})
      if (section.has(key))
        section.fail(key, "requires arrangement = \"random\"; remove it, or arrangement = \"lattice\"");
    if (t.layers && t.depth) section.fail("depth", "[m] is mutually exclusive with layers; remove one");
    if (!t.layers && !t.depth) section.fail("layers", "is missing; set layers [-] or depth [m] of the bed");
    t.spacing = t.spacing.value_or(Terrain::kSpacing), t.jitter = t.jitter.value_or(Terrain::kJitter);
    t.packing = t.packing.value_or(Terrain::kPacking);
    return;
  }
  for (const char* key : {"layers", "spacing", "jitter", "packing"})
    if (section.has(key))
      section.fail(key, "requires arrangement = \"lattice\"; set it, or remove the key and set depth [m]");
  if (!t.depth) section.fail("depth", "[m] is missing, but a random bed requires it; add it, e.g. depth = 0.5");
  t.radiusDistribution = t.radiusDistribution.value_or(RadiusLaw::uniform);
  const bool spreads = t.radiusDistribution == RadiusLaw::uniform || t.radiusDistribution == RadiusLaw::lognormal;
  if (spreads)
    t.radiusSpread = t.radiusSpread.value_or(Terrain::kSpread);
  else if (section.has("radius_spread"))
    section.fail("radius_spread", "[-] requires a uniform or lognormal radius_distribution; remove it");
  if (t.radiusDistribution == RadiusLaw::sieve) return checkSieves(section, t);
  refuseSieves(section, t);
}

void checkGrading(const Section& section, const Terrain& t) {
  if (!t.fineDepth && !t.coarsening && !t.coarsestRadius) return;
  for (const char* key : {"fine_depth", "coarsening", "coarsest_radius"})
    if (!section.has(key))
      section.fail(key, "is missing, but a graded bed requires fine_depth, coarsening and coarsest_radius; add it");
  if (*t.coarsestRadius <= *t.grainRadius)
    section.fail("coarsest_radius",
                 fmt::format("[m] must exceed the radius at the surface, {:g} m; raise it", *t.grainRadius));
  if (*t.fineDepth >= *t.depth)
    section.fail("fine_depth", fmt::format("[m] reaches the floor, which is at a depth of {:g} m; lower it", *t.depth));
}

void checkRandomDepth(const Section& section, const Terrain& t) {
  const double largest = bedRadii(t).largest(), least = kMinForPorosity * 2 * *t.grainRadius;
  if (*t.depth < largest)
    section.fail("depth", fmt::format("[m] is less than the largest grain radius; set at least {:.4g}", largest));
  if (t.porosity && *t.depth < (1 - 1e-9) * least)
    section.fail("porosity", fmt::format("[-] requires a bed depth of at least {:g} grain diameters of {:g} m, but the "
                                         "depth is {:g} m; set depth = {:.3g}, or remove porosity",
                                         kMinForPorosity, 2 * *t.grainRadius, *t.depth, least));
}

/// Sets radius_spread and porosity of a random bed from its soil if the scene omits them.
void takeFromSoil(const Section& section, Terrain& t, const Soil& soil) {
  if (t.lattice()) return;
  const bool uniform = t.radiusDistribution.value_or(terrain::RadiusLaw::uniform) == terrain::RadiusLaw::uniform;
  if (uniform && !section.has("radius_spread")) t.radiusSpread = soil.grains.radiusSpread;
  const bool deepEnough = t.depth && t.grainRadius && *t.depth >= (1 - 1e-9) * kMinForPorosity * 2 * *t.grainRadius;
  if (!section.has("porosity") && deepEnough && t.settleTimeLimit > 0) t.porosity = soil.grains.porosity;
}

void checkBed(const Section& section, Terrain& t, const Scene& scene) {
  completeArrangement(section, t);
  if (const auto soil = scene.soils.find(t.material); soil != scene.soils.end())
    takeFromSoil(section, t, *soil->second);
  if (!t.grainRadius)
    section.fail("grain_radius", "[m] is missing, but a granular bed requires it; add it, or set kind = \"rigid\"");
  checkGrading(section, t);
  const double radius = t.coarsestRadius.value_or(*t.grainRadius);
  if (t.depth && *t.depth < 2 * radius)
    section.fail("depth",
                 fmt::format("[m] is less than the diameter of a grain of radius {:.4g} m{}; set at least {}", radius,
                             t.sieveSize.empty() ? "" : ", the median of sieve_size", base::roundedUp(2 * radius, 4)));
  if (!t.lattice()) checkRandomDepth(section, t);
  if (t.tile && std::min((*t.tile)[0], (*t.tile)[1]) < kMinPeriod * radius)
    section.fail(
        "tile",
        fmt::format("[m] is less than {} grain radii, so grains would touch their own images; set at least {:g}",
                    kMinPeriod, kMinPeriod * radius));
  if (std::min(t.size[0], t.size[1]) < 4 * radius)
    section.fail("size", fmt::format("[m] is less than two diameters of grains of radius {} m; enlarge it", radius));
}

void checkTerrain(const Section& section, Terrain& t, const Scene& scene) {
  requireMaterial(scene, section, "material", t.material);
  if (t.groundMaterial.empty()) t.groundMaterial = t.material;
  requireMaterial(scene, section, "ground_material", t.groundMaterial);
  if (t.heightRange[1] < t.heightRange[0])
    section.fail("height_range", "[m] must be [min, max]; put the lower height first");
  if (t.granular()) {
    checkBed(section, t, scene);
  } else {
    refuseSieves(section, t);
    for (const char* key : kBedKeys)
      if (section.has(key))
        section.fail(key, t.deformable() ? "has no effect on deformable soil; remove it, or set kind = \"granular\""
                                         : "has no effect on rigid ground; remove it, or set kind = \"granular\"");
  }
  resolveFile(scene, section, "heightmap", t.heightmap);
}

} // namespace

SectionList terrainSections() {
  return {optional("terrain", &Scene::terrain, terrainTable(), checkTerrain), scmSection()};
}

} // namespace grouser::scene::detail
