// SPDX-License-Identifier: BSD-3-Clause
// Extreme stiffnesses: rejected with key, value and the smallest valid value, or run.
#include "base/error.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/step_limit.hpp"
#include "tests/runs/scene_fixture.hpp"

#include <gtest/gtest.h>

#include <fmt/format.h>

#include <string>
#include <vector>

namespace grouser::coupling {

using namespace test; // fixtures

namespace {

/// Two materials, a plane, grains of 2 and 5 cm.
const std::string kScene = R"(version = 1
[run]
duration = 1e-2
[material.a]
density = 2000
LAW
[material.b]
density = 3000
LAW
[[plane]]
material = "b"
[[grain]]
position = [0, 0, 0.5]
radius = 0.05
material = "a"
[[grain]]
position = [1, 0, 0.5]
radius = 0.02
material = "a"
)";

std::string with(const std::string& law) {
  const std::string first = replaced(kScene, "LAW", law);
  return replaced(first, "LAW", law);
}

std::string errorOf(const std::string& text, const std::vector<std::string>& overrides) {
  try {
    setup::chooseTimeStep(setup::parseScene(text, "scene.toml", overrides));
  } catch (const base::InputError& error) {
    return error.what();
  }
  return "";
}

struct Soft {
  std::string text, key;
  double value;
  std::string unit;
};

/// A grain of 5 cm and 2000 kg/m3 weighs 10.27 N: an overlap of 0.2 radii requires 1027 N/m.
std::vector<Soft> softOnes() {
  return {{with("stiffness = 1e6"), "material.a.stiffness", 1, "N/m"},
          {with("stiffness = 1e6"), "material.b.stiffness", 500, "N/m"},
          {with("stiffness = 1e6") + "[contact.\"b|a\"]\nstiffness = 1e6\n", "contact.\"b|a\".stiffness", 0.1, "N/m"},
          {with("law = \"hertz\"\nyoung = 1e7"), "material.a.young", 1, "Pa"}};
}

TEST(Softness, IsRefusedWithTheLeastThatWillDo) {
  for (const Soft& soft : softOnes()) {
    const auto set = [&](double value) { return std::vector{fmt::format("{}={:.6g}", soft.key, value)}; };
    const std::string error = errorOf(soft.text, set(soft.value));
    EXPECT_NE(error.find(fmt::format("{} = {:g} [{}] is too low", soft.key, soft.value, soft.unit)), std::string::npos)
        << error;
    const std::size_t number = error.find("raise it to ");
    ASSERT_NE(number, std::string::npos) << error;
    const double least = std::stod(error.substr(number + 12));
    EXPECT_EQ(errorOf(soft.text, set(least)), "") << soft.key;
    EXPECT_NE(errorOf(soft.text, set(0.97 * least)), "") << soft.key << " is too large; valid: " << least;
  }
}

TEST(Softness, NamesTheLeastFromTheWeight) {
  // k = m g / (0.2 R), for the larger grain.
  const std::string error = errorOf(with("stiffness = 1e6"), {"material.a.stiffness=1"});
  EXPECT_NE(error.find("raise it to 1.04e+03"), std::string::npos) << error;
  EXPECT_NE(error.find("radius 0.05 m"), std::string::npos) << error;
}

TEST(Softness, IsNoneWithoutWeight) {
  const std::vector<std::string> floating = {"run.gravity=[0,0,0]", "material.a.stiffness=0.001"};
  EXPECT_EQ(errorOf(with("stiffness = 1e6"), floating), "");
  // The stability rule would allow 0.9 s there: limited by the run's duration, and by the range of the key.
  EXPECT_EQ(setup::chooseTimeStep(setup::parseScene(with("stiffness = 1e6"), "scene.toml", floating)), 1e-2);
  EXPECT_EQ(setup::chooseTimeStep(
                setup::parseScene(with("stiffness = 1e-3"), "scene.toml",
                                  {"run.gravity=[0,0,0]", "run.duration=100", "material.a.stiffness=0.001"})),
            0.1);
}

TEST(Softness, ExtremesOfEveryMaterialAreOutOfTheirRange) {
  for (const char* extreme : {"1e-300", "1e-30", "1e-9", "1e30", "1e300"})
    for (const char* key : {"stiffness", "young", "density", "restitution"}) {
      const bool young = std::string(key) == "young";
      const std::string text = with(young ? "law = \"hertz\"\nyoung = 1e7" : "stiffness = 1e6");
      const std::string error = errorOf(text, {fmt::format("material.a.{}={}", key, extreme)});
      EXPECT_NE(error.find(fmt::format("material.a.{} = ", key)), std::string::npos) << extreme << ' ' << error;
      const bool ranged = error.find("is outside ") != std::string::npos ||
                          error.find("must be 0 or in [1e-06, 1]") != std::string::npos;
      EXPECT_TRUE(ranged) << extreme << ' ' << error;
    }
}

} // namespace
} // namespace grouser::coupling
