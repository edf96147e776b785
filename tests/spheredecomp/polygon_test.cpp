// SPDX-License-Identifier: BSD-3-Clause
// Faces with many corners, and vertices that differ by rounding in the file.
#include "spheredecomp/detail/polygon.hpp"

#include "base/error.hpp"
#include "base/math.hpp"
#include "spheredecomp/decompose.hpp"
#include "spheredecomp/mesh.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

namespace grouser::spheredecomp {
namespace {

using Outline = std::vector<std::array<double, 2>>;

Outline lShape() { return {{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 2}, {0, 2}}; }
Outline star(int points) {
  Outline o;
  for (int k = 0; k < 2 * points; ++k) {
    const double a = base::kPi * k / points, r = k % 2 == 0 ? 1 : 0.3;
    o.push_back({r * base::cos(a), r * base::sin(a)});
  }
  return o;
}
Outline comb(int teeth) {
  Outline o{{0, -0.2}};
  o.push_back({2.0 * teeth - 1, -0.2});
  for (int k = teeth - 1; k >= 0; --k) {
    o.push_back({2.0 * k + 1, 5}), o.push_back({2.0 * k, 5});
    if (k > 0) o.push_back({2.0 * k, 0}), o.push_back({2.0 * k - 1, 0});
  }
  return o;
}
/// A square with a square hole, connected to the outline by a bridge.
Outline bridged() { return {{0, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 0}, {1, 1}, {1, 3}, {3, 3}, {3, 1}, {1, 1}}; }
/// Corners on straight sides, one of them duplicate.
Outline split() { return {{0, 0}, {1, 0}, {2, 0}, {3, 0}, {3, 1}, {3, 1}, {1, 1}, {1, 1.5}, {1, 2}, {0, 2}, {0, 1}}; }
Outline spiral() {
  Outline out, in;
  for (int k = 0; k <= 60; ++k) {
    const double a = 0.2 * k, r = 0.2 + 0.1 * a;
    out.push_back({r * base::cos(a), r * base::sin(a)});
    in.push_back({(r - 0.05) * base::cos(a), (r - 0.05) * base::sin(a)});
  }
  out.insert(out.end(), in.rbegin(), in.rend());
  return out;
}

double areaOf(const Outline& o) {
  double sum = 0;
  for (std::size_t k = 0; k < o.size(); ++k) {
    const auto &a = o[k], &b = o[(k + 1) % o.size()];
    sum += 0.5 * (a[0] * b[1] - b[0] * a[1]);
  }
  return sum;
}
double perimeterOf(const Outline& o) {
  double sum = 0;
  for (std::size_t k = 0; k < o.size(); ++k) {
    const auto &a = o[k], &b = o[(k + 1) % o.size()];
    sum += std::hypot(b[0] - a[0], b[1] - a[1]);
  }
  return sum;
}

/// Corners of the prism's lower and upper end, rotated about an oblique axis.
std::vector<Vec3d> cornersOf(const Outline& o, double height, double turn) {
  const base::Quat q{base::cos(turn / 2), base::sin(turn / 2) * 0.6, base::sin(turn / 2) * 0.48,
                     base::sin(turn / 2) * 0.64};
  std::vector<Vec3d> corners;
  for (const double z : {0.0, height})
    for (const auto& [x, y] : o) corners.push_back(base::rotate(q, {x, y, z}));
  return corners;
}

std::string prismAsObj(const Outline& o, double turn) {
  std::string text, lower = "f", upper = "f";
  const std::size_t n = o.size();
  for (const Vec3d& c : cornersOf(o, 0.5, turn)) text += fmt::format("v {:.9g} {:.9g} {:.9g}\n", c.x, c.y, c.z);
  for (std::size_t k = 0; k < n; ++k) {
    lower += fmt::format(" {}", n - k), upper += fmt::format(" {}", n + k + 1);
    text += fmt::format("f {} {} {} {}\n", k + 1, (k + 1) % n + 1, n + (k + 1) % n + 1, n + k + 1);
  }
  return text + lower + "\n" + upper + "\n";
}
std::string prismAsPly(const Outline& o, double turn) {
  const std::size_t n = o.size();
  std::string text = fmt::format("ply\nformat ascii 1.0\nelement vertex {}\nproperty float x\nproperty float y\n"
                                 "property float z\nelement face {}\nproperty list uchar int vertex_indices\n"
                                 "end_header\n",
                                 2 * n, n + 2);
  for (const Vec3d& c : cornersOf(o, 0.5, turn)) text += fmt::format("{:.9g} {:.9g} {:.9g}\n", c.x, c.y, c.z);
  std::string lower = fmt::format("{}", n), upper = lower;
  for (std::size_t k = 0; k < n; ++k) {
    lower += fmt::format(" {}", n - 1 - k), upper += fmt::format(" {}", n + k);
    text += fmt::format("4 {} {} {} {}\n", k, (k + 1) % n, n + (k + 1) % n, n + k);
  }
  return text + lower + "\n" + upper + "\n";
}

/// The mesh of a text, through a temporary file.
TriangleMesh imported(const std::string& text, const std::string& ending, std::string* note = nullptr) {
  const std::string path =
      ::testing::TempDir() + "grouser_" + ::testing::UnitTest::GetInstance()->current_test_info()->name() + ending;
  std::ofstream(path) << text;
  struct Remove {
    const std::string& path;
    ~Remove() { std::filesystem::remove(path); }
  } remove{path};
  return importMesh(path, note);
}

// Files contain floats: coordinates are accurate to 6e-8 of their size, areas to a few times that.
TEST(ImportMesh, NGons_HaveVolumeAndAreaOfTheirPrism) {
  constexpr double kFloat = 1e-6;
  for (const Outline& o : {lShape(), star(5), star(17), comb(4), comb(9), bridged(), split(), spiral()})
    for (const double turn : {0.0, 0.7, 2.5}) {
      const double area = areaOf(o);
      for (const TriangleMesh& mesh : {imported(prismAsObj(o, turn), ".obj"), imported(prismAsPly(o, turn), ".ply")}) {
        EXPECT_NEAR(signedVolume(mesh), 0.5 * area, kFloat * area * 3) << o.size() << " corners, turned by " << turn;
        EXPECT_NEAR(spheredecomp::area(mesh), 2 * area + 0.5 * perimeterOf(o), kFloat * (area + perimeterOf(o)))
            << o.size() << " corners, turned by " << turn;
      }
    }
}

/// About a point, with radii of an additive recurrence: simple, and seldom convex.
Outline uneven(int corners, int seed) {
  Outline o;
  for (int k = 0; k < corners; ++k) {
    const double u = 0.7548776662466927 * (k + 1) * (seed + 1), r = 0.15 + (u - std::floor(u));
    const double a = 2 * base::kPi * k / corners;
    o.push_back({r * base::cos(a), r * base::sin(a)});
  }
  return o;
}

TEST(ImportMesh, NGonsOfAnyOutline_HaveVolumeAndAreaOfTheirPrism) {
  for (int seed = 0; seed < 60; ++seed) {
    const Outline o = uneven(4 + seed % 23, seed);
    const TriangleMesh mesh = imported(prismAsObj(o, 0.37 * seed), ".obj");
    EXPECT_NEAR(signedVolume(mesh), 0.5 * areaOf(o), 3e-6) << o.size() << " corners, seed " << seed;
    EXPECT_NEAR(spheredecomp::area(mesh), 2 * areaOf(o) + 0.5 * perimeterOf(o), 2e-5) << "seed " << seed;
  }
}

TEST(Triangulate, OrderOfCornersAndDirectionDoNotMatter) {
  for (Outline o : {lShape(), star(5), comb(4), split()})
    for (std::size_t first = 0; first < o.size(); ++first) {
      std::rotate(o.begin(), o.begin() + 1, o.end());
      std::vector<Vec3d> corners;
      for (const auto& [x, y] : o) corners.push_back({x, y, 0.25 * x});
      for (int pass = 0; pass < 2; ++pass) {
        double sum = 0; // seen from above, all of one sign
        for (const auto& [a, b, c] : detail::triangulate(corners))
          sum += std::fabs(0.5 * cross(corners[b] - corners[a], corners[c] - corners[a]).z);
        EXPECT_NEAR(sum, areaOf(o), 1e-12) << o.size() << " corners from " << first;
        std::reverse(corners.begin(), corners.end());
      }
    }
}

/// Triangles of a mesh by their corners' positions.
std::vector<Vec3d> cornersOf(const TriangleMesh& mesh) {
  std::vector<Vec3d> corners;
  for (const std::uint32_t i : mesh.indices) corners.push_back(mesh.vertices[i]);
  return corners;
}

struct Faces {
  std::vector<Vec3d> vertices;
  std::vector<std::vector<std::size_t>> faces;

