// SPDX-License-Identifier: BSD-3-Clause
// Grain-size case of `grouser check` for a soil: values of the soil file are scaled once.
#include "runs/campaigns/sweeps/check_cases.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/load_scene.hpp"
#include "tests/runs/folder_fixture.hpp"

#include <string>
#include <vector>

namespace grouser::sweeps {

using namespace test; // fixtures

namespace {

class SoilCases : public FolderTest {
protected:
  /// The material in the case with finer grains in this scene's bed.
  scene::Material finer(const std::string& material) const {
    const auto file = folder_ / "scene.toml";
    put(file, "version = 1\n[run]\nduration = 1\n" + material +
                  "[terrain]\nheightmap = \"heightmaps/flat.png\"\nsize = [1, 1]\nheight_range = [0, 0]\n"
                  "grain_radius = 0.027\ndepth = 0.3\nmaterial = \"reference_spheres\"\n");
    const scene::Scene scene = setup::loadScene(file);
    for (const CheckCase& c : checkCases(file, {}, scene).cases)
      if (c.axis == CheckAxis::grainSize) {
        EXPECT_EQ(c.refused, "");
        return setup::loadScene(file, c.overrides).material("reference_spheres");
      }
    ADD_FAILURE() << "no case with finer grains";
    return {};
  }
};

TEST_F(SoilCases, WhatTheSoilSaysIsScaledOnce) {
  const scene::Material m = finer("");
  EXPECT_DOUBLE_EQ(*m.stiffness, 0.8e6);
  EXPECT_DOUBLE_EQ(*m.grainRadius, 0.8 * 0.027);
}

TEST_F(SoilCases, WhatTheSceneSaysIsScaledOnceToo) {
  const scene::Material own =
      finer("[material.reference_spheres]\nsoil = \"reference_spheres\"\nstiffness = 2e6\ncohesion = 5\n");
  EXPECT_DOUBLE_EQ(*own.stiffness, 1.6e6);
  EXPECT_DOUBLE_EQ(own.cohesion, 4);
  const scene::Material sized =
      finer("[material.reference_spheres]\nsoil = \"reference_spheres\"\ngrain_radius = 0.054\n");
  EXPECT_DOUBLE_EQ(*sized.grainRadius, 0.8 * 0.054);
  EXPECT_DOUBLE_EQ(*sized.stiffness, 1.6e6);
}

} // namespace
} // namespace grouser::sweeps
