// SPDX-License-Identifier: BSD-3-Clause
#include "runs/scene/scene_file.hpp"

#include "base/error.hpp"
#include "runs/support/locations.hpp"
#include "tests/runs/scene_fixture.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

namespace grouser::scene {

using namespace test; // fixtures

namespace {

Scene parse(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return readSceneText(text, std::string(GROUSER_SOURCE_DIR) + "/scene.toml", overrides);
}

TEST(Scene, EverySectionIsRead) {
  const Scene s = parse(goodScene());
  EXPECT_EQ(s.run.duration, 2);
  EXPECT_EQ(s.run.timeStep, 1e-4);
  ASSERT_EQ(s.materials.size(), 2u);
  EXPECT_EQ(s.material("steel").stiffness, 1e7);
  EXPECT_EQ(s.material("soil").restitution, 0.5);
  EXPECT_EQ(s.material("soil").tangentialStiffnessRatio, 2.0 / 7.0);
  ASSERT_NE(s.contact("steel", "soil"), nullptr);
  EXPECT_EQ(s.contact("steel", "soil")->friction, 0.7);
  ASSERT_TRUE(s.terrain.has_value());
  EXPECT_TRUE(std::filesystem::path(s.terrain->heightmap).is_absolute());
  EXPECT_EQ(s.terrain->layers, 2);
  ASSERT_TRUE(s.vehicle.has_value());
  EXPECT_EQ(s.driver.speeds().left, std::vector<double>{1});
  EXPECT_FALSE(s.output.picture);
}

TEST(Scene, WhatIsAbsentIsNotBuilt) {
  const Scene s = parse("version = 1\n[run]\nduration = 1\n[material.a]\n[[grain]]\nposition = [0, 0, 1]\nradius = "
                        "0.01\nmaterial = \"a\"\n[[grain]]\nposition = [0, 0, 2]\nradius = 0.01\nmaterial = \"a\"\n");
  EXPECT_FALSE(s.terrain.has_value());
  EXPECT_FALSE(s.vehicle.has_value());
  EXPECT_EQ(s.grains.size(), 2u);
  EXPECT_FALSE(s.run.timeStep.has_value());
}

TEST(Scene, ResolvedCopyLoadsToTheSameScene) {
  std::string text = replaced(goodScene(), "sprocket_speed = 1\n",
                              "[driver.table]\ntime = [0, 1.5]\nleft = [0, 1]\nright = [0, -1]\n");
  text += "[[plane]]\nnormal = [0, 0.1, 1]\nmaterial = \"soil\"\n[material.\"wet clay\"]\ndamping = 12.5\nattraction = "
          "true\n"
          "[[grain]]\nposition = [0.1, 0.2, 3]\nvelocity = [0, 0, -1]\nradius = 0.05\nmaterial = \"wet clay\"\n"
          "[material.glass]\nlaw = \"hertz\"\nyoung = 7e10\nrolling_friction = 0.01\ncohesion = 0.1\n"
          "[[grains]]\nlow = [0, 0, 5]\nhigh = [1, 1, 6]\nradius = 0.05\nradius_to = 0.1\nmaterial = \"glass\"\n";
  const Scene first = parse(text, {"run.seed=7", "terrain.jitter=0.3"});
  const Scene second = parse(resolvedToml(first));
  EXPECT_EQ(second.run, first.run);
  EXPECT_EQ(second.materials, first.materials);
  EXPECT_EQ(second.contacts, first.contacts);
  EXPECT_EQ(second.grains, first.grains);
  EXPECT_EQ(second.planes, first.planes);
  EXPECT_EQ(second.fills, first.fills);
  EXPECT_EQ(second.material("glass").poisson, 0.25);
  EXPECT_EQ(second.terrain, first.terrain);
  EXPECT_EQ(second.vehicle, first.vehicle);
  EXPECT_EQ(second.driver, first.driver);
  EXPECT_EQ(second.output, first.output);
  EXPECT_EQ(resolvedToml(second), resolvedToml(first));
  EXPECT_EQ(first.run.seed, 7);
  EXPECT_EQ(first.terrain->jitter, 0.3);
}

TEST(Scene, PathsAreFoundBesideTheSceneFirst) {
  const std::filesystem::path folder = std::filesystem::path(::testing::TempDir()) / "scene_paths";
  std::filesystem::create_directories(folder / "heightmaps");
  std::filesystem::copy_file(std::string(GROUSER_SOURCE_DIR) + "/assets/heightmaps/hills.png",
                             folder / "heightmaps/hills.png", std::filesystem::copy_options::overwrite_existing);
  const Scene s = readSceneText(goodScene(), folder / "scene.toml");
  EXPECT_EQ(s.terrain->heightmap, std::filesystem::canonical(folder / "heightmaps/hills.png").string());
  std::filesystem::remove_all(folder);
}

TEST(Scene, PlacesLookedAtAreNamedOnce) {
  std::vector<std::filesystem::path> tried;
  EXPECT_TRUE(support::findInput("nosuch.png", "scene.toml", tried).empty());
  EXPECT_EQ(tried.size(), 2u); // current folder (the scene's) and assets/
  EXPECT_TRUE(support::findInput("/nosuch.png", "scene.toml", tried).empty());
  EXPECT_EQ(tried, std::vector<std::filesystem::path>{"/nosuch.png"});
}

TEST(Scene, DriverFormsGiveTheSameSpeeds) {
  const SpeedTable both = parse(goodScene(), {"driver.sprocket_speed=2"}).driver.speeds();
  EXPECT_EQ(both.left, std::vector<double>{2});
  const SpeedTable sides = parse(replaced(goodScene(), "sprocket_speed = 1", "left = 1\nright = -1")).driver.speeds();
  EXPECT_EQ(sides.left, std::vector<double>{1});
  EXPECT_EQ(sides.right, std::vector<double>{-1});
  EXPECT_DOUBLE_EQ(parse(goodScene()).driver.driveBegins(), 0.45);
  EXPECT_EQ(parse(goodScene(), {"driver.drive_start=2"}).driver.driveBegins(), 2);
  // In binary 0.1 + 0.2 exceeds 0.3.
  EXPECT_EQ(parse(goodScene(), {"driver.drive_start=0.3", "driver.tension_ramp=0.1", "driver.weight_ramp=0.2"})
                .driver.driveBegins(),
            0.3);
}

/// One mistake in a valid scene, and the required parts of the message: place or key, and remedy.
struct Broken {
  const char* name;
  const char* from;
  const char* to;
  std::vector<const char*> says;
  // NOLINTNEXTLINE(readability-identifier-naming): name required by GoogleTest.
  friend void PrintTo(const Broken& b, std::ostream* out) { *out << b.name; }
};

class BrokenScene : public ::testing::TestWithParam<Broken> {};

TEST_P(BrokenScene, GivesOneErrorWithKeyAndRemedy) {
  const std::string text = replaced(goodScene(), GetParam().from, GetParam().to);
  ASSERT_NE(text, "") << "the valid scene has no such line";
  try {
    parse(text);
    FAIL() << "the scene was accepted";
  } catch (const base::InputError& e) {
    for (const char* part : GetParam().says)
      EXPECT_NE(std::string(e.what()).find(part), std::string::npos) << e.what() << "\nlacks: " << part;
    EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos) << "more than one line: " << e.what();
  }
}

INSTANTIATE_TEST_SUITE_P(
    Mistakes, BrokenScene,
    ::testing::Values(
        Broken{"UnknownKey",
               "duration = 2",
               "duraton = 2",
               {"scene.toml:3", "unknown key run.duraton", "did you mean duration?"}},
        Broken{"UnknownSection",
               "[driver]",
               "[drivers]",
               {"scene.toml:28", "unknown section drivers", "did you mean driver?"}},
        Broken{"LaterSection", "[driver]", "[[tyre]]", {"unknown section tyre", "valid here"}},
        Broken{"MissingDuration",
               "duration = 2\n",
               "",
               {"scene.toml:2", "[run] lacks the required key duration [s]", "add duration ="}},
        Broken{"NoRun", "[run]\nduration = 2\ntime_step = 1e-4\n", "", {"[run] is missing; add it"}},
        Broken{"NegativeDuration",
               "duration = 2",
               "duration = -2",
               {"scene.toml:3", "run.duration = -2 [s] is outside [1e-12, 100000]", "choose"}},
        Broken{"NotANumber", "duration = 2", "duration = nan", {"run.duration", "not finite", "use a finite number"}},
        Broken{"TextForNumber",
               "duration = 2",
               "duration = \"long\"",
               {"run.duration = \"long\" has the wrong type; expected a number [s]"}},
        Broken{"Restitution",
               "stiffness = 1e6",
               "restitution = 1.4",
               {"scene.toml:6", "material.soil.restitution = 1.4 [-] is outside [0, 1]"}},
        Broken{"RestitutionAndDamping",
               "stiffness = 1e6",
               "restitution = 0.4\ndamping = 3",
               {"material.soil.damping = 3", "mutually exclusive with restitution", "remove one"}},
        Broken{"UnsupportedLaw",
               "stiffness = 1e6",
               "law = \"jkr\"",
               {"material.soil.law = \"jkr\" is not one of linear, hertz"}},
        Broken{"HertzWithoutYoung",
               "stiffness = 1e6",
               "law = \"hertz\"",
               {"material.soil", "young", "is missing", "add it"}},
        Broken{"HertzWithStiffness",
               "stiffness = 1e6",
               "law = \"hertz\"\nyoung = 1e8\nstiffness = 1e6",
               {"material.soil.stiffness", "requires law = \"linear\"", "remove it"}},
        Broken{
            "LinearWithYoung", "stiffness = 1e6", "young = 1e8", {"material.soil.young", "requires law = \"hertz\""}},
        Broken{"PoissonOutOfRange",
               "stiffness = 1e6",
               "law = \"hertz\"\nyoung = 1e8\npoisson = 0.6",
               {"material.soil.poisson = 0.6 [-] is outside [0, 0.5]"}},
        Broken{"NegativeRollingFriction",
               "stiffness = 1e6",
               "rolling_friction = -0.1",
               {"material.soil.rolling_friction = -0.1 [-] is outside [0, 2]"}},
        Broken{"WrongPrecision",
               "duration = 2",
               "duration = 2\nprecision = \"half\"",
               {"run.precision = \"half\" is not one of single, double"}},
        Broken{"BlockWithoutRoom",
               "[terrain]",
               "[[grains]]\nlow = [0, 0, 0]\nhigh = [1, 1, 0.1]\nradius = 0.1\nmaterial = \"soil\"\n[terrain]",
               {"grains.0.high", "makes the box too small for a grain of radius 0.1 m", "enlarge the box"}},
        Broken{"RandomWithoutNumber",
               "[terrain]",
               "[[grains]]\nform = \"random\"\nlow = [0, 0, 0]\nhigh = [1, 1, 1]\nradius = 0.1\nmaterial = "
               "\"soil\"\n[terrain]",
               {"grains.0", "number", "is missing", "add it"}},
        Broken{"BlockOfNoFile",
               "[terrain]",
               "[[grains]]\nform = \"file\"\nfile = \"none.txt\"\nmaterial = \"soil\"\n[terrain]",
               {"grains.0.file", "does not exist", "correct the path"}},
        Broken{"UnknownMaterial",
               "material = \"soil\"",
               "material = \"sol\"",
               {"scene.toml:17", "terrain.material", "did you mean \"soil\"?"}},
        Broken{"ContactOfUnknown",
               "\"soil|steel\"",
               "\"soil|stel\"",
               {"scene.toml:11", "contact.\"soil|stel\"", "did you mean \"steel\"?"}},
        Broken{"ContactOfOne", "\"soil|steel\"", "soil", {"contact.soil", "must have the form [contact.\"a|b\"]"}},
        Broken{"ContactTwice", "[terrain]", "[contact.\"steel|soil\"]\n[terrain]", {"defined twice", "remove one"}},
        Broken{"NoHeightmap",
               "hills.png",
               "hill.png",
               {"scene.toml:14", "terrain.heightmap", "does not exist", "correct the path", "searched"}},
        Broken{"LayersAndDepth",
               "layers = 2",
               "layers = 2\ndepth = 0.3",
               {"terrain.depth = 0.3", "mutually exclusive with layers", "remove one"}},
        Broken{"NeitherLayersNorDepth", "layers = 2\n", "", {"terrain.layers is missing; set layers [-] or depth [m]"}},
        Broken{
            "NoGrainRadius", "grain_radius = 0.05\n", "", {"terrain.grain_radius [m] is missing", "kind = \"rigid\""}},
        Broken{"LayersOnRigid",
               "grain_radius = 0.05",
               "kind = \"rigid\"",
               {"terrain.layers = 2 has no effect on rigid ground; remove it"}},
        Broken{"SievesOnRigid",
               "grain_radius = 0.05\nlayers = 2",
               "kind = \"rigid\"\nsieve_size = [0.02, 0.05]",
               {"terrain.sieve_size = [0.02, 0.05] requires arrangement"}},
        Broken{"UnknownKind",
               "grain_radius = 0.05",
               "kind = \"granulr\"",
               {"is not one of granular, rigid", "did you mean \"granular\"?"}},
        Broken{"SizeOfThree",
               "size = [6, 4]",
               "size = [6, 4, 1]",
               {"terrain.size = [6, 4, 1]", "expected two numbers [a, b]"}},
        Broken{"ZeroSize", "size = [6, 4]", "size = [6, 0]", {"terrain.size = [6, 0] [m] is outside (0, 100000]"}},
        Broken{"WhiteBelowBlack",
               "height_range = [0, 0.3]",
               "height_range = [0.3, 0]",
               {"terrain.height_range", "lower height first"}},
        Broken{"EmptyHeightmap",
               "\"heightmaps/hills.png\"",
               "\"\"",
               {"scene.toml:14: terrain.heightmap = \"\" is empty; set the path of a file"}},
        Broken{"FolderAsHeightmap",
               "heightmaps/hills.png",
               "heightmaps",
               {"terrain.heightmap", "is a folder (a regular file is required)"}},
        Broken{"EmptySpec",
               "\"vehicles/light_tracked.toml\"",
               "\"\"",
               {"scene.toml:25: vehicle.spec = \"\" is empty; set the path of a file"}},
        Broken{"NoSpec", "light_tracked.toml", "lite.toml", {"vehicle.spec", "does not exist", "correct the path"}},
        Broken{"OffTheTerrain",
               "position = [1.5, 0]",
               "position = [1.5, 3]",
               {"vehicle.position = [1.5, 3] [m] is outside the terrain", "y in [-2, 2]"}},
        Broken{"DriveBeforeTheWeight",
               "sprocket_speed = 1",
               "sprocket_speed = 1\ndrive_start = 0.3",
               {"scene.toml:30: driver.drive_start = 0.3 [s]", "is before the end of the ramps",
                "driver.weight_ramp = 0.45 s", "set it to 0.45 or more"}},
        Broken{"OneSide", "sprocket_speed = 1", "left = 1", {"driver.left = 1", "requires right", "set both"}},
        Broken{"SpeedsTwice",
               "sprocket_speed = 1",
               "sprocket_speed = 1\nleft = 1\nright = 1",
               {"driver.sprocket_speed", "conflicts with another", "keep only one"}},
        Broken{"TableLengths",
               "sprocket_speed = 1",
               "[driver.table]\ntime = [0, 1]\nleft = [1]\nright = [1, 1]",
               {"driver.table.left", "must have as many entries as time (2)", "correct the lists"}},
        Broken{"TableOrder",
               "sprocket_speed = 1",
               "[driver.table]\ntime = [1, 0]\nleft = [1, 1]\nright = [1, 1]",
               {"driver.table.time", "must increase", "sort the list"}},
        Broken{"OutputBelowStep",
               "time_step = 1e-4",
               "time_step = 1e-4\noutput_interval = 1e-5",
               {"run.output_interval = 1e-05", "below the time step", "raise it"}},
        Broken{"OutputInfinitelyRare", "duration = 2", "duration = 2\noutput_interval = 1e300", {"[1e-12, 100000]"}},
        Broken{"CheckpointBelowStep",
               "time_step = 1e-4",
               "time_step = 1e-4\ncheckpoint_interval = 1e-300",
               {"run.checkpoint_interval = 1e-300", "below the time step", "set 0"}},
        Broken{"StepAboveDuration",
               "duration = 2\ntime_step = 1e-4",
               "duration = 0.01\ntime_step = 0.1",
               {"run.time_step", "above the duration", "lower it"}},
        Broken{"DriverWithoutVehicle",
               "[vehicle]\nspec = \"vehicles/light_tracked.toml\"\nposition = [1.5, 0]\nmaterial = \"steel\"\n",
               "",
               {"driver has no effect without a vehicle", "[vehicle]"}},
        Broken{"WrongDevice",
               "duration = 2",
               "duration = 2\ndevice = \"gpu\"",
               {"run.device = \"gpu\" is not one of auto, cpu, cuda"}},
        Broken{"WrongVersion", "version = 1", "version = 2", {"scene.toml:1", "this program reads version = 1"}},
        Broken{"Syntax", "layers = 2", "layers 2", {"scene.toml:20:8", "not valid TOML"}},
        Broken{
            "SyntaxOverTwoLines", "stiffness = 1e6", "attraction = f\nstiffness = 1e6", {"scene.toml:6", "saw 'f\\n'"}},
        Broken{"ControlCharacterInKey", "layers = 2", "\"lay\\u001Bers\" = 2", {"unknown key terrain.lay\\x1Bers"}},
        Broken{"NameOfASurfaceWithoutOne",
               "[terrain]",
               "[[plane]]\npoint = [0, 0, -9]\nnormal = [0, 0, 1]\nmaterial = \"soil\"\n[[box]]\nname = \"plane0\"\n"
               "position = [0, 0, -8]\nsize = [1, 1, 1]\nmaterial = \"soil\"\n[terrain]",
               {"box.0.name = \"plane0\"", "default name of another surface", "choose another"}},
        Broken{"PlaneWithoutNormal",
               "[terrain]",
               "[[plane]]\nnormal = [0, 0, 0]\nmaterial = \"soil\"\n[terrain]",
               {"plane.0.normal", "has zero length", "set the direction"}},
        Broken{"SingleBracketGrain",
               "[terrain]",
               "[grain]\nradius = 1\n[terrain]",
               {"grain has the wrong type", "[[grain]]"}}),
    [](const auto& test) { return test.param.name; });

TEST(Scene, EmptySceneHasNothingToSimulate) {
  EXPECT_THROW(parse("version = 1\n[run]\nduration = 1\n"), base::InputError);
}

TEST(Scene, VehicleOverNothingMustBeFixed) {
  const std::string text = "version = 1\n[run]\nduration = 1\n[vehicle]\nspec = \"vehicles/light_tracked.toml\"\n";
  EXPECT_THROW(parse(text), base::InputError);
  EXPECT_NO_THROW(parse(text + "chassis = \"fixed\"\n"));
}

TEST(Scene, OverridesAreCheckedLikeTheFile) {
  try {
    parse(goodScene(), {"driver.sproket_speed=2"});
    FAIL();
  } catch (const base::InputError& e) {
    EXPECT_EQ(std::string(e.what()).find("--set: unknown key driver.sproket_speed; did you mean sprocket_speed?"), 0u)
        << e.what();
  }
  EXPECT_THROW(parse(goodScene(), {"driver.sprocket_speed=1e9"}), base::InputError);
  EXPECT_THROW(parse(goodScene(), {"terrain.grain_radius=0"}), base::InputError);
}

TEST(Scene, HelpListsEveryKeyOfTheResolvedCopy) {
  const std::string help = fieldHelp();
  const std::string resolved = resolvedToml(parse(goodScene()));
  std::size_t keys = 0;
  for (std::size_t begin = 0; begin < resolved.size();) {
    const std::size_t end = resolved.find('\n', begin), equals = resolved.find(" = ", begin);
    if (equals < end) {
      const std::string key = resolved.substr(begin, equals - begin);
      EXPECT_TRUE(key == "version" || help.find("| `" + key + "` |") != std::string::npos) << key;
      ++keys;
    }
    begin = end + 1;
  }
  EXPECT_GT(keys, 50u);
}

} // namespace
} // namespace grouser::scene
