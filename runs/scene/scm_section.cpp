// SPDX-License-Identifier: BSD-3-Clause
// Keys and checks of [scm].
#include "runs/scene/detail/section_lists.hpp"
#include "runs/scene/detail/soil_materials.hpp"

namespace grouser::scene::detail {

base::Table<Scm> scmTable() {
  using S = Scm;
  base::Table<S> t("scm", "Deformable soil (terrain.kind = \"scm\"): p = (k_c / b + k_phi) z^n under a loaded area "
                          "with the smaller side b; tau = (c + p tan phi) (1 - exp(-j / K)). Constants not set in this "
                          "section come from the soil file of terrain.material");
  t.add("constants", &S::constants, "",
        "source of the constants not set here: published (values of the literature) or measured (virtual tests of the "
        "soil's grains)");
  t.add("constants_draw", &S::constantsDraw, "",
        "number (at least 1) of a random sample of the constants not set here, drawn from their intervals; 0: nominal "
        "values")
      .atLeast(0)
      .atMost(1'000'000);
  t.add("n", &S::n, "-", "sinkage exponent").plausible(0.1, 2).above(0).atMost(3);
  t.add("k_c", &S::kc, "N/m^(n+1)",
        "cohesive modulus of deformation; k_c / b + k_phi must be above 0 for the width b of a shoe")
      .plausible(30, 1e7);
  t.add("k_phi", &S::kphi, "N/m^(n+2)", "frictional modulus of deformation").plausible(1e4, 1e9);
  t.add("c", &S::cohesion, "Pa", "cohesion").plausible(30, 5e5).atLeast(0).atMost(1e7);
  t.add("phi", &S::frictionAngle, "deg", "angle of internal friction, in degrees")
      .plausible(4, 50)
      .atLeast(0)
      .atMost(60);
  t.add("K", &S::shearDisplacement, "m", "shear displacement modulus").plausible(5e-4, 0.3).above(0).atMost(1);
  t.add("unloading_stiffness", &S::unloadingStiffness, "N/m3",
        "constant k_0 of the unloading slope k_0 + A_u z; the slope is at least elastic_ratio max(1, n) p / z")
      .plausible(1e5, 1e11)
      .atLeast(-1e12)
      .atMost(1e12);
  t.add("unloading_growth", &S::unloadingGrowth, "N/m4", "coefficient A_u of the unloading slope k_0 + A_u z")
      .plausible(1e5, 1e12)
      .atLeast(0)
      .atMost(1e13);
  t.add("elastic_ratio", &S::elasticRatio, "-",
        "minimum unloading slope / (max(1, n) p / z), where p / z is the secant slope of loading")
      .atLeast(1)
      .atMost(1e3);
  t.add("damping", &S::damping, "Pa s/m",
        "damping R: pressure per compression speed, and shear stress R K ds/dt with s = j / K (at most 1 % of the "
        "shear strength)")
      .plausible(100, 3e6)
      .atLeast(0)
      .atMost(1e7);
  t.add("slip_sinkage", &S::slipSinkage, "-",
        "sinkage per shear displacement at constant pressure; default: 3 z / L, with the sinkage z at the mean ground "
        "pressure of the vehicle and the track-ground contact length L (Lyasko's rule at small slip), or 0 without a "
        "vehicle")
      .atLeast(0)
      .atMost(1);
  t.add("maximum_slip_sinkage", &S::maximumSlipSinkage, "m", "maximum slip sinkage; default: the grouser height")
      .plausible(1e-4, 0.5)
      .atLeast(0)
      .atMost(1);
  t.add("displaced_share", &S::displacedShare, "-",
        "fraction of the rut volume that is displaced to the sides as loose soil; the rest is compacted")
      .atLeast(0)
      .atMost(1);
  t.add("repose_angle", &S::reposeAngle, "deg",
        "angle of repose of loose soil, in degrees; default: published value of the soil, or phi")
      .plausible(10, 50)
      .above(0)
      .atMost(60);
  t.add("bulk_density", &S::bulkDensity, "kg/m3",
        "bulk density for the passive pressure on grousers and track sides; default: published value of the soil, or "
        "from its grains and porosity, or 1600")
      .plausible(200, 3000)
      .above(0)
      .atMost(1e4);
  t.add("node_spacing", &S::nodeSpacing, "m",
        "grid spacing; default: a quarter of the shoe length, or an eighth of the smallest body")
      .plausible(1e-3, 0.5)
      .above(0)
      .atMost(1);
  t.add("largest_sinkage", &S::deepest, "m", "maximum sinkage (range in which z^n is tabulated)")
      .plausible(0.01, 3)
      .above(0)
      .atMost(10);
  return t;
}

namespace {

void checkScm(const base::Section& section, Scm& scm, const Scene& scene) {
  if (!scene.deformable())
    section.fail("", "has no effect without terrain.kind = \"scm\"; set it, or remove the section");
  if (scm.constantsDraw > 0 && scm.n && scm.kc && scm.kphi && scm.cohesion && scm.frictionAngle &&
      scm.shearDisplacement)
    section.fail("constants_draw", "has no effect, since n, k_c, k_phi, c, phi and K are all set; remove the constants "
                                   "to be sampled, or set constants_draw = 0");
}

} // namespace

SectionEntry scmSection() { return optional("scm", &Scene::scm, scmTable(), checkScm); }

} // namespace grouser::scene::detail
