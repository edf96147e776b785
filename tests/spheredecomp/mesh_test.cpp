// SPDX-License-Identifier: BSD-3-Clause
#include "spheredecomp/mesh.hpp"

#include "base/error.hpp"
#include "base/math.hpp"
#include "shapes.hpp"
#include "spheredecomp/detail/outer_surface.hpp"
#include "spheredecomp/mesh_query.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>

namespace grouser::spheredecomp {
namespace {

/// Quasi-random points within [-1, 1]^3: additive recurrence with irrational steps.
Vec3d spread(int i) {
  auto part = [&](double step) { return 2 * (step * i - std::floor(step * i)) - 1; };
  return {part(0.8191725133961645), part(0.6710436067037893), part(0.5497004779019703)};
}

/// Generalised winding number by solid angles, sum / (4 pi) [-] (van Oosterom and Strackee 1983, eq. 8).
double solidAngleWinding(const TriangleMesh& mesh, const Vec3d& p) {
  double sum = 0;
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const Vec3d a = mesh.vertices[mesh.indices[i]] - p, b = mesh.vertices[mesh.indices[i + 1]] - p,
                c = mesh.vertices[mesh.indices[i + 2]] - p;
    const double la = norm(a), lb = norm(b), lc = norm(c);
    // tan(angle / 2) = a . (b x c) / (|a||b||c| + (a.b)|c| + (b.c)|a| + (c.a)|b|)
    sum += 2 * base::atan2(dot(a, cross(b, c)), la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
  }
  return sum / (4 * base::kPi);
}

/// A temporary file.
struct File {
  std::string path;
  File(const std::string& name, const std::string& text) : path(::testing::TempDir() + name) {
    std::ofstream(path) << text;
  }
  ~File() { std::filesystem::remove(path); }
};

std::string messageOf(const std::string& path) {
  try {
    importMesh(path);
  } catch (const base::InputError& error) {
    return error.what();
  }
  return "no error";
}

constexpr const char* kTetrahedron = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\n";

TEST(ImportMesh, Tetrahedron_KeepsVolumeAndWeldsVertices) {
  const File file("grouser_tetra.obj", std::string(kTetrahedron) + "f 2 3 4\n");
  const TriangleMesh mesh = importMesh(file.path);
  EXPECT_EQ(mesh.vertices.size(), 4u);
  EXPECT_EQ(mesh.indices.size(), 12u);
  EXPECT_NEAR(signedVolume(mesh), 1.0 / 6, 1e-15);
}

TEST(ImportMesh, RepeatedFaces_CountOnce) {
  const std::string whole = std::string(kTetrahedron) + "f 2 3 4\n";
  // Every face twice; turned to begin at another corner; once more with vertices of its own.
  for (const char* more : {"f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n", "f 3 2 1\nf 4 1 2\nf 4 3 1\nf 3 4 2\n",
                           "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 5 7 6\nf 5 6 8\nf 5 8 7\nf 6 7 8\n"}) {
    const File file("grouser_twice.obj", whole + more);
    std::string note;
    const TriangleMesh mesh = importMesh(file.path, &note);
    EXPECT_NEAR(signedVolume(mesh), 1.0 / 6, 1e-15);
    EXPECT_EQ(mesh.indices.size(), 12u);
    EXPECT_NE(note.find("4 repeated faces were removed"), std::string::npos) << note;
    note = "welded";
    importMesh(file.path, &note);
    EXPECT_EQ(note.find("welded; "), 0u) << "a former note remains";
  }
  const File both("grouser_both.obj", whole + "f 1 2 3\nf 1 4 2\nf 1 3 4\nf 2 4 3\n");
  EXPECT_NE(messageOf(both.path).find("its faces occur in both orientations"), std::string::npos)
      << messageOf(both.path);
}

TEST(ImportMesh, BinaryAndTextFormatsOfAssimp_AreRead) {
  const File file("grouser_tetra.stl",
                  "solid t\n"
                  "facet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 0 1 0\nvertex 1 0 0\nendloop\nendfacet\n"
                  "facet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 0 1\nendloop\nendfacet\n"
                  "facet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 0 0 1\nvertex 0 1 0\nendloop\nendfacet\n"
                  "facet normal 0 0 0\nouter loop\nvertex 1 0 0\nvertex 0 1 0\nvertex 0 0 1\nendloop\nendfacet\n"
                  "endsolid t\n");
  EXPECT_NEAR(signedVolume(importMesh(file.path)), 1.0 / 6, 1e-15);
}

TEST(ImportMesh, VerticesOfAnObjThatWouldBeDroppedOrChanged_AreRefusedWithTheirLine) {
  const auto messageFor = [](const std::string& vertex) {
    const File file("grouser_vertex.obj",
                    "v 0 0 0\nv 1 0 0\nv 0 1 0\n" + vertex + "\nv 0 0 2\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
    return messageOf(file.path);
  };
  EXPECT_NE(messageFor("v 0 0").find("grouser_vertex.obj:4: a vertex has 2 of its 3 coordinates"), std::string::npos)
      << messageFor("v 0 0");
  EXPECT_NE(messageFor("v 0 0 1.5.2").find(":4: a vertex has \"1.5.2\" instead of a number"), std::string::npos);
  EXPECT_NE(messageFor("v 0 0 1 2").find(":4: a vertex has the weight 2"), std::string::npos);
  EXPECT_NE(messageFor("v 0 0 .9").find(":4: a vertex has the number \".9\"; write 0.9"), std::string::npos);
  EXPECT_NE(messageFor("v 0 0 1 1 0").find(":4: a vertex has 5 numbers"), std::string::npos);
  EXPECT_NE(messageFor("v 0 0 1 1 0 0 1").find(":4: a vertex has 7 numbers"), std::string::npos);
  EXPECT_NE(messageFor(" v 0 0 1").find(":4: the line is indented or in upper case"), std::string::npos);
  EXPECT_NE(messageFor("V 0 0 1").find("it must begin with \"v\""), std::string::npos);
  EXPECT_NE(messageFor("v 0 0 1\n f 1 2 3").find(":5: the line is indented"), std::string::npos);
  for (const char* good : {"v 0 0 1", "v +0 0,0 1e0 # top", "v 0 0 1 1", "v 0 0 1 0.5 0.5 0.5", "v 0 0 \\\n1",
                           "v\t0   0 1.", "v -.0 0 1 # .9", "vn .9 0 0\nv 0 0 1"})
    EXPECT_EQ(messageFor(good), "no error") << good;
}

TEST(ImportMesh, AnObjOfAnotherNameOrLineEnd_IsCheckedAlike) {
  const std::string vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 .9\nv 0 0 2\n", faces = "f 1 3 2\nf 1 2 4\n";
  const File capitals("grouser_vertex.OBJ", vertices + faces);
  EXPECT_NE(messageOf(capitals.path).find("grouser_vertex.OBJ:4: a vertex has the number \".9\""), std::string::npos);
  std::string old = std::string(kTetrahedron) + "f 2 3 4\n";
  std::replace(old.begin(), old.end(), '\n', '\r');
  const File returns("grouser_returns.obj", old);
  EXPECT_NE(messageOf(returns.path).find("lines end in bare carriage returns"), std::string::npos);
  const File marked("grouser_mark.obj", "\xEF\xBB\xBF" + std::string(kTetrahedron) + "f 2 3 4\n");
  EXPECT_NE(messageOf(marked.path).find("byte-order mark precedes \"v\""), std::string::npos);
}

/// A tetrahedron; from `text`, or binary.
std::string tetrahedronAsPly(bool text, std::int32_t lastIndex = 3, const std::string& lastVertex = "0 0 1\n") {
  std::string file = std::string("ply\nformat ") + (text ? "ascii" : "binary_little_endian") +
                     " 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
                     "element face 4\nproperty list uchar int vertex_indices\nend_header\n";
  if (text)
    return file + "0 0 0\n1 0 0\n0 1 0\n" + lastVertex + "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 " +
           std::to_string(lastIndex) + "\n";
  const auto put = [&file](auto value) { file.append(reinterpret_cast<const char*>(&value), sizeof value); };
  for (const float c : {0.F, 0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 1.F}) put(c);
  for (const auto& face : {std::array{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, lastIndex}}) {
    put(std::uint8_t{3});
    for (const std::int32_t i : face) put(i);
  }
  return file;
}

TEST(ImportMesh, ADamagedPly_IsRefusedWhereverItEnds) {
  for (const bool text : {true, false}) {
    const std::string good = tetrahedronAsPly(text);
    const File file("grouser_good.ply", good);
    EXPECT_EQ(messageOf(file.path), "no error");
    // The last byte of the text is only a line end.
    for (std::size_t size = text ? good.find("end_header") : 0; size + 1 < good.size(); size += text ? 1 : 5) {
      const File cut("grouser_cut.ply", good.substr(0, size));
      EXPECT_NE(messageOf(cut.path).find("grouser_cut.ply:"), std::string::npos) << size << ": " << messageOf(cut.path);
    }
    for (const std::int32_t index : {4, -1, 1000000}) {
      const File bad("grouser_index.ply", tetrahedronAsPly(text, index));
      EXPECT_NE(messageOf(bad.path).find("face 4 refers to a vertex beyond the 4"), std::string::npos)
          << messageOf(bad.path);
    }
  }
}

TEST(ImportMesh, VerticesOfAPlyThatHaveOtherNumbersThanItsHeader_AreRefused) {
  for (const char* vertex : {"0 1\n", "0 0 1 1\n"}) {
    const File file("grouser_vertex.ply", tetrahedronAsPly(true, 3, vertex));
    EXPECT_NE(messageOf(file.path).find("grouser_vertex.ply:13: a vertex has"), std::string::npos)
        << messageOf(file.path);
  }
}

TEST(ImportMesh, BadFiles_GiveOneClearError) {
  EXPECT_NE(messageOf("/no/such/mesh.obj").find("/no/such/mesh.obj: no such file; check the path of the mesh file"),
            std::string::npos);
  const File open("grouser_open.obj", kTetrahedron);
  EXPECT_NE(messageOf(open.path).find("not watertight: 3 open edges"), std::string::npos) << messageOf(open.path);
  const File text("grouser_text.obj", "this is no mesh\n");
  EXPECT_NE(messageOf(text.path).find(text.path), std::string::npos);
  const File inward("grouser_inward.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 4 2\nf 1 3 4\nf 2 4 3\n");
  EXPECT_NE(messageOf(inward.path).find("inwards"), std::string::npos) << messageOf(inward.path);
  const File nan("grouser_nan.obj", "v 0 0 0\nv nan 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  EXPECT_NE(messageOf(nan.path).find("of the mesh is not finite"), std::string::npos) << messageOf(nan.path);
}

TEST(Winding, Cube_IsOneInsideAndZeroOutside) {
  const MeshQuery query(shapes::box({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}));
  for (int i = 1; i < 1000; ++i) {
    const Vec3d p = spread(i);
    const bool in = std::abs(p.x) < 0.5 && std::abs(p.y) < 0.5 && std::abs(p.z) < 0.5;
    ASSERT_EQ(query.winding(p), in ? 1 : 0) << i;
  }
}

TEST(Winding, VerticalLineThroughEdgesAndVertices_CountsEachShellOnce) {
  const MeshQuery cube(shapes::box({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}));
  EXPECT_EQ(cube.winding({0, 0, 0}), 1); // through the diagonals of top and bottom
  EXPECT_EQ(cube.winding({0.25, -0.25, 0}), 1);
  const MeshQuery ball(shapes::ball(1, 24)); // through the poles
  EXPECT_EQ(ball.winding({0, 0, 0}), 1);
  EXPECT_EQ(ball.winding({0, 0, 2}), 0);
  EXPECT_EQ(ball.winding({0, 0, -2}), 0);
  EXPECT_EQ(ball.winding({0.5, 0, 0}), 1); // along a meridian
}

TEST(Winding, OverlappingShells_AddUpAndAgreeWithTheSolidAngle) {
  TriangleMesh mesh = shapes::box({-0.6, -0.5, -0.5}, {0.2, 0.5, 0.5});
  mesh = shapes::box({-0.2, -0.7, -0.3}, {0.8, 0.3, 0.6}, mesh);
  const MeshQuery query(mesh);
  EXPECT_EQ(query.winding({0, 0, 0}), 2);
  for (int i = 1; i < 500; ++i) {
    const Vec3d p = spread(i);
    // Round-off of 24 solid angles, each within a few 1e-16 of 4 pi, magnified near edges.
    ASSERT_NEAR(solidAngleWinding(mesh, p), query.winding(p), 1e-10) << i;
  }
}

TEST(ClosestPoint, Box_MatchesTheClosedForm) {
  const MeshQuery query(shapes::box({-0.5, -0.4, -0.3}, {0.5, 0.4, 0.3}));
  for (int i = 1; i < 1000; ++i) {
    const Vec3d p = spread(i);
    const Vec3d q{std::abs(p.x) - 0.5, std::abs(p.y) - 0.4, std::abs(p.z) - 0.3};
    const double outside = norm(base::max(q, Vec3d{}));
    const double expected = outside > 0 ? outside : std::max({q.x, q.y, q.z});
    ASSERT_NEAR(query.signedDistance(p), expected, 4e-16) << i;
    const double d = std::abs(expected);
    ASSERT_TRUE(query.within(p, d * 1.000001));
    ASSERT_FALSE(query.within(p, d * 0.999999));
    ASSERT_EQ(query.closest(p, d * 0.999999).triangle, kNone);
  }
}

TEST(OuterSurface, OverlappingBoxes_HaveTheUnionsAreaAndVolume) {
  // Two unit cubes that share a quarter of a unit in x, shifted sideways: union 2 - 0.25 * 0.5 * 0.75.
  TriangleMesh mesh = shapes::box({0, 0, 0}, {1, 1, 1});
  mesh = shapes::box({0.75, 0.5, 0.25}, {1.75, 1.5, 1.25}, mesh);
  const double resolution = 0.005;
  const detail::OuterSurface outer(mesh, resolution);
  const double lens = 0.25 * 0.5 + 0.5 * 0.75 + 0.75 * 0.25; // half the surface of the common box
  // Pieces along the curves of intersection (total length 4 (0.25 + 0.5 + 0.75) / 2, both sides) are kept or dropped
  // whole.
  EXPECT_NEAR(outer.area(), 12 - 2 * lens, resolution * 6 * 0.2);
  EXPECT_NEAR(outer.volume(), 2 - 0.25 * 0.5 * 0.75, resolution * 6 * 0.2);
  for (const auto& sample : outer.samples(0.05)) {
    const Vec3d p = sample.point - sample.normal * 1e-9;
    const bool inFirst = p.x < 0.75 || p.y < 0.5 || p.z<0.25, inSecond = p.x> 1 || p.y > 1 || p.z > 1;
    EXPECT_TRUE(inFirst || inSecond || outer.surface().closest(p).distance < resolution);
  }
}

TEST(OuterSurface, ShellsThatTouch_LoseTheirCommonFace) {
  TriangleMesh mesh = shapes::box({0, 0, 0}, {1, 1, 1});
  mesh = shapes::box({1, 0, 0}, {2, 1, 1}, mesh);
  const detail::OuterSurface outer(mesh, 0.02);
  EXPECT_NEAR(outer.area(), 10, 1e-12);
  EXPECT_NEAR(outer.volume(), 2, 1e-12);
  // Two identical boxes form one box.
  const TriangleMesh twice = shapes::box({0, 0, 0}, {1, 1, 1}, shapes::box({0, 0, 0}, {1, 1, 1}));
  EXPECT_NEAR(detail::OuterSurface(twice, 0.05).area(), 6, 1e-12);
}

} // namespace
} // namespace grouser::spheredecomp
