// SPDX-License-Identifier: BSD-3-Clause
// Contacts of a running gear from its shapes: rims, horns and bosses against closed forms and sums over 1e6 points.
#include "contact/gear_surfaces.hpp"

#include "base/bits.hpp"
#include "base/hash.hpp"
#include "base/math.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace grouser::contact {
namespace {

using base::Vec3d;

constexpr PatchLaw kLaw{1e10, 0, 0, 0.8};
constexpr double kStep = 1e-4;

void put(Vec3P& to, int lane, const Vec3d& v) { to.x[lane] = v.x, to.y[lane] = v.y, to.z[lane] = v.z; }

/// A wheel of radius r on a plate z = 0 of length 2 half and width w, with its axle at height h above x.
RimsOnPlates rim(double r, double half, double w, double x, double h, const Vec3d& axis = {0, 1, 0}) {
  RimsOnPlates rims{};
  for (int l = 0; l < kPointLanes; ++l) {
    put(rims.along, l, {1, 0, 0}), put(rims.across, l, {0, 1, 0}), put(rims.axis, l, axis);
    put(rims.axle, l, {x, 0, h});
    rims.halfLength[l] = half, rims.from[l] = -0.5 * w, rims.to[l] = l == 3 ? 0.5 * w : -0.5 * w, rims.radius[l] = r;
  }
  return rims;
}

TEST(GearSurfaces, ARimOnAPlateIsPressedByTheClosedForm) {
  const double r = 0.19, w = 0.08;
  for (const double depth : {1e-6, 1e-4, 3e-4, 3e-3}) {
    const double h = r - depth, a = std::sqrt(r * r - h * h);
    const PressureLanes sums = pressRims(kLaw, kStep, rim(r, 0.068, w, 0.01, h));
    const PatchPressure p = sums.lane(3);
    // Pressure K (r - rho) along the radius; downwards K (r h / rho - h), with rho^2 = h^2 + s^2.
    const double force = kLaw.modulus * w * h * 2 * (r * std::asinh(a / h) - a);
    EXPECT_NEAR(p.force.z, -force, 1e-5 * force) << depth;
    EXPECT_NEAR(p.force.x, 0, 1e-12 * force);
    EXPECT_NEAR(p.area, 2 * a * w, 1e-12);
    EXPECT_NEAR(p.torque.y, 0.01 * force, 1e-5 * 0.01 * force) << "about the plate's centre";
    EXPECT_EQ(sums.weight[2], 0) << "an idle lane";
  }
}

TEST(GearSurfaces, ARimOverTheEndOfAPlateTouchesOnlyTheRest) {
  const double r = 0.19, w = 0.08, depth = 3e-4, h = r - depth, half = 0.068;
  for (const double beyond : {-0.005, 0.0, 0.005}) {
    const double x = half + beyond, a = std::sqrt(r * r - h * h), to = -beyond; // from the foot: [-a, to]
    const PatchPressure p = pressRims(kLaw, kStep, rim(r, half, w, x, h)).lane(3);
    const double force = kLaw.modulus * w * h * (r * (std::asinh(to / h) + std::asinh(a / h)) - (to + a));
    EXPECT_NEAR(p.force.z, -force, 1e-5 * force) << beyond;
    // Across: K (r / rho - 1) s.
    const double rho = std::sqrt(h * h + to * to);
    const double across = kLaw.modulus * w * (r * (rho - r) - 0.5 * (to * to - a * a));
    EXPECT_NEAR(p.force.x, across, 1e-5 * force) << beyond;
  }
}

TEST(GearSurfaces, ATiltedRimHasTheForceAndMomentOfAMillionPoints) {
  const double r = 0.19, w = 0.08, h = r - 4e-4, tilt = 4e-3; // one side of the plate is lower by 0.16 mm
  const Vec3d axis = base::normalized(Vec3d{0.01, 1, tilt});
  const PatchPressure p = pressRims(kLaw, kStep, rim(r, 0.068, w, 0, h, axis)).lane(3);
  Vec3d force, torque;
  const int n = 1000;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const Vec3d x{(i + 0.5) / n * 0.06 - 0.03, ((j + 0.5) / n - 0.5) * w, 0}, apart = x - Vec3d{0, 0, h};
      const Vec3d radial = apart - axis * dot(apart, axis);
      const double overlap = r - norm(radial);
      if (overlap <= 0) continue;
      const Vec3d normal = radial * (1 / norm(radial)), f = normal * (kLaw.modulus * overlap * 0.06 * w / (n * n));
      force += f, torque += cross(x + normal * (0.5 * overlap), f);
    }
  EXPECT_LT(norm(p.force - force), 2e-4 * norm(force));
  EXPECT_LT(norm(p.torque - torque), 2e-4 * norm(force) * w);
}

