// SPDX-License-Identifier: BSD-3-Clause
// Common input mistakes: a truncated file, a misspelt path, a full disk. Each ends with exit code 2, or with 3
// if a simulation failed, and prints one line with cause and remedy, and leaves no incomplete output.
// scene_test.cpp covers wrong keys and values inside a scene.
#include "tests/runs/commands/mistake_fixture.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace grouser::commands {

using namespace test; // fixtures

namespace {

/// Damaged scene files.
std::vector<Mistake> sceneFiles() {
  return {
      {"SceneMissing", nothing, "run nosuch.toml", {"nosuch.toml", "no such file", "check the path"}},
      {"SceneIsFolder",
       [](const fs::path& f) { fs::create_directory(f / "scene.toml"); },
       "run scene.toml",
       {"scene.toml"}},
      badScene("PeriodicBoundariesNowhere", "time_step = 1e-5", "time_step = 1e-5\nperiodic = [true, false]",
               {"periodic", "requires positions of the boundaries along x", "run.domain_x"}),
      badScene("DomainOfSidesNotJoined", "time_step = 1e-5", "time_step = 1e-5\ndomain_y = [0, 1]",
               {"domain_y", "no effect", "remove it"}),
      badScene("DomainUpsideDown", "time_step = 1e-5", "time_step = 1e-5\nperiodic = [true, false]\ndomain_x = [1, -1]",
               {"domain_x", "lower side first"}),
      badScene("PeriodicBoundariesTooNear", "time_step = 1e-5",
               "time_step = 1e-5\nperiodic = [false, true]\ndomain_y = [-0.02, 0.02]",
               {"scene.toml:6: run.domain_y", "too close", "at least 0.06", "use smaller grains"}),
      badScene("PeriodicBoundariesBeyondTheRangeOfPlaces", "time_step = 1e-5",
               "time_step = 1e-5\nperiodic = [false, true]\ndomain_y = [-1e5, 1e5]",
               {"scene.toml:6: run.domain_y", "farther than 256 m from the origin"}),
      badScene("GrainOutsidePeriodicBoundaries", "time_step = 1e-5",
               "time_step = 1e-5\nperiodic = [true, false]\ndomain_x = [-0.05, 0.08]",
               {"grain.1", "beyond the periodic boundaries", "run.domain_x"}),
      badScene("TileTooSmall", "layers = 1", "layers = 1\ntile = [0.1, 0.5]", {"tile", "own images", "at least"}, kBed),
      badScene("SceneEmpty", kGrains, "", {"scene.toml", "version"}),
      {"SceneIsBinary",
       [](const fs::path& f) { put(f / "scene.toml", picture()); },
       "run scene.toml",
       {"scene.toml:1"}},
      {"SceneCutShort",
       [](const fs::path& f) { put(f / "scene.toml", std::string(kGrains).substr(0, 100)); },
       "run scene.toml",
       {"scene.toml:"}},
      badScene("NothingInIt", std::string(kGrains).substr(std::string(kGrains).find("[material")), "",
               {"nothing to simulate", "add [terrain]"}),
  };
}

/// Pictures.
std::vector<Mistake> pictures() {
  return {
      {"PictureMissing",
       [](const fs::path& f) { put(f / "scene.toml", kBed); },
       "run scene.toml",
       {"terrain.heightmap", "does not exist", "correct the path"}},
      badPicture("PictureEmpty", "", {"map.png", "the file is empty", "give a PNG"}),
      badPicture("PictureIsText", "this is no picture", {"map.png", "not a picture", "give a PNG"}),
      badPicture("PictureCutShort", picture().substr(0, 70), {"map.png", "damaged or truncated", "copy it again"}),
      badPicture("PictureHeaderAlone", picture().substr(0, 33), {"map.png", "truncated"}),
      badPicture("PictureOfOnePixel", picture(16, std::string("\0\0\0\1\0\0\0\1", 8)),
                 {"1 x 1 pixels", "at least 2 x 2"}),
      badPicture("PictureOfNoPixel", picture(16, std::string("\0\0\0\0", 4)), {"map.png"}),
      badPicture("PictureHuge", picture(16, std::string("\0\1\0\0\0\1\0\0", 8)),
                 {"65536 x 65536 pixels", "give a smaller"}),
      badPicture("PictureBeyondMeasure", picture(16, "\x7f\xff\xff\xff\x7f\xff\xff\xff"), {"map.png", "at most 2^28"}),
      badPicture("PictureOfWrongColourType", picture(25, "\7"), {"map.png", "give a PNG"}),
      badPicture("PictureOfWrongDepth", picture(24, "\3"), {"map.png", "give a PNG"}),
      badPicture("PictureInterlacedWrong", picture(28, "\x09"), {"map.png"}),
      {"PictureIsFolder",
       [](const fs::path& f) {
         put(f / "scene.toml", kBed);
         fs::create_directory(f / "map.png");
       },
       "run scene.toml",
       {"terrain.heightmap", "is a folder"}},
  };
}

/// Vehicles.
std::vector<Mistake> vehicles() {
  const std::string spec = contents(asset("vehicles/light_tracked.toml"));
  return {
      badVehicle("VehicleMissing", nothing, {"vehicle.spec", "does not exist"}),
      badVehicle("VehicleCutShort", [spec](const fs::path& p) { put(p, spec.substr(0, spec.size() / 2)); },
                 {"car.toml"}),
      badVehicle("VehicleOfNegativeMass",
                 [spec](const fs::path& p) {
                   const std::size_t at = spec.find("mass = ");
                   put(p, std::string(spec).replace(at, spec.find('\n', at) - at, "mass = -1"));
                 },
                 {"car.toml:", "mass = -1", "outside"}),
      badVehicle("VehicleNameWithMarkup",
                 [spec](const fs::path& p) {
                   const std::size_t at = spec.find("name = ");
                   put(p, std::string(spec).replace(at, spec.find('\n', at) - at, "name = \"<b>car\""));
                 },
                 {"car.toml:", "name = \"<b>car\" contains < or >"}),
      badScene("VehicleCutTooFine", kGrains, replaced(kBench, "RADIUS", "1e-5"),
               {"scene.toml:6: vehicle.sphere_radius", "lattice points", "raise it"}),
      badScene("VehicleCutTooCoarse", kGrains, replaced(kBench, "RADIUS", "0.9"),
               {"scene.toml:6: vehicle.sphere_radius", " m, half of the longest side of ", "lower it"}),
      badVehicle("VehicleMeshMissing", [spec](const fs::path& p) { put(p, spec); }, {".obj"}),
  };
}

/// Invalid grains and surfaces, or invalid positions of them.
std::vector<Mistake> grainsAndSurfaces() {
  return {
      badScene("GrainOfNoSize", "position = [0, 0, 0.5]\nradius = 0.01", "position = [0, 0, 0]\nradius = 2e-320",
               {"scene.toml:10", "grain.0.radius", "below the minimum 1e-12 m"}),
      badScene("GrainsOverlap", "position = [0.1, 0, 0.5]", "position = [0.015, 0, 0.5]",
               {"grain.1.position", "overlaps", "move it"}),
      badScene("GrainsAtOnePlace", "position = [0.1, 0, 0.5]", "position = [0, 0, 0.5]",
               {"grain.1.position", "overlaps"}),
      badScene("GrainInPlane", "position = [0, 0, 0.5]", "position = [0, 0, -0.5]",
               {"grain.0.position", "overlaps plane 0"}),
      badScene("GrainInBox", "[[plane]]", "[[box]]\nposition = [0, 0, 0.5]\nsize = [0.05, 0.05, 0.05]",
               {"grain.0.position", "overlaps box 0"}),
      badScene("FixedGrainThatMoves", "position = [0, 0, 0.5]",
               "position = [0, 0, 0.5]\nfixed = true\nspin = [0, 0, 1]", {"grain.0.spin", "fixed grain", "remove it"}),
      badScene("BoxOfNegativeSize", "[[plane]]", "[[box]]\nposition = [0, 0, 0]\nsize = [1, 1, -1]",
               {"scene.toml:8", "box.0.size", "is outside"}),
      badScene("CylinderAlongNothing", "[[plane]]",
               "[[cylinder]]\nposition = [0, 0, 0]\naxis = [0, 0, 0]\nradius = 0.1\nlength = 1",
               {"cylinder.0.axis", "has zero length", "set the direction"}),
      badScene("LidBothPushedAndMoved", "[[plane]]",
               "[[box]]\nposition = [0, 0, 0]\nsize = [1, 1, 0.1]\nfree = \"z\"\nmass = 1\nload = -5\nvelocity = [0, "
               "0, 1]",
               {"box.0.velocity", "the free axis", "remove free"}),
      badScene("LidWithoutMass", "[[plane]]", "[[box]]\nposition = [0, 0, 0]\nsize = [1, 1, 0.1]\nfree = \"z\"",
               {"box.0", "mass [kg] is missing", "add it"}),
      badScene("GrainOutsideTheDomain", "position = [0.1, 0, 0.5]", "position = [1e9, 0, 0.5]",
               {"scene.toml:13: grain.1.position", "farther than 256 m from the origin", "move the scene closer"}),
      badScene("GrainAtNoNumber", "position = [0, 0, 0.5]", "position = [nan, 0, 0.5]",
               {"scene.toml:9", "grain.0.position", "is not finite"}),
      badScene("RadiiTooUnlike", "radius = 0.01", "radius = 5e-6",
               {"scene.toml:10: grain.0.radius", "less than 0.001 of the largest", "raise it"}),
  };
}

/// Values too large for the step, the memory or the position range.
std::vector<Mistake> stepsAndSizes() {
  return {
      badScene("MoreBoundariesThanBits", "[[plane]]", manyPlanes(32) + "[[plane]]",
               {"scene.toml:70: plane.32", "at most 32", "[[mesh]]"}),
      badScene("FreeLidTooLightForTheStep", "[[plane]]",
               "[[box]]\nname = \"lid\"\nposition = [0, 0, 0]\nsize = [1, 1, 0.1]\nfree = \"z\"\nmass = 1e-6",
               {"scene.toml:4: run.time_step", "lid of 1e-06 kg", "raise box.0.mass"}),
      badScene("SurfaceTooQuick", "[[plane]]",
               "[[box]]\nposition = [0, 0, 0]\nsize = [1, 1, 0.1]\nvelocity = [0, 0, 600]",
               {"scene.toml:9: box.0.velocity", "without contact", "keep it below 500 m/s"}),
      badScene("StepTooLarge", "time_step = 1e-5", "time_step = 1e-3",
               {"run.time_step", "the stability limit", "or less"}),
      badScene("TooManyGrains", "grain_radius = 0.03\nlayers = 1", "grain_radius = 5e-5\nlayers = 10000",
               {"scene.toml:11: terrain.grain_radius", "use larger grains"}, replaced(kBed, "time_step = 1e-4\n", "")),
      badScene("TerrainBeyondTheRangeOfPlaces", "grain_radius = 0.03", "grain_radius = 1e-6",
               {"scene.toml:9: terrain.size", "terrain.grain_radius", "use larger grains"}, kBed),
      badScene(
          "PlaneAcrossPeriodicBoundaries", "time_step = 1e-5\n[material.glass]\n[[plane]]",
          "time_step = 1e-5\nperiodic = [true, false]\ndomain_x = [-1, 1]\n[material.glass]\n[[plane]]\nnormal = [1, "
          "0, 1]",
          {"scene.toml:9: plane.0.normal", "inclined along x", "set this entry to 0"}),
      badScene(
          "LawsThatDoNotMeet", "[material.glass]",
          "[material.stone]\nlaw = \"hertz\"\nyoung = 1e7\n[material.glass]\n[[plane]]\nmaterial = \"stone\"",
          {"scene.toml:6: material.stone.law", "is incompatible with law = \"linear\" of material.glass", "for both"}),
      badScene("FolderWithControlCharacter", "[output]", "[output]\nfolder = \"a\\u0000b\"",
               {"scene.toml:17: output.folder", "control character"}),
      badScene(
          "OrderThatIsNone", kGrains,
          "version = 1\n[run]\nduration = 1\nintegrator_order = 3\n[[body]]\nname = \"a\"\nmass = 1\nbox = [1, 1, 1]\n",
          {"scene.toml:4: run.integrator_order", "must be 2, 4, 6 or 8"}),
      badScene(
          "BodiesBesideGrains", kGrains,
          "version = 1\n[run]\nduration = 1\n[material.glass]\n[[grains]]\nlow = [0, 0, 0]\nhigh = [1, 1, 1]\nradius = "
          "0.1\nmaterial = \"glass\"\n[[body]]\nname = \"a\"\nmass = 1\nbox = [1, 1, 1]\n",
          {"scene.toml:10: body.0", "incompatible with grains", "add [[body.shape]]"}),
      badScene("GrainTooQuickForTheLists", "radius = 0.01", "radius = 0.01\nvelocity = [200, 0, 0]",
               {"scene.toml:11: grain.0.velocity", "keep it below 150 m/s", "lower run.time_step"}),
      badScene("SpinTooQuickToBeFelt", "[[plane]]",
               "[[box]]\nposition = [0, 0, 0]\nsize = [1, 1, 0.1]\nspin = [0, 1000, 0]",
               {"scene.toml:9: box.0.spin", "without contact", "keep it below 500 m/s"}),
      badScene("MoreGrainsThanIds", "[output]",
               "[[grains]]\nlow = [0, 0, 1]\nhigh = [100, 100, 100]\nradius = 0.01\nmaterial = \"glass\"\n[output]",
               {"scene.toml:19: grains.0.radius", "larger grains or a smaller box"}),
      // Four billion grains at 1.5 kB: more than the memory of any machine.
      badScene("MoreGrainsThanMemory", "[output]",
               manyPlanes(30) +
                   "[[grains]]\nlow = [0, 0, 1]\nhigh = [33, 33, 34]\nradius = 0.01\nmaterial = \"glass\"\n[output]",
               {"grains.0.radius", "this machine has", "use fewer or larger grains"},
               replaced(kGrains, "[material.glass]", "[material.glass]\nrolling_friction = 0.1")),
      badScene("BedWithoutGravity", "time_step = 1e-4", "time_step = 1e-4\ngravity = [0, 0, 0]",
               {"scene.toml:5: run.gravity", "set z below 0", "settle_time_limit"},
               replaced(kBed, "settle_time_limit = 0.0", "settle_time_limit = 1.0")),
      badScene("ExplicitSpringTooStiffForTheStep", kGrains,
               "version = 1\n[run]\nduration = 1\ntime_step = 1e-3\nsprings = \"explicit\"\n[[body]]\nname = "
               "\"a\"\nmass = 1\nbox = [1, 1, 1]\n[[spring]]\nname = \"s\"\nbodies = [\"world\", "
               "\"a\"]\npoint_a = [0, 0, 3]\nstiffness = 1e9\n",
               {"scene.toml:4: run.time_step", "set by spring 's'", "take a shorter step"}),
  };
}

/// Sources at occupied places.
std::vector<Mistake> sources() {
  return {
      badScene("SourceAfterTheEnd", "[output]", source("[0.4, 0, 0.3]", "start = 2e-3"),
               {"scene.toml:23: source.0.start = 0.002 [s] is after the end of the run (run.duration = 0.001 s)",
                "raise run.duration"}),
      badScene("SourceInPlane", "[output]", source("[0.4, 0, -0.3]"),
               {"scene.toml:17: source.0.low", "overlaps plane 0", "move low and high"}),
      badScene("SourceInBox", "[output]", cube("[0.4, 0, 0.3]") + source("[0.4, 0, 0.3]"),
               {"source.0.low", "overlaps box 0"}),
      badScene("SourceWhereABoxWillBe", "[output]",
               cube("[0.4, 0, 0.2]", "velocity = [0, 0, 200]\n") + source("[0.4, 0, 0.3]", "start = 5e-4"),
               {"source.0.low", "at 0.0005 s", "overlaps box 0", "change start"}),
      badScene("SourceInMesh", "[output]",
               "[[mesh]]\nfile = \"meshes/idler.obj\"\nposition = [0.8, 0, 0.3]\nmaterial = \"glass\"\n" +
                   source("[0.8, 0, 0.32]"),
               {"source.0.low", "overlaps mesh 0"}),
      badScene("SourceOnGrain", "[output]", source("[0.1, 0, 0.505]"),
               {"source.0.low", "overlaps grain 1 at (0.1, 0, 0.5) m", "move low and high"}),
      badScene("SourcesOnEachOther", "[output]",
               replaced(source("[0.4, 0, 0.5]"), "[output]", "") + source("[0.4, 0, 0.501]"),
               {"source.1.low", "overlaps a grain of source.0"}),
      badScene("SourceBelowTheFloor", "[output]", source("[0.3, 0, -1]", "", "soil"),
               {"source.0.low", "the terrain's floor"}, kBed),
      badScene("SourceBeyondTheWalls", "[output]", source("[0.3, 0.3, 0.3]", "", "soil"),
               {"source.0.low", "a wall of the terrain"}, kBed),
      badScene("SourceInTheBed", "[output]", source("[0.3, 0, 0.06]", "", "soil", "0.03"),
               {"scene.toml:18: source.0 would insert a grain", "at step 0", "deep in grain", "elsewhere (low, high)"},
               kBed),
  };
}

/// Names of results.
std::vector<Mistake> names() {
  return {
      badScene("NameWithControlCharacter", "[[plane]]", "[[plane]]\nname = \"a\\u0001b\"",
               {"scene.toml:7: plane.0.name", "control character", "remove it"}),
      badScene("NameWithSlash", "[[plane]]", "[[plane]]\nname = \"a/b\"", {"scene.toml:7: plane.0.name", "has a /"}),
      badScene("MaterialNameWithControlCharacter", "[material.glass]", "[material.\"a\\tb\"]\n[material.glass]",
               {"scene.toml:5: material", "control character"}),
      badScene("BodyNameWithControlCharacter", kGrains,
               "version = 1\n[run]\nduration = 1\n[[body]]\nname = \"a\\u0000b\"\nmass = 1\nbox = [1, 1, 1]\n",
               {"scene.toml:5: body.0.name", "control character"}),
      badScene("NameWithLineSeparator", "[[plane]]", "[[plane]]\nname = \"a\\u2028b\"",
               {"scene.toml:7: plane.0.name", "control character"}),
      badScene("NameThatReversesTheText", "[[plane]]", "[[plane]]\nname = \"a\\u202Eb\"",
               {"scene.toml:7: plane.0.name = \"a\\u202Eb\" contains a control character"}),
      badScene("NameOf65Characters", "[[plane]]", "[[plane]]\nname = \"" + std::string(65, 'a') + "\"",
               {"scene.toml:7: plane.0.name", "has 65 characters, more than 64"}),
      badScene("NameWithMarkup", "[[plane]]", "[[plane]]\nname = \"<b>\"",
               {"scene.toml:7: plane.0.name = \"<b>\" contains < or >", "use letters, digits"}),
      badScene("MaterialNameWithMarkup", "[material.glass]", "[material.\"a>b\"]\n[material.glass]",
               {"scene.toml:5: material.\"a>b\" contains < or >"}),
      badScene(
          "BodyNameWithMarkup", kGrains,
          "version = 1\n[run]\nduration = 1\n[[body]]\nname = \"<img src=x onerror=x()>\"\nmass = 1\nbox = [1, 1, 1]\n",
          {"scene.toml:5: body.0.name = \"<img src=x onerror=x()>\" contains < or >"}),
      badScene("TitleWithMarkup", "[output]",
               "[[output.plot]]\ny = [\"ledger.kinetic\"]\ny_label = \"E [J]\"\ntitle = \"<b>\"\n[output]",
               {"output.plot.0.title = \"<b>\" contains < or >"}),
  };
}

/// Meshes.
std::vector<Mistake> meshes() {
  return {
      badMesh("MeshFlat", "", {"scene.toml:7: mesh.0.file", "flat and encloses no volume", "a thin box"},
              "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n"),
      badMesh("MeshTooSmall", "scale = 1e-7", {"scene.toml:9: mesh.0.scale", "correct it"}),
      badMesh("MeshTooLarge", "scale = 1e5", {"scene.toml:9: mesh.0.scale", "correct it"}),
      badMesh("MeshCutTooFine", "sphere_radius = 1e-5",
              {"scene.toml:9: mesh.0.sphere_radius", "lattice points", "raise it"}),
      badMesh("MeshCutTooCoarse", "sphere_radius = 5", {"scene.toml:9: mesh.0.sphere_radius", "lower it"}),
  };
}

/// Output folders.
std::vector<Mistake> folders() {
  return {
      {"OutIsFile",
       [](const fs::path& f) { put(f / "scene.toml", kGrains), put(f / "a", "precious"); },
       "run scene.toml --out a",
       {"a: is a file", "--out"}},
      {"OutBelowFile",
       [](const fs::path& f) { put(f / "scene.toml", kGrains), put(f / "a", "precious"); },
       "run scene.toml --out a/b",
       {"a/b", "--out"}},
      {"OutNotWritable",
       [](const fs::path& f) { put(f / "scene.toml", kGrains); },
       "run scene.toml --out /proc/results",
       {"/proc/results", "--out"}},
      {"OutIsFull",
       [](const fs::path& f) {
         put(f / "scene.toml", kGrains);
         fs::create_directory(f / "a"), put(f / "a/b", "precious");
       },
       "run scene.toml --out a",
       {"not empty", "--force"}},
      {"FullDisk",
       [](const fs::path& f) { fs::copy(asset("meshes/idler.obj"), f / "idler.obj"); },
       "spheres idler.obj --radius 0.02 --csv s.csv",
       {"s.csv", "is the disk full?"},
       3,
       "ulimit -f 1; "},
  };
}

/// session::Checkpoints.
std::vector<Mistake> checkpoints() {
  return {
      badCheckpoint("CheckpointMissing", [](const fs::path& c) { fs::remove(c); }, {"checkpoint.h5", "no such file"}),
      badCheckpoint("CheckpointCut", [](const fs::path& c) { fs::resize_file(c, fs::file_size(c) / 2); },
                    {"damaged", "start a new run"}),
      badCheckpoint("CheckpointEmpty", [](const fs::path& c) { fs::resize_file(c, 0); }, {"not a checkpoint"}),
      badCheckpoint("CheckpointOfAnotherFormat", [](const fs::path& c) { put(c, picture()); }, {"not a checkpoint"}),
      badCheckpoint("CheckpointOfAnotherScene", nothing, {"run.seed", "restore it"},
                    "run scene.toml --resume --out a --set run.seed=9"),
      badCheckpoint("CheckpointBeyondTheEnd", nothing, {"raise run.duration"},
                    "run scene.toml --resume --out a --steps 10"),
      badCheckpoint("HashOfWhatIsNone", nothing, {"not a checkpoint"}, "hash a/results.h5"),
      badCheckpoint("SinkageOfWhatHasNone", nothing, {"results.h5"}, "sinkage a/results.h5"),
      badCheckpoint("FramesThatAreNone", nothing, {"checkpoint.h5"}, "render a/checkpoint.h5 --out p"),
  };
}

std::vector<Mistake> mistakes() {
  std::vector<Mistake> all;
  for (const auto subject :
       {sceneFiles, pictures, vehicles, grainsAndSurfaces, stepsAndSizes, sources, names, meshes, folders, checkpoints})
    for (Mistake& mistake : subject()) all.push_back(std::move(mistake));
  return all;
}

class BadInput : public ProgramTest, public testing::WithParamInterface<Mistake> {
protected:
  /// Every file below the working folder with its contents.
  std::map<std::string, std::string> files() const {
    std::map<std::string, std::string> all;
    for (const auto& entry : fs::recursive_directory_iterator(folder_))
      all[entry.path().string()] = entry.is_regular_file() ? contents(entry.path()) : "";
    return all;
  }
};

/// Text without the lines on values outside the usual span of their key, which precede the error.
std::string withoutUnusualValues(const std::string& text) {
  std::istringstream lines(text);
  std::string others;
  for (std::string line; std::getline(lines, line);)
    if (!line.starts_with("grouser: note: ") || line.find(" is outside the usual span, ") == std::string::npos)
      others += line + "\n";
  return others;
}

TEST_P(BadInput, EndsWithOneLineAndTouchesNothing) {
  const Mistake& m = GetParam();
  m.make(folder_);
  if (HasFatalFailure()) return;
  const std::map<std::string, std::string> before = files();
  const Outcome o = call(m.words, m.before);
  const std::string errors = withoutUnusualValues(o.errors);
  EXPECT_EQ(o.code, m.code) << errors;
  EXPECT_EQ(errors.rfind("grouser: error: ", 0), 0u) << errors;
  EXPECT_EQ(std::count(errors.begin(), errors.end(), '\n'), 1) << errors;
  for (const std::string& part : m.says) EXPECT_NE(errors.find(part), std::string::npos) << part << "\n" << errors;
  EXPECT_EQ(files() == before, true) << "a file was written, changed or removed";
}

INSTANTIATE_TEST_SUITE_P(Mistakes, BadInput, ::testing::ValuesIn(mistakes()),
                         [](const auto& test) { return test.param.name; });

} // namespace
} // namespace grouser::commands
