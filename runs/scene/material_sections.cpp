// SPDX-License-Identifier: BSD-3-Clause
// Keys and checks of [material.NAME] and [contact."a|b"].
#include "runs/scene/detail/section_lists.hpp"

#include "base/name_fault.hpp"
#include "runs/scene/detail/section_checks.hpp"
#include "runs/scene/detail/soil_materials.hpp"

#include <cmath>
#include <fmt/format.h>

namespace grouser::scene::detail {

namespace {

using base::Section;
using base::Table;

/// A default in short form: 0.25, 1e6.
std::string brief(double x) {
  std::string text = fmt::format("{:g}", x);
  if (const std::size_t at = text.find("e+0"); at != std::string::npos) text.erase(at + 1, 2);
  return text;
}

/// Keys of elastic-plastic laws.
void addPlasticity(Table<Material>& t) {
  using S = Material;
  t.add("plasticity", &S::plasticity, "-",
        fmt::format("eepa, eepa_linear, luding: lambda = 1 - k1/k2 with loading stiffness k1 and unloading stiffness "
                    "k2 (luding: maximum of k2); default: {}",
                    brief(S::kPlasticity)))
      .atLeast(0)
      .atMost(0.99);
  t.add("surface_energy", &S::surfaceEnergy, "J/m2",
        "eepa, eepa_linear: surface energy gamma in the pull-off force 1.5 pi gamma a, where a is the contact radius "
        "after loading; default: 0, no adhesion")
      .plausible(1e-5, 1000)
      .atLeast(0)
      .atMost(1e6);
  t.add("adhesion_exponent", &S::adhesionExponent, "-",
        "eepa, eepa_linear: exponent chi of the decrease of the adhesive force with overlap after pull-off, a multiple "
        "of 0.5; default: 1.5 for eepa, 1 for eepa_linear")
      .atLeast(0.5)
      .atMost(6);
  t.add("plastic_depth", &S::plasticDepth, "-",
        fmt::format("luding: plasticity depth phi_f; at overlaps above phi_f 2 R_eff / lambda, the unloading stiffness "
                    "is constant; default: {}",
                    brief(S::kPlasticDepth)))
      .above(0)
      .atMost(1);
  t.add("adhesion_stiffness", &S::adhesionStiffness, "N/m",
        "luding: adhesive stiffness k_c; the adhesive force during unloading is at most k_c x at overlap x; default: "
        "0, no adhesion")
      .plausible(1, 1e10)
      .atLeast(0)
      .atMost(1e12);
}

/// Keys of sliding and rolling friction.
void addFriction(Table<Material>& t) {
  using S = Material;
  t.add("friction", &S::friction, "-", "Coulomb friction coefficient")
      .plausible(1e-3, 3, "tan of the friction angle, not the angle")
      .atLeast(0)
      .atMost(10);
  static_assert(S::kTangentialStiffnessRatio == 2.0 / 7, "as the help says");
  t.add("tangential_stiffness_ratio", &S::tangentialStiffnessRatio, "-",
        "linear: tangential / normal stiffness; default: 2/7")
      .above(0)
      .atMost(1);
  t.add("tangential_damping_ratio", &S::tangentialDampingRatio, "-",
        fmt::format("linear: tangential / normal damping, default: {}; hertz: tangential damping / (2 beta sqrt(k_t "
                    "m_eff)), default: {}",
                    brief(S::kLinearTangentialDampingRatio), brief(S::kHertzTangentialDampingRatio)))
      .atLeast(0)
      .atMost(2);
  t.add("rolling_friction", &S::rollingFriction, "-",
        "coefficient of rolling friction of an elastic-plastic spring (type C): maximum torque / (R_r F_n), where R_r "
        "= R_i R_j / (R_i + R_j), i.e. half the radius for equal grains and the radius at a wall; 0: no rolling "
        "resistance")
      .atLeast(0)
      .atMost(2);
  t.add("rolling_damping_ratio", &S::rollingDampingRatio, "-", "damping ratio of the rolling spring")
      .atLeast(0)
      .atMost(1);
}

/// Keys of a material that is a soil.
void addSoil(Table<Material>& t) {
  using S = Material;
  t.leaveOutEmpty();
  t.add("soil", &S::soil, "",
        "soil name (see `grouser soils`) or path of a soil file; the values of the file, scaled to the grain size of "
        "the scene, are the defaults of the keys below");
  t.add("soil_hash", &S::soilHash, "",
        "hash of the soil file, which grouser writes to resolved scenes; a run prints a note if the file now has a "
        "different hash");
  t.add("grain_radius", &S::grainRadius, "m",
        "grain radius to which stiffness and cohesion of the soil are scaled; default: terrain.grain_radius of a bed "
        "of this material, otherwise the common radius of all grains of this material")
      .plausible(1e-6, 0.5)
      .above(0)
      .atMost(10);
}

} // namespace

Table<Material> materialTable() {
  using S = Material;
  Table<S> t("material.NAME", "Material; other sections refer to it by NAME");
  addSoil(t);
  t.add("density", &S::density, "kg/m3", "density of the solid, not bulk density")
      .plausible(100, 25000)
      .atLeast(1e-3)
      .atMost(1e5);
  t.add(
      "law", &S::law, "",
      "contact law: linear (springs) or hertz (Hertz-Mindlin); elastic-plastic with adhesion: eepa (based on Hertz), "
      "eepa_linear and luding (based on linear springs); all with dashpots and Coulomb friction (docs/contact_law.md)");
  t.add("stiffness", &S::stiffness, "N/m",
        fmt::format("linear, eepa_linear, luding: normal stiffness k of a contact between two bodies of this material "
                    "(eepa_linear, luding: during virgin loading); default: {}",
                    brief(S::kStiffness)))
      .plausible(10, 1e10)
      .atLeast(1e-3)
      .atMost(1e12);
  t.add("young", &S::young, "Pa", "hertz, eepa: Young's modulus of the solid; required")
      .plausible(2e4, 1.3e12)
      .atLeast(1)
      .atMost(1e13);
  t.add("poisson", &S::poisson, "-",
        fmt::format("hertz, eepa: Poisson's ratio of the solid; default: {}", brief(S::kPoisson)))
      .atLeast(0)
      .atMost(0.5);
  t.add("restitution", &S::restitution, "-",
        fmt::format("coefficient of restitution, rebound speed / impact speed; default: {} unless damping is set; "
                    "minimum 1e-6, or 0 with attraction or complementarity",
                    brief(S::kRestitution)))
      .atLeast(0)
      .atMost(1);
  t.add("damping", &S::damping, "1/s",
        "linear: damping coefficient gamma in F_n = k overlap + gamma m_eff v_n (v_n: approach speed), instead of "
        "restitution")
      .atLeast(0)
      .atMost(1e9);
  t.add("attraction", &S::attraction, "",
        "whether the dashpot may cause a tensile force while surfaces separate; otherwise the sum of spring and "
        "dashpot force is at least 0 (to model cohesion, set cohesion)");
  addFriction(t);
  t.add("cohesion", &S::cohesion, "J/m2",
        "work of adhesion w (twice the surface energy for equal surfaces): each contact has the constant adhesive "
        "force 2 pi w R_eff (DMT); 0: no cohesion")
      .plausible(1e-5, 1000)
      .atLeast(0)
      .atMost(1e6);
  t.add("adhesion_radius", &S::adhesionRadius, "m",
        "grain radius for which cohesion and surface_energy are given; for other grains, grouser scales both with "
        "R_eff, so that the tensile strength of a bed does not depend on grain size; two materials use the geometric "
        "mean of their values, or the only value set; default: no scaling, so that coarser beds have a lower tensile "
        "strength")
      .plausible(1e-6, 0.5)
      .above(0)
      .atMost(10);
  addPlasticity(t);
  t.add("foundation_modulus", &S::foundationModulus, "N/m3",
        "modulus of the Winkler foundation (pressure / overlap) in contacts of bodies with bodies, rigid ground, "
        "planes and obstacles")
      .plausible(1e5, 1e12)
      .atLeast(1e3)
      .atMost(1e14);
  t.add("crushing_strength", &S::crushingStrength, "Pa",
        "crushing strength sigma_f of the grains: in contacts with vehicle parts and meshes, a grain crushes at the "
        "normal force sigma_f d^2 (d: diameter; docs/contact_law.md#crushing); default: no crushing")
      .plausible(1e4, 5e9)
      .above(0)
      .atMost(1e13);
  return t;
}

namespace {

Table<ContactPair> contactTable() {
  using S = ContactPair;
  Table<S> t("contact.\"a|b\"",
             "Contact parameters of the material pair a, b, that override the mixing rule (twice the stiffnesses in "
             "series, minimum of friction and restitution, geometric mean of cohesion; docs/contact_law.md)");
  t.add("stiffness", &S::stiffness, "N/m", "normal stiffness of the pair")
      .plausible(10, 1e10)
      .atLeast(1e-3)
      .atMost(1e12);
  t.add("restitution", &S::restitution, "-",
        "coefficient of restitution of the pair; minimum 1e-6, or 0 with attraction or complementarity")
      .atLeast(0)
      .atMost(1);
  t.add("damping", &S::damping, "1/s", "damping gamma of the pair, instead of restitution").atLeast(0).atMost(1e9);
  t.add("friction", &S::friction, "-", "Coulomb friction coefficient of the pair")
      .plausible(1e-3, 3, "tan of the friction angle, not the angle")
      .atLeast(0)
      .atMost(10);
  t.add("rolling_friction", &S::rollingFriction, "-", "rolling friction of the pair").atLeast(0).atMost(2);
  t.add("cohesion", &S::cohesion, "J/m2", "work of adhesion of the pair").plausible(1e-5, 1000).atLeast(0).atMost(1e6);
  t.add("plasticity", &S::plasticity, "-",
        "plasticity lambda of the pair, if both materials are elastic-plastic; 0: elastic")
      .atLeast(0)
      .atMost(0.99);
  t.add("surface_energy", &S::surfaceEnergy, "J/m2",
        "surface energy gamma of the pair, if both are eepa or eepa_linear")
      .plausible(1e-5, 1000)
      .atLeast(0)
      .atMost(1e6);
  return t;
}

/// Throws InputError if both restitution and damping are given.
template <class S> void checkDampingKeys(const Section& section, const S& s) {
  if (s.restitution && s.damping) section.fail("damping", "is mutually exclusive with restitution; remove one");
  if (s.restitution && *s.restitution > 0 && *s.restitution < 1e-6)
    section.fail("restitution", "[-] must be 0 or in [1e-06, 1]");
}

void checkPlasticity(const Section& section, const Material& m) {
  const bool luding = m.law == contact::LawKind::luding;
  const auto refuse = [&](const char* key, bool allowed, const char* laws) {
    if (!allowed && section.has(key))
      section.fail(key, fmt::format("requires law = {}; set it, or remove the key", laws));
  };
  refuse("plasticity", m.yields(), "\"eepa\", \"eepa_linear\" or \"luding\"");
  for (const char* key : {"surface_energy", "adhesion_exponent"})
    refuse(key, m.yields() && !luding, "\"eepa\" or \"eepa_linear\"");
  for (const char* key : {"plastic_depth", "adhesion_stiffness"}) refuse(key, luding, "\"luding\"");
  if (!m.adhesionExponent) return;
  const double halves = 2 * *m.adhesionExponent;
  if (halves != std::floor(halves))
    section.fail("adhesion_exponent",
                 fmt::format("= {:g} [-] is not a multiple of 0.5; choose {:g} or {:g}", *m.adhesionExponent,
                             std::floor(halves) / 2, std::floor(halves) / 2 + 0.5));
}

/// Sets the defaults of the material's law and rejects keys of other laws.
void completeLaw(const Section& section, Material& m) {
  const bool hertz = m.hertzian();
  for (const char* key : {"stiffness", "tangential_stiffness_ratio", "damping"})
    if (hertz && section.has(key))
      section.fail(key, "requires law = \"linear\", \"eepa_linear\" or \"luding\"; remove it (hertz and eepa use "
                        "young, poisson and restitution)");
  for (const char* key : {"young", "poisson"})
    if (!hertz && section.has(key))
      section.fail(key, "requires law = \"hertz\" or \"eepa\"; set it, or remove the key (other laws use stiffness)");
  if (hertz && !m.young)
    section.fail("young", fmt::format("[Pa] is missing, but law = \"{}\" requires it; add it, e.g. young = 7e7",
                                      base::wordOf(m.law)));
  checkPlasticity(section, m);
  m.complete();
}

/// A material with its name and the values of its soil. Throws InputError for invalid names.
Material beginMaterial(const Section& section, const std::string& name, Scene& scene) {
  if (name.find('|') != std::string::npos)
    section.fail("", "has a name with |, which separates the two materials of a contact; choose another name");
  if (const std::string fault = base::nameFault(name); !fault.empty()) section.fail("", fault);
  const Soil* soil = soilOf(section, name, scene);
  Material m = soil ? materialOf(*soil, section) : Material{};
  m.name = name;
  return m;
}

void checkMaterial(const Section& section, Material& m, const Scene& scene) {
  completeMaterial(section, m);
  const auto soil = scene.soils.find(m.name);
  for (const char* key : {"soil_hash", "grain_radius"})
    if (soil == scene.soils.end() && section.has(key))
      section.fail(key, "has no effect without soil; remove it, or add soil = \"NAME\" (`grouser soils` lists them)");
  if (soil != scene.soils.end()) m.soil = soil->second->file.string(), m.soilHash = soil->second->hash;
}

/// Contact parameters of the pair `name`. Throws InputError unless it names two materials.
ContactPair beginContact(const Section& section, const std::string& name, Scene&) {
  const std::size_t bar = name.find('|');
  if (bar == std::string::npos || name.find('|', bar + 1) != std::string::npos)
    section.fail("", "must have the form [contact.\"a|b\"] with the names of two materials");
  ContactPair pair;
  pair.first = name.substr(0, bar), pair.second = name.substr(bar + 1);
  return pair;
}

void checkContact(const Section& section, ContactPair& pair, const Scene& scene) {
  requireMaterial(scene, section, "", pair.first);
  requireMaterial(scene, section, "", pair.second);
  checkDampingKeys(section, pair);
  for (const char* key : {"stiffness", "damping"})
    if (section.has(key) && scene.material(pair.first).hertzian())
      section.fail(
          key, "requires law = \"linear\", \"eepa_linear\" or \"luding\", but this pair uses hertz or eepa; remove it");
  const bool yields = scene.material(pair.first).yields() && scene.material(pair.second).yields();
  if (pair.plasticity && !yields)
    section.fail("plasticity", "requires two materials with law eepa, eepa_linear or luding; remove it");
  if (pair.surfaceEnergy && (!yields || scene.material(pair.first).law == contact::LawKind::luding))
    section.fail("surface_energy", "requires two materials with law eepa or eepa_linear; remove it");
  if (scene.contact(pair.first, pair.second)) section.fail("", "is defined twice (as a|b and b|a); remove one");
}

} // namespace

void completeMaterial(const Section& section, Material& m) {
  checkDampingKeys(section, m);
  completeLaw(section, m);
}

SectionList materialSections() {
  return {named<Material>(
              "material", &Scene::materials, materialTable(), beginMaterial, [](const Material& m) { return m.name; },
              checkMaterial),
          named<ContactPair>(
              "contact", &Scene::contacts, contactTable(), beginContact,
              [](const ContactPair& p) { return p.first + "|" + p.second; }, checkContact)};
}

} // namespace grouser::scene::detail
