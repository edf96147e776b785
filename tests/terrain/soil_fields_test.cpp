// SPDX-License-Identifier: BSD-3-Clause
// Stress, strain rate, porosity, velocity and coordination on a grid.
#include "terrain/soil_fields.hpp"
#include "tests/device_under_test.hpp"
#include "tests/terrain/surface_fixture.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace grouser::terrain::testing {
namespace {

constexpr double kFloat = 2e-7; // relative: forces, springs and velocities are floats

/// Integral of the stress over the box [N m].
Tensor6 totalOf(const SoilFields& fields) {
  Tensor6 sum{};
  for (const Tensor6& cell : fields.stress)
    for (std::size_t k = 0; k < 6; ++k) sum[k] += cell[k] * fields.grid.cellVolume();
  return sum;
}

TEST(SoilFields, TwoPressedSpheresCarryForceTimesDistance) {
  const GrainModel m = ball(1e-5);
  const Vec3d n{1.0 / 3, 2.0 / 3, 2.0 / 3};
  const double overlap = 1e-4, distance = 2 * m.radius - overlap;
  Grains grains(testExec(), m, {}, {{{0, 0, 0}, {}, {}}, {distance * n, {}, {}}});
  grains.refreshNeighbours();
  const SoilFields fields = fieldsOf(grains, fieldGrid({-0.02, -0.02, -0.02}, {0.03, 0.03, 0.03}, 0.01, {}));
  const Tensor6 total = totalOf(fields);
  const double moment = -m.law.stiffness * overlap * distance; // compression is negative
  const double resolution = 1e-9 / overlap;                    // resolution of positions [overlap]
  std::size_t k = 0;
  for (int a = 0; a < 3; ++a)
    for (int b = a; b < 3; ++b, ++k)
      EXPECT_NEAR(total[k], moment * n[a] * n[b], (kFloat + resolution) * std::fabs(moment)) << a << b;
}

/// Grains in a cubic lattice, all touching or apart.
std::vector<GrainSpec> lattice(int side, double spacing, const std::function<Vec3d(const Vec3d&)>& velocity) {
  std::vector<GrainSpec> start;
  for (int z = 0; z < side; ++z)
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x) {
        const Vec3d place{spacing * x, spacing * y, spacing * z};
        start.push_back({place, velocity(place), {}});
      }
  return start;
}
Vec3d still(const Vec3d&) { return {}; }

TEST(SoilFields, PorosityOfACubicLatticeIsOneLessSixthOfPi) {
  const GrainModel m = ball(1e-5);
  const double spacing = 0.0102;
  Grains grains(testExec(), m, {}, lattice(8, spacing, still));
  grains.refreshNeighbours();
  // Planes cut spheres anywhere, and in several directions: the parts of cut spheres add up to whole spheres.
  const Vec3d low{0.3 * spacing, 0.9 * spacing, 0.5 * spacing}, size{6 * spacing, 6 * spacing, 6 * spacing};
  const SoilFields fields = fieldsOf(grains, fieldGrid(low, low + size, 2 * spacing, {}));
  ASSERT_EQ(fields.grid.count(), 27u);
  const double solid = base::kPi / 6 * std::pow(2 * m.radius / spacing, 3);
  for (const double porosity : fields.porosity) EXPECT_NEAR(porosity, 1 - solid, 1e-6); // positions are whole units
}

TEST(SoilFields, GrainsCountOnceWhereverPlanesCutThem) {
  const GrainModel m = ball(1e-5);
  std::vector<GrainSpec> start;
  for (int i = 0; i < 40; ++i) start.push_back({{0.0111 * i, 0.0137 * (i % 7), 0.0119 * (i % 5)}, {}, {}});
  Grains grains(testExec(), m, {}, start);
  grains.refreshNeighbours();
  const SoilFields fields = fieldsOf(grains, fieldGrid({-0.01, -0.01, -0.01}, {0.46, 0.12, 0.08}, 0.0101, {}));
  double solid = 0;
  for (const double porosity : fields.porosity) solid += (1 - porosity) * fields.grid.cellVolume();
  const double ball = 4.0 / 3 * base::kPi * std::pow(m.radius, 3);
  EXPECT_NEAR(solid, 40 * ball, 40 * 2e-7 * ball) << "radii are single precision, volumes go as the cube";
}

TEST(SoilFields, ABallCutByAPlaneFillsASphericalSegmentOnEitherSide) {
  const GrainModel m = ball(1e-5);
  const double h = 0.3 * m.radius; // above the plane
  Grains grains(testExec(), m, {}, {{{0.005, 0.005, 0.01 - m.radius + h}, {}, {}}});
  grains.refreshNeighbours();
  const SoilFields fields = fieldsOf(grains, fieldGrid({0, 0, 0}, {0.01, 0.01, 0.02}, 0.01, {}));
  ASSERT_EQ(fields.grid.cells, (std::array{1, 1, 2}));
  const double segment = base::kPi * h * h * (m.radius - h / 3);
  EXPECT_NEAR((1 - fields.porosity[1]) * fields.grid.cellVolume() / segment, 1, 1e-5) << "positions are whole units";
}