  std::string asObj() const {
    std::string text;
    for (const Vec3d& v : vertices) text += fmt::format("v {:.9g} {:.9g} {:.9g}\n", v.x, v.y, v.z);
    for (const auto& face : faces) {
      text += "f";
      for (const std::size_t i : face) text += fmt::format(" {}", i + 1);
      text += "\n";
    }
    return text;
  }
};

Faces torus() {
  constexpr std::size_t kAround = 20, kAcross = 8;
  Faces t;
  for (std::size_t i = 0; i < kAround; ++i)
    for (std::size_t j = 0; j < kAcross; ++j) {
      const double a = 2 * base::kPi * static_cast<double>(i) / kAround,
                   b = 2 * base::kPi * static_cast<double>(j) / kAcross, r = 1 + 0.25 * base::cos(b);
      t.vertices.push_back({r * base::cos(a), r * base::sin(a), 0.25 * base::sin(b)});
      const std::size_t next = (i + 1) % kAround, up = (j + 1) % kAcross;
      t.faces.push_back({i * kAcross + j, next * kAcross + j, next * kAcross + up, i * kAcross + up});
    }
  return t;
}

// Sphere sets, and their hashes, depend on the triangles: quads must keep their fan.
TEST(ImportMesh, Quads_KeepTheirFan) {
  const Faces box{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}},
                  {{0, 3, 2, 1}, {4, 5, 6, 7}, {5, 4, 0, 1}, {6, 5, 1, 2}, {7, 6, 2, 3}, {4, 7, 3, 0}}};
  Faces saddle = box;
  for (const std::size_t k : {4u, 6u}) saddle.vertices[k].z = 1.5;
  for (const Faces& f : {box, saddle, torus()}) {
    std::vector<Vec3d> expected;
    for (const auto& face : f.faces)
      for (const std::size_t k : {0u, 1u, 2u, 0u, 2u, 3u}) expected.push_back(f.vertices[face[k]]);
    const std::vector<Vec3d> corners = cornersOf(imported(f.asObj(), ".obj"));
    ASSERT_EQ(corners.size(), expected.size());
    for (std::size_t i = 0; i < corners.size(); ++i)
      EXPECT_NEAR(norm(corners[i] - expected[i]), 0, 1e-6) << "corner " << i; // floats
  }
  // The diagonal of the top joins the upper corners; the other one would give 1.0 + 1/6.
  EXPECT_NEAR(signedVolume(imported(saddle.asObj(), ".obj")), 1 + 2.0 / 6, 1e-6);
}

