// SPDX-License-Identifier: BSD-3-Clause
// A contact under cyclic shear and rolling with varying load absorbs work at every phase and never releases net work.
#include "base/math.hpp"
#include "contact/strongest_force.hpp"
#include "contact_fixture.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace grouser::contact::testing {
namespace {

using base::Vec3d;
using base::Vec3f;

constexpr double kRadius = 0.01, kMass = 0.01, kDepth = 1e-4; // a hundredth of the radius

struct Work {
  double normal = 0, sliding = 0, rolling = 0; ///< work done on the contact [J]
  double turnover = 0;                         ///< absolute work [J]
  double lost = 0;                             ///< dissipation in the ledger [J]
  double gained = 0;                           ///< energy gained by the shear spring [J]
};

struct Drive {
  double depth;   ///< amplitude of the overlap over its mean [-]; beyond 1 the surfaces separate
  double phase;   ///< phase lag of shear and rolling [rad]
  double shear;   ///< [m]
  double angle;   ///< amplitude of rolling [rad]
  int ratio;      ///< periods of the load per period of the shear
  int steps;      ///< per period of the shear
  bool turning{}; ///< shear rotates instead of reversing
};

/// Work of one steady-state period: after two others, which set the springs as the next period does.
Work pumped(const BasicLaw<double>& law, const Drive& drive) {
  const double period = 0.05, dt = period / drive.steps; // 20 Hz
  Vec3d shear, angle;
  BasicPlasticState<double> plastic;
  bool touching = false;
  Work sum;
  const auto overlapAt = [&](int k) {
    return kDepth * (1 + drive.depth * base::sin(2 * base::kPi * drive.ratio * k / drive.steps));
  };
  const auto swing = [&](int k) {
    const double at = 2 * base::kPi * k / drive.steps + drive.phase;
    return Vec3d{base::sin(at), drive.turning ? base::cos(at) : 0, 0};
  };
  for (int k = 1; k <= 3 * drive.steps; ++k) {
    const double overlap = overlapAt(k), way = overlap - overlapAt(k - 1);
    if (overlap <= 0) {
      touching = false;
      continue;
    }
    if (!touching) shear = angle = {}, plastic = {};
    touching = true;
    const Vec3d slid = (swing(k) - swing(k - 1)) * drive.shear, rolled = (swing(k) - swing(k - 1)) * drive.angle;
    const Vec3d n{0, 0, -1};
    const auto r = contactForce<kGeneral>(law, {n, overlap, (slid - Vec3d{0, 0, way}) * (1 / dt), kMass, kRadius}, dt,
                                          shear, &plastic);
    double lost = r.damped + r.rubbed + r.slipped + r.yielded;
    const Vec3d torque = rollingTorque(law, {n, rolled * (1 / dt), kRadius, 1.4 * kMass * kRadius * kRadius},
                                       r.pressing, r.normalStiffness, dt, angle, lost, law.hertz ? &r.change : nullptr);
    const double held = storedEnergy(law, overlap, kRadius, shear) - storedEnergy(law, overlap, kRadius, Vec3d{});
    if (k == 2 * drive.steps) sum.gained = -held;
    if (k <= 2 * drive.steps) continue;
    if (k == 3 * drive.steps) sum.gained += held;
    const double parts[] = {r.force.z * way, -dot(r.force, slid), -dot(torque, rolled)};
    sum.normal += parts[0], sum.sliding += parts[1], sum.rolling += parts[2];
    for (const double part : parts) sum.turnover += std::fabs(part);
    sum.lost += lost;
  }
  return sum;
}

struct Named {
  std::string name;
  BasicLaw<double> law;
};

/// Every law, with and without dashpots.
std::vector<Named> laws() {
  std::vector<Named> all;
  for (const double friction : {0.1, 0.5, 100.0})
    for (const bool damped : {false, true}) {
      BasicLaw<double> line = linear<double>(), ball = hertz<double>();
      line.stiffness = 1e6, line.tangentialStiffness = 3e5;
      ball.stiffness = 1e8, ball.tangentialStiffness = 9e7, ball.rootDamping = ball.tangentialRootDamping = 2e3;
      for (BasicLaw<double>* law : {&line, &ball}) {
        law->friction = friction, law->rollingFriction = friction < 1 ? 0.1 : 100, law->rollingDamping = 0.3;
        if (!damped) {
          law->damping = law->tangentialDamping = law->rollingDamping = 0;
          law->rootDamping = law->tangentialRootDamping = 0;
        }
      }
      const std::string how = " of friction " + std::to_string(friction) + (damped ? ", damped" : "");
      all.push_back({"linear" + how, line}), all.push_back({"Hertz" + how, ball});
      BasicLaw<double> masses = line;
      masses.rootDamping = damped ? 100 : 0, masses.tangentialRootDamping = damped ? 50 : 0;
      masses.damping = masses.tangentialDamping = 0;
      all.push_back({"linear of many masses" + how, masses});
      BasicLaw<double> sticky = ball;
      sticky.pullPerRadius = 100;
      all.push_back({"cohesion" + how, sticky});
      for (const BasicLaw<double>& elastic : {line, ball}) {
        BasicLaw<double> eepa = elastic;
        const double m = eepa.hertz ? 1.5 : 1, share = 0.6;
        const double depth = eepa.hertz ? base::pow(share, 1 / m) : share;
        eepa.plastic = {share, depth, share / (1 - share) * (1 - depth) * m / (m + 1), 1e4, 0, 0, 0, 3};
        all.push_back({(eepa.hertz ? "EEPA" : "linear EEPA") + how, eepa});
      }
      BasicLaw<double> luding = line;
      luding.plastic.share = 0.7, luding.plastic.fullDepth = 0.015, luding.plastic.adhesion = 0.5;
      all.push_back({"Luding" + how, luding});
    }
  return all;
}

TEST(Pump, AShearedAndRolledContactUnderAVaryingLoadNeverDoesWork) {
  // Rounding may seem to release energy: 1e-12 of the exchanged energy.
  for (const Named& each : laws())
    for (const int ratio : {1, 2})
      for (const double depth : {0.5, 0.95, 1.3})
        for (const double shear : {1e-6, 1e-5, 1e-4})
          for (int phase = 0; phase < 8; ++phase) {
            const Drive drive{depth, base::kPi / 4 * phase, shear, 100 * shear, ratio, 200, phase % 3 == 1};
            const Work w = pumped(each.law, drive);
            const double rounding = 1e-12 * w.turnover;
            ASSERT_GE(w.sliding, -rounding) << each.name << ", swing " << depth << ", shear " << shear << " m, phase "
                                            << phase << ", ratio " << ratio;
            ASSERT_GE(w.rolling, -rounding) << each.name << ", swing " << depth << ", phase " << phase;
            ASSERT_GE(w.normal, -rounding) << each.name << ", swing " << depth << ", phase " << phase;
          }
}

TEST(Pump, ASurfacePulledFastAndPushedBackSlowlyNeverGivesWork) {
  // At high speed, the dashpot exceeds Coulomb's limit with hardly any spring; at low speed only the spring acts.
  constexpr double kLength = 2e-5;
  for (const Named& each : laws())
    for (const int fast : {2, 20, 200})
      for (const double overlap : {1e-5, 1e-4, 3e-4}) {
        const double dt = 1e-7;
        Vec3d shear;
        BasicPlasticState<double> plastic;
        double work = 0, turnover = 0;
        const auto slide = [&](double way, int steps) {
          for (int k = 0; k < steps; ++k) {
            const Vec3d slid{way / steps, 0, 0};
            const auto r = contactForce<kGeneral>(each.law, {{0, 0, -1}, overlap, slid * (1 / dt), kMass, kRadius}, dt,
                                                  shear, &plastic);
            turnover += std::fabs(dot(r.force, slid));
            ASSERT_GE(r.rubbed, -1e-12 * turnover) << each.name << ", " << fast << " steps, overlap " << overlap;
            work -= dot(r.force, slid);
          }
        };
        slide(-kLength, 20000); // the springs are in their steady state
        for (int cycle = 0; cycle < 3; ++cycle) {
          if (cycle == 2) work = 0;
          slide(kLength, fast), slide(-kLength, 20000);
        }
        EXPECT_GE(work, -1e-9 * turnover) << each.name << ", " << fast << " steps, overlap " << overlap;
      }
}

TEST(Pump, LargeForcesAndSmallOnesObeyCoulomb) {
  // Single precision represents squares of forces only from 1e-19 to 1e19 N.
  for (const double radius : {1e-6, 1e-3, 1.0, 100.0, 1000.0}) {
    BasicLaw<double> law = hertz<double>();
    law.rootDamping = law.tangentialRootDamping = 0;
    const BasicLaw<float> single = scaledFor(law, radius).as<float>();
    for (const double share : {1e-8, 1e-4, 0.1}) {
      Vec3f shear{static_cast<float>(share * radius), 0, 0}; // far above the limit
      const BasicContactGeometry<float> touch{
          {0, 0, -1}, static_cast<float>(share * radius), {}, 1, static_cast<float>(radius)};
      const auto r = contactForce<kGeneral>(single, touch, 1e-9f, shear);
      EXPECT_NEAR(r.force.x / r.force.z, -0.5, 1e-6) << "radius " << radius << " m, overlap " << share << " radii";
    }
  }
}

TEST(Pump, WhatAHertzContactTakesIsBookedToAnErrorThatFallsWithTheStep) {
  BasicLaw<double> law = hertz<double>();
  law.stiffness = 1e8, law.tangentialStiffness = 9e7, law.rootDamping = law.tangentialRootDamping = 0;
  law.friction = 100;
  double error[2];
  for (int k = 0; k < 2; ++k) {
    const Work w = pumped(law, {0.5, 0.7, 1e-5, 0, 2, k ? 16000 : 2000});
    error[k] = std::fabs(w.sliding - w.gained - w.lost) / w.lost;
  }
  EXPECT_LT(error[1], 2e-3) << "16000 steps per period";
  EXPECT_LT(error[1], 0.15 * error[0]) << "first order in the step";
}

TEST(Pump, AHertzSpringHoldsItsForceWhileLoadedAndItsLengthWhileUnloaded) {
  BasicLaw<double> law = hertz<double>();
  law.rootDamping = law.tangentialRootDamping = 0, law.friction = 100;
  Vec3d shear{1e-6, 0, 0};
  const double dt = 1e-6;
  const auto forceAt = [&](double overlap, double from) {
    return contactForce<kGeneral>(law, {{0, 0, -1}, overlap, {0, 0, (from - overlap) / dt}, kMass, kRadius}, dt, shear)
        .force.x;
  };
  const double before = forceAt(1e-4, 1e-4);
  EXPECT_NEAR(forceAt(4e-4, 1e-4) / before, 1, 1e-12) << "the contact radius has doubled";
  EXPECT_NEAR(shear.x, 0.5e-6, 1e-18);
  EXPECT_NEAR(forceAt(1e-4, 4e-4) / before, 0.5, 1e-12);
  EXPECT_NEAR(shear.x, 0.5e-6, 1e-18);
}

} // namespace
} // namespace grouser::contact::testing
