// SPDX-License-Identifier: BSD-3-Clause
// Keys and checks of [material.NAME] and [contact."a|b"].
#include "runs/scene/detail/section_lists.hpp"

#include "runs/scene/detail/section_checks.hpp"
#include "runs/scene/detail/soil_materials.hpp"
#include "runs/support/result_names.hpp"

#include <cmath>
#include <fmt/format.h>

namespace grouser::scene::detail {

namespace {

using base::Section;
using base::Table;

/// A default as a person writes it: 0.25, 1e6.
std::string brief(double x) {
  std::string text = fmt::format("{:g}", x);
  if (const std::size_t at = text.find("e+0"); at != std::string::npos) text.erase(at + 1, 2);
  return text;
}

/// Of elastic-plastic laws.
void addPlasticity(Table<Material>& t) {
  using S = Material;
  t.add("plasticity", &S::plasticity, "-",
        fmt::format(
            "eepa, eepa_linear, luding: lambda = 1 - k1/k2, of the stiffnesses of loading and unloading; luding: "
            "its greatest; {} where not given",
            brief(S::kPlasticity)))
      .atLeast(0)
      .atMost(0.99);
  t.add("surface_energy", &S::surfaceEnergy, "J/m2",
        "eepa, eepa_linear: gamma of the pull-off force 1.5 pi gamma a, which grows with the radius a of the contact "
        "that loading has left; 0 where not given: no adhesion")
      .atLeast(0)
      .atMost(1e6);
  t.add("adhesion_exponent", &S::adhesionExponent, "-",
        "eepa, eepa_linear: chi, by which the pull falls with the overlap beyond pull-off, in halves; 1.5 for eepa, 1 "
        "for eepa_linear where not given")
      .atLeast(0.5)
      .atMost(6);
  t.add("plastic_depth", &S::plasticDepth, "-",
        fmt::format("luding: phi_f; beyond an overlap of phi_f 2 R_eff / lambda the unloading stiffness grows no more; "
                    "{} where not given",
                    brief(S::kPlasticDepth)))
      .above(0)
      .atMost(1);
  t.add("adhesion_stiffness", &S::adhesionStiffness, "N/m",
        "luding: k_c, with which an unloaded contact pulls at an overlap x: k_c x at most; 0 where not given: no "
        "adhesion")
      .atLeast(0)
      .atMost(1e12);
}

/// Which soil a material is of.
void addSoil(Table<Material>& t) {
  using S = Material;
  t.leaveOutEmpty();
  t.add("soil", &S::soil, "",
        "soil that it is of (`grouser soils`): what its file says, scaled to the scene's grains, stands for the keys "
        "below that are not given; a name, or the path of a file");
  t.add(
      "soil_hash", &S::soilHash, "",
      "hash of that file, as a run leaves it in its resolved scene; where the file has changed since, a note says so");
  t.add("grain_radius", &S::grainRadius, "m",
        "of a soil: radius of grains that stiffness and cohesion are scaled to; where not given terrain.grain_radius "
        "of a bed of it, else the one radius of the grains that are of it")
      .above(0)
      .atMost(10);
}

} // namespace

Table<Material> materialTable() {
  using S = Material;
  Table<S> t("material.NAME", "A material; NAME is what other sections call it");
  addSoil(t);
  t.add("density", &S::density, "kg/m3", "of the solid").atLeast(1e-3).atMost(1e5);
  t.add("law", &S::law, "",
        "contact law: linear springs, or Hertz-Mindlin; elastic-plastic with adhesion: eepa (on Hertz' law), "
        "eepa_linear and luding (on linear springs); all with dashpots and Coulomb friction (docs/contact_law.md)");
  t.add("stiffness", &S::stiffness, "N/m",
        fmt::format("linear, eepa_linear, luding: normal stiffness k of a contact, at its first loading; {} where not "
                    "given",
                    brief(S::kStiffness)))
      .atLeast(1e-3)
      .atMost(1e12);
  t.add("young", &S::young, "Pa", "hertz, eepa: Young's modulus of the solid; required").atLeast(1).atMost(1e13);
  t.add("poisson", &S::poisson, "-",
        fmt::format("hertz, eepa: Poisson's ratio of the solid; {} where not given", brief(S::kPoisson)))
      .atLeast(0)
      .atMost(0.5);
  t.add("restitution", &S::restitution, "-",
        fmt::format("rebound over impact speed; {} where damping is not given either; at least 1e-6, or 0 with "
                    "attraction or complementarity",
                    brief(S::kRestitution)))
      .atLeast(0)
      .atMost(1);
  t.add("damping", &S::damping, "1/s",
        "linear: gamma of F_n = k overlap + gamma m_eff v_n (v_n: approach speed), instead of restitution")
      .atLeast(0)
      .atMost(1e9);
  t.add("attraction", &S::attraction, "",
        "whether the dashpot may pull where surfaces part; else it may at most cancel the spring; not cohesion, which "
        "is a key of its own");
  t.add("friction", &S::friction, "-", "Coulomb coefficient").atLeast(0).atMost(10);
  static_assert(S::kTangentialStiffnessRatio == 2.0 / 7, "as the help says");
  t.add("tangential_stiffness_ratio", &S::tangentialStiffnessRatio, "-",
        "linear: tangential over normal stiffness; 2/7 where not given")
      .above(0)
      .atMost(1);
  t.add("tangential_damping_ratio", &S::tangentialDampingRatio, "-",
        fmt::format(
            "linear: tangential over normal damping, {} where not given; hertz: over the damping 2 beta sqrt(k_t "
            "m_eff), {} where not given",
            brief(S::kLinearTangentialDampingRatio), brief(S::kHertzTangentialDampingRatio)))
      .atLeast(0)
      .atMost(2);
  t.add("rolling_friction", &S::rollingFriction, "-",
        "largest torque of rolling resistance over R_r F_n, by an elastic-plastic spring (type C); R_r = R_i R_j / "
        "(R_i + R_j): half the radius of equal grains, all of it against a wall; 0 leaves it out")
      .atLeast(0)
      .atMost(2);
  t.add("rolling_damping_ratio", &S::rollingDampingRatio, "-", "of the rolling spring's critical damping")
      .atLeast(0)
      .atMost(1);
  t.add("cohesion", &S::cohesion, "J/m2",
        "energy of adhesion w (twice the surface energy between like surfaces): touching surfaces pull with 2 pi w "
        "R_eff (DMT); 0 leaves it out")
      .atLeast(0)
      .atMost(1e6);
  t.add("adhesion_radius", &S::adhesionRadius, "m",
        "radius of the grains that cohesion and surface_energy are of: in other contacts these grow in proportion to "
        "R_eff, so that grains of all sizes hold together under the same stress; of two materials their geometric "
        "mean, or that of the one that has it; not given: one energy at all sizes, and coarse grains hold together "
        "less")
      .above(0)
      .atMost(10);
  addPlasticity(t);
  t.add("foundation_modulus", &S::foundationModulus, "N/m3",
        "bodies against bodies, rigid ground, planes and obstacles: pressure over overlap (Winkler foundation)")
      .atLeast(1e3)
      .atMost(1e14);
  t.add("crushing_strength", &S::crushingStrength, "Pa",
        "sigma_f of the grains: against parts of a vehicle and meshes their normal force is at most sigma_f d^2 (d: "
        "diameter), beyond which they crush (docs/contact_law.md#crushing); without it they do not")
      .above(0)
      .atMost(1e13);
  return t;
}

namespace {

Table<ContactPair> contactTable() {
  using S = ContactPair;
  Table<S> t(
      "contact.\"a|b\"",
      "What materials a and b have against each other, otherwise than the mixing rule gives: stiffness in series, "
      "doubled; the smaller of frictions and restitutions; the geometric mean of cohesions (docs/contact_law.md)");
  t.add("stiffness", &S::stiffness, "N/m", "normal stiffness of the pair").atLeast(1e-3).atMost(1e12);
  t.add("restitution", &S::restitution, "-",
        "rebound over impact speed of the pair; at least 1e-6, or 0 with attraction or complementarity")
      .atLeast(0)
      .atMost(1);
  t.add("damping", &S::damping, "1/s", "gamma of the pair, instead of restitution").atLeast(0).atMost(1e9);
  t.add("friction", &S::friction, "-", "Coulomb coefficient of the pair").atLeast(0).atMost(10);
  t.add("rolling_friction", &S::rollingFriction, "-", "of the pair").atLeast(0).atMost(2);
  t.add("cohesion", &S::cohesion, "J/m2", "energy of adhesion of the pair").atLeast(0).atMost(1e6);
  t.add("plasticity", &S::plasticity, "-", "lambda of the pair, where both yield; 0: it is elastic")
      .atLeast(0)
      .atMost(0.99);
  t.add("surface_energy", &S::surfaceEnergy, "J/m2", "gamma of the pair, where both are eepa or eepa_linear")
      .atLeast(0)
      .atMost(1e6);
  return t;
}

/// One of the two ways to say how lossy a contact is.
template <class S> void checkOneLoss(const Section& section, const S& s) {
  if (s.restitution && s.damping)
    section.fail("damping", "stands beside restitution, which says the same; remove one of the two");
  if (s.restitution && *s.restitution > 0 && *s.restitution < 1e-6)
    section.fail("restitution", "[-] is outside [1e-06, 1], and not 0; choose one of these");
}

void checkPlasticity(const Section& section, const Material& m) {
  const bool luding = m.law == contact::LawKind::luding;
  const auto refuse = [&](const char* key, bool allowed, const char* laws) {
    if (!allowed && section.has(key))
      section.fail(key, fmt::format("belongs to law = {}; add that, or remove the key", laws));
  };
  refuse("plasticity", m.yields(), "\"eepa\", \"eepa_linear\" or \"luding\"");
  for (const char* key : {"surface_energy", "adhesion_exponent"})
    refuse(key, m.yields() && !luding, "\"eepa\" or \"eepa_linear\"");
  for (const char* key : {"plastic_depth", "adhesion_stiffness"}) refuse(key, luding, "\"luding\"");
  if (!m.adhesionExponent) return;
  const double halves = 2 * *m.adhesionExponent;
  if (halves != std::floor(halves))
    section.fail("adhesion_exponent",
                 fmt::format("= {:g} [-] is not a whole number of halves; choose {:g} or {:g}", *m.adhesionExponent,
                             std::floor(halves) / 2, std::floor(halves) / 2 + 0.5));
}

/// What belongs to the material's law gets its default; what belongs to the other must not stand there.
void completeLaw(const Section& section, Material& m) {
  const bool hertz = m.hertzian();
  for (const char* key : {"stiffness", "tangential_stiffness_ratio", "damping"})
    if (hertz && section.has(key))
      section.fail(key, "belongs to law = \"linear\", \"eepa_linear\" or \"luding\"; remove it: young, poisson and "
                        "restitution say it for hertz and eepa");
  for (const char* key : {"young", "poisson"})
    if (!hertz && section.has(key))
      section.fail(key, "belongs to law = \"hertz\" or \"eepa\"; add that, or remove it: stiffness says it for the "
                        "others");
  if (hertz && !m.young)
    section.fail("young", fmt::format("[Pa] is missing, which law = \"{}\" needs; add it, e.g. young = 7e7",
                                      base::wordOf(m.law)));
  checkPlasticity(section, m);
  m.complete();
}

/// A material with its name, and with what its soil says of it. Throws where the name cannot be one.
Material beginMaterial(const Section& section, const std::string& name, Scene& scene) {
  if (name.find('|') != std::string::npos)
    section.fail("", "has a name with |, which separates the two of a pair; choose another name");
  if (const std::string fault = support::nameFault(name); !fault.empty()) section.fail("", fault);
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
      section.fail(key, "has no meaning without soil; remove it, or add soil = \"NAME\" (`grouser soils` lists them)");
  if (soil != scene.soils.end()) m.soil = soil->second->file.string(), m.soilHash = soil->second->hash;
}

/// What two materials have against each other, with their names. Throws where there are not two.
ContactPair beginContact(const Section& section, const std::string& name, Scene&) {
  const std::size_t bar = name.find('|');
  if (bar == std::string::npos || name.find('|', bar + 1) != std::string::npos)
    section.fail("", "is not of the form [contact.\"a|b\"] with two materials; write the pair that way");
  ContactPair pair;
  pair.first = name.substr(0, bar), pair.second = name.substr(bar + 1);
  return pair;
}

void checkContact(const Section& section, ContactPair& pair, const Scene& scene) {
  requireMaterial(scene, section, "", pair.first);
  requireMaterial(scene, section, "", pair.second);
  checkOneLoss(section, pair);
  for (const char* key : {"stiffness", "damping"})
    if (section.has(key) && scene.material(pair.first).hertzian())
      section.fail(key, "belongs to law = \"linear\", but this pair is hertz; remove it");
  const bool yields = scene.material(pair.first).yields() && scene.material(pair.second).yields();
  if (pair.plasticity && !yields)
    section.fail("plasticity", "belongs to pairs of which both are eepa, eepa_linear or luding; remove it");
  if (pair.surfaceEnergy && (!yields || scene.material(pair.first).law == contact::LawKind::luding))
    section.fail("surface_energy", "belongs to pairs of which both are eepa or eepa_linear; remove it");
  if (scene.contact(pair.first, pair.second)) section.fail("", "is given twice, in both orders; remove one of the two");
}

} // namespace

void completeMaterial(const Section& section, Material& m) {
  checkOneLoss(section, m);
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
