// SPDX-License-Identifier: BSD-3-Clause
// Bodies with a mesh shape: among grains, on rigid surfaces, on each other, and rejected scenes.
#include "base/error.hpp"
#include "base/math.hpp"
#include "contact/shape_points.hpp"
#include "coupling/simulation.hpp"
#include "runs/scene/scene.hpp"
#include "runs/scene/scene_file.hpp"
#include "runs/setup/body_mass.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/mechanism_setup.hpp"
#include "runs/setup/provenance.hpp"
#include "runs/setup/simulation_setup.hpp"
#include "runs/setup/step_limit.hpp"
#include "runs/setup/vehicle_surroundings.hpp"
#include "spheredecomp/mesh.hpp"
#include "tests/message_of.hpp"
#include "tests/system/scene_simulation.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

namespace grouser::coupling::mesh_bodies {
namespace {

using base::Vec3d;
using test::messageOf;
namespace fs = std::filesystem;

constexpr double kGravity = 9.81;

/// Folder with a test's meshes and scene; removed at the end.
class Folder {
public:
  Folder() {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    path_ = fs::temp_directory_path() / fmt::format("grouser_{}_{}", test->name(), getpid());
    fs::create_directories(path_);
  }
  ~Folder() { fs::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  std::string scene() const { return (path_ / "bodies.toml").string(); }
  /// A box between two corners as `name`; `open`: without its last triangle.
  void box(const std::string& name, const Vec3d& low, const Vec3d& high, bool open = false) const {
    std::ofstream file(path_ / name);
    for (int i = 0; i < 8; ++i)
      file << fmt::format("v {} {} {}\n", i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z);
    for (const char* face :
         {"1 3 4", "1 4 2", "5 6 8", "5 8 7", "1 2 6", "1 6 5", "3 7 8", "3 8 4", "1 5 7", "1 7 3", "2 4 8"})
      file << "f " << face << "\n";
    if (!open) file << "f 2 8 6\n";
  }
  /// Appends the box of file `second` to file `first`, which holds one box.
  void append(const std::string& first, const std::string& second) const {
    std::ifstream from(path_ / second);
    std::ofstream to(path_ / first, std::ios::app);
    std::string kind;
    double a = 0, b = 0, c = 0;
    while (from >> kind >> a >> b >> c)
      to << (kind == "f" ? fmt::format("f {} {} {}\n", a + 8, b + 8, c + 8) : fmt::format("v {} {} {}\n", a, b, c));
  }
  void cube(const std::string& name = "cube.obj") const { box(name, {-0.05, -0.05, -0.05}, {0.05, 0.05, 0.05}); }
  std::unique_ptr<Simulation> made(const std::string& text, int threads = 1) const {
    return std::make_unique<Simulation>(setup::simulationSetup(setup::parseScene(text, scene())),
                                        base::cpuExec(threads), [](double, double) {});
  }

private:
  fs::path path_;
};

std::string head(const std::string& run = {}) {
  return "version = 1\n[run]\nduration = 1.0\nprecision = \"double\"\nthreads = 1\n" + run +
         "\n[material.glass]\nstiffness = 1e5\nrestitution = 0.4\nfriction = 0.3\nfoundation_modulus = 1e8\n";
}
const std::string kPlane = "[[plane]]\nnormal = [0, 0, 1]\nmaterial = \"glass\"\n";
/// With its default sphere radius as a key: without this key, the cube would be an exact box without spheres.
const std::string kCubeShape = "[[body.shape]]\nkind = \"mesh\"\nfile = \"cube.obj\"\nsphere_radius = 0.00433\n";
const std::string kBoxShape = "[[body.shape]]\nkind = \"box\"\nsize = [0.1, 0.1, 0.1]\n";

std::string body(const std::string& name, const std::string& position, const std::string& keys,
                 const std::string& shape = kCubeShape) {
  return fmt::format("[[body]]\nname = \"{}\"\nposition = {}\nmaterial = \"glass\"\n{}\n{}", name, position, keys,
                     shape);
}
const std::string kTwoKilograms = "mass = 2\nbox = [0.1, 0.1, 0.1]\n";

std::string feet() {
  std::string all;
  for (const char* place : {"[-0.03, -0.03, 0]", "[0.03, -0.03, 0]", "[-0.03, 0.03, 0]", "[0.03, 0.03, 0]"})
    all += fmt::format("[[grain]]\nposition = {}\nradius = 0.01\nmaterial = \"glass\"\nfixed = true\n", place);
  return all;
}

TEST(MeshPoints, CarryTheAreaAndLieInTheirFaces) {
  const Folder folder;
  folder.box("brick.obj", {-0.1, -0.05, -0.02}, {0.1, 0.05, 0.02});
  const base::TriangleMesh mesh =
      spheredecomp::importMesh((fs::path(folder.scene()).parent_path() / "brick.obj").string());
  double area = 0, farthest = 0;
  Vec3d moment;
  const contact::SurfaceGeometry box{contact::SurfaceShape::box, {0.1, 0.05, 0.02}};
  for (const contact::SurfaceSample& s : contact::meshPoints(mesh, 0.01, [](const Vec3d&) { return false; })) {
    area += s.area, moment += s.centre.as<double>() * static_cast<double>(s.area);
    farthest = std::max(farthest, std::fabs(gapTo(box, s.centre.as<double>()).distance));
    // The cluster is that of the face: a corner belongs to three.
    const Vec3d p = s.centre.as<double>();
    EXPECT_NEAR(std::fabs(p[static_cast<int>(s.cluster / 2)]), box.half[static_cast<int>(s.cluster / 2)], 1e-7);
  }
  EXPECT_NEAR(area, 8 * (0.1 * 0.05 + 0.1 * 0.02 + 0.05 * 0.02), 1e-6);
  EXPECT_LT(farthest, 1e-7) << "single precision";
  EXPECT_LT(norm(moment), 1e-3 * area * 0.1) << "two triangles of a face have different points";
  const auto upper = contact::meshPoints(mesh, 0.01, [](const Vec3d& p) { return p.z < 0.02; });
  EXPECT_FALSE(upper.empty());
  for (const contact::SurfaceSample& s : upper) EXPECT_EQ(s.cluster, 5u) << "the others are hidden";
}

TEST(MeshBodies, WeightIsTheMeanContactForceOnGrains) {
  const Folder folder;
  folder.cube();
  const auto s = folder.made(head("time_step = 2e-5") + feet() + body("cube", "[0, 0, 0.0599]", kTwoKilograms));
  advanceTo(*s, 0.5);
  s->restartMeans();
  advanceTo(*s, 0.6);
  const Vec3d force = s->mechanism()->contactForces()[0];
  EXPECT_NEAR(force.z, 2 * kGravity, 1e-3 * 2 * kGravity);
  EXPECT_LT(std::hypot(force.x, force.y), 1e-3 * 2 * kGravity);
  // Each foot carries a quarter: overlap = m g / (4 k), relative to the face in single precision.
  EXPECT_NEAR(stateOf(*s).pose[0].position.z, 0.06 - 2 * kGravity / 4e5, 1e-6);
}

TEST(MeshBodies, RestOnAPlaneAsABoxDoes) {
  const Folder folder;
  folder.cube();
  const auto s = folder.made(head() + kPlane + body("mesh", "[0, 0, 0.05]", kTwoKilograms) +
                             body("box", "[1, 0, 0.05]", kTwoKilograms, kBoxShape));
  advanceTo(*s, 0.4);
  s->restartMeans();
  advanceTo(*s, 0.5);
  const double ofMesh = 0.05 - stateOf(*s).pose[0].position.z, ofBox = 0.05 - stateOf(*s).pose[1].position.z;
  EXPECT_NEAR(ofMesh, 2 * kGravity / (1e8 * 0.01), 0.02 * ofMesh) << "W / (K A)";
  EXPECT_NEAR(ofMesh, ofBox, 0.05 * ofBox);
  EXPECT_NEAR(s->mechanism()->contactForces()[0].z, 2 * kGravity, 1e-3 * 2 * kGravity);
  EXPECT_NEAR(s->mechanism()->meanForceOn(0).z, -4 * kGravity, 1e-3 * 4 * kGravity);
}

TEST(MeshBodies, StandOnEachOtherByPointsAndSpheres) {
  const Folder folder;
  folder.cube();
  folder.box("slab.obj", {-0.1, -0.1, -0.02}, {0.1, 0.1, 0.02});
  // Box on mesh, mesh on mesh, mesh on box: sample points are on the smaller one.
  const std::string slab = "[[body.shape]]\nkind = \"mesh\"\nfile = \"slab.obj\"\nsphere_radius = 0.00714\n";
  const std::string ofSlab = "mass = 5\nbox = [0.2, 0.2, 0.04]\n";
  const auto s = folder.made(
      head() + kPlane + body("slab", "[0, 0, 0.02]", ofSlab, slab) + body("mesh", "[0, 0, 0.09]", kTwoKilograms) +
      body("slab2", "[1, 0, 0.02]", ofSlab, slab) + body("box", "[1, 0, 0.09]", kTwoKilograms, kBoxShape) +
      body("plate", "[2, 0, 0.02]", ofSlab, "[[body.shape]]\nkind = \"box\"\nsize = [0.2, 0.2, 0.04]\n") +
      body("mesh2", "[2, 0, 0.09]", kTwoKilograms));
  advanceTo(*s, 0.4);
  s->restartMeans();
  advanceTo(*s, 0.5);
  const auto force = s->mechanism()->contactForces();
  for (std::size_t b = 0; b < 6; ++b) {
    const double weight = (b % 2 ? 2 : 5) * kGravity;
    EXPECT_NEAR(force[b].z, weight, 2e-3 * weight) << b;
    EXPECT_NEAR(stateOf(*s).pose[b].position.z, b % 2 ? 0.09 : 0.02, 2e-4) << b;
  }
  const Ledger l = s->ledger();
  EXPECT_LT(std::fabs(l.residual), 1e-9 * l.turnover);
}

TEST(MeshBodies, MomentumIsConservedWhereTwoMeet) {
  const Folder folder;
  folder.cube();
  const auto s =
      folder.made(head("gravity = [0, 0, 0]") + body("a", "[0, 0, 0]", kTwoKilograms + "velocity = [1, 0, 0]\n") +
                  body("b", "[0.12, 0.02, 0.01]", kTwoKilograms + "spin = [0, 1, 2]\n"));
  const multibody::Totals start = s->mechanism()->bodiesBalance().now;
  advanceTo(*s, 0.1);
  const multibody::Totals now = s->mechanism()->bodiesBalance().now;
  EXPECT_LT(norm(now.linearMomentum - start.linearMomentum), 1e-9);
  EXPECT_LT(norm(now.angularMomentum - start.angularMomentum), 1e-6);
  EXPECT_LT(stateOf(*s).twist[0].v.x, 0.9) << "they have collided";
  EXPECT_LT(now.kinetic, start.kinetic);
}

TEST(MeshBodies, MassAndInertiaAreThoseOfTheBox) {
  const Folder folder;
  folder.box("brick.obj", {0, 0, 0}, {1, 2, 3}); // its origin is a corner
  const auto modelOf = [&](const std::string& shape) {
    return setup::mechanismSetup(
               setup::parseScene(head() + kPlane + body("b", "[0, 0, 1]", "density = 800\n", shape), folder.scene()))
        .model.bodies()[0];
  };
  const std::string brick = "[[body.shape]]\nkind = \"mesh\"\nfile = \"brick.obj\"\nscale = 0.1\naxis = [0, 0, 1]\n"
                            "angle = 90\nposition = [0.1, -0.05, -0.15]\n";
  const auto box = modelOf("[[body.shape]]\nkind = \"box\"\nsize = [0.2, 0.1, 0.3]\n");
  for (const auto& mesh : {modelOf(brick), modelOf(brick + "sphere_radius = 0.009\n")}) {
    EXPECT_NEAR(mesh.mass, 800 * 0.006, 1e-9);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        EXPECT_NEAR(mesh.inertia_B.m[i][j], box.inertia_B.m[i][j], 1e-7 * box.inertia_B.m[0][0]) << i << j;
  }
  const std::string beside = messageOf([&] { modelOf("[[body.shape]]\nkind = \"mesh\"\nfile = \"brick.obj\"\n"); });
  EXPECT_NE(beside.find("has its centre of mass at [0.5, 1, 1.5] m"), std::string::npos) << beside;
  // A hollow box with an inner shell that is not reversed.
  folder.box("nested.obj", {-0.05, -0.05, -0.05}, {0.05, 0.05, 0.05});
  folder.box("inner.obj", {-0.04, -0.04, -0.04}, {0.04, 0.04, 0.04});
  folder.append("nested.obj", "inner.obj");
  const std::string nested = messageOf([&] { modelOf("[[body.shape]]\nkind = \"mesh\"\nfile = \"nested.obj\"\n"); });
  EXPECT_NE(nested.find("overlapping, nested or repeated shells in the mesh of shape.0, e.g. at ("), std::string::npos)
      << nested;
  // A rod and its copy, 1 mm further along it: only the ends are hidden, 1/2004 of the surface.
  folder.box("rod.obj", {-0.5, -0.001, -0.001}, {0.5, 0.001, 0.001});
  folder.box("copy.obj", {-0.499, -0.001, -0.001}, {0.501, 0.001, 0.001});
  folder.append("rod.obj", "copy.obj");
  const std::string repeated = messageOf([&] { modelOf("[[body.shape]]\nkind = \"mesh\"\nfile = \"rod.obj\"\n"); });
  EXPECT_NE(repeated.find("repeated shells in the mesh of shape.0, e.g. at ("), std::string::npos) << repeated;
  // A tetrahedron with a vertex at the origin: integrals in closed form.
  base::TriangleMesh tetra{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3}};
  const setup::SolidMoments m = setup::momentsOf(tetra);
  EXPECT_NEAR(m.volume, 1.0 / 6, 1e-15);
  EXPECT_NEAR(norm(m.centre - Vec3d{0.25, 0.25, 0.25}), 0, 1e-15);
  EXPECT_NEAR(m.inertia.m[0][0], 2 * (1.0 / 60 - 1.0 / 96), 1e-15);
  EXPECT_NEAR(m.inertia.m[0][1], -(1.0 / 120 - 1.0 / 96), 1e-15);
}

/// One grain on a fixed sheet of 0.4 x 0.4 x 0.001 m with its upper face at z = 0.
std::string grainOn(const std::string& shape) {
  return head() + "[[grain]]\nposition = [0.0213, 0.0371, 0.0099]\nradius = 0.01\nmaterial = \"glass\"\n" +
         body("sheet", "[0, 0, 0]", "fixed = true", "[[body.shape]]\n" + shape);
}
const std::string kSheetAsBox = "kind = \"box\"\nsize = [0.4, 0.4, 0.001]\nposition = [0, 0, -0.0005]\n";

TEST(MeshBodies, ThatAreBoxesMoveAsBoxesDo) {
  const Folder folder;
  folder.box("sheet.obj", {-0.2, -0.2, -0.001}, {0.2, 0.2, 0});
  folder.box("sheet_mm.obj", {0, 0, -1}, {400, 400, 0});
  folder.cube();
  const auto box = folder.made(grainOn(kSheetAsBox));
  const auto mesh = folder.made(grainOn("kind = \"mesh\"\nfile = \"sheet.obj\"\n"));
  const auto scaled =
      folder.made(grainOn("kind = \"mesh\"\nfile = \"sheet_mm.obj\"\nscale = 0.001\nposition = [-0.2, -0.2, 0]\n"));
  EXPECT_EQ(mesh->timeStep(), box->timeStep());
  for (const auto& s : {mesh.get(), scaled.get(), box.get()}) advanceTo(*s, 0.02);
  EXPECT_EQ(mesh->stateHash(), box->stateHash());
  EXPECT_EQ(scaled->stateHash(), box->stateHash());
  EXPECT_TRUE(cutReports(*mesh).empty()) << "no spheres";
  // On a plane and on each other.
  const auto pile = [&](const std::string& shape) {
    return folder.made(head() + kPlane + body("a", "[0, 0, 0.0505]", kTwoKilograms, shape) +
                       body("b", "[0.01, 0, 0.152]", "density = 2000\nspin = [0.5, 0, 1]\n", shape));
  };
  const auto meshes = pile("[[body.shape]]\nkind = \"mesh\"\nfile = \"cube.obj\"\n"), boxes = pile(kBoxShape);
  advanceTo(*meshes, 0.05), advanceTo(*boxes, 0.05);
  EXPECT_EQ(meshes->stateHash(), boxes->stateHash());
}

TEST(MeshBodies, ThatAreBoxesAreShapesAndNotesOfBoxes) {
  const Folder folder;
  // The corners of a box of 0.3 x 0.2 x 0.1 m, rotated by 30 degrees about x in the file.
  const double c = std::sqrt(0.75), s = 0.5;
  {
    std::ofstream file(fs::path(folder.scene()).parent_path() / "turned.obj");
    for (int i = 0; i < 8; ++i) {
      const double x = i & 1 ? 0.35 : 0.05, y = i & 2 ? 0.1 : -0.1, z = i & 4 ? 0.05 : -0.05;
      file << fmt::format("v {:.6f} {:.6f} {:.6f}\n", x, c * y - s * z, s * y + c * z);
    }
    file << "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
  }
  const auto sceneOf = [&](const std::string& shape) {
    return setup::parseScene(head() + kPlane + body("b", "[0, 0, 1]", kTwoKilograms, "[[body.shape]]\n" + shape),
                             folder.scene());
  };
  const scene::Scene scene =
      sceneOf("kind = \"mesh\"\nfile = \"turned.obj\"\nposition = [-0.2, 0, 0]\naxis = [1, 0, 0]\nangle = 15\n");
  const auto shapeOf = [](const scene::Scene& of) { return setup::mechanismSetup(of).shapes.at(0); };
  const BodyShape shape = shapeOf(scene);
  const BodyShape box = shapeOf(sceneOf("kind = \"box\"\nsize = [0.3, 0.2, 0.1]\naxis = [1, 0, 0]\nangle = 45\n"));
  EXPECT_EQ(shape.mesh, nullptr);
  EXPECT_EQ(shape.shape.shape, contact::SurfaceShape::box);
  EXPECT_LT(norm(shape.shape.half - box.shape.half), 1e-6) << "six digits of the file";
  EXPECT_LT(norm(shape.pose_B.position - box.pose_B.position), 1e-6);
  for (const Vec3d& p : {Vec3d{0.15, 0.1, 0.05}, {-0.15, 0.1, -0.05}})
    EXPECT_LT(norm(shape.pose_B.toWorld(p) - box.pose_B.toWorld(p)), 3e-6);
  EXPECT_FALSE(scene.mechanism.hasMeshes()) << "no spheres in the forecast";
  const std::vector<std::string> notes = setup::meshNotes(scene);
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_NE(notes[0].find("turned.obj: the mesh is a box of 0.3 x 0.2 x 0.1 m; contacts use the exact box"),
            std::string::npos)
      << notes[0];
  // With the key sphere_radius it consists of spheres.
  const scene::Scene spheres = sceneOf("kind = \"mesh\"\nfile = \"turned.obj\"\nsphere_radius = 0.005\n");
  EXPECT_NE(shapeOf(spheres).mesh, nullptr);
  const std::vector<std::string> advice = setup::meshNotes(spheres);
  ASSERT_EQ(advice.size(), 1u);
  EXPECT_NE(advice[0].find("the mesh is a box; remove sphere_radius"), std::string::npos) << advice[0];
}

TEST(MeshBodies, ThinSheetsAreAsAccurateAsTheirPartnersRequire) {
  const Folder folder;
  { // An angle of 1 mm sheet: profile in the x-z plane, 0.4 m long. Its own thickness does not limit its spheres.
    std::ofstream file(fs::path(folder.scene()).parent_path() / "angle.obj");
    for (const double y : {-0.2, 0.2})
      for (const char* at :
           {"-0.2 {} 0", "-0.2 {} -0.001", "0.2 {} -0.001", "0.2 {} 0.05", "0.199 {} 0.05", "0.199 {} 0"})
        file << "v " << fmt::format(fmt::runtime(at), y) << "\n";
    file << "f 1 2 3 4 5 6\nf 12 11 10 9 8 7\n";
    for (int i = 1; i <= 6; ++i) file << fmt::format("f {} {} {} {}\n", i, i + 6, i % 6 + 7, i % 6 + 1);
  }
  const auto s = folder.made(grainOn("kind = \"mesh\"\nfile = \"angle.obj\"\n"));
  const auto reports = cutReports(*s);
  ASSERT_EQ(reports.size(), 1u);
  EXPECT_DOUBLE_EQ(reports[0].limit.permitted, 0.02 * 0.01) << "a fiftieth of the grain radius";
  EXPECT_LE(reports[0].protrusion.distance, 0.02 * 0.01);
  EXPECT_LT(reports[0].spheres, 2e4);
  advanceTo(*s, 0.5);
  EXPECT_NEAR(s->ground().grains->snapshot().position[0].z, 0.01, 3e-6) << "static overlap below 2 um";
}

TEST(MeshBodies, HaveOneAnswerWhenResumedAndWithTwoThreads) {
  const Folder folder;
  folder.cube();
  const std::string text = head("time_step = 2e-5") + feet() + kPlane +
                           body("cube", "[0.01, 0, 0.0605]", kTwoKilograms + "velocity = [0.2, 0, -0.1]\n") +
                           body("other", "[0.13, 0, 0.0505]", kTwoKilograms);
  const auto straight = folder.made(text), first = folder.made(text), two = folder.made(text, 2);
  advanceTo(*straight, 0.1), advanceTo(*first, 0.06), advanceTo(*two, 0.1);
  EXPECT_EQ(two->stateHash(), straight->stateHash());
  const SimulationState saved = first->save();
  Simulation resumed(setup::simulationSetup(setup::parseScene(text, folder.scene())), base::cpuExec(1), saved);
  EXPECT_EQ(resumed.stateHash(), first->stateHash());
  advanceTo(resumed, 0.1);
  EXPECT_EQ(resumed.stateHash(), straight->stateHash());
}

TEST(MeshBodies, HollowOnesHoldGrainsAndBodies) {
  const Folder folder;
  // A tray of five overlapping walls: the inside is where the winding number is not zero.
  fs::path tray = fs::path(folder.scene()).parent_path() / "tray.obj";
  std::ofstream file(tray);
  int first = 1;
  const auto add = [&](const Vec3d& low, const Vec3d& high) {
    for (int i = 0; i < 8; ++i)
      file << fmt::format("v {} {} {}\n", i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z);
    const int faces[12][3] = {{1, 3, 4}, {1, 4, 2}, {5, 6, 8}, {5, 8, 7}, {1, 2, 6}, {1, 6, 5},
                              {3, 7, 8}, {3, 8, 4}, {1, 5, 7}, {1, 7, 3}, {2, 4, 8}, {2, 8, 6}};
    for (const auto& f : faces)
      file << fmt::format("f {} {} {}\n", f[0] + first - 1, f[1] + first - 1, f[2] + first - 1);
    first += 8;
  };
  add({-0.06, -0.06, 0}, {0.06, 0.06, 0.01});
  add({-0.06, -0.06, 0}, {-0.05, 0.06, 0.05}), add({0.05, -0.06, 0}, {0.06, 0.06, 0.05});
  add({-0.06, -0.06, 0}, {0.06, -0.05, 0.05}), add({-0.06, 0.05, 0}, {0.06, 0.06, 0.05});
  file.close();
  std::string grains;
  for (const char* place : {"[0.03, 0, 0.03]", "[-0.02, 0.02, 0.03]", "[0, -0.03, 0.03]"})
    grains += fmt::format("[[grain]]\nposition = {}\nradius = 0.01\nmaterial = \"glass\"\n", place);
  const auto s = folder.made(head() + kPlane + grains +
                             body("tray", "[0, 0, 0]", "mass = 1\nbox = [0.12, 0.12, 0.05]\n",
                                  "[[body.shape]]\nkind = \"mesh\"\nfile = \"tray.obj\"\n") +
                             body("block", "[-0.03, -0.03, 0.0251]", "mass = 0.1\nbox = [0.03, 0.03, 0.03]\n",
                                  "[[body.shape]]\nkind = \"box\"\nsize = [0.03, 0.03, 0.03]\n"));
  advanceTo(*s, 0.8);
  s->restartMeans();
  advanceTo(*s, 0.9);
  for (const Vec3d& p : s->ground().grains->snapshot().position) {
    EXPECT_NEAR(p.z, 0.02, 5e-4);
    EXPECT_LT(std::max(std::fabs(p.x), std::fabs(p.y)), 0.0405);
  }
  EXPECT_NEAR(stateOf(*s).pose[1].position.z, 0.025, 2e-4) << "the block stands in it, too";
  EXPECT_NEAR(s->mechanism()->contactForces()[0].z, kGravity, 0.01 * kGravity);
  EXPECT_NEAR(s->mechanism()->contactForces()[1].z, 0.1 * kGravity, 0.01 * kGravity);
}

TEST(MeshBodies, OverlapsAtTheStartAreRefused) {
  const Folder folder;
  folder.cube();
  const auto refused = [&](const std::string& rest, const std::string& words) {
    const std::string message = messageOf([&] { folder.made(head() + rest); });
    EXPECT_NE(message.find(words), std::string::npos) << message;
  };
  refused(feet() + body("cube", "[0, 0, 0.05]", kTwoKilograms), "body \"cube\" overlaps grain 0 of radius 0.01 m");
  refused(kPlane + body("cube", "[0, 0, 0.04]", kTwoKilograms), "overlaps plane0 by 0.01 m");
  refused(body("a", "[0, 0, 0]", kTwoKilograms) + body("b", "[0.09, 0, 0]", kTwoKilograms), "overlaps body \"");
}

TEST(MeshBodies, StepsAreLimitedAsThoseOfBoxes) {
  const Folder folder;
  folder.cube();
  const auto step = [&](const std::string& shape) {
    return setup::stepLimit(
               setup::parseScene(head() + feet() + kPlane +
                                     body("cube", "[0, 0, 0.06]", "mass = 0.001\nbox = [0.1, 0.1, 0.1]\n", shape),
                                 folder.scene()))
        .step;
  };
  EXPECT_NEAR(step(kCubeShape), step(kBoxShape), 1e-6 * step(kBoxShape));
  const std::string fast = messageOf([&] {
    folder.made(head("time_step = 1e-4") + feet() +
                body("cube", "[0, 0, 0.2]", kTwoKilograms + "velocity = [0, 0, -60]\n"));
  });
  EXPECT_NE(fast.find("body.0.velocity"), std::string::npos) << fast;
}

TEST(MeshBodies, BadFilesAndKeysAreRefusedAtTheirPlace) {
  const Folder folder;
  folder.cube();
  folder.box("open.obj", {-0.05, -0.05, -0.05}, {0.05, 0.05, 0.05}, true);
  const auto refused = [&](const std::string& shape, const std::string& words) {
    const std::string message = messageOf([&] {
      setup::parseScene(head() + kPlane + body("b", "[0, 0, 1]", kTwoKilograms, "[[body.shape]]\n" + shape),
                        folder.scene());
    });
    EXPECT_NE(message.find(words), std::string::npos) << message;
    EXPECT_NE(message.find("bodies.toml:"), std::string::npos) << message;
  };
  const std::string cube = "kind = \"mesh\"\nfile = \"cube.obj\"\n";
  refused("kind = \"mesh\"", "shape.0.file is missing, but a mesh requires it");
  refused("kind = \"mesh\"\nfile = \"cub.obj\"", "shape.0.file = \"cub.obj\" does not exist");
  refused("kind = \"mesh\"\nfile = \"open.obj\"", "cannot be used");
  refused(cube + "sphere_radius = 0.06", "shape.0.sphere_radius = 0.06 [m] is above 0.05 m");
  refused(cube + "sphere_radius = 1e-5", "lattice points");
  refused(cube + "radius = 0.1", "shape.0.radius = 0.1 does not apply to a mesh");
  refused(cube + "size = [1, 1, 1]", "does not apply to a mesh");
  refused(cube + "length = 1", "does not apply to a mesh");
  refused(cube + "angle = 3", "and angle must be set together for a mesh");
  refused("kind = \"sphere\"\nradius = 0.1\nfile = \"cube.obj\"", "does not apply to a sphere");
  refused("kind = \"sphere\"\nradius = 0.1\nsphere_radius = 0.01", "does not apply to a sphere");
  refused("kind = \"box\"\nsize = [1, 1, 1]\nscale = 2", "does not apply to a box");
}

TEST(MeshBodies, TheResolvedSceneIsTheSame) {
  const Folder folder;
  folder.cube();
  const std::string text = head() + kPlane + body("cube", "[0, 0, 0.05]", "", kCubeShape + "scale = 1\n");
  const scene::Scene scene = setup::parseScene(text, folder.scene());
  const scene::Scene again = setup::parseScene(scene::resolvedToml(scene), "elsewhere.toml");
  EXPECT_EQ(scene.mechanism, again.mechanism);
  EXPECT_EQ(setup::inputsOf(scene), setup::inputsOf(again));
  EXPECT_NE(setup::inputsOf(scene).find("body.shape.file:"), std::string::npos);
}

} // namespace
} // namespace grouser::coupling::mesh_bodies