TEST(GearSurfaces, RelaxationResistsTheApproachAndNeverPulls) {
  PatchLaw law = kLaw;
  law.relaxation = 2e-4;
  const double r = 0.19, depth = 3e-4;
  RimsOnPlates rims = rim(r, 0.068, 0.08, 0, r - depth);
  const double still = -pressRims(law, kStep, rims).lane(3).force.z;
  put(rims.motion.velocity, 3, {0, 0, 0.1}); // the plate approaches
  const PatchPressure coming = pressRims(law, kStep, rims).lane(3);
  // K times area times relaxation times speed, except for the inclined pressure at the chord's ends.
  EXPECT_NEAR(-coming.force.z - still, law.modulus * coming.area * 2e-5, 2e-3 * still);
  EXPECT_NEAR(coming.dissipated, law.modulus * coming.area * 2e-5 * 0.1 * kStep, 1e-2 * coming.dissipated);
  put(rims.motion.velocity, 3, {0, 0, -10});
  EXPECT_EQ(pressRims(law, kStep, rims).lane(3).weight, 0);
}

/// Overlap of a point with a disc behind its side, rim and chamfer: the smallest of the three.
double discDepth(double side, double rho, double radius, double chamfer) {
  return std::min({side, radius - rho, (side + radius - rho - chamfer) * std::sqrt(0.5)});
}

TEST(GearSurfaces, AHornsSideHasTheForceOfAMillionPoints) {
  // A horn with a taper of 6 mm in 60, beside discs, with an offset, a yaw and a tilt.
  for (const double radius : {0.19, 0.09})
    for (const double shift : {6e-4, 1.5e-3, 5e-3}) { // the last is deeper than the chamfer: the rim pushes out
      FaceAtDisc f;
      const double turn = 2e-3, lean = 3e-3;
      f.axis = base::normalized(Vec3d{turn, 1, lean});
      f.foot = {0.004, shift + lean * radius, 0}, f.along = {1, 0, 0}, f.up = {0, -0.006, 0.06};
      f.halfFoot = 0.04, f.halfTip = 0.015;
      f.axle = {0, 0, radius}, f.radius = radius, f.chamfer = 0.003;
      f.motion = {};
      const PatchPressure p = pressFace(kLaw, kStep, f);
      Vec3d force;
      const int n = 1500;
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
          const double u = (i + 0.5) / n, x = (2 * (j + 0.5) / n - 1) * 0.04;
          if (std::fabs(x) > 0.04 - 0.025 * u) continue;
          const Vec3d apart = f.foot + f.along * x + f.up * u - f.axle;
          const double side = dot(apart, f.axis);
          const Vec3d radial = apart - f.axis * side;
          const double rho = norm(radial), depth = discDepth(side, rho, radius, f.chamfer);
          if (depth <= 0) continue;
          const Vec3d outward = radial * (1 / rho);
          const Vec3d normal = depth == side           ? -f.axis
                               : depth == radius - rho ? outward
                                                       : (outward - f.axis) * std::sqrt(0.5);
          force += normal * (kLaw.modulus * depth * norm(f.up) * 0.08 / (n * n));
        }
      ASSERT_GT(norm(force), 1) << radius << ' ' << shift;
      EXPECT_LT(norm(p.force - force), (shift < f.chamfer ? 0.02 : 0.03) * norm(force)) << radius << ' ' << shift;
    }
}

