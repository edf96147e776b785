// SPDX-License-Identifier: BSD-3-Clause
// Elastic-plastic contacts against their closed forms, branch by branch, and energy along load paths.
#include "contact_fixture.hpp"

#include "base/random.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace grouser::contact {
namespace {

using State = BasicPlasticState<double>;
using Spring = BasicElasticSpring<double>;
using Plasticity = BasicPlasticity<double>;

constexpr double kRadius = 0.01;

/// Plasticity as set by the scene's laws.
Plasticity eepa(bool hertz, double share, double surfaceEnergy, double exponent) {
  Plasticity p;
  const double m = hertz ? 1.5 : 1;
  p.share = share, p.depthShare = std::pow(share, 1 / m);
  p.lossShare = share / (1 - share) * (1 - p.depthShare) * m / (m + 1);
  p.pull = 1.5 * M_PI * surfaceEnergy * std::sqrt(2 * p.depthShare);
  p.exponent = static_cast<int>(2 * exponent);
  return p;
}
/// `fullDepth`: phi_f.
Plasticity luding(double share, double fullDepth, double adhesion) {
  Plasticity p;
  p.share = share, p.fullDepth = 2 * fullDepth / share, p.adhesion = adhesion;
  return p;
}
Spring springOf(bool hertz) { return {hertz ? 4e8 : 1e5, kRadius, hertz}; }

double forceAt(const Plasticity& p, const Spring& spring, double overlap, State& state) {
  return plasticForce(p, spring, overlap, state).force;
}

class Eepa : public ::testing::TestWithParam<bool> {
protected:
  bool hertz = GetParam();
  double m = hertz ? 1.5 : 1, k1 = hertz ? 4e8 * std::sqrt(kRadius) : 1e5;
  Spring spring = springOf(hertz);
  double deepest = 1e-4;
  double round = 1e-13 * k1 * std::pow(deepest, m); ///< rounding error of the forces here
};

TEST_P(Eepa, EnergyThatGrowsWithTheRadiusPullsLikeAConstantOneOfThatRadius) {
  const Plasticity constant = eepa(hertz, 0.6, 20, m);
  Plasticity growing = constant;
  growing.pull = 0, growing.pullGrowth = constant.pull / kRadius;
  State a, b;
  for (const double x : {0.5 * deepest, deepest, 0.9 * deepest, 0.7 * deepest, 0.4 * deepest, 0.6 * deepest})
    EXPECT_NEAR(forceAt(growing, spring, x, a), forceAt(constant, spring, x, b), round) << x;
  EXPECT_LT(forceAt(growing, spring, 0.3 * deepest, a), 0) << "pulls";
}

TEST_P(Eepa, IsLoadedByTheElasticLawAndUnloadedAlongASteeperLine) {
  const Plasticity p = eepa(hertz, 0.6, 0, m);
  State s;
  for (const double x : {1e-6, 3e-5, deepest}) EXPECT_NEAR(forceAt(p, spring, x, s), k1 * std::pow(x, m), round);
  const double k2 = k1 / 0.4, zero = std::pow(0.6, 1 / m) * deepest;
  EXPECT_NEAR(std::pow(s.origin / k1, 1 / m), zero, 1e-12 * zero);
  for (const double x : {0.95e-4, 0.8e-4, 0.99 * deepest, 1.001 * zero})
    EXPECT_NEAR(forceAt(p, spring, x, s), k2 * (std::pow(x, m) - std::pow(zero, m)), 10 * round) << "back and forth";
  EXPECT_NEAR(forceAt(p, spring, deepest, s), k1 * std::pow(deepest, m), 10 * round) << "returns to the virgin curve";
  EXPECT_NEAR(forceAt(p, spring, 1.2 * deepest, s), k1 * std::pow(1.2 * deepest, m), 10 * round) << "and follows it";
}

TEST_P(Eepa, WithoutAdhesionItPartsWithoutForceAndIsFlattened) {
  const Plasticity p = eepa(hertz, 0.6, 0, m);
  State s;
  forceAt(p, spring, deepest, s);
  const double zero = std::pow(0.6, 1 / m) * deepest;
  EXPECT_EQ(forceAt(p, spring, 0.5 * zero, s), 0);
  const double k2 = k1 / 0.4, from = 0.5 * zero, x = 0.6 * zero;
  EXPECT_NEAR(forceAt(p, spring, x, s), k2 * (std::pow(x, m) - std::pow(from, m)), 10 * round) << "from unloading on";
}

TEST_P(Eepa, PullsUpToThePullOffForceAndFallsByTheExponentBeyond) {
  for (const double chi : {1.0, 1.5, 3.0, 5.0}) {
    const Plasticity p = eepa(hertz, 0.6, 500, chi);
    State s;
    forceAt(p, spring, deepest, s);
    const double k2 = k1 / 0.4, zero = std::pow(0.6, 1 / m) * deepest;
    const double pull = 1.5 * M_PI * 500 * std::sqrt(2 * zero * kRadius);
    ASSERT_LT(pull, 0.5 * k2 * std::pow(zero, m)) << "below the limit";
    const double turn = std::pow(std::pow(zero, m) - pull / k2, 1 / m);
    EXPECT_NEAR(forceAt(p, spring, turn * (1 + 1e-12), s), -pull, 1e-9 * pull);
    State before = s;
    for (const double part : {0.9, 0.5, 0.1})
      EXPECT_NEAR(forceAt(p, spring, part * turn, s), -pull * std::pow(part, chi), 1e-12 * pull) << chi;
    // Reloads along the steep line from any point.
    s = before;
    const double x = 0.5 * turn, a = pull * std::pow(0.5, chi);
    forceAt(p, spring, x, s);
    const double origin = std::pow(x, m) + a / k2;
    EXPECT_NEAR(forceAt(p, spring, 1.1 * x, s), k2 * (std::pow(1.1 * x, m) - origin), 1e-11 * pull) << chi;
    const double yields = std::pow(origin / 0.6, 1 / m);
    EXPECT_NEAR(forceAt(p, spring, yields, s), k1 * std::pow(yields, m), 1e-10 * pull) << "virgin curve";
    EXPECT_NEAR(forceAt(p, spring, deepest, s), k1 * std::pow(deepest, m), 10 * round);
  }
}

TEST_P(Eepa, PullIsAtMostHalfOfTheSteepLinesAtZero) {
  const Plasticity p = eepa(hertz, 0.6, 1e6, m);
  State s;
  forceAt(p, spring, deepest, s);
  const double line = k1 / 0.4 * 0.6 * std::pow(deepest, m); // k2 x_p^m
  double least = 0;
  for (double x = deepest; x > 0; x -= 1e-3 * deepest) least = std::min(least, forceAt(p, spring, x, s));
  EXPECT_NEAR(least, -0.5 * line, 5e-3 * line);
}

TEST_P(Eepa, ImpactReturnsWhatPlasticWorkLeaves) {
  // Undamped, without adhesion: e^2 is the share of the loading work that unloading returns.
  const double share = 0.5, depth = std::pow(share, 1 / m);
  const double back = 1 - share / (1 - share) * (1 - depth) * m; // linear: k1/k2
  std::vector<double> errors;
  for (const double dt : {2e-6, 1e-6, 5e-7}) {
    double worst = 0;
    for (const double phase : {0.1, 0.35, 0.6, 0.85}) {
      double x = -phase * dt, v = 1;
      State s;
      const Plasticity p = eepa(hertz, share, 0, m);
      do {
        const double f = x > 0 ? forceAt(p, spring, x, s) : 0;
        v -= f / 0.01 * dt, x += v * dt;
      } while (x > 0 && (v > 0 || s.origin <= 0 || forceAt(p, spring, x, s) > 0));
      worst = std::max(worst, std::fabs(-v - std::sqrt(back)));
    }
    errors.push_back(worst);
  }
  if (!hertz) {
    EXPECT_NEAR(back, 1 - share, 1e-12) << "e = sqrt(k1 / k2)";
  }
  EXPECT_LT(errors.back(), 4e-3);
  EXPECT_GT(errors.front() / errors.back(), 3) << "first order: " << errors.front() << " " << errors.back();
}

INSTANTIATE_TEST_SUITE_P(Laws, Eepa, ::testing::Bool(),
                         [](const auto& which) { return which.param ? std::string("Hertz") : std::string("Linear"); });

TEST(Luding, UnloadingStiffnessGrowsWithTheGreatestOverlap) {
  const Plasticity p = luding(0.75, 0.05, 0); // k2 up to 4 k1, from x* = 4/3 0.05 2 R_eff on
  const Spring spring = springOf(false);
  const double full = 4.0 / 3 * 0.05 * 2 * kRadius, k1 = 1e5;
  for (const double deepest : {0.1 * full, 0.5 * full, full, 1.5 * full}) {
    State s;
    EXPECT_NEAR(forceAt(p, spring, deepest, s), k1 * deepest, 1e-9);
    const double k2 = k1 + 3 * k1 * std::min(1.0, deepest / full), zero = (1 - k1 / k2) * deepest;
    for (const double part : {0.999, 0.97}) {
      const double x = zero + part * (deepest - zero);
      EXPECT_NEAR(forceAt(p, spring, x, s), k2 * (x - zero), 1e-9 * k1 * deepest) << deepest / full;
    }
    EXPECT_EQ(forceAt(p, spring, 0.5 * zero, s), 0);
  }
}

TEST(Luding, PullsByItsAdhesionStiffnessAndForgetsTheDepth) {
  const double k1 = 1e5, kc = 0.8 * k1, full = 4.0 / 3 * 0.05 * 2 * kRadius;
  const Plasticity p = luding(0.75, 0.05, kc / k1);
  const Spring spring = springOf(false);
  for (const double deepest : {0.4 * full, 1.5 * full}) {
    State s;
    forceAt(p, spring, deepest, s);
    const double k2 = k1 + 3 * k1 * std::min(1.0, deepest / full), turn = (k2 - k1) / (k2 + kc) * deepest;
    EXPECT_NEAR(forceAt(p, spring, turn * (1 + 1e-12), s), -kc * turn, 1e-6 * kc * turn) << "pull-off";
    double before = deepest;
    for (const double part : {0.8, 0.4, 0.05}) {
      const double x = part * turn;
      EXPECT_NEAR(forceAt(p, spring, x, s), -kc * x, 1e-12 * kc * turn);
      EXPECT_LT(s.deepest, before);
      before = s.deepest;
      State again = s; // the steep line of that depth starts exactly here
      const double k = k1 + 3 * k1 * std::min(1.0, s.deepest / full), zero = (1 - k1 / k) * s.deepest;
      EXPECT_NEAR(k * (x - zero), -kc * x, 1e-9 * kc * turn);
      EXPECT_NEAR(forceAt(p, spring, 1.01 * x, again), k * (1.01 * x - zero), 1e-9 * kc * turn);
    }
  }
}

/// Work along a path of overlaps minus stored and plastic energy, over the absolute work. Trapezoidal rule:
/// second order in the step.
double imbalance(const Plasticity& p, const Spring& spring, const std::vector<double>& turns, int steps) {
  State s;
  double work = 0, most = 0, yielded = 0, force = 0, at = 0;
  for (const double turn : turns) {
    const double from = at;
    for (int k = 1; k <= steps; ++k) {
      const double x = from + (turn - from) * k / steps;
      const BasicPlasticForce<double> r = plasticForce(p, spring, x, s);
      work += 0.5 * (force + r.force) * (x - at), most += 0.5 * std::fabs((force + r.force) * (x - at));
      EXPECT_GE(r.yielded, -1e-12 * most) << "never negative";
      yielded += r.yielded, force = r.force, at = x;
    }
  }
  return std::fabs(work - yielded - plasticEnergy(p, spring, at, s)) / most;
}

TEST(PlasticEnergy, WorkIsStoredOrYielded) {
  const std::vector<double> turns{1e-4, 6e-5, 9e-5, 1.3e-4, 2e-5, 8e-5, 5e-6, 6e-5, 1e-6};
  const auto check = [&](const char* name, const Plasticity& p, const Spring& spring) {
    const double coarse = imbalance(p, spring, turns, 200), fine = imbalance(p, spring, turns, 3200);
    EXPECT_LT(fine, 3e-5) << name;
    EXPECT_GT(coarse / fine, 12) << name << ": at least first order " << coarse << " " << fine;
  };
  for (const bool hertz : {false, true}) {
    check("dry", eepa(hertz, 0.6, 0, 1), springOf(hertz));
    for (const double chi : {1.0, 1.5, 3.0}) check("adhesive", eepa(hertz, 0.6, 500, chi), springOf(hertz));
  }
  check("luding", luding(0.75, 0.05, 0.8), springOf(false));
  check("luding, shallow", luding(0.75, 0.004, 0.8), springOf(false));
}

TEST(PlasticEnergy, IsTheSameBeforeAndAfterAStepHasSeenTheOverlap) {
  // Between steps a contact may have an overlap that its state does not contain yet.
  for (const double to : {1.4e-4, 7e-5, 3e-5, 4e-6})
    for (int law = 0; law < 3; ++law) {
      const Plasticity p = law == 2 ? luding(0.75, 0.05, 0.8) : eepa(law == 1, 0.6, 500, 1.5);
      const Spring spring = springOf(law == 1);
      State s;
      plasticForce(p, spring, 1e-4, s);
      const double before = plasticEnergy(p, spring, to, s), yielded = plasticForce(p, spring, to, s).yielded;
      const double after = plasticEnergy(p, spring, to, s);
      EXPECT_NEAR(before, after + yielded, 1e-9 * std::fabs(before)) << to << " " << law;
    }
}

TEST(PlasticContact, FrictionIsLimitedByForceAndAdhesionTogether) {
  BasicLaw<double> law = testing::linear<double>();
  law.damping = law.tangentialDamping = 0;
  law.plastic = eepa(false, 0.6, 500, 1);
  State s;
  base::Vec3d shear{};
  const auto touch = [&](double x, double slip) {
    return BasicContactGeometry<double>{{0, 0, 1}, x, {slip, 0, 0}, 0.01, kRadius};
  };
  contactForce<kFriction | kPlastic>(law, touch(1e-4, 0), 1e-6, shear, &s);
  const double zero = 0.6e-4, pull = 1.5 * M_PI * 500 * std::sqrt(2 * zero * kRadius);
  const auto r = contactForce<kFriction | kPlastic>(law, touch(zero, 100), 1e-6, shear, &s);
  EXPECT_NEAR(r.force.z, 0, 1e-9);
  EXPECT_NEAR(std::fabs(r.force.x), law.friction * pull, 1e-9 * pull) << "unloaded, with adhesion";
  EXPECT_NEAR(r.pressing, pull, 1e-9 * pull);
}

TEST(PlasticContact, DashpotDoesNotHelpToPull) {
  BasicLaw<double> law = testing::linear<double>();
  law.plastic = eepa(false, 0.6, 500, 1);
  State s;
  base::Vec3d shear{};
  contactForce<kPlastic>(law, {{0, 0, 1}, 1e-4, {}, 0.01, kRadius}, 1e-6, shear, &s);
  State still = s;
  const auto slow = contactForce<kPlastic>(law, {{0, 0, 1}, 0.5e-4, {}, 0.01, kRadius}, 1e-6, shear, &still);
  const auto fast = contactForce<kPlastic>(law, {{0, 0, 1}, 0.5e-4, {0, 0, -3}, 0.01, kRadius}, 1e-6, shear, &s);
  EXPECT_GT(slow.force.z, 0) << "attractive";
  EXPECT_EQ(slow.force.z, fast.force.z);
  EXPECT_EQ(fast.damped, 0);
}

TEST(PlasticContact, GeneralFunctionGivesTheBitsOfTheSpecialOne) {
  for (int which = 0; which < 3; ++which) {
    BasicLaw<float> law = which == 1 ? testing::hertz<float>() : testing::linear<float>();
    law.plastic = (which == 2 ? luding(0.75, 0.05, 0.8) : eepa(which == 1, 0.6, 50, 1.5)).as<float>();
    BasicPlasticState<float> a, b;
    base::Vec3f shear{}, other{};
    for (const float x : {1e-5f, 8e-5f, 4e-5f, 1e-6f, 6e-5f}) {
      const ContactGeometry touch{
          base::normalized(base::Vec3f{0.3f, -0.5f, 0.7f}), x, {0.2f, 0.1f, -0.4f}, 0.1f, 0.01f};
      const auto special = which == 1 ? contactForce<kFriction | kHertz | kPlastic>(law, touch, 1e-6f, shear, &a)
                                      : contactForce<kFriction | kPlastic>(law, touch, 1e-6f, shear, &a);
      const auto general = contactForce<kGeneral>(law, touch, 1e-6f, other, &b);
      EXPECT_EQ(special.force, general.force);
      EXPECT_EQ(special.yielded, general.yielded);
      EXPECT_EQ(a.deepest, b.deepest);
      EXPECT_EQ(a.origin, b.origin);
    }
  }
}

TEST(PlasticContact, SinglePrecisionFollowsDouble) {
  const Plasticity p = eepa(true, 0.6, 50, 1.5);
  const Spring spring = springOf(true);
  const BasicElasticSpring<float> rough{static_cast<float>(spring.stiffness), static_cast<float>(kRadius), true};
  State s;
  BasicPlasticState<float> f;
  const double scale = spring.force(1e-4);
  for (const double x : {5e-5, 1e-4, 8e-5, 7e-5, 5e-5, 2e-5, 6e-5, 9e-5}) {
    const double exact = forceAt(p, spring, x, s);
    EXPECT_NEAR(static_cast<double>(plasticForce(p.as<float>(), rough, static_cast<float>(x), f).force), exact,
                3e-6 * scale);
  }
}

} // namespace
} // namespace grouser::contact
