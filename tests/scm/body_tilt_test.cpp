// SPDX-License-Identifier: BSD-3-Clause
// Loads on bodies of all shapes at all tilts, against integrals of Bekker's pressure over their undersides; bodies of
// several shapes; ruts of partly covered squares.
#include "base/math.hpp"
#include "scm/breadth.hpp"
#include "scm/soil_contacts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace grouser::scm::body_tilt {
namespace {

using contact::SurfaceGeometry;
using contact::SurfaceShape;

constexpr double kModulus = 1e6, kRatio = 10; // k [N/m3] with n = 1, and f

SoilConstants frictionless() {
  SoilConstants s;
  s.exponent = 1, s.kphi = kModulus, s.shearDisplacement = 0.01, s.elasticRatio = kRatio;
  return s;
}

terrain::SurfaceJet level(double, double) { return {}; }

Solid solid(const SurfaceGeometry& shape, double spacing, int part = 0) { return solidOf(shape, spacing, part); }

/// A box as a triangle mesh.
Solid meshOfBox(const Vec3d& half) {
  Solid s{.half = half, .isConvex = false};
  for (const Facet& f : solid({SurfaceShape::box, half}, 1).facets)
    for (const std::size_t k : {std::size_t{1}, std::size_t{2}})
      s.facets.push_back({{f.corners[0], f.corners[k], f.corners[k + 1]}, f.normal});
  return s;
}

/// Turned by `tilt` about +y, then by `yaw` about +z [deg].
base::Mat3d turned(double tilt, double yaw = 0) {
  const double a = tilt * base::kPi / 180, b = yaw * base::kPi / 180;
  const double c = std::cos(a), s = std::sin(a), cz = std::cos(b), sz = std::sin(b);
  return {{{cz * c, -sz, cz * s}, {sz * c, cz, sz * s}, {-s, 0, c}}};
}

contact::PartMotion at(const Vec3d& place, const base::Mat3d& rotation) {
  contact::PartMotion m{};
  m.rotation = rotation, m.origin = m.centre = place;
  return m;
}

/// Force on a body whose origin sinks to the height `end` [m] in steps without speed.
Vec3d pressed(const SoilConstants& soil, std::vector<Solid> solids, const std::vector<Vec3d>& places,
              const base::Mat3d& rotation, double spacing, double way = 0.1) {
  SoilMap map(spacing, level);
  SoilContacts contacts(soil, 0.5, {}, map, {}, std::move(solids), 1e-3);
  constexpr int kSteps = 10;
  for (int k = 0; k <= kSteps; ++k) {
    std::vector<contact::PartMotion> motion;
    for (const Vec3d& p : places)
      motion.push_back(at(p + Vec3d{0, 0, way * (1 - static_cast<double>(k) / kSteps)}, rotation));
    contacts.step(motion.data());
  }
  Vec3d force;
  for (const BodyLoad& l : contacts.bodies().loads()) force += l.force;
  return force;
}

/// Force on a box of the height 0.3 m with its lowest edge at a depth: underside and side, both in the soil.
Vec3d forceOnBox(double tilt, double length, double width, double depth) {
  const double t = std::tan(tilt * base::kPi / 180), s = std::sin(tilt * base::kPi / 180);
  const auto face = [&](double slope, double side) { // wet length of a face
    return std::min(side / std::sqrt(1 + slope * slope), slope > 0 ? depth / slope : 1e300);
  };
  const double under = face(t, length), lift = kModulus * width * (depth * under - t * under * under / 2);
  const double up = std::sqrt(1 - s * s), limit = std::min(1.0, kRatio * s), limitUnder = std::min(1.0, kRatio * up);
  if (!(s > 0)) return {0, 0, lift};
  const double beside = face(1 / t, 0.3);
  const double aside = limit * kModulus * width * (depth * beside - beside * beside / t / 2);
  return {limitUnder * lift * t - aside / t, 0, limitUnder * lift + aside};
}

TEST(BodyTilt, ForceOnABoxIsTheIntegralOverItsUndersideAtAnyTilt) {
  const Vec3d half{0.15, 0.1, 0.15};
  for (const bool isMesh : {false, true})
    for (const double spacing : {0.01, 0.02, 0.025}) {
      double worst = 0;
      for (double tilt = 0; tilt<89.7; tilt += tilt> 11 && tilt < 12 ? 0.1 : 0.5) {
        const double a = tilt * base::kPi / 180, depth = 0.08;
        const double z = half.x * std::sin(a) + half.z * std::cos(a) - depth;
        const Vec3d f = pressed(frictionless(), {isMesh ? meshOfBox(half) : solid({SurfaceShape::box, half}, spacing)},
                                {{1.003, 0.001, z}}, turned(tilt), spacing);
        const Vec3d expected = forceOnBox(tilt, 2 * half.x, 2 * half.y, depth);
        worst = std::max(worst, norm(f - expected) / norm(expected));
        EXPECT_LT(norm(f - expected),
                  55 * spacing * spacing * norm(expected)) // 0.55 % at 10 mm; second-order convergence
            << tilt << " deg, " << spacing << " m, mesh " << isMesh;
      }
      std::printf("spacing %g m, mesh %d: largest error %.3g %%\n", spacing, isMesh, 100 * worst);
    }
}

TEST(BodyTilt, ForceHasNoJumpInTheTilt) {
  const Vec3d half{0.15, 0.1, 0.15};
  for (const double depth : {0.02, 0.08}) {
    Vec3d last;
    const double step = 0.02;
    for (int k = 0; k * step <= 90; ++k) {
      const double a = k * step * base::kPi / 180;
      const Vec3d f =
          pressed(frictionless(), {solid({SurfaceShape::box, half}, 0.02)},
                  {{1.003, 0.001, half.x * std::sin(a) + half.z * std::cos(a) - depth}}, turned(k * step), 0.02);
      if (k > 0) {
        EXPECT_LT(norm(f - last), 0.01 * (norm(f) + 300)) << k * step << " deg, " << depth << " m";
      }
      last = f;
    }
  }
}

TEST(BodyTilt, LoadOfEveryShapeIsModulusTimesVolumeBelowTheSurface) {
  constexpr double pi = base::kPi;
  const double R = 0.15, d = 0.05, cap = pi * d * d * (R - d / 3);
  const double segment = R * R * std::acos(1 - d / R) - (R - d) * std::sqrt(2 * R * d - d * d);
  struct Case {
    const char* name;
    SurfaceGeometry shape;
    double tilt, height, volume;
  };
  const double coneSlope = 0.5; // radius / height of the sharp cone
  const Case cases[] = {
      // depth 50 mm
      {"box", {SurfaceShape::box, {0.15, 0.1, 0.05}}, 0, 0.05, 0.3 * 0.2 * d},
      {"upright cylinder", {SurfaceShape::cylinder, {R, R, 0.1}}, 0, 0.1, pi * R * R * d},
      {"lying cylinder", {SurfaceShape::cylinder, {R, R, 0.1}}, 90, R, segment * 0.2},
      {"ball", {SurfaceShape::capsule, {R, R, 0}}, 0, R, cap},
      {"upright capsule", {SurfaceShape::capsule, {R, R, 0.1}}, 0, 0.1 + R, cap},
      {"lying capsule", {SurfaceShape::capsule, {R, R, 0.1}}, 90, R, cap + segment * 0.2},
      {"cone on its base", {SurfaceShape::cone, {R, 0.05, 0.1}}, 0, 0.1, pi * R * R * d},
      {"cone on its tip", {SurfaceShape::cone, {0.1, 0, 0.1}}, 180, 0.1, pi * coneSlope * coneSlope * d * d * d / 3},
  };
  for (const Case& c : cases)
    for (const double spacing : {0.005, 0.01, 0.02, 0.03})
      for (const double yaw : {0.0, 17.0, 45.0}) {
        if (c.height == 0.1 && c.tilt == 180 && spacing > 0.01) continue; // the tip's hole has a radius of 25 mm
        const Vec3d f = pressed(frictionless(), {solid(c.shape, spacing)}, {{0.003, 0.002, c.height - d}},
                                turned(c.tilt, yaw), spacing);
        const double expected = kModulus * c.volume;
        const double error = (c.tilt == 180 ? 350 : 35) * spacing * spacing; // second-order convergence
        EXPECT_NEAR(f.z, expected, error * expected) << c.name << " " << spacing << " " << yaw;
        EXPECT_LT(std::hypot(f.x, f.y), error * expected) << c.name << " " << spacing << " " << yaw;
      }
}

TEST(BodyTilt, ShapesOfOneBodyPushOnceWhereTheyOverlap) {
  const SurfaceGeometry plate{SurfaceShape::box, {0.15, 0.1, 0.025}}, half{SurfaceShape::box, {0.09, 0.1, 0.025}};
  const SurfaceGeometry ball{SurfaceShape::capsule, {0.1, 0.1, 0}};
  for (const double spacing : {0.01, 0.02})
    for (const double yaw : {0.0, 20.0})
      for (const double tilt : {0.0, 5.0, 20.0, 50.0}) {
        const base::Mat3d r = turned(tilt, yaw);
        const Vec3d centre{0.003, 0.001, 0.0}, along = r * Vec3d{0.06, 0, 0};
        const double one = norm(pressed(frictionless(), {solid(plate, spacing)}, {centre}, r, spacing));
        const auto same = [&](std::vector<Solid> solids, const std::vector<Vec3d>& places, const char* what) {
          EXPECT_NEAR(norm(pressed(frictionless(), std::move(solids), places, r, spacing)), one, 1e-3 * one)
              << what << " " << spacing << " " << yaw << " " << tilt;
        };
        same({solid(plate, spacing), solid(plate, spacing, 1)}, {centre, centre}, "twice");
        same({solid(half, spacing), solid(half, spacing, 1)}, {centre - along, centre + along}, "overlapping halves");
        Solid other = solid(plate, spacing, 1);
        other.body = 1;
        if (tilt == 0) {
          EXPECT_GT(norm(pressed(frictionless(), {solid(plate, spacing), other}, {centre, centre}, r, spacing)),
                    1.9 * one)
              << "two bodies push both";
        }
        const double lone = pressed(frictionless(), {solid(ball, spacing)}, {{0, 0, 0.06}}, r, spacing).z;
        EXPECT_NEAR(pressed(frictionless(), {solid(ball, spacing), solid(ball, spacing, 1)},
                            {{0, 0, 0.06}, {0, 0, 0.06}}, r, spacing)
                        .z,
                    lone, 1e-3 * lone);
      }
}

TEST(BodyTilt, BoxesSideBySideHaveTheWidthOfTheirPlate) {
  const SurfaceGeometry half{SurfaceShape::box, {0.15, 0.05, 0.025}}, disc{SurfaceShape::cylinder, {0.1, 0.1, 0.02}};
  const std::vector<Solid> two{solid(half, 0.02), solid(half, 0.02, 1)};
  const auto widths = [&](const std::vector<Solid>& solids, const Vec3d& apart, double tilt) {
    const base::Mat3d r = turned(tilt, 30);
    const contact::PartMotion motion[] = {at(r * (apart * -0.5), r), at(r * (apart * 0.5), r)};
    return breadthsOf(solids.data(), 2, motion);
  };
  for (const double tilt : {0.0, 10.0, 40.0}) {
    EXPECT_NEAR(widths(two, {0, 0.1, 0}, tilt)[0], 0.2, 1e-12) << "one plate";
    EXPECT_NEAR(widths(two, {0, 0.1, 0}, tilt)[1], 0.2, 1e-12);
    EXPECT_NEAR(widths(two, {0, 0.15, 0}, tilt)[0], 0.1, 1e-12) << "a gap between them";
    EXPECT_NEAR(widths(two, {0, 0.1, 0.03}, tilt)[0], 0.1, 1e-12) << "a step between them";
    EXPECT_NEAR(widths({solid(disc, 0.02), solid(disc, 0.02, 1)}, {}, tilt)[0], 0.1, 1e-12) << "one disc, twice";
  }
}

/// Energy [-] that a box which swings about its centre gains from the soil beyond the elastic energy at the start, at
/// most, relative to the absolute work of the soil.
double gainedEnergy(const Vec3d& half, double tilt, double depth, double swing) {
  SoilMap map(0.0125, level);
  SoilConstants soil = frictionless();
  soil.friction = 0.5, soil.cohesion = 1000;
  SoilContacts contacts(soil, 0.5, {}, map, {}, {solid({SurfaceShape::box, half}, 0.0125)}, 1e-3);
  constexpr int kSteps = 300;
  Vec3d torque;
  double work = 0, least = 0, exchanged = 0, elastic = 0, angle = tilt;
  for (int k = -100; k <= kSteps; ++k) {
    const double now = tilt + (k > 0 ? swing * std::sin(2 * base::kPi * k / kSteps) : 0);
    const double turn = (now - angle) * base::kPi / 180;
    angle = now;
    contact::PartMotion m = at({1.003, 0.001, half.x - depth - 0.001 * std::min(k, 0)}, turned(now));
    m.spin = {0, turn / 1e-3, 0}, m.velocity = {0, 0, k <= 0 ? -1.0 : 0.0};
    contacts.step(&m);
    const Vec3d before = torque;
    torque = contacts.bodies().loads()[0].torque;
    if (k == 0) elastic = contacts.energy().elastic + contacts.energy().elasticShear;
    if (k <= 0) continue;
    const double more = -0.5 * (torque.y + before.y) * turn;
    work += more, exchanged += std::fabs(more), least = std::min(least, work);
  }
  return -(least + elastic) / exchanged;
}

TEST(BodyTilt, SwingingBodiesGainNoEnergyFromTheSoil) {
  for (const double tilt : {60.0, 75.0, 85.0, 90.0})
    for (const double depth : {0.05, 0.15, 0.2})
      for (const double swing : {-25.0, -2.0, 2.0, 25.0})
        for (const double thick : {0.005, 0.05})
          EXPECT_LT(gainedEnergy({0.2, 0.2, thick}, tilt, depth, swing), 0.03)
              << tilt << " " << depth << " " << swing << " " << thick;
}

TEST(BodyTilt, ABlockOnASlopeSlidesAsUnderTiltedGravity) {
  SoilConstants soil = frictionless();
  soil.friction = 0.5, soil.cohesion = 500, soil.shearDisplacement = 0.005;
  for (const double slope : {0.0, 5.0, 12.0, 25.0, 35.0})
    for (const auto& [height, depth] : {std::pair{0.05, 0.02}, std::pair{0.005, 0.05}}) {
      const Vec3d half{0.15, 0.1, height};
      const double t = std::tan(slope * base::kPi / 180);
      SoilMap map(0.02, [t](double x, double) { return terrain::SurfaceJet{.h = -t * x, .hx = -t, .hy = 0}; });
      SoilContacts contacts(soil, 0.5, {}, map, {}, {solid({SurfaceShape::box, half}, 0.02)}, 1e-3);
      const base::Mat3d r = turned(slope);
      for (int k = 0; k <= 100; ++k) {
        const contact::PartMotion m =
            at(r * Vec3d{0.003 + 1e-3 * k, 0.001, half.z - depth * std::min(1.0, k / 20.0)}, r);
        contacts.step(&m);
      }
      const Vec3d f = contacts.bodies().loads()[0].force;
      const double down = dot(f, r * Vec3d{1, 0, 0}), normal = dot(f, r * Vec3d{0, 0, 1}), area = 4 * half.x * half.y;
      EXPECT_NEAR(normal, kModulus * depth * area, 0.03 * normal)
          << slope << ": plus the unloaded squares behind the block";
      EXPECT_NEAR(down, -(0.5 * normal + 500 * area), 0.01 * normal) << slope;
    }
}

TEST(BodyTilt, VolumeOfARutIsThatOfTheBodyAtAnySpacingAndHeading) {
  const Vec3d half{0.15, 0.1, 0.1};
  for (const double spacing : {0.01, 0.02, 0.034, 0.05})
    for (const double yaw : {0.0, 10.0, 30.0, 45.0})
      for (const int shapes : {1, 2}) {
        SoilMap map(spacing, level);
        std::vector<Solid> solids(static_cast<std::size_t>(shapes), solid({SurfaceShape::box, half}, spacing));
        SoilContacts contacts(frictionless(), 0.5, {1, std::tan(base::kPi / 6)}, map, {}, solids, 1e-3);
        for (int k = 0; k <= 60; ++k) {
          const contact::PartMotion m =
              at({1.003, 0.001, half.z - 0.002 * std::min(k, 40) + (k > 40 ? 0.1 : 0)}, turned(0, yaw));
          contacts.step(&m);
        }
        double rut = 0, berm = 0, pending = 0;
        map.forEach([&](std::int32_t, std::int32_t, const Node& n) {
          rut += (n.firmDepth() - n.spared) * spacing * spacing, berm += n.looseThickness() * spacing * spacing,
              pending += n.displaced * spacing * spacing;
        });
        const double expected = 0.08 * (1 - 1 / kRatio) * 4 * half.x * half.y; // plastic part of the sinkage
        EXPECT_NEAR(rut, expected, 1e-6 * expected) << spacing << " " << yaw << " " << shapes;
        EXPECT_NEAR(berm + pending, expected, 1e-4 * expected) << spacing << " " << yaw << " " << shapes;
      }
}

} // namespace
} // namespace grouser::scm::body_tilt
