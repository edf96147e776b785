// SPDX-License-Identifier: BSD-3-Clause
// Mechanisms in scene files: parsing, and one clear error per mistake.
#include "runs/scene/scene_file.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/mechanism_model.hpp"
#include "tests/runs/scene_fixture.hpp"

#include <gtest/gtest.h>

#include <filesystem>

namespace grouser::setup {

using namespace test; // fixtures

namespace {

/// Two rods on hinges, a spring, a bushing, a drive and a coupling; line numbers count from 1.
const std::string kScene = R"(version = 1
[run]
duration = 1
[[body]]
name = "upper"
mass = 2
inertia = [0.1, 0.2, 0.15]
position = [0.5, 0, 0]
[[body]]
name = "lower"
mass = 1
box = [1, 0.1, 0.1]
position = [1, 0, -0.5]
axis = [0, 1, 0]
angle = 90
[[joint]]
name = "hinge"
bodies = ["world", "upper"]
point = [0, 0, 0]
axis = [0, 1, 0]
limits = [-1, 1]
stop_stiffness = 1e4
[[joint]]
name = "elbow"
bodies = ["upper", "lower"]
point_a = [0.5, 0, 0]
point_b = [-0.5, 0, 0]
axis_a = [0, 1, 0]
axis_b = [0, 1, 0]
[[spring]]
name = "return"
joint = "elbow"
stiffness = 10
[[spring]]
name = "cord"
bodies = ["world", "lower"]
point_a = [3, 0, 0]
stiffness = 100
[[drive]]
name = "motor"
joint = "hinge"
imposes = "torque"
time = [0, 1]
values = [0, 5]
)";

std::string refusal(const std::string& text) {
  try {
    parseScene(text, "scene.toml");
  } catch (const base::InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(MechanismScene, HoldsWhatTheFileSays) {
  const scene::Scene scene = parseScene(kScene, "scene.toml");
  const multibody::Model model = buildModel(scene.mechanism);
  ASSERT_EQ(model.bodies().size(), 2u);
  EXPECT_EQ(model.bodies()[0].inertia_B.m[1][1], 0.2);
  EXPECT_DOUBLE_EQ(model.bodies()[1].inertia_B.m[0][0], 1.0 / 12 * (0.01 + 0.01)) << "inertia of the box";
  EXPECT_EQ(model.joints()[1].bodyA, 0);
  // Springs follow joints, and each joint's stops follow the joint.
  ASSERT_EQ(model.axisSprings().size(), 2u);
  EXPECT_EQ(model.axisSprings()[0].upperLimit, 1);
  EXPECT_EQ(model.axisSprings()[1].stiffness, 10);
  ASSERT_EQ(model.pointSprings().size(), 1u);
  EXPECT_DOUBLE_EQ(model.pointSprings()[0].restLength, std::sqrt(4.25)) << "relaxed at the start";
  ASSERT_EQ(model.drives().size(), 1u);
  EXPECT_DOUBLE_EQ(model.drives()[0].law.value(0.5), 2.5);
}

TEST(MechanismScene, ResolvedCopyLoadsToTheSameMechanism) {
  const scene::Scene scene = parseScene(kScene, "scene.toml");
  const scene::Scene again = parseScene(scene::resolvedToml(scene), "scene.toml");
  EXPECT_TRUE(again.mechanism == scene.mechanism);
  EXPECT_EQ(scene::resolvedToml(again), resolvedToml(scene));
}

TEST(MechanismScene, InertiaOfSixNumbersIsTheMatrix) {
  const scene::Scene scene =
      parseScene(replaced(kScene, "[0.1, 0.2, 0.15]", "[0.1, 0.2, 0.15, 0.01, 0.02, 0.03]"), "scene.toml");
  const auto& I = buildModel(scene.mechanism).bodies()[0].inertia_B.m;
  EXPECT_EQ(I[0][1], 0.01);
  EXPECT_EQ(I[0][2], 0.02);
  EXPECT_EQ(I[2][1], 0.03);
}

TEST(MechanismScene, QuaternionAndAxisWithAngleMeanTheSameTurn) {
  const scene::Scene turned = parseScene(kScene, "scene.toml");
  const scene::Scene given = parseScene(replaced(kScene, "axis = [0, 1, 0]\nangle = 90",
                                                 "orientation = [0.70710678118654757, 0, 0.70710678118654757, 0]"),
                                        "scene.toml");
  const base::Quat a = buildModel(turned.mechanism).bodies()[1].pose.orientation,
                   b = buildModel(given.mechanism).bodies()[1].pose.orientation;
  EXPECT_NEAR(a.w, b.w, 1e-15); // a few units in the last place
  EXPECT_NEAR(a.y, b.y, 1e-15);
}

struct Mistake {
  const char *from, *to; ///< replacement in the scene
  const char* message;   ///< a part of the error
};

class MechanismMistakes : public ::testing::TestWithParam<Mistake> {};

TEST_P(MechanismMistakes, NamePlaceValueAndRemedy) {
  const auto& [from, to, message] = GetParam();
  const std::string text = replaced(kScene, from, to);
  ASSERT_FALSE(text.empty()) << from;
  const std::string error = refusal(text);
  EXPECT_NE(error.find(message), std::string::npos) << error;
  EXPECT_EQ(error.rfind("scene.toml:", 0), 0u) << error;
}

constexpr Mistake kMistakes[] = {
    // bodies
    {"name = \"lower\"", "name = \"upper\"", "scene.toml:10: body.1.name = \"upper\" is also the name of another body"},
    {"name = \"lower\"", "name = \"world\"", "body.1.name = \"world\" is reserved for the ground"},
    {"name = \"lower\"", "name = \"a/b\"", "body.1.name = \"a/b\" has a / in its name"},
    {"name = \"elbow\"", "name = \"<b>\"", "joint.1.name = \"<b>\" contains < or >"},
    {"mass = 2\n", "", "scene.toml:4: body.0.mass [kg] is missing; add it, or set fixed = true"},
    {"mass = 2", "mass = 0", "scene.toml:6: body.0.mass = 0 [kg] is outside (0, 1e+12]"},
    {"[0.1, 0.2, 0.15]", "[0, 0, 0]", "scene.toml:7: body.0.inertia = [0, 0, 0] [kg m2] is not positive definite"},
    {"[0.1, 0.2, 0.15]", "[0.1, 0.2, -0.1]", "body.0.inertia = [0.1, 0.2, -0.1] [kg m2] is not positive definite"},
    {"[0.1, 0.2, 0.15]", "[0.1, 0.2, 0.15, 1, 0, 0]", "[kg m2] is not positive definite"},
    {"[0.1, 0.2, 0.15]", "[0.1, 0.2, 0.5]",
     "body.0.inertia = [0.1, 0.2, 0.5] [kg m2] violates the triangle inequality"},
    {"[0.1, 0.2, 0.15]", "[0.1, 0.2]", "body.0.inertia = [0.1, 0.2] [kg m2] must have 3 entries"},
    {"inertia = [0.1, 0.2, 0.15]\n", "",
     "scene.toml:4: body.0.inertia [kg m2] is missing; add it, or box (edge lengths)"},
    {"angle = 90\n", "", "body.1.axis = [0, 1, 0] [-] requires angle"},
    {"axis = [0, 1, 0]\nangle = 90", "angle = 90", "body.1.angle = 90 [deg] requires axis"},
    {"axis = [0, 1, 0]\nangle = 90", "orientation = [1, 1, 0, 0]",
     "body.1.orientation = [1, 1, 0, 0] [-] has length 1.41421; set a unit quaternion"},
    {"angle = 90", "angle = 90\norientation = [1, 0, 0, 0]", "is mutually exclusive with axis and angle"},
    // joints
    {"[\"world\", \"upper\"]", "[\"world\", \"uper\"]",
     "scene.toml:18: joint.0.bodies = [\"world\", \"uper\"] refers to an unknown body \"uper\"; did you mean "
     "\"upper\"?"},
    {"[\"world\", \"upper\"]", "[\"upper\"]", "joint.0.bodies = [\"upper\"] must name two bodies"},
    {"[\"world\", \"upper\"]", "[\"upper\", \"upper\"]", "joins 'upper' to itself"},
    {"name = \"elbow\"", "name = \"hinge\"", "joint.1.name = \"hinge\" is also the name of another joint"},
    {"axis = [0, 1, 0]\nlimits", "limits", "scene.toml:16: joint.0.axis [-] is missing"},
    {"axis = [0, 1, 0]\nlimits", "axis = [0, 0, 0]\nlimits", "joint.0.axis = [0, 0, 0] [-] has zero length"},
    {"point = [0, 0, 0]\n", "", "joint.0.point [m] is missing"},
    {"point_b = [-0.5, 0, 0]", "point_b = [-0.4, 0, 0]",
     "scene.toml:27: joint.1.point_b = [-0.4, 0, 0] [m] is initially at (1, 0, -0.1) in the world, 0.1 m from point_a "
     "at (1, 0, 0)"},
    {"axis_b = [0, 1, 0]", "axis_b = [0, 1, 0.1]",
     "scene.toml:29: joint.1.axis_b = [0, 1, 0.1] [-] initially points along"},
    {"axis_b = [0, 1, 0]", "axis_b = [0, -1, 0]", "joint.1.axis_b = [0, -1, 0] [-] initially points along"},
    {"axis_b = [0, 1, 0]", "axis_b = [0, 1, 0]\nsecond_axis = [1, 0, 0]", "applies to universal joints only"},
    {"axis = [0, 1, 0]\nlimits", "axis = [0, 1, 0]\ntype = \"universal\"\nlimits", "second_axis [-] is missing"},
    {"axis = [0, 1, 0]\nlimits", "axis = [0, 1, 0]\nsecond_axis = [1, 1, 0]\ntype = \"universal\"\nlimits",
     "must be perpendicular to axis at the start"},
    {"limits = [-1, 1]", "limits = [1, -1]", "joint.0.limits = [1, -1] [rad or m] must be [min, max]"},
    {"stop_stiffness = 1e4\n", "", "stop_stiffness [N m/rad or N/m] must be above 0 if limits is set"},
    {"axis = [0, 1, 0]\nlimits", "axis = [0, 1, 0]\ntype = \"revolut\"\nlimits", "did you mean \"revolute\"?"},
    // velocities
    {"position = [0.5, 0, 0]", "position = [0.5, 0, 0]\nvelocity = [0, 0, 1]",
     "(\"hinge\") connects \"world\" and \"upper\" at (0, 0, 0) m, but their initial velocities there, (0, 0, 0) and "
     "(0, 0, 1) m/s"},
    {"position = [0.5, 0, 0]", "position = [0.5, 0, 0]\nspin = [1, 0, 0]",
     "(\"hinge\") connects \"world\" and \"upper\", but their initial spins, (0, 0, 0) and (1, 0, 0) rad/s"},
    // springs
    {"joint = \"elbow\"", "joint = \"elbo\"",
     "spring.0.joint = \"elbo\" refers to an unknown joint \"elbo\"; did you mean \"elbow\"?"},
    {"joint = \"elbow\"\n", "", "spring.0 has neither bodies nor joint"},
    {"joint = \"elbow\"", "joint = \"elbow\"\nacts_on = \"slide\"",
     "spring.0.acts_on = \"slide\" is not free in joint"},
    {"point_a = [3, 0, 0]", "point_a = [1, 0, -0.5]", "coincides with point_a at the start"},
    {"stiffness = 100", "stiffness = -1", "spring.1.stiffness = -1 [N/m or N m/rad] is outside [0"},
    // drives
    {"values = [0, 5]", "values = [0]", "drive.0.values = [0] must have as many entries as time (2)"},
    {"time = [0, 1]", "time = [1, 0]", "drive.0.time = [1, 0] [s] must increase, but does not at entry 1"},
    {"time = [0, 1]\nvalues = [0, 5]\n", "", "drive.0 has no value; set value, polynomial, amplitude, or time"},
    {"values = [0, 5]\n",
     "values = [0, 5]\n[[drive]]\nname = \"a\"\njoint = \"elbow\"\nvalue = 1\n[[drive]]\nname = \"b\"\njoint = "
     "\"elbow\"\nimposes = \"position\"\nvalue = 1\n",
     "drive.2.joint = \"elbow\" is already driven by \"a\""},
    // couplings
    {"values = [0, 5]\n", "values = [0, 5]\n[[coupling]]\nname = \"g\"\njoints = [\"hinge\", \"elbow\"]\nratio = 0\n",
     "coupling.0.ratio = 0 must not be 0"},
    {"values = [0, 5]\n", "values = [0, 5]\n[[coupling]]\nname = \"g\"\njoints = [\"hinge\"]\nratio = 1\n",
     "coupling.0.joints = [\"hinge\"] must name two joints"},
    // beside other things
    {"[[spring]]", "[material.glass]\n[[grain]]\nposition = [9, 0, 0]\nradius = 0.1\nmaterial = \"glass\"\n[[spring]]",
     "is incompatible with grain, since no body has a shape for contact"},
};
INSTANTIATE_TEST_SUITE_P(All, MechanismMistakes, ::testing::ValuesIn(kMistakes));

TEST(MechanismScene, DrivesThatContradictEachOtherThroughALoopAreRefusedAtTheirLine) {
  // Both cranks of a parallelogram, at different speeds.
  std::string text = "version = 1\n[run]\nduration = 1\n";
  const auto bar = [&](const char* name, const char* place, const char* box) {
    text += std::string("[[body]]\nname = \"") + name + "\"\nmass = 1\nposition = " + place + "\nbox = " + box + "\n";
  };
  bar("left", "[0, 0, 0.5]", "[0.1, 0.1, 1]"), bar("right", "[1, 0, 0.5]", "[0.1, 0.1, 1]");
  bar("top", "[0.5, 0, 1]", "[1, 0.1, 0.1]");
  const auto pin = [&](const char* name, const char* a, const char* b, const char* point) {
    text += std::string("[[joint]]\nname = \"") + name + "\"\nbodies = [\"" + a + "\", \"" + b +
            "\"]\npoint = " + point + "\naxis = [0, 1, 0]\n";
  };
  pin("a", "world", "left", "[0, 0, 0]"), pin("b", "left", "top", "[0, 0, 1]");
  pin("c", "top", "right", "[1, 0, 1]"), pin("d", "world", "right", "[1, 0, 0]");
  const std::string good = text + "[[drive]]\nname = \"one\"\njoint = \"a\"\nvalue = 1\n";
  EXPECT_EQ(refusal(good), "no error");
  const std::string error = refusal(good + "[[drive]]\nname = \"two\"\njoint = \"d\"\nvalue = 2\n");
  EXPECT_EQ(error.rfind("scene.toml:43: drive.1 (\"two\"): ", 0), 0u) << error;
  EXPECT_NE(error.find("'one'"), std::string::npos) << error;
}

TEST(MechanismScene, OverridesTakeTheNameOfAPart) {
  const scene::Scene scene = parseScene(kScene, "scene.toml", {"body.upper.mass=3", "spring.cord.stiffness=7"});
  EXPECT_EQ(*scene.mechanism.bodies[0].mass, 3);
  EXPECT_EQ(scene.mechanism.springs[1].stiffness, 7);
  EXPECT_THROW(parseScene(kScene, "scene.toml", {"body.uper.mass=3"}), base::InputError);
}

TEST(MechanismScene, PartsWithoutBodiesAreRefused) {
  EXPECT_NE(refusal("version = 1\n[run]\nduration = 1\n[[joint]]\nname = \"a\"\nbodies = [\"world\", \"b\"]\n")
                .find("refers to an unknown body \"b\""),
            std::string::npos);
}

TEST(MechanismScene, EveryFileOfTheFolderLoads) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(GROUSER_SOURCE_DIR "/runs/mechanisms")) {
    if (entry.path().extension() != ".toml") continue;
    EXPECT_NO_THROW(loadScene(entry.path())) << entry.path();
    ++count;
  }
  EXPECT_GE(count, 15);
}

} // namespace
} // namespace grouser::setup
