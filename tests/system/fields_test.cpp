// SPDX-License-Identifier: BSD-3-Clause
// Soil stress above all possible supports of a scene, and during a run.
#include "base/math.hpp"
#include "coupling/simulation.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/simulation_setup.hpp"
#include "tests/device_under_test.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <ostream>

namespace grouser::coupling {
namespace {

/// Supports of a grain, each with its top at z = 0.
struct Support {
  const char* name;
  std::string text;
};
std::ostream& operator<<(std::ostream& out, const Support& s) { return out << s.name; }

class StressOfOneGrain : public ::testing::TestWithParam<Support> {};

std::string fileOfCube() {
  const std::filesystem::path path = std::filesystem::path(::testing::TempDir()) / "grouser_fields_cube.obj";
  std::ofstream(path) << "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\n"
                         "f 1 3 2\nf 1 4 3\nf 5 6 7\nf 5 7 8\nf 1 2 6\nf 1 6 5\nf 2 3 7\nf 2 7 6\nf 3 4 8\nf 3 8 7\n"
                         "f 4 1 5\nf 4 5 8\n";
  return path.string();
}

/// Inclined gravity: friction carries the component along the ground.
TEST_P(StressOfOneGrain, IsTheForceOfItsSupportTimesItsRadius) {
  constexpr double kAlong = 1, kDown = 9.5; // [m/s2]
  const std::string text =
      fmt::format("version = 1\n[run]\nduration = 2.0\ntime_step = 2e-5\nthreads = 1\ngravity = [{}, 0, "
                  "{}]\n[material.glass]\ndensity = 2500\nstiffness = 1e5\nrestitution = 0.3\n"
                  "friction = 0.5\nrolling_friction = 0.4\n[[grain]]\nposition = [0.003, 0.004, 0.01]\n"
                  "radius = 0.01\nmaterial = \"glass\"\n{}",
                  kAlong, -kDown, GetParam().text);
  Simulation s(setup::simulationSetup(setup::parseScene(text, "fields.toml")), testExec(), [](double, double) {});
  while (s.time() < 1.5) s.step();
  const terrain::FieldGrid grid = terrain::fieldGrid({-0.05, -0.05, -0.05}, {0.05, 0.05, 0.05}, 0.025, {});
  const terrain::SoilFields fields = fieldsOf(s, grid);
  terrain::Tensor6 sum{};
  for (const terrain::Tensor6& cell : fields.stress)
    for (std::size_t k = 0; k < 6; ++k) sum[k] += cell[k] * grid.cellVolume();
  const double radius = 0.01, mass = s.ground().grains->model().mass;
  // The support's force on the grain is m (-along, 0, down), at (0, 0, -radius); overlaps are 1e-4 of the radius.
  const double scale = mass * kDown * radius;
  EXPECT_NEAR(sum[5], -scale, 2e-3 * scale);
  EXPECT_NEAR(sum[2], 0.5 * mass * kAlong * radius, 2e-3 * scale);
  for (const std::size_t none : {0, 1, 3, 4}) EXPECT_NEAR(sum[none], 0, 2e-3 * scale) << none;
}

INSTANTIATE_TEST_SUITE_P(
    Supports, StressOfOneGrain,
    ::testing::Values(
        Support{"plane", "[[plane]]\nnormal = [0, 0, 1]\nmaterial = \"glass\"\n"},
        Support{"box", "[[box]]\nname = \"ground\"\nposition = [0, 0, -0.05]\nsize = [0.1, 0.1, 0.1]\nmaterial = "
                       "\"glass\"\n"},
        Support{"mesh", fmt::format("[[mesh]]\nname = \"ground\"\nfile = \"{}\"\nscale = 0.05\nsphere_radius = 0.004\n"
                                    "position = [0, 0, -0.05]\nmaterial = \"glass\"\n",
                                    fileOfCube())},
        Support{"body", "[[body]]\nname = \"ground\"\nfixed = true\nposition = [0, 0, -0.05]\nmaterial = \"glass\"\n"
                        "[[body.shape]]\nkind = \"box\"\nsize = [0.1, 0.1, 0.1]\n"}),
    [](const ::testing::TestParamInfo<Support>& each) { return std::string(each.param.name); });

/// Moving surfaces, bodies, a mesh, cohesion: measurements during the run do not change any bit.
class FieldsOnTheWay : public ::testing::TestWithParam<const char*> {};

TEST_P(FieldsOnTheWay, ChangeNoBitOfTheRun) {
  const auto begin = [] {
    return setup::simulationSetup(setup::loadScene(testScene(std::string(GetParam()) + ".toml")));
  };
  Simulation measured(begin(), testExec(2), [](double, double) {}), plain(begin(), testExec(1), [](double, double) {});
  for (int k = 0; k < 8; ++k) {
    const terrain::SoilFields a = fieldsOf(measured, terrain::fieldGrid({-1, -1, -1}, {1, 1, 1}, 0.1, {}));
    if (k == 7) {
      plain.ledger(); // as in rows; it may sort the grains anew
      const terrain::SoilFields b = fieldsOf(plain, a.grid);
      EXPECT_EQ(a.stress, b.stress);
      EXPECT_EQ(a.porosity, b.porosity);
    }
    for (int n = 0; n < 100; ++n) measured.step(), plain.step();
    EXPECT_EQ(measured.stateHash(), plain.stateHash()) << "after step " << measured.steps();
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, FieldsOnTheWay, ::testing::Values("moving", "bodies", "rigs", "cohesive", "mixture"),
                         [](const ::testing::TestParamInfo<const char*>& each) { return std::string(each.param); });

} // namespace
} // namespace grouser::coupling
