// SPDX-License-Identifier: BSD-3-Clause
// Pads on soil: areas on the grid, a track's traction and resistance, static grip on a slope, and energies of a path.
#include "scm/soil_contacts.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace grouser::scm::pad_contacts {
namespace {

constexpr double kHalfLength = 0.068, kHalfWidth = 0.14; // [m] of the paper's shoes

SoilConstants lete() {
  SoilConstants s;
  s.exponent = 0.793, s.kc = 102e3, s.kphi = 5301e3, s.cohesion = 1300, s.friction = std::tan(31.1 * base::kPi / 180);
  s.shearDisplacement = 0.012;
  return s;
}

terrain::SurfaceJet level(double, double) { return {}; }

Pad shoe(int part) { return {part, {}, {1, 0, 0}, {0, 1, 0}, kHalfLength, kHalfWidth, 2 * kHalfWidth}; }

/// A pad at a position, rotated by a heading about z and then pitched about its own y axis.
contact::PartMotion at(Vec3d centre, double heading = 0, double pitch = 0) {
  contact::PartMotion m{};
  const double c = std::cos(heading), s = std::sin(heading), cp = std::cos(pitch), sp = std::sin(pitch);
  m.rotation = base::Mat3d{{{c * cp, -s, c * sp}, {s * cp, c, s * sp}, {-sp, 0, cp}}};
  m.origin = m.centre = centre;
  return m;
}

double pressure(double z) { return lete().modulusAt(2 * kHalfWidth) * std::pow(z, 0.793); }

TEST(PadContacts, AreaOfAPadDoesNotDependOnHowItLiesOnTheGrid) {
  const double expected = pressure(0.01) * 4 * kHalfLength * kHalfWidth;
  for (const double spacing : {0.034, 0.02, 0.01}) {
    double most = 0, sum = 0;
    for (int k = 0; k < 64; ++k) {
      SoilMap map(spacing, level);
      SoilContacts contacts(lete(), 0.5, {}, map, {shoe(0)}, {}, 1e-4);
      const contact::PartMotion m = at({0.0137 * k, 0.0071 * k, -0.01}, base::kPi * k / 64);
      contacts.step(&m);
      const double off = contacts.pads().loads()[0].force.z / expected - 1;
      most = std::max(most, std::fabs(off)), sum += off / 64;
    }
    EXPECT_LT(most, 0.15 * spacing) << spacing;
    EXPECT_LT(std::fabs(sum), 3e-4) << spacing;
    SoilMap map(spacing, level);
    SoilContacts contacts(lete(), 0.5, {}, map, {shoe(0)}, {}, 1e-4);
    for (int k = 0; k < 50; ++k) {
      const contact::PartMotion m = at({0.0013 * k, 0, -0.01});
      contacts.step(&m);
      EXPECT_NEAR(contacts.pads().loads()[0].force.z, expected, 1e-4 * expected) << "no grid dependence";
    }
  }
}

TEST(PadContacts, StressesAtNodesAddUpToTheLoads) {
  constexpr double kSpacing = 0.02, kDeep = 0.01;
  SoilMap map(kSpacing, level);
  SoilContacts contacts(lete(), 0.5, {}, map, {shoe(0), shoe(1)}, {}, 1e-4);
  // Two adjacent shoes, which share nodes, slip by 5 mm.
  contact::PartMotion m[2];
  for (const double slip : {0.0, -0.005}) {
    m[0] = at({slip, 0.003, -kDeep}, 0.3);
    m[1] = at({slip + 2 * kHalfLength * std::cos(0.3), 0.003 + 2 * kHalfLength * std::sin(0.3), -kDeep}, 0.3);
    contacts.step(m);
  }
  double pressed = 0;
  Vec3d shear, loads;
  contacts.forEachLoaded([&](const NodeStress& stress) {
    pressed += stress.pressure * kSpacing * kSpacing, shear += stress.shear * (kSpacing * kSpacing);
    EXPECT_NEAR(stress.depth, kDeep, 1e-12);
  });
  for (const PadLoad& load : contacts.pads().loads()) loads += load.force;
  EXPECT_NEAR(pressed, loads.z, 1e-9 * loads.z);
  EXPECT_LT(norm(shear + Vec3d{loads.x, loads.y, 0}), 1e-9 * norm(shear))
      << "on the soil: opposite to that on the pads";
  EXPECT_LT(shear.x, 0) << "pads that move backwards pull the soil backwards";
  // A restored state has the same stresses.
  SoilMap other(kSpacing, level);
  SoilContacts restored(lete(), 0.5, {}, other, {shoe(0), shoe(1)}, {}, 1e-4);
  ASSERT_TRUE(restored.restore(contacts.save()));
  Vec3d again;
  restored.forEachLoaded([&](const NodeStress& stress) { again += stress.shear * (kSpacing * kSpacing); });
  EXPECT_EQ(again.x, shear.x);
}

TEST(PadContacts, APitchedPadBearsByItsHorizontalArea) {
  constexpr double kPitch = 0.3, kDeep = 0.04;
  SoilMap map(0.004, level);
  SoilContacts contacts(lete(), 0.5, {}, map, {shoe(0)}, {}, 1e-4);
  const contact::PartMotion m = at({0, 0, -kDeep}, 0, kPitch);
  contacts.step(&m);
  // Its normal is inclined along x; the vertical force is the integral of p over x and y.
  double expected = 0;
  constexpr int kPieces = 2000;
  for (int i = 0; i < kPieces; ++i) {
    const double x = kHalfLength * std::cos(kPitch) * ((2 * i + 1.0) / kPieces - 1);
    expected += pressure(kDeep + x * std::tan(kPitch)) * 4 * kHalfLength * std::cos(kPitch) * kHalfWidth / kPieces;
  }
  EXPECT_NEAR(contacts.pads().loads()[0].force.z, expected, 2e-3 * expected);
  EXPECT_NEAR(contacts.pads().loads()[0].force.x / contacts.pads().loads()[0].force.z, std::tan(kPitch), 1e-9)
      << "along its own normal";
}

TEST(PadContacts, ShoesThatSlipPullAsJanosiHasIt) {
  const double z = 0.00240673, K = lete().shearDisplacement;
  SoilMap map(0.034, level);
  SoilContacts contacts(lete(), 0.5, {}, map, {shoe(0)}, {}, 1e-4);
  const double strength = lete().cohesion + 47.5e3 * lete().friction, area = 4 * kHalfLength * kHalfWidth;
  for (int i = 0; i <= 600; ++i) {
    const double slip = 1e-4 * i;
    const contact::PartMotion m = at({-slip, 0, -z});
    contacts.step(&m);
    const double expected = strength * area * (1 - std::exp(-slip / K));
    EXPECT_NEAR(contacts.pads().loads()[0].force.x, expected, 1e-3 * strength * area) << slip;
  }
  // Reversed, the force changes sign after K ln 2.
  for (int i = 0; i <= 83; ++i) {
    const contact::PartMotion m = at({-0.06 + 1e-4 * i, 0, -z});
    contacts.step(&m);
  }
  EXPECT_NEAR(contacts.pads().loads()[0].force.x, 0, 0.01 * strength * area);
}

TEST(PadContacts, LeavesARutWhoseDepthIsTheSinkageLessTheRebound) {
  SoilMap map(0.02, level);
  SoilContacts contacts(lete(), 0.5, {}, map, {shoe(0)}, {}, 1e-4);
  for (const double z : {-0.02, 0.1}) {
    const contact::PartMotion m = at({0, 0, z});
    contacts.step(&m);
  }
  EXPECT_NEAR(map.rutAt(0.013, 0.05), 0.02 * (1 - 1 / lete().elasticRatio), 1e-9) << "k_u = f p / z";
  EXPECT_EQ(map.rutAt(0.5, 0), 0);
  EXPECT_EQ(contacts.pads().loads()[0].pressed, 0);
}

TEST(PadContacts, NodesBetweenTwoPadsRememberTheDeeperWhateverTheirOrder) {
  // A row of nodes lies in the middle of the gap, under both contacts by a quarter of its area.
  const double pitch = 2 * kHalfLength + 0.018, x = -0.009;
  SoilMap other(0.034, level);
  SoilContacts alone(lete(), 0.5, {}, other, {shoe(0)}, {}, 1e-4);
  const contact::PartMotion there = at({x + pitch, 0, -0.008});
  alone.step(&there);
  std::vector<PadLoad> loads[2];
  for (const int first : {0, 1}) {
    SoilMap map(0.034, level);
    SoilContacts contacts(lete(), 0.5, {}, map, {shoe(first), shoe(1 - first)}, {}, 1e-4);
    const contact::PartMotion lower[] = {at({x, 0, -0.012}), there}, after[] = {at({x, 0, 0.1}), there};
    contacts.step(lower);
    const double together = contacts.pads().loads()[static_cast<std::size_t>(1 - first)].pressed;
    EXPECT_LT(together, 0.98 * alone.pads().loads()[0].pressed) << "the deeper pad has compacted its edge";
    contacts.step(after);
    EXPECT_EQ(contacts.pads().loads()[static_cast<std::size_t>(1 - first)].pressed, together) << "the state persists";
    loads[first] = {contacts.pads().loads()[static_cast<std::size_t>(first)],
                    contacts.pads().loads()[static_cast<std::size_t>(1 - first)]};
  }
  for (const int k : {0, 1})
    EXPECT_EQ(loads[0][static_cast<std::size_t>(k)].pressed, loads[1][static_cast<std::size_t>(k)].pressed);
}

/// Energies of a path: press, slide and turn, lift. Work on the pad equals the soil's stored and dissipated energy, up
/// to the step error, which is of first order.
double unexplained(int steps, double& turnover) {
  SoilMap map(0.034, level);
  SoilConstants soil = lete();
  soil.damping = 2e4;
  SoilContacts contacts(soil, 0.5, {}, map, {shoe(0)}, {}, 1.0 / steps);
  double work = 0;
  const double dt = 1.0 / steps;
  const auto pose = [](double t) {
    return at({0.03 * t * t, 0.01 * t, 0.001 - 0.012 * std::sin(base::kPi * t)}, 0.3 * t, 0.02 * std::sin(5 * t));
  };
  for (int i = 0; i <= steps; ++i) {
    const double t = i * dt;
    contact::PartMotion m = pose(t);
    const contact::PartMotion ahead = pose(t + 1e-6), behind = pose(t - 1e-6);
    m.velocity = (ahead.centre - behind.centre) * 5e5;
    // Spin from the difference of the rotations: R' R^T.
    const base::Mat3d &a = ahead.rotation, &b = behind.rotation;
    Vec3d spin;
    for (const Vec3d e : {Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}})
      spin += cross(m.rotation * e, (a * e - b * e) * 5e5) * 0.5;
    m.spin = spin;
    contacts.step(&m);
    const PadLoad& load = contacts.pads().loads()[0];
    const double weight = i == 0 || i == steps ? 0.5 : 1;
    work -= weight * dt * (dot(load.force, m.velocity) + dot(load.torque, m.spin));
  }
  const SoilEnergy& e = contacts.energy();
  turnover = e.compaction + e.shear;
  return work - (e.elastic + e.elasticShear + e.lost());
}

TEST(PadContacts, EnergyOfAPathIsHeldOrLost) {
  double turnover = 0;
  const double coarse = unexplained(1000, turnover), fine = unexplained(2000, turnover),
               finest = unexplained(4000, turnover);
  EXPECT_GT(turnover, 1);
  EXPECT_LT(std::fabs(finest), 0.01 * turnover) << coarse << " " << fine << " " << finest << " of " << turnover;
  EXPECT_NEAR(fine / finest, 2, 0.5) << coarse << " " << fine << " " << finest;
}

} // namespace
} // namespace grouser::scm::pad_contacts