TEST(SoilFields, LinearVelocityFieldHasItsStrainRate) {
  // A rotation, which has no strain rate, plus shear and stretch.
  const Vec3d spin{3, -2, 5};
  const double gradient[3][3] = {{0.7, 1.1, 0}, {0, -0.4, 0.9}, {0.2, 0, 0.3}};
  const GrainModel m = ball(1e-6);
  const auto velocity = [&](const Vec3d& x) {
    Vec3d v = Vec3d{0.5, 0.2, -0.1} + cross(spin, x);
    for (int a = 0; a < 3; ++a) v[a] += gradient[a][0] * x.x + gradient[a][1] * x.y + gradient[a][2] * x.z;
    return v;
  };
  Grains grains(testExec(), m, {}, lattice(8, 0.0107, velocity));
  grains.refreshNeighbours();
  const SoilFields fields = fieldsOf(grains, fieldGrid({-0.004, -0.007, -0.001}, {0.08, 0.08, 0.08}, 0.025, {}));
  for (const Tensor6& rate : fields.strainRate) {
    std::size_t k = 0;
    for (int a = 0; a < 3; ++a)
      for (int b = a; b < 3; ++b, ++k)
        EXPECT_NEAR(rate[k], 0.5 * (gradient[a][b] + gradient[b][a]), 1e-5) << "floats of 1 m/s over grains 1 cm apart";
  }
}

TEST(SoilFields, CellsWithoutGrainsHaveNoVelocityAndNoStress) {
  Grains grains(testExec(), ball(1e-5), {}, {{{0.005, 0.005, 0.005}, {1, 2, 3}, {}}});
  grains.refreshNeighbours();
  const SoilFields fields = fieldsOf(grains, fieldGrid({0, 0, 0}, {0.03, 0.01, 0.01}, 0.01, {}));
  ASSERT_EQ(fields.grid.cells, (std::array{3, 1, 1}));
  EXPECT_EQ(fields.velocity[0], (Vec3d{1, 2, 3}));
  EXPECT_EQ(fields.coordination[0], 0);
  EXPECT_TRUE(std::isnan(fields.mechanicalCoordination[0])) << "it has fewer than two contacts";
  EXPECT_TRUE(std::isnan(fields.strainRate[0][0])) << "one grain has no gradient";
  EXPECT_EQ(fields.porosity[2], 1);
  EXPECT_TRUE(std::isnan(fields.velocity[2].x));
  EXPECT_EQ(fields.stress[2], Tensor6{});
}

/// Rough grains in a slightly disordered face-centred lattice, pressed together by six smooth planes; each plane is
/// a surface with known load.
struct PressedBox {
  static constexpr int kSites = 6; ///< along each axis; every other one holds a grain
  static constexpr std::int64_t kGrains = 108;
  GrainModel model;
  Vec3d low, high;
  std::unique_ptr<Grains> grains;

