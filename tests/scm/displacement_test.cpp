// SPDX-License-Identifier: BSD-3-Clause
// Shoes with grousers and sides, slip sinkage, and displaced soil.
#include "base/math.hpp"
#include "scm/soil_contacts.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace grouser::scm::displacement {
namespace {

constexpr double kHalfLength = 0.068, kHalfWidth = 0.14, kPitch = 0.154; // [m] of the paper's shoes

SoilConstants lete() {
  SoilConstants s;
  s.exponent = 0.793, s.kc = 102e3, s.kphi = 5301e3, s.cohesion = 1300, s.friction = std::tan(31.1 * base::kPi / 180);
  s.shearDisplacement = 0.012, s.unitWeight = 15e3;
  return s;
}

terrain::SurfaceJet level(double, double) { return {}; }

Pad shoe(int part) {
  return {.part = part,
          .centre = {},
          .along = {1, 0, 0},
          .across = {0, 1, 0},
          .halfLength = kHalfLength,
          .halfWidth = kHalfWidth,
          .breadth = 2 * kHalfWidth};
}

contact::PartMotion at(const Vec3d& centre) {
  contact::PartMotion m{};
  m.rotation = base::Mat3d{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  m.origin = m.centre = centre;
  return m;
}

double lift(const SoilContacts& contacts, std::size_t pad = 0) { return contacts.pads().loads()[pad].force.z; }

TEST(ShoeStrength, IsTheSmallerOfSoilBlockAndPlateWithGrousers) {
  const double length = 2 * kHalfLength, width = 2 * kHalfWidth, area = length * width, force = 47.5e3 * area;
  const ShoeStrength s = shoeStrength(lete(), {2, 0.015}, length, width);
  EXPECT_NEAR(s.block.cohesion / lete().cohesion, 1.107, 0.001) << "Bekker's sides of a block of 15 mm";
  EXPECT_NEAR(s.block.friction / lete().friction, 1.052, 0.001);
  // Plate at 2/3 phi, and two faces with Rankine's passive pressure under a surcharge of 47.5 kPa.
  const double N = std::pow(std::tan((45 + 31.1 / 2) * base::kPi / 180), 2);
  const double face = 0.015 * (0.5 * 15e3 * 0.015 * N + 47.5e3 * N + 2 * 1300 * std::sqrt(N));
  const double plate = std::tan(31.1 * 2 / 3 * base::kPi / 180) * force + 2.0 / 3 * 1300 * area;
  EXPECT_NEAR(s.plate.of(area, force), plate + 2 * width * face, 1e-9 * force);
  EXPECT_EQ(s.of(area, force), s.block.of(area, force)) << "grousers hold their soil";
  const ShoeStrength smooth = shoeStrength(lete(), {0, 0}, length, width);
  EXPECT_NEAR(smooth.of(area, force), plate, 1e-9 * force) << "without grousers soil slides on steel";
}

TEST(SideResistance, FollowsHegedus) {
  // D1 = 3.5422, D2 = 3.6633 at phi = 31.1 degrees.
  const double expected = 3.5422 * (1300 * 0.03 + 3.6633 * 15e3 * 0.03 * 0.03 / 2);
  EXPECT_NEAR(SideResistance(lete()).at(0.03), expected, 1e-3 * expected);
  EXPECT_EQ(SideResistance(lete()).at(-0.01), 0);
}

TEST(PadContacts, SidesResistLateralMotion) {
  SoilMap map(0.034, level);
  Pad pad = shoe(0);
  SoilConstants smooth = lete();
  pad.grousers = Grousers{2, 0.015};
  SoilContacts with(smooth, 0.5, {}, map, {pad}, {}, 1e-3);
  SoilMap otherMap(0.034, level);
  pad.grousers = {};
  SoilContacts without(smooth, 0.5, {}, otherMap, {pad}, {}, 1e-3);
  const ShoeStrength strength = shoeStrength(smooth, {2, 0.015}, 2 * kHalfLength, 2 * kHalfWidth);
  const double depth = 0.03;
  for (int k = 0; k <= 100; ++k) {
    const contact::PartMotion m = at({0, -1.2e-3 * k, -depth});
    with.step(&m), without.step(&m);
  }
  const PadLoad &a = with.pads().loads()[0], &b = without.pads().loads()[0];
  const double side = SideResistance(smooth).at(depth) * 2 * kHalfLength;
  EXPECT_NEAR(a.force.y - b.force.y * strength.of(a.area, a.pressed) / (1300 * b.area + smooth.friction * b.pressed),
              side, 0.01 * side)
      << "the bulldozing resistance of the side that pushes";
  EXPECT_GT(side, 25);
}

TEST(PadContacts, ShearSinksAPlateAtConstantPressure) {
  SoilConstants soil = lete();
  soil.slipSinkage = 0.1, soil.maximumSlipSinkage = 0.004;
  SoilMap map(0.034, level);
  SoilContacts contacts(soil, 0.5, {}, map, {shoe(0)}, {}, 1e-3);
  const double depth = 0.01;
  contact::PartMotion m = at({0, 0, -depth});
  contacts.step(&m);
  const double before = lift(contacts);
  for (int k = 1; k <= 300; ++k) { // sinks by a tenth of the slip
    m = at({-1e-4 * k, 0, -depth - 1e-5 * k});
    contacts.step(&m);
  }
  EXPECT_NEAR(map.at(0, 0).slipSinkage, 0.003, 2e-5);
  EXPECT_NEAR(lift(contacts), before, 0.02 * before) << "the same pressure at a larger depth";
  EXPECT_GT(contacts.energy().slipSinkage, 0.5 * before * 0.003) << "the weight's work is dissipated";
  for (int k = 301; k <= 600; ++k) {
    m = at({-1e-4 * k, 0, -depth - 3e-3});
    contacts.step(&m);
  }
  EXPECT_EQ(map.at(0, 0).slipSinkage, 0.004) << "up to the limit";
}

TEST(PadContacts, WidthIsThatOfTheRunOfShoesInContact) {
  SoilMap map(0.034, level);
  std::vector<Pad> pads;
  for (int k = 0; k < 6; ++k) {
    pads.push_back(shoe(k));
    pads.back().track = 0, pads.back().pitch = kPitch;
  }
  SoilContacts contacts(lete(), 0.5, {}, map, pads, {}, 1e-3);
  const auto lay = [&](int from, int count, double x) {
    std::vector<contact::PartMotion> all;
    for (int k = 0; k < 6; ++k) all.push_back(at({x + kPitch * k, 0, k >= from && k < from + count ? -0.01 : 0.1}));
    contacts.step(all.data());
  };
  lay(1, 1, 0), lay(1, 1, 3);
  const double lone = lift(contacts, 1);
  lay(1, 3, 6), lay(1, 3, 9); // the second time as part of a track
  const double inRun = lift(contacts, 2);
  EXPECT_NEAR(lone / inRun, lete().modulusAt(2 * kHalfLength) / lete().modulusAt(2 * kHalfWidth), 1e-9);
  lay(0, 1, 12), lay(0, 1, 15);
  EXPECT_NEAR(lift(contacts, 0), lone, 1e-9 * lone) << "the loop is closed; shoes on its upper run do not count";
}

/// Loose soil on the map [m3].
double looseVolume(const SoilMap& map) {
  double sum = 0;
  map.forEach([&](std::int32_t, std::int32_t, const Node& n) { sum += n.looseThickness(); });
  return sum * map.spacing() * map.spacing();
}

TEST(Berms, HoldTheDisplacedShareOfTheRut) {
  SoilMap map(0.034, level);
  SoilContacts contacts(lete(), 0.5, {0.4, 0.6}, map, {shoe(0)}, {}, 1e-3);
  for (int k = 1; k <= 100; ++k) {
    const contact::PartMotion m = at({0, 0, -4e-4 * k});
    contacts.step(&m);
  }
  double sunk = 0, waiting = 0;
  map.forEach([&](std::int32_t, std::int32_t, const Node& n) { sunk += n.firmDepth(), waiting += n.displaced; });
  sunk *= 0.034 * 0.034, waiting *= 0.034 * 0.034;
  EXPECT_NEAR(looseVolume(map) + waiting, 0.4 * sunk, 1e-9 * sunk);
  EXPECT_EQ(looseVolume(map), contacts.movedVolume()) << "exact in quanta";
  EXPECT_GT(map.at(0, 5).surface(), 0) << "a berm beside the rut";
  EXPECT_EQ(map.at(8, 0).looseQuanta, 0) << "not ahead of the shoe";
}

TEST(Berms, SlideToTheAngleOfReposeWithoutLossOfVolume) {
  SoilMap map(0.02, level);
  Berms berms(map, 0.6);
  Node source;
  source.displaced = 0.3;
  berms.deposit(source, 0, 0, 1, 0);
  const double volume = looseVolume(map);
  EXPECT_NEAR(volume, 0.3 * 0.02 * 0.02, 1e-12);
  for (int k = 0; k < 3000; ++k) berms.slide();
  EXPECT_EQ(looseVolume(map), volume);
  double steepest = 0;
  for (int i = -20; i < 20; ++i)
    for (int j = -20; j < 20; ++j)
      for (const auto& [a, b] : {std::pair{1, 0}, std::pair{0, 1}})
        steepest = std::max(steepest, std::fabs(map.at(i, j).surface() - map.at(i + a, j + b).surface()) / 0.02);
  EXPECT_NEAR(steepest, 0.6, 0.01);
}

TEST(LoadedNodes, LooseSoilCarriesUntilTheFirmSoilCarriesMore) {
  SoilMap map(0.034, level);
  SoilContacts contacts(lete(), 0.5, {}, map, {shoe(0)}, {}, 1e-3);
  contact::PartMotion m = at({0, 0, -0.02});
  contacts.step(&m);
  m = at({0, 0, 0.2});
  contacts.step(&m);
  const double bottom = map.rutAt(0, 0);
  for (int i = -3; i <= 3; ++i)
    for (int j = -5; j <= 5; ++j) map.addLoose(map.at(i, j), std::llround(0.01 / kHeightQuantum));
  EXPECT_NEAR(map.rutAt(0, 0), bottom - 0.01, 1e-9);
  const double area = 4 * kHalfLength * kHalfWidth, k = lete().modulusAt(2 * kHalfWidth);
  m = at({0, 0, -bottom + 0.01 - 0.004});
  contacts.step(&m);
  EXPECT_NEAR(lift(contacts), area * k * std::pow(0.004, 0.793), 2e-3 * lift(contacts))
      << "like virgin soil, from its surface";
  m = at({0, 0, -0.0199});
  contacts.step(&m);
  EXPECT_NEAR(lift(contacts), area * map.at(0, 0).state.pressureAt(0.0199), 1e-6 * lift(contacts));
  EXPECT_EQ(map.at(0, 0).looseQuanta, 0) << "compacted into the firm soil";
}

} // namespace
} // namespace grouser::scm::displacement