TEST(ImportMesh, ConvexNGons_KeepTheTrianglesOfBefore) {
  Outline hexagon{{4, 0}, {2, 3}, {-2, 3}, {-4, 0}, {-2, -3}, {2, -3}};
  const std::string origin = cutOrigin(imported(prismAsObj(hexagon, 0), ".obj"), {});
  EXPECT_NE(origin.find("hash d036328000f63996"), std::string::npos) << origin;
}

TEST(Triangulate, AnOutlineThatCrossesItselfIsRefused) {
  EXPECT_TRUE(detail::triangulate({{0, 0, 0}, {3, 0, 0}, {3, 2, 0}, {1, -1, 0}, {0, 2, 0}}).empty());
  std::string bow = prismAsObj({{0, 0}, {3, 0}, {3, 2}, {1, -1}, {0, 2}}, 0);
  try {
    imported(bow, ".obj");
    FAIL() << "accepted";
  } catch (const base::InputError& error) {
    EXPECT_NE(std::string(error.what()).find("face of 5 corners crosses itself"), std::string::npos) << error.what();
  }
}

/// A box whose faces have separate corners, written with `digits`, the upper ones displaced by `apart`.
std::string looseBox(double thickness, double apart) {
  const auto corner = [&](int i) { return Vec3d{i & 1 ? 0.4 : 0, i & 2 ? 0.4 : 0, i & 4 ? thickness : 0}; };
  std::string text, faces;
  int count = 0;
  for (const auto& f : {std::array{0, 2, 3, 1}, std::array{4, 5, 7, 6}, std::array{0, 1, 5, 4}, std::array{2, 6, 7, 3},
                        std::array{0, 4, 6, 2}, std::array{1, 3, 7, 5}}) {
    faces += "f";
    for (const int i : f) {
      const Vec3d c = corner(i);
      const double off = apart * ((count * 7) % 5 - 2) / 2;
      text += fmt::format("v {:.9f} {:.9f} {:.9f}\n", c.x + off, c.y - off, c.z + 0.5 * off);
      faces += fmt::format(" {}", ++count);
    }
    faces += "\n";
  }
  return text + faces;
}

