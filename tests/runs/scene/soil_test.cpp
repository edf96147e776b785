// SPDX-License-Identifier: BSD-3-Clause
// Soils by name: values of the soil file in a scene, and their scaling to the scene's grains.
#include "runs/scene/soil.hpp"
#include "runs/scene/soil_calibration.hpp"

#include "base/error.hpp"
#include "runs/scene/scene_file.hpp"
#include "tests/runs/scene_fixture.hpp"
#include "tests/runs/soil_fixture.hpp"

#include <string>
#include <vector>

namespace grouser::scene {

using namespace test; // fixtures

namespace {

namespace fs = std::filesystem;

class Soils : public SoilTest {
protected:
  Scene parse(const std::string& text, const std::vector<std::string>& overrides = {}) const {
    return readSceneText(text, folder_ / "scene.toml", overrides);
  }
  /// The error of a scene.
  std::string errorOf(const std::string& text, const std::vector<std::string>& overrides = {}) const {
    try {
      parse(text, overrides);
    } catch (const base::InputError& error) {
      return error.what();
    }
    ADD_FAILURE() << "the scene was accepted:\n" << text;
    return "";
  }
  void expectError(const std::string& text, const std::vector<std::string>& parts) const {
    const std::string error = errorOf(text);
    for (const std::string& part : parts) EXPECT_NE(error.find(part), std::string::npos) << error << "\nlacks " << part;
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
  }
  /// The error of a soil file that is valid except for one line.
  void expectFileError(const std::string& from, const std::string& to, const std::vector<std::string>& parts) const {
    const std::string text = replaced(kLoam, from, to);
    ASSERT_NE(text, "") << from;
    put(folder_ / "soils/loam.toml", text);
    expectError(grainOf("loam", 0.01), parts);
  }
};

TEST_F(Soils, ANameTakesThePresetWhereverAMaterialStands) {
  for (const std::string& section :
       {grainOf("loam", 0.01), grainOf("other", 0.01, "[material.other]\n[[plane]]\nmaterial = \"loam\"\n"),
        grainOf("other", 0.01, "[material.other]\nlaw = \"linear\"\n[contact.\"other|loam\"]\nfriction = 0.1\n")}) {
    const bool needsRadius = section.find("other") != std::string::npos;
    const Scene s = parse(section, needsRadius ? std::vector<std::string>{"material.loam.grain_radius=0.01"}
                                               : std::vector<std::string>{});
    const Material& m = s.material("loam");
    EXPECT_EQ(m.stiffness, 2e5) << section;
    EXPECT_EQ(m.density, 2600);
    EXPECT_EQ(m.soil, fs::canonical(folder_ / "soils/loam.toml").string());
    EXPECT_EQ(m.tangentialStiffnessRatio, 2.0 / 7) << "missing keys have their defaults";
  }
}

TEST_F(Soils, StiffnessAndCohesionGoWithTheRadius) {
  const Scene s = parse(grainOf("loam", 0.02));
  const Material& m = s.material("loam");
  EXPECT_DOUBLE_EQ(*m.stiffness, 4e5);
  EXPECT_DOUBLE_EQ(m.cohesion, 6);
  EXPECT_DOUBLE_EQ(*m.damping, 25) << "scales as sqrt(k / m)";
  EXPECT_EQ(m.friction, 0.45);
  EXPECT_EQ(m.rollingFriction, 0.1);
  EXPECT_EQ(m.density, 2600);
  EXPECT_EQ(m.grainRadius, 0.02);
}

TEST_F(Soils, YoungsModulusIsKept) {
  put(folder_ / "soils/stone.toml",
      replaced(replaced(kLoam, "law = \"linear\"\nstiffness = 2e5\ndamping = 50\n", "law = \"hertz\"\nyoung = 3e8\n"),
               "title = \"loam\"", "title = \"stone\""));
  const Scene s = parse(grainOf("stone", 0.03));
  const Material& m = s.material("stone");
  EXPECT_EQ(m.young, 3e8);
  EXPECT_DOUBLE_EQ(m.cohesion, 9);
}

TEST_F(Soils, KeysOfTheSceneOverrideAndAreNotScaled) {
  const std::string own = "[material.ground]\nsoil = \"loam\"\nstiffness = 7e5\nfriction = 0.6\n";
  const Scene s = parse(grainOf("ground", 0.02, own));
  EXPECT_EQ(s.material("ground").stiffness, 7e5);
  EXPECT_EQ(s.material("ground").friction, 0.6);
  EXPECT_DOUBLE_EQ(s.material("ground").cohesion, 6);
  EXPECT_EQ(s.materials.size(), 1u);
}

TEST_F(Soils, OverridesOfTheCommandLineWorkOnAPreset) {
  const Scene s = parse(bedOf("loam", "depth = 0.3\n"), {"material.loam.friction=0.6", "terrain.grain_radius=0.015"});
  EXPECT_EQ(s.material("loam").friction, 0.6);
  EXPECT_DOUBLE_EQ(*s.material("loam").stiffness, 3e5) << "scaled to the radius of the override";
  const Scene named = parse(bedOf("clay", "depth = 0.3\n"), {"terrain.material=loam", "material.loam.cohesion=1"});
  EXPECT_EQ(named.material("loam").cohesion, 1);
  EXPECT_NE(errorOf(bedOf("loam", "depth = 0.3\n"), {"material.loan.friction=0.6"}).find("did you mean loam?"),
            std::string::npos);
}

TEST_F(Soils, WhatContradictsTheSceneIsLeftOut) {
  const Material lossy = parse(grainOf("g", 0.01, "[material.g]\nsoil = \"loam\"\nrestitution = 0.4\n")).material("g");
  EXPECT_EQ(lossy.restitution, 0.4);
  EXPECT_FALSE(lossy.damping);
  const Material hertz =
      parse(grainOf("g", 0.01, "[material.g]\nsoil = \"loam\"\nlaw = \"hertz\"\nyoung = 1e8\n")).material("g");
  EXPECT_FALSE(hertz.stiffness);
  EXPECT_FALSE(hertz.damping);
  EXPECT_EQ(hertz.friction, 0.45);
}

TEST_F(Soils, AMaterialOfTheSceneGoesBeforeASoilOfThatName) {
  const Scene s = parse(grainOf("loam", 0.01, "[material.loam]\ndensity = 1000\n"));
  EXPECT_TRUE(s.material("loam").soil.empty());
  EXPECT_EQ(s.material("loam").friction, Material{}.friction);
  ASSERT_EQ(soilNotes(s).size(), 1u);
  EXPECT_NE(soilNotes(s)[0].find("defined in the scene"), std::string::npos) << soilNotes(s)[0];
}

TEST_F(Soils, TheRadiusIsTheBedsThenThatOfTheGrains) {
  const std::string more = "[[grain]]\nposition = [0.5, 0, 0]\nabove_bed = 0.01\nradius = 0.05\nmaterial = \"loam\"\n";
  EXPECT_EQ(parse(bedOf("loam", "depth = 0.3\n" + more)).material("loam").grainRadius, 0.02);
  const std::string fill = "[[grains]]\nlow = [0, 0, 0]\nhigh = [1, 1, 1]\nradius = 0.01\nradius_to = 0.03\n"
                           "material = \"loam\"\n";
  EXPECT_DOUBLE_EQ(*parse("version = 1\n[run]\nduration = 1\n" + fill).material("loam").grainRadius, 0.02);
  const std::string two = grainOf("loam", 0.01) + fill;
  expectError(two, {"material.loam.grain_radius [m] is missing", "from 10 mm to 20 mm", "add grain_radius = 0.01",
                    "[material.loam]", "soil = \"loam\""});
  EXPECT_DOUBLE_EQ(*parse(two, {"material.loam.grain_radius=0.03"}).material("loam").stiffness, 6e5);
  expectError(grainOf("other", 0.01, "[material.other]\n[[plane]]\nmaterial = \"loam\"\n"),
              {"scene.toml:6", "the scene has no grains of this soil", "add grain_radius = 0.01"});
  const std::string sieved = "depth = 0.3\nradius_distribution = \"sieve\"\nsieve_size = [0.02, 0.04]\n"
                             "sieve_passing = [0, 1]\n";
  const Scene s = parse(replaced(bedOf("loam", sieved), "grain_radius = 0.02\n", ""));
  EXPECT_EQ(s.material("loam").grainRadius, s.terrain->grainRadius);
}

TEST_F(Soils, GrainRadiusNeedsASoil) {
  expectError(grainOf("a", 0.01, "[material.a]\ngrain_radius = 0.01\n"),
              {"material.a.grain_radius = 0.01", "has no effect without soil"});
}

TEST_F(Soils, UnknownNamesAreAnsweredWithTheNearestAndAll) {
  expectError(grainOf("lete_snad", 0.01), {"scene.toml:7: grain.0.material", "is not a material of this scene",
                                           "did you mean \"lete_sand\"?", "gravel", "loam"});
  expectError(grainOf("a", 0.01, "[material.a]\nsoil = \"laom\"\n"),
              {"scene.toml:5", "material.a.soil = \"laom\" is not a known soil", "did you mean \"loam\"?", "searched"});
  expectError(grainOf("soils/loam.toml", 0.01), {"grain.0.material", "soil = \"soils/loam.toml\""});
  expectError(grainOf("a", 0.01, "[material.a]\nsoil = \"\"\n"), {"material.a.soil"});
  expectError(grainOf("a", 0.01, "[material.a]\nsoil = 3\n"), {"material.a.soil = 3 has the wrong type"});
}

TEST_F(Soils, APathStandsForAFile) {
  fs::create_directories(folder_ / "mine");
  put(folder_ / "mine/wet.toml", replaced(kLoam, "density = 2600", "density = 2222"));
  const Scene s = parse(grainOf("a", 0.01, "[material.a]\nsoil = \"mine/wet.toml\"\n"));
  EXPECT_EQ(s.material("a").density, 2222);
}

TEST_F(Soils, MistakesInASoilsFileNameItsLine) {
  expectFileError("friction = 0.45", "friction = 11", {"loam.toml:11: material.friction = 11", "[0, 10]"});
  expectFileError("friction = 0.45", "fricton = 0.4", {"loam.toml:11", "did you mean friction?"});
  expectFileError("radius_spread = 0.2", "radius_spread = 2", {"loam.toml:16: bed.radius_spread", "(0, 0.9]"});
  expectFileError("[0.008, 0.02]", "[0.02, 0.008]", {"loam.toml:18", "must be [min, max]"});
  expectFileError("[0.008, 0.02]", "[0.015, 0.02]", {"does not include grain_radius = 0.01"});
  expectFileError("unit = \"deg\"", "unit = \"rad\"", {"loam.toml:22", "unit = \"rad\"", "unit = \"deg\""});
  expectFileError("low = 29", "low = 31", {"published.0.low", "exceeds value"});
  expectFileError("quantity = \"phi\"", "quantity = \"ph\"", {"is not one of n, k_c", "did you mean \"phi\"?"});
  expectFileError("title = \"loam\"\n", "", {"[soil] lacks the required key title"});
  expectFileError("density = 2600", "soil = \"loam\"", {"loam.toml:7: material.soil", "is a key of scene files only"});
  expectFileError("stiffness = 2e5", "young = 2e5", {"loam.toml:9: material.young", "requires law = \"hertz\""});
  const std::string text(kLoam);
  put(folder_ / "soils/loam.toml", text.substr(0, text.find("[[reached]]")));
  expectError(grainOf("loam", 0.01), {"loam.toml:5: soil.calibrated", "the file has no measured constants"});
  put(folder_ / "soils/<b>.toml", kLoam);
  expectError(grainOf("a", 0.01, "[material.a]\nsoil = \"soils/<b>.toml\"\n"),
              {"<b>.toml: the name of a soil file contains < or >"});
}

TEST_F(Soils, TheBedLiesAsTheSoilDoesUnlessTheSceneSaysOtherwise) {
  EXPECT_EQ(parse(bedOf("loam", "depth = 0.3\n")).terrain->porosity, 0.41);
  EXPECT_EQ(parse(bedOf("loam", "depth = 0.3\n")).terrain->radiusSpread, 0.2);
  const Scene given = parse(bedOf("loam", "depth = 0.3\nporosity = 0.38\nradius_spread = 0.1\n"));
  EXPECT_EQ(given.terrain->porosity, 0.38);
  EXPECT_EQ(given.terrain->radiusSpread, 0.1);
  const Scene shallow = parse(bedOf("loam", "depth = 0.1\n"));
  EXPECT_FALSE(shallow.terrain->porosity) << "not measured in beds shallower than three diameters";
  ASSERT_EQ(soilNotes(shallow).size(), 1u);
  EXPECT_NE(soilNotes(shallow)[0].find("too shallow"), std::string::npos);
  EXPECT_FALSE(parse(bedOf("loam", "arrangement = \"lattice\"\nlayers = 3\n")).terrain->porosity);
  EXPECT_FALSE(parse(bedOf("plain", "depth = 0.3\n[material.plain]\n")).terrain->porosity);
}

TEST_F(Soils, ResolvedSceneSaysWhereItsValuesComeFromAndLoadsToTheSame) {
  const Scene first = parse(bedOf("loam", "depth = 0.3\n"), {"material.loam.friction=0.6"});
  const std::string resolved = resolvedToml(first);
  const std::string file = fs::canonical(folder_ / "soils/loam.toml").string();
  EXPECT_NE(resolved.find("[material.\"loam\"]\nsoil = \"" + file + "\"\nsoil_hash = \"" +
                          first.material("loam").soilHash + "\"\ngrain_radius = 0.02\n"),
            std::string::npos)
      << resolved;
  EXPECT_NE(resolved.find("\nstiffness = 400000.0\n"), std::string::npos) << resolved;
  const Scene second = readSceneText(resolved, folder_ / "out/scene.toml");
  EXPECT_EQ(second.materials, first.materials) << "not scaled twice";
  EXPECT_EQ(second.terrain, first.terrain);
  EXPECT_EQ(resolvedToml(second), resolved);
  // A later change of the soil causes a message, and no change of values.
  put(folder_ / "soils/loam.toml", replaced(kLoam, "stiffness = 2e5", "stiffness = 3e5"));
  const Scene later = readSceneText(resolved, folder_ / "out/scene.toml");
  EXPECT_EQ(later.material("loam").stiffness, 4e5);
  ASSERT_EQ(soilNotes(later).size(), 1u);
  EXPECT_NE(soilNotes(later)[0].find("the soil file has changed"), std::string::npos) << soilNotes(later)[0];
}

TEST_F(Soils, NotesTellWhatHasNotBeenMeasured) {
  EXPECT_TRUE(soilNotes(parse(grainOf("loam", 0.02))).empty());
  const std::vector<std::string> other =
      soilNotes(parse(bedOf("loam", "depth = 0.3\n"), {"material.loam.grain_radius=0.01"}));
  ASSERT_EQ(other.size(), 1u);
  EXPECT_NE(other[0].find("scaled to grains of 10 mm"), std::string::npos) << other[0];
  put(folder_ / "soils/loam.toml", replaced(kLoam, "calibrated = true", "calibrated = false"));
  const std::vector<std::string> unmeasured = soilNotes(parse(grainOf("loam", 0.021)));
  ASSERT_EQ(unmeasured.size(), 1u);
  EXPECT_NE(unmeasured[0].find("the soil loam is uncalibrated"), std::string::npos) << unmeasured[0];
}

TEST_F(Soils, AreCalibratedAtTheirSizeAndWithTheirValuesAlone) {
  const auto of = [&](double radius, const std::vector<std::string>& sets = {}) {
    const Scene scene = parse(grainOf("loam", radius), sets);
    const std::vector<std::string> warnings = soilWarnings(scene);
    return std::pair{soilUses(scene).front(), warnings.empty() ? std::string() : warnings.front()};
  };
  for (const double radius : {0.008, 0.01, 0.02, 0.0201}) { // measured from 8 mm to 20 mm, within 1 %
    const auto [use, warning] = of(radius);
    EXPECT_TRUE(use.calibrated) << radius;
    EXPECT_TRUE(soilLine(use).ends_with("; calibrated")) << soilLine(use);
    EXPECT_EQ(warning, "") << radius;
  }
  for (const double radius : {0.0079, 0.0203, 0.06}) {
    const auto [use, warning] = of(radius);
    EXPECT_FALSE(use.calibrated) << radius;
    EXPECT_TRUE(soilLine(use).ends_with("; scaled, not calibrated at this size")) << soilLine(use);
    EXPECT_NE(warning.find("calibrated for grains of 8 mm to 20 mm, not "), std::string::npos) << warning;
  }
  EXPECT_NE(of(0.06).second.find("not 60 mm (6 times the soil's grain radius)"), std::string::npos) << of(0.06).second;
  EXPECT_NE(of(0.06).second.find("grouser soil loam --grain-radius 0.06"), std::string::npos);
  const support::SoilUse changed = of(0.02, {"material.loam.friction=0.6"}).first;
  EXPECT_FALSE(changed.calibrated);
}

TEST_F(Soils, UsesNameFileHashAndScaledValues) {
  const std::vector<support::SoilUse> uses = soilUses(parse(grainOf("g", 0.02, "[material.g]\nsoil = \"loam\"\n")));
  ASSERT_EQ(uses.size(), 1u);
  EXPECT_EQ(uses[0].material, "g");
  EXPECT_EQ(uses[0].soil, "loam");
  EXPECT_EQ(uses[0].hash.size(), 16u);
  EXPECT_EQ(uses[0].scale, 2);
  EXPECT_DOUBLE_EQ(uses[0].scaled.at("stiffness [N/m]"), 4e5);
  EXPECT_DOUBLE_EQ(uses[0].scaled.at("cohesion [J/m2]"), 6);
  EXPECT_NE(soilLine(uses[0]).find("g is loam: "), std::string::npos) << soilLine(uses[0]);
}

TEST(AssetSoils, AreReadAndSayTheirSources) {
  const fs::path assets = fs::path(GROUSER_SOURCE_DIR) / "assets";
  const auto known = knownSoils(assets / "scene.toml");
  for (const char* name :
       {"dry_sand", "grenville_loam", "lete_sand", "sandy_loam", "gravel", "grc1", "reference_spheres"}) {
    ASSERT_TRUE(known.contains(name)) << name;
    const Soil soil = readSoil(known.at(name));
    EXPECT_GT(soil.grains.radius, 0) << name;
    for (const PublishedConstant& c : soil.published) EXPECT_GT(c.source.size(), 10u) << name;
    EXPECT_EQ(soil.head.calibrated, !soil.reached.empty()) << name;
    const Scene s = readSceneText(grainOf(name, 0.01), assets / "scene.toml");
    EXPECT_EQ(s.material(name).density, soil.material.density);
  }
  EXPECT_GT(readSoil(known.at("sandy_loam")).material.cohesion, 0);
}

} // namespace
} // namespace grouser::scene
