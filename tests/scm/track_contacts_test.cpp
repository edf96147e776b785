// SPDX-License-Identifier: BSD-3-Clause
// Two tracks of pads on soil: independence of the heading, yaw moments, and a loaded pad parked on a slope.
#include "scm/soil_contacts.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace grouser::scm::track_contacts {
namespace {

constexpr int kShoes = 13; // shoes per track in ground contact
constexpr double kLength = 1.85, kBreadth = 0.28, kGauge = 1.9, kPitch = kLength / kShoes; // [m]
constexpr double kPressure = 47.5e3;                                                       // [Pa]
constexpr double kSinkage = 0.00240673;                                                    // [m] at kPressure

SoilConstants lete() {
  SoilConstants s;
  s.exponent = 0.793, s.kc = 102e3, s.kphi = 5301e3, s.cohesion = 1300, s.friction = std::tan(31.1 * base::kPi / 180);
  s.shearDisplacement = 0.012;
  return s;
}

double strength() { return lete().cohesion + kPressure * lete().friction; }

terrain::SurfaceJet level(double, double) { return {}; }

/// Pads of two tracks without gaps, on one part with its origin midway between the tracks.
std::vector<Pad> twoTracks() {
  std::vector<Pad> pads;
  for (const double y : {-0.5 * kGauge, 0.5 * kGauge})
    for (int i = 0; i < kShoes; ++i)
      pads.push_back(
          {0, {kPitch * (i - 0.5 * (kShoes - 1)), y, 0}, {1, 0, 0}, {0, 1, 0}, 0.5 * kPitch, 0.5 * kBreadth, kBreadth});
  return pads;
}

contact::PartMotion at(Vec3d centre, double heading) {
  contact::PartMotion m{};
  const double c = std::cos(heading), s = std::sin(heading);
  m.rotation = base::Mat3d{{{c, -s, 0}, {s, c, 0}, {0, 0, 1}}};
  m.origin = m.centre = centre;
  return m;
}

PadLoad sumOf(const SoilContacts& contacts) {
  PadLoad sum;
  for (const PadLoad& load : contacts.pads().loads()) sum.force += load.force, sum.torque += load.torque;
  return sum;
}

TEST(TrackContacts, ForcesDoNotDependOnTheHeadingOnTheGrid) {
  const double area = 2 * kLength * kBreadth, slip = 0.012;
  const double lift = kPressure * area, pull = strength() * area * (1 - std::exp(-1.0));
  double meanLift = 0, meanPull = 0;
  for (int k = 0; k < 64; ++k) {
    SoilMap map(0.034, level);
    SoilContacts contacts(lete(), 0.5, {}, map, twoTracks(), {}, 1e-4);
    const double heading = 2 * base::kPi * k / 64;
    const Vec3d forward{std::cos(heading), std::sin(heading), 0}, middle{0.0137 * k, 0.0071 * k, -kSinkage};
    contact::PartMotion m = at(middle, heading);
    contacts.step(&m);
    m = at(middle - forward * slip, heading);
    contacts.step(&m);
    const PadLoad sum = sumOf(contacts);
    EXPECT_NEAR(sum.force.z, lift, 0.01 * lift) << k;
    EXPECT_NEAR(dot(sum.force, forward), pull, 0.01 * pull) << k;
    meanLift += sum.force.z / 64, meanPull += dot(sum.force, forward) / 64;
  }
  EXPECT_NEAR(meanLift, lift, 1e-3 * lift);
  EXPECT_NEAR(meanPull, pull, 1e-3 * pull);
}

TEST(TrackContacts, ASmallTurnIsResistedByTheShearStiffness) {
  SoilMap map(0.02, level);
  SoilContacts contacts(lete(), 0.5, {}, map, twoTracks(), {}, 1e-4);
  const double angle = 1e-6;
  for (const double heading : {0.0, angle}) {
    const contact::PartMotion m = at({0, 0, -kSinkage}, heading);
    contacts.step(&m);
  }
  const double area = 2 * kLength * kBreadth;
  const double arm2 = kLength * kLength / 12 + kBreadth * kBreadth / 12 + kGauge * kGauge / 4;
  const double stiffness = strength() / lete().shearDisplacement * area * arm2; // 3.088 MN m/rad
  EXPECT_NEAR(-sumOf(contacts).torque.z / angle, stiffness, 5e-3 * stiffness);
}

TEST(TrackContacts, MomentOfATurnOnTheSpotIsTheSumOfTheShearOfAllShoes) {
  SoilMap map(0.02, level);
  SoilContacts contacts(lete(), 0.5, {}, map, twoTracks(), {}, 1e-3);
  contact::PartMotion m{};
  for (int k = 0; k <= 400; ++k) {
    m = at({0, 0, -kSinkage}, 1e-3 * k);
    contacts.step(&m);
  }
  // Each point slips on a circle about the centre; its shear stress lags by atan(K / radius).
  double expected = 0;
  constexpr int kCells = 400;
  for (int i = 0; i < kCells; ++i)
    for (int j = 0; j < kCells; ++j) {
      const double x = kLength * ((i + 0.5) / kCells - 0.5), y = 0.5 * kGauge + kBreadth * ((j + 0.5) / kCells - 0.5);
      const double radius = std::hypot(x, y), lag = lete().shearDisplacement / radius;
      expected += 2 * strength() * radius / (1 + lag * lag) * kLength * kBreadth / (kCells * kCells);
    }
  double byShoe = 0;
  for (std::size_t k = 0; k < contacts.pads().loads().size(); ++k) {
    const Vec3d arm = m.rotation * contacts.pads().pads()[k].centre, force = contacts.pads().loads()[k].force;
    byShoe += arm.x * force.y - arm.y * force.x;
  }
  EXPECT_NEAR(-sumOf(contacts).torque.z, expected, 0.01 * expected);
  EXPECT_NEAR(byShoe, sumOf(contacts).torque.z, 2e-3 * expected) << "forces at the middles of the shoes";
}

TEST(TrackContacts, DampingOfShearFadesWithTheSlipAndIsAHundredthOfTheStrengthAtMost) {
  constexpr double kStep = 1e-4, kSpeed = 0.01; // s, m/s
  const double area = 2 * kLength * kBreadth, full = strength() * area;
  for (const double damping : {2e4, 1e7}) { // Pa s/m
    SoilMap map(0.034, level);
    SoilConstants soil = lete();
    soil.damping = damping;
    SoilContacts contacts(soil, 0.5, {}, map, twoTracks(), {}, kStep);
    double lost = 0;
    for (int k = 0; k <= 20000; ++k) {
      const contact::PartMotion m = at({-kSpeed * kStep * k, 0, -kSinkage}, 0);
      contacts.step(&m);
      const double left = std::exp(-kSpeed * kStep * k / soil.shearDisplacement);
      const double damped = k == 0 ? 0 : std::min(damping * kSpeed * area * left, 0.01 * full);
      if (k % 400 == 0) {
        EXPECT_NEAR(sumOf(contacts).force.x, full * (1 - left) + damped, 1e-3 * full) << damping << " " << k;
      }
      lost += damped * kSpeed * kStep;
    }
    EXPECT_NEAR(contacts.energy().damping, lost, 2e-3 * lost) << damping;
  }
}

/// Loaded pad on a slope that mobilises `share` of its shear strength; the load ramps up within 1 s. Returns the mean
/// downhill speed between 9 and 10 s [m/s].
double speedParked(double share, double timeStep) {
  SoilMap map(0.034, level);
  SoilConstants soil = lete();
  soil.damping = 3e4;
  const Pad pad{0, {}, {1, 0, 0}, {0, 1, 0}, 0.5 * kPitch, 0.5 * kBreadth, kBreadth};
  SoilContacts contacts(soil, 0.5, {}, map, {pad}, {}, timeStep);
  const double area = kPitch * kBreadth, normal = kPressure * area, mass = normal / 9.81;
  const double downhill = share * (lete().cohesion * area + normal * lete().friction);
  Vec3d place, velocity;
  double before = 0;
  const int steps = static_cast<int>(10 / timeStep), last = static_cast<int>(9 / timeStep);
  for (int i = 0; i < steps; ++i) {
    const double ramp = std::min(1.0, i * timeStep);
    contact::PartMotion m = at(place, 0);
    m.velocity = velocity;
    contacts.step(&m);
    const Vec3d force = contacts.pads().loads()[0].force + Vec3d{downhill, 0, -normal} * ramp;
    velocity += force * (timeStep / mass), place += velocity * timeStep;
    if (i == last) before = place.x;
  }
  return place.x - before;
}

TEST(TrackContacts, APadParkedBelowItsShearStrengthDoesNotCreep) {
  for (const double timeStep : {1e-4, 5e-4}) {
    EXPECT_LT(std::fabs(speedParked(0.9, timeStep)), 1e-6) << timeStep;
    EXPECT_GT(speedParked(1.02, timeStep), 0.1) << timeStep;
  }
}

} // namespace
} // namespace grouser::scm::track_contacts