constexpr double kTip = 0.2692, kLowTip = 0.2515; // [m]

/// The default vehicle's sprocket, or one with low teeth.
GapProfile gap(double tip = kTip) {
  return {10, 0.154 / (2 * base::sin(base::kPi / 10)), 0.0185, base::kPi / 3, 0.06, tip};
}

BossInGap bossAt(double x, double y, int gapNumber) {
  const GapProfile g = gap();
  const double angle = 2 * base::kPi * gapNumber / 10, c = base::cos(angle), s = base::sin(angle);
  BossInGap b;
  b.axle = {}, b.axis = {0, 1, 0}, b.x = {1, 0, 0}, b.z = {0, 0, 1};
  b.boss = {(g.pinRadius + y) * c - x * s, 0.16, (g.pinRadius + y) * s + x * c};
  b.alongX = {1, 0, 0}, b.alongZ = {0, 0, 1}, b.across = {0, 1, 0}, b.radius = 0.018, b.from = -0.01, b.to = 0.01,
  b.motion = {};
  return b;
}

/// Outline of half a gap, x > 0: seat, flank, tip circle, in points some micrometres apart.
std::vector<std::pair<double, double>> outline(const GapProfile& g) {
  std::vector<std::pair<double, double>> points;
  const double end = base::kPi / 3;
  for (int k = 0; k <= 5000; ++k)
    points.emplace_back(0.0185 * std::sin(end * k / 5000), -0.0185 * std::cos(end * k / 5000));
  for (int k = 0; k <= 20000; ++k) {
    const double a = base::kPi / 2 + end - 0.9 * k / 20000;
    const double x = g.flankX + 0.06 * std::cos(a), y = g.flankY + 0.06 * std::sin(a);
    if (std::hypot(x, g.pinRadius + y) > g.tipRadius) break;
    points.emplace_back(x, y);
  }
  const double tip = std::atan2(points.back().first, g.pinRadius + points.back().second);
  for (int k = 0; k <= 20000; ++k) {
    const double a = tip + (base::kPi / 5 - 2 * tip) * k / 20000; // up to the other flank of the tooth
    points.emplace_back(g.tipRadius * std::sin(a), g.tipRadius * std::cos(a) - g.pinRadius);
  }
  return points;
}

/// Force on a boss at (x, y) of the half x > 0, from 4000 of its points and the nearest of the outline.
std::pair<double, double> forceByPoints(const GapProfile& g, double x, double y) {
  const std::vector<std::pair<double, double>> profile = outline(g);
  double fx = 0, fy = 0;
  const int n = 4000;
  for (int k = 0; k < n; ++k) {
    const double a = 2 * base::kPi * (k + 0.5) / n, px = x + 0.018 * std::cos(a), py = y + 0.018 * std::sin(a);
    if (px < 0) continue;
    const bool inSeat = py < -0.5 * std::hypot(px, py);
    const bool inside =
        inSeat ? std::hypot(px, py) > 0.0185
               : std::hypot(px - g.flankX, py - g.flankY) < 0.06 && std::hypot(px, g.pinRadius + py) < g.tipRadius;
    if (!inside) continue;
    double nearest = 1, nx = 0, ny = 0;
    for (const auto& [qx, qy] : profile)
      if (const double d = std::hypot(qx - px, qy - py); d < nearest) nearest = d, nx = qx - px, ny = qy - py;
    if (nearest < 1e-7) continue;
    const double f = kLaw.modulus * nearest * 2 * base::kPi * 0.018 / n * 0.02 / nearest;
    fx += f * nx, fy += f * ny;
  }
  return {fx, fy};
}

