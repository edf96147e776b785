// SPDX-License-Identifier: BSD-3-Clause
// Sphere case of `grouser check`, for every source of the sphere radius.
#include "runs/campaigns/sweeps/check_cases.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/load_scene.hpp"
#include "tests/runs/folder_fixture.hpp"

#include <string>

namespace grouser::sweeps {

using namespace test; // fixtures

namespace {

class SphereCases : public FolderTest {};

TEST_F(SphereCases, AnAutomaticRadiusStaysAutomaticAndIsRefined) {
  const auto file = folder_ / "scene.toml";
  for (const std::string radius : {"", "sphere_radius = 0.02\n"}) {
    put(file, "version = 1\n[run]\nduration = 1\n[material.m]\nstiffness = 1e5\n"
              "[[grain]]\nposition = [0, 0, 2]\nradius = 0.01\nmaterial = \"m\"\n"
              "[[mesh]]\nfile = \"meshes/roller.obj\"\nmaterial = \"m\"\n" +
                  radius);
    int seen = 0;
    for (const CheckCase& c : checkCases(file, {}, setup::loadScene(file)).cases) {
      if (c.axis != CheckAxis::spheres) continue;
      EXPECT_EQ(c.refused, "");
      const scene::Scene finer = setup::loadScene(file, c.overrides);
      EXPECT_EQ(finer.meshes.at(0).sphereRadius.has_value(), !radius.empty());
      EXPECT_DOUBLE_EQ(finer.meshes.at(0).sphereRefinement, 2);
      ++seen;
    }
    EXPECT_EQ(seen, 1);
  }
}

} // namespace
} // namespace grouser::sweeps
