// SPDX-License-Identifier: BSD-3-Clause
// Bodies on soil: a rigid wheel against the integrals of pressure and shear over its rim, a box against a pad of the
// same size, and the energies of a rolling wheel.
#include "base/math.hpp"
#include "scm/breadth.hpp"
#include "scm/soil_contacts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace grouser::scm::body_contacts {
namespace {

constexpr double kRadius = 0.25, kWidth = 0.15; // [m] of the wheel

SoilConstants drySand() {
  SoilConstants s;
  s.exponent = 1.1, s.kc = 990, s.kphi = 1528e3, s.cohesion = 1040, s.friction = std::tan(28 * base::kPi / 180);
  s.shearDisplacement = 0.025;
  return s;
}

terrain::SurfaceJet level(double, double) { return {}; }

Solid solid(const contact::SurfaceGeometry& shape, double spacing = 0.01) { return solidOf(shape, spacing); }

/// The wheel: its axis, z of the shape, is along -y; it has rotated by `turn` about +y.
contact::PartMotion wheelAt(double x, double z, double turn, double speed, double rate) {
  contact::PartMotion m{};
  const double c = std::cos(turn), s = std::sin(turn);
  m.rotation = base::Mat3d{{{c, s, 0}, {0, 0, -1}, {-s, c, 0}}};
  m.origin = m.centre = {x, 0, z};
  m.velocity = {speed, 0, 0}, m.spin = {0, rate, 0};
  return m;
}

struct WheelLoad {
  double lift, pull, torque;
};

/// Rolls at constant sinkage and slip until the contact is steady; mean over the last millimetres.
WheelLoad rolled(const SoilConstants& soil, double sinkage, double slip, double spacing, double dx) {
  SoilMap map(spacing, level);
  const contact::SurfaceGeometry wheel{contact::SurfaceShape::cylinder, {kRadius, kRadius, kWidth / 2}};
  SoilContacts contacts(soil, 0.5, {}, map, {}, {solid(wheel)}, 1e-3);
  WheelLoad mean{};
  const double end = 0.34;
  const int steps = static_cast<int>(end / dx), last = static_cast<int>(4 * spacing / dx);
  for (int k = 0; k <= steps; ++k) {
    const double x = k * dx, turn = x / (kRadius * (1 - slip));
    const contact::PartMotion m = wheelAt(x, kRadius - sinkage, turn, 0, 0);
    contacts.step(&m);
    const BodyLoad& load = contacts.bodies().loads()[0];
    if (k > steps - last)
      mean.lift += load.force.z / last, mean.pull += load.force.x / last, mean.torque -= load.torque.y / last;
  }
  return mean;
}

/// The same by integration along the ground, for nodes with shear history.
WheelLoad integrated(const SoilConstants& soil, double sinkage, double slip) {
  const double k = soil.modulusAt(kWidth);
  const double yielded = k * std::pow(sinkage, soil.exponent), stiffness = unloadingStiffness(soil, sinkage, yielded);
  const double front = std::sqrt(kRadius * kRadius - (kRadius - sinkage) * (kRadius - sinkage));
  WheelLoad sum{};
  double s = 0;
  constexpr int kPieces = 20000;
  const double dx = 2 * front / kPieces;
  for (int n = 0; n < kPieces; ++n) {
    const double x = front - (n + 0.5) * dx, sine = x / kRadius, cosine = std::sqrt(1 - sine * sine);
    const double z = sinkage - kRadius * (1 - cosine);
    const double p = x > 0 ? k * std::pow(z, soil.exponent) : yielded - stiffness * (sinkage - z);
    if (!(p > 0)) break;
    // The rim moves by (1 / (1 - i) - cos) dx against the soil while the wheel moves by dx.
    s += (1 - s) * (1 - std::exp(-(1 / (1 - slip) - cosine) * dx / soil.shearDisplacement));
    const double stress = (soil.cohesion + p * soil.friction) * s, area = kWidth * dx / cosine;
    sum.lift += area * (p * cosine + stress * sine);
    sum.pull += area * (stress * cosine - p * sine);
    sum.torque += area * stress * kRadius;
  }
  return sum;
}

TEST(BodyContacts, TowedWheelSinksAndResistsAsBekkerHasIt) {
  SoilConstants smooth = drySand();
  smooth.cohesion = smooth.friction = 0;
  smooth.elasticRatio = 1e4; // no rebound
  // Closed forms for 1 kN: z = 55.45 mm and R = b k z^(n+1) / (n+1) = 252.4 N.
  const WheelLoad plastic = rolled(smooth, 0.05545, 0, 0.01, 0.0025);
  EXPECT_NEAR(plastic.lift, 1000, 15) << "a node behind the lowest point carries load for up to one step";
  EXPECT_NEAR(plastic.pull, -252.4, 2.5);
  smooth.elasticRatio = 10; // the soil behind the lowest point rebounds: z = 46.54 mm, R = 158.0 N
  const WheelLoad elastic = rolled(smooth, 0.04654, 0, 0.01, 0.0025);
  EXPECT_NEAR(elastic.lift, 1000, 10);
  EXPECT_NEAR(elastic.pull, -158.0, 3);
}

TEST(BodyContacts, DrivenWheelPullsAsTheIntegralOverItsRim) {
  for (const double slip : {0.1, 0.4}) {
    const WheelLoad expected = integrated(drySand(), 0.0455, slip),
                    found = rolled(drySand(), 0.0455, slip, 0.01, 0.0025);
    EXPECT_NEAR(found.lift, expected.lift, 0.01 * expected.lift) << slip;
    EXPECT_NEAR(found.pull, expected.pull, 0.02 * expected.lift) << slip;
    EXPECT_NEAR(found.torque, expected.torque, 0.03 * expected.torque) << slip;
  }
}

TEST(BodyContacts, TorqueOfAWheelIsOfFirstOrderInTheStep) {
  const auto torque = [](double dx) { return rolled(drySand(), 0.0455, 0.2, 0.02, dx).torque; };
  const double coarse = torque(1e-3), fine = torque(5e-4), finest = torque(2.5e-4);
  EXPECT_NEAR((coarse - fine) / (fine - finest), 2, 0.5) << coarse << " " << fine << " " << finest;
  const double expected = integrated(drySand(), 0.0455, 0.2).torque;
  EXPECT_NEAR(2 * finest - fine, expected, 0.005 * expected) << "the residual is due to the grid";
}

/// Mean sinkage [m] of a wheel under a load [N] in two passes over the same soil, without slip.
std::pair<double, double> passes(double load) {
  SoilConstants soil = drySand();
  soil.cohesion = soil.friction = 0;
  SoilMap map(0.01, level);
  const contact::SurfaceGeometry wheel{contact::SurfaceShape::cylinder, {kRadius, kRadius, kWidth / 2}};
  SoilContacts contacts(soil, 0.5, {}, map, {}, {solid(wheel)}, 1e-3);
  double sinkage[2] = {}, z = kRadius;
  for (double& mean : sinkage) {
    contact::PartMotion above = wheelAt(-1, 1, 0, 0, 0);
    contacts.step(&above);
    for (int k = 0; k <= 400; ++k) {
      for (int iteration = 0; iteration < 5; ++iteration) {
        const contact::PartMotion m = wheelAt(1e-3 * k, z, 1e-3 * k / kRadius, 0, 0);
        contacts.step(&m);
        z += 4e-7 * (contacts.bodies().loads()[0].force.z - load);
      }
      if (k >= 200 && k < 400) mean += (kRadius - z) / 200;
    }
  }
  return {sinkage[0], sinkage[1]};
}

TEST(BodyContacts, SecondPassOfAWheelSinksSomewhatFurther) {
  // After the first pass the soil carries the wheel elastically. Within the arc in contact, the elastic load of both
  // halves is smaller than that of the virgin front half, so the wheel sinks until it is as large.
  const auto [first, second] = passes(1000);
  EXPECT_NEAR(first, 0.04654, 0.02 * 0.04654) << "see TowedWheelSinksAndResistsAsBekkerHasIt";
  EXPECT_GT(second, 1.1 * first);
  EXPECT_LT(second, 2 * first);
}

TEST(BodyContacts, WidthOfALyingCylinderOrConeIsItsSmallerSideAtAnyLength) {
  using contact::SurfaceShape;
  const contact::PartMotion lying = wheelAt(0, 0, 0, 0, 0);
  contact::PartMotion upright{};
  upright.rotation = base::Mat3d::identity();
  for (const SurfaceShape shape : {SurfaceShape::cylinder, SurfaceShape::cone})
    for (const double halfLength : {0.0999, 0.1, 0.1001}) {
      const Solid round = solid({shape, {0.1, shape == SurfaceShape::cone ? 0.05 : 0.1, halfLength}});
      EXPECT_EQ(breadthOf(round, lying), 2 * std::min(0.1, halfLength)) << halfLength;
      EXPECT_EQ(breadthOf(round, upright), 0.1) << halfLength;
    }
  for (const contact::PartMotion& pose : {lying, upright})
    EXPECT_EQ(breadthOf(solid({SurfaceShape::capsule, {0.1, 0.1, 0}}), pose), 0.1) << "a ball is round on any side";
}

TEST(BodyContacts, BoxPressesAndSlidesAsAPadOfItsSize) {
  const Vec3d half{0.068, 0.136, 0.01}; // whole and half squares of the grid
  SoilMap ofBox(0.034, level), ofPad(0.034, level);
  SoilConstants soil = drySand();
  soil.damping = 1e4;
  SoilContacts box(soil, 0.5, {}, ofBox, {}, {solid({contact::SurfaceShape::box, half})}, 1e-3);
  const Pad plate{.part = 0,
                  .centre = {0, 0, -half.z},
                  .along = {1, 0, 0},
                  .across = {0, 1, 0},
                  .halfLength = half.x,
                  .halfWidth = half.y,
                  .breadth = 2 * half.x};
  SoilContacts pad(soil, 0.5, {}, ofPad, {plate}, {}, 1e-3);
  for (int k = 0; k < 100; ++k) {
    contact::PartMotion m{};
    m.rotation = base::Mat3d{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    m.origin = m.centre = {1e-5 * k, 3e-6 * k, half.z - 0.02};
    box.step(&m), pad.step(&m);
    const Vec3d a = box.bodies().loads()[0].force, b = pad.pads().loads()[0].force;
    EXPECT_LT(norm(a - b), 2e-3 * norm(b)) << k;
  }
  EXPECT_LT(box.bodies().loads()[0].force.x, -0.02 * box.bodies().loads()[0].force.z) << "shear opposes the motion";
}

/// Work of a rolling and sliding wheel minus the energies of the soil [J].
double unexplained(int steps, double& turnover) {
  SoilMap map(0.02, level);
  SoilConstants soil = drySand();
  soil.damping = 1e4, soil.slipSinkage = 0.05, soil.maximumSlipSinkage = 0.01;
  const contact::SurfaceGeometry wheel{contact::SurfaceShape::cylinder, {kRadius, kRadius, kWidth / 2}};
  const double dt = 0.2 / steps;
  SoilContacts contacts(soil, 0.5, {0.5, 0.5}, map, {}, {solid(wheel)}, dt);
  double work = 0;
  for (int k = 0; k <= steps; ++k) {
    const double t = k * dt, sink = 2, roll = 1.2;
    contact::PartMotion m =
        wheelAt(t, kRadius + 0.001 - 0.03 * std::sin(sink * t), roll * t / kRadius, 1, roll / kRadius);
    m.velocity.z = -0.03 * sink * std::cos(sink * t);
    contacts.step(&m);
    const BodyLoad& load = contacts.bodies().loads()[0];
    work -= (k == 0 || k == steps ? 0.5 : 1) * dt * (dot(load.force, m.velocity) + dot(load.torque, m.spin));
  }
  const SoilEnergy& e = contacts.energy();
  turnover = e.compaction + e.shear;
  EXPECT_GT(e.slipSinkage, 0);
  return work - (e.elastic + e.elasticShear + e.lost());
}

TEST(BodyContacts, EnergyOfAWheelIsHeldOrLost) {
  double turnover = 0;
  const double coarse = unexplained(200, turnover), fine = unexplained(400, turnover),
               finest = unexplained(800, turnover);
  EXPECT_GT(turnover, 0.5);
  for (const double error : {coarse, fine, finest}) EXPECT_LT(std::fabs(error), 2e-3 * turnover) << error;
}

TEST(BodyContacts, ContinuesFromASavedStateWithTheSameBits) {
  const contact::SurfaceGeometry ball{contact::SurfaceShape::capsule, {0.1, 0.1, 0}};
  SoilConstants soil = drySand();
  soil.slipSinkage = 0.1, soil.maximumSlipSinkage = 0.01;
  const auto make = [&](SoilMap& map) { return SoilContacts(soil, 0.5, {0.5, 0.5}, map, {}, {solid(ball)}, 1e-3); };
  const auto advance = [](SoilContacts& contacts, int from, int to) {
    for (int k = from; k < to; ++k) {
      contact::PartMotion m = wheelAt(1e-3 * k, 0.08 - 1e-4 * k, 0.02 * k, 1, 20);
      contacts.step(&m);
    }
  };
  SoilMap first(0.02, level), second(0.02, level);
  SoilContacts straight = make(first), resumed = make(second);
  advance(straight, 0, 60);
  ASSERT_TRUE(resumed.restore(straight.save()));
  advance(straight, 60, 120), advance(resumed, 60, 120);
  EXPECT_EQ(straight.save(), resumed.save());
  EXPECT_GT(straight.movedVolume(), 0);
  SoilMap third(0.02, level);
  SoilContacts other(soil, 0.5, {0.5, 0.5}, third, {}, {solid(ball), solid(ball)}, 1e-3);
  EXPECT_FALSE(other.restore(straight.save())) << "another number of bodies";
}

} // namespace
} // namespace grouser::scm::body_contacts