TEST(GearSurfaces, ABossInAGapHasTheForceOfItsPoints) {
  struct Case {
    const char* where;
    double x, y;
    double bar = 0.03; ///< [-]; at edges the fixed points, 0.9 mm apart, are few
    double tip = kTip;
  };
  for (const Case& c :
       {Case{"at the seat's bottom", 0, -7e-4}, Case{"up the seat", 5e-4, -4e-4},
        Case{"where seat and flank meet", 6.5e-4, -1e-5}, Case{"on the flank", 0.0046, 0.006},
        Case{"high on the flank", 0.0108, 0.0125}, Case{"on the edge of flank and tip", 0.0432, 0.0331, 0.06},
        Case{"on the edge of a low tooth", 0.01279, 0.01294, 0.08, kLowTip}, Case{"on the tip", 0.06, 0.03138}}) {
    double fx = 0, fy = 0;
    const std::array<PatchPressure, 2> p = pressBoss(kLaw, kStep, gap(c.tip), bossAt(c.x, c.y, 0));
    const auto [ox, oy] = forceByPoints(gap(c.tip), c.x, c.y);
    fx = p[1].force.z, fy = p[1].force.x; // gap 0: x of the gap is z of the sprocket, y its x
    const double size = std::hypot(ox, oy);
    ASSERT_GT(size, 10) << c.where;
    EXPECT_LT(std::hypot(fx - ox, fy - oy), c.bar * size)
        << c.where << ' ' << fx << ' ' << fy << ' ' << ox << ' ' << oy;
  }
}

TEST(GearSurfaces, ABossFeelsEveryGapAlikeAndBothHalvesAsMirrors) {
  const auto first = pressBoss(kLaw, kStep, gap(), bossAt(5e-4, -4e-4, 0));
  for (int k = 1; k < 10; ++k) {
    const auto other = pressBoss(kLaw, kStep, gap(), bossAt(5e-4, -4e-4, k));
    EXPECT_NEAR(other[1].weight, first[1].weight, 1e-7 * first[1].weight) << k;
  }
  const auto mirrored = pressBoss(kLaw, kStep, gap(), bossAt(-5e-4, -4e-4, 0));
  EXPECT_NEAR(mirrored[0].force.z, -first[1].force.z, 1e-9 * first[1].weight);
  EXPECT_NEAR(mirrored[0].force.x, first[1].force.x, 1e-9 * first[1].weight);
  const auto free = pressBoss(kLaw, kStep, gap(), bossAt(0, 0, 3));
  EXPECT_EQ(free[0].weight + free[1].weight, 0) << "half a millimetre of clearance";
}

TEST(GearSurfaces, HaveTheSameBitsOnEveryProcessor) {
  base::StateHash hash;
  const auto add = [&hash](const PatchPressure& p) {
    for (const double x : {p.area, p.weight, p.place.x, p.place.y, p.place.z, p.force.x, p.force.y, p.force.z,
                           p.torque.x, p.torque.y, p.torque.z, p.elastic, p.dissipated})
      hash.add(base::bitsAs<std::uint64_t>(x));
  };
  PatchLaw law = kLaw;
  law.relaxation = 2e-4;
  RimsOnPlates rims = rim(0.19, 0.068, 0.08, 0.03, 0.19 - 2e-4, base::normalized(Vec3d{0.002, 1, 0.001}));
  put(rims.motion.velocity, 3, {0.1, 0.2, 0.3}), put(rims.motion.spin, 3, {1, 2, 3});
  add(pressRims(law, kStep, rims).lane(3));
  FaceAtDisc face{{0.004, 9e-4, 0},
                  {1, 0, 0},
                  {0, -0.006, 0.06},
                  0.04,
                  0.015,
                  {0, 0, 0.19},
                  {0, 1, 0},
                  0.19,
                  0.003,
                  {{0.1, 0.2, 0.3}, {1, 2, 3}}};
  add(pressFace(law, kStep, face));
  for (int k = 0; k < 10; ++k) {
    BossInGap boss = bossAt(1e-4 * k, -7e-4 + 1e-4 * k, k);
    boss.motion = {{0.1, 0.2, 0.3}, {1, 2, 3}};
    for (const PatchPressure& p : pressBoss(law, kStep, gap(), boss)) add(p);
  }
  EXPECT_EQ(hash.hex(), "b6f0c756cdfbaea9");
}

} // namespace
} // namespace grouser::contact