TEST(ImportMesh, VerticesApartByRounding_AreWeldedAndTold) {
  std::string note;
  const TriangleMesh mesh = imported(looseBox(0.001, 4e-7), ".obj", &note);
  EXPECT_EQ(mesh.vertices.size(), 8u);
  EXPECT_NEAR(signedVolume(mesh), 0.4 * 0.4 * 0.001, 0.16 * 1e-6);
  EXPECT_NE(note.find("14 vertices"), std::string::npos) << note;
  note.clear();
  imported(looseBox(0.001, 0), ".obj", &note);
  EXPECT_EQ(note, "") << "equal vertices are welded without a message";
}

TEST(ImportMesh, VerticesOfFiveDigits_AreWelded) {
  std::string note;
  EXPECT_EQ(imported(looseBox(0.01, 1.5e-6), ".obj", &note).vertices.size(), 8u);
  EXPECT_NE(note.find("14 vertices"), std::string::npos) << note;
  try {
    imported(looseBox(0.01, 1e-4), ".obj");
    FAIL() << "accepted";
  } catch (const base::InputError& error) {
    EXPECT_NE(std::string(error.what()).find("of their vertices are within 0.00057 m of another: merge these"),
              std::string::npos)
        << error.what();
  }
}

TEST(ImportMesh, WeldingDoesNotCollapseAThinSheet) {
  std::string note;
  EXPECT_NEAR(signedVolume(imported(looseBox(1e-4, 4e-7), ".obj", &note)), 0.16 * 1e-4, 0.16 * 1e-6);
  // Thinner than the welding distance: the mesh stays open instead of changing its shape.
  EXPECT_THROW(imported(looseBox(1e-6, 4e-7), ".obj"), base::InputError);
  EXPECT_THROW(imported(looseBox(0.001, 1e-4), ".obj"), base::InputError) << "real gaps stay open";
}

} // namespace
} // namespace grouser::spheredecomp