  PressedBox(bool gravity, int threads, std::int64_t steps, Precision precision = Precision::single) {
    model = gravel();
    model.precision = precision;
    if (!gravity) model.gravity = {};
    const double radius = model.radius, overlap = 5e-4, site = (2 * radius - overlap) / std::sqrt(2.0);
    std::vector<GrainSpec> start;
    for (int k = 0; k < kSites * kSites * kSites; ++k) {
      const int x = k % kSites, y = k / kSites % kSites, z = k / (kSites * kSites);
      const double out = 1e-4 * ((7 * x + 5 * y + 3 * z) % 4 - 1.5);
      if ((x + y + z) % 2 == 0) start.push_back({{site * x + out, site * y - out, site * z + 0.5 * out}, {}, {}});
    }
    const double rim = radius - overlap / 2, extent = site * (kSites - 1) + rim;
    low = {-rim, -rim, -rim}, high = {extent, extent, extent};
    contact::ContactLaw smooth = model.law;
    smooth.friction = 0;
    const Vec3d inward[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    Boundaries sides;
    for (const Vec3d& n : inward) {
      const Vec3d axis = std::fabs(n.z) < 0.5 ? normalized(cross({0, 0, 1}, n)) : Vec3d{1, 0, 0};
      const double angle = n.z > 0.5 ? 0 : n.z < -0.5 ? base::kPi : base::kPi / 2;
      sides.surfaces.push_back(
          {{SurfaceShape::plane, {}}, smooth, placed(n.x + n.y + n.z > 0 ? low : high, turn(axis, angle))});
    }
    grains = std::make_unique<Grains>(testExec(threads), model, sides, start);
    advance(*grains, steps);
    grains->refreshNeighbours();
  }
  /// Force on plane k along its outward normal.
  double load(std::size_t k) const {
    const Vec3d f = grains->system().boundaries.surfaceLoads()[k].force;
    return k % 2 == 0 ? -f[static_cast<int>(k / 2)] : f[static_cast<int>(k / 2)];
  }
  SoilFields fields(double edge) const { return fieldsOf(*grains, fieldGrid(low - pad(), high + pad(), edge, {})); }
  static Vec3d pad() { return {0.03, 0.03, 0.03}; } // grains overlap the planes slightly
};

constexpr std::int64_t kToRest = 4000; // a fifth of a second: hundreds of contact periods

TEST(SoilFields, MeanStressOfABoxAtRestIsTheLoadOfItsWalls) {
  const PressedBox box(false, 1, kToRest);
  const Tensor6 total = totalOf(box.fields(0.06));
  const std::size_t diagonal[] = {0, 3, 5};
  const Vec3d size = box.high - box.low;
  for (int a = 0; a < 3; ++a) {
    const std::size_t k = 2 * static_cast<std::size_t>(a);
    const double area = size.x * size.y * size.z / size[a], pressure = box.load(k) / area;
    EXPECT_GT(pressure, 1e3);
    EXPECT_NEAR(box.load(k) / box.load(k + 1), 1, 1e-4) << "at rest";
    const double stress = total[diagonal[a]] / (area * size[a]);
    EXPECT_NEAR(stress / -pressure, 1, 0.002) << "axis " << a;
    RecordProperty("ratio " + std::to_string(a), std::to_string(stress / -pressure));
  }
}

TEST(SoilFields, WeightAddsItsMomentToTheLoadsOfTheWalls) {
  const PressedBox box(true, 1, kToRest);
  const Tensor6 total = totalOf(box.fields(0.06));
  double moment = 0; // sum of force times height over floor, lid and weight
  const auto snapshot = box.grains->snapshot();
  for (const Vec3d& x : snapshot.position) moment += box.model.mass * box.model.gravity.z * x.z;
  moment += box.load(4) * box.low.z - box.load(5) * box.high.z;
  EXPECT_GT(box.load(4) / box.load(5), 1.0001) << "the floor also carries the weight";
  EXPECT_NEAR(total[5] / moment, 1, 0.002);
}

TEST(SoilFields, CoordinationCountsEveryContactOfAGrain) {
  const PressedBox box(false, 1, 2000);
  const SoilFields fields = box.fields(1);
  ASSERT_EQ(fields.grid.count(), 1u);
  const GrainLedger ledger = box.grains->ledger();
  const double mean = static_cast<double>(2 * ledger.contacts + ledger.boundaryContacts) / PressedBox::kGrains;
  EXPECT_NEAR(fields.coordination[0], mean, 1e-9);
  EXPECT_GE(fields.mechanicalCoordination[0], mean - 1e-9);
}

TEST(SoilFields, MeasuringChangesNoBitOfTheState) {
  const PressedBox once(true, 1, 300), twice(true, 1, 300);
  twice.fields(0.06);
  EXPECT_EQ(once.grains->state().words(), twice.grains->state().words());
  advance(*once.grains, 300), advance(*twice.grains, 300);
  EXPECT_EQ(once.grains->state().words(), twice.grains->state().words());
}

TEST(SoilFields, SameBitsForThreadsAndRebuilds) {
  for (const Precision precision : {Precision::single, Precision::double_}) {
    const PressedBox one(true, 1, 500, precision), two(true, 2, 500, precision);
    two.grains->invalidateNeighbours();
    two.grains->refreshNeighbours();
    const SoilFields a = one.fields(0.06), b = two.fields(0.06);
    EXPECT_EQ(a.stress, b.stress);
    EXPECT_EQ(a.porosity, b.porosity);
    ASSERT_EQ(a.grid.count(), b.grid.count());
    for (std::size_t c = 0; c < a.grid.count(); ++c) {
      ASSERT_EQ(std::isnan(a.velocity[c].x), std::isnan(b.velocity[c].x));
      if (std::isnan(a.velocity[c].x)) continue; // no grains
      EXPECT_EQ(a.velocity[c], b.velocity[c]);
      EXPECT_EQ(a.coordination[c], b.coordination[c]);
    }
  }
}

TEST(SoilFields, PeriodicBoundariesAreSeamless) {
  // A lattice pressed against itself across the boundaries, which cut its grains at a third.
  const GrainModel m = ball(1e-5);
  const double spacing = 0.0099, period = 6 * spacing, shift = 0.002;
  std::vector<GrainSpec> start = lattice(6, spacing, still);
  for (GrainSpec& g : start) g.position = g.position + Vec3d{shift, shift, 0};
  Boundaries sides;
  sides.periodic = {std::array{0.0, period}, std::array{0.0, period}};
  Grains grains(testExec(), m, sides, start);
  grains.refreshNeighbours();
  const double half = 0.5 * spacing;
  const SoilFields fields =
      fieldsOf(grains, fieldGrid({0, 0, -half}, {period, period, period - half}, 2 * spacing, sides.periodic));
  ASSERT_EQ(fields.grid.cells, (std::array{3, 3, 3}));
  const double pressure = m.law.stiffness * (2 * m.radius - spacing) / (spacing * spacing);
  for (std::size_t c = 0; c < 27; ++c) {
    EXPECT_NEAR(fields.stress[c][0], -pressure, 1e-3 * pressure) << c;      // places in units of 1e-4 of the overlap
    EXPECT_NEAR(fields.porosity[c], fields.porosity[c / 9 * 9], 1e-6) << c; // layer by layer: z has an end
  }
}

} // namespace
} // namespace grouser::terrain::testing
