// SPDX-License-Identifier: BSD-3-Clause
// Effects of a scene's soil: the time step, the name of its settled bed, the size of the shipped scenes.
#include "runs/scene/scene.hpp"
#include "runs/setup/grain_count.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/provenance.hpp"
#include "runs/setup/step_limit.hpp"
#include "tests/runs/scene_fixture.hpp"
#include "tests/runs/soil_fixture.hpp"

#include <filesystem>
#include <string>

namespace grouser::setup {

using namespace test; // fixtures

namespace {

namespace fs = std::filesystem;

class SoilOfAScene : public SoilTest {
protected:
  scene::Scene parse(const std::string& text) const { return parseScene(text, folder_ / "scene.toml"); }
};

TEST_F(SoilOfAScene, TheTimeStepGoesWithTheRadius) {
  // Linear, without its own damping: sqrt(m / k) with m as r^3 and k as r.
  put(folder_ / "soils/loam.toml", replaced(kLoam, "damping = 50", "restitution = 0.4"));
  const std::string plane = "[[plane]]\nmaterial = \"loam\"\n";
  const double fine = chooseTimeStep(parse(grainOf("loam", 0.01) + plane)),
               coarse = chooseTimeStep(parse(grainOf("loam", 0.02) + plane));
  EXPECT_NEAR(coarse / fine, 2, 1e-3) << "steps are rounded";
}

TEST_F(SoilOfAScene, ASettledBedIsKnownByItsValuesNotByTheSoilsName) {
  const std::string values = "[material.plain]\ndensity = 2600\nstiffness = 4e5\ndamping = 25\nfriction = 0.45\n"
                             "rolling_friction = 0.1\ncohesion = 6\n";
  const std::string bed = "depth = 0.3\nporosity = 0.41\nradius_spread = 0.2\n";
  std::string named = bedOrigin(parse(bedOf("loam", bed)), 1e-5);
  const std::string plain = bedOrigin(parse(bedOf("plain", bed + values)), 1e-5);
  for (std::size_t at = 0; (at = named.find("loam")) != std::string::npos;) named.replace(at, 4, "plain");
  EXPECT_EQ(named, plain);
}

TEST(SoilScenes, AreLoadedAndOfTheSizeTheySay) {
  const fs::path scenes = fs::path(GROUSER_SOURCE_DIR) / "runs/scenes";
  const scene::Scene full = loadScene(scenes / "soil_full_size.toml");
  EXPECT_GE(full.terrain->size[1], 4.6);
  EXPECT_GE(*full.terrain->depth, 0.5);
  EXPECT_LE(*full.terrain->grainRadius, 0.007);
  EXPECT_LT(plannedGrains(full), 3'000'000);
  EXPECT_EQ(full.terrain->porosity, 0.445) << "the soil's value";
  EXPECT_EQ(full.material("grenville_loam").young, 2.68e8) << "the soil's value, at its own radius";
  const scene::Scene coarse = loadScene(scenes / "soil_coarse.toml");
  EXPECT_GT(coarse.material("lete_sand").young, 1e9);
  EXPECT_LT(plannedGrains(coarse), 20'000);
  const scene::Scene wheel = loadScene(scenes / "grc1_wheel.toml");
  EXPECT_EQ(wheel.material("grc1").density, 2580);
  EXPECT_EQ(wheel.meshes.at(0).mass, 17.5);
}

} // namespace
} // namespace grouser::setup
