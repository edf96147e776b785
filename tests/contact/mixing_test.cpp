// SPDX-License-Identifier: BSD-3-Clause
// Contact laws from material properties, without a scene.
#include "contact/mixing.hpp"

#include "base/math.hpp"
#include "contact/restitution.hpp"
#include "tests/contact/contact_fixture.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

namespace grouser::contact {
namespace {

MaterialProperties linearMaterial(double stiffness) {
  MaterialProperties m;
  m.stiffness = stiffness;
  return m;
}

MaterialProperties hertzMaterial(double young, double poisson) {
  MaterialProperties m;
  m.law = LawKind::hertz, m.young = young, m.poisson = poisson;
  return m;
}

/// All numbers of a law.
std::vector<double> numbersOf(const ContactLaw& l) {
  const auto& p = l.plastic;
  return {l.stiffness,
          l.damping,
          l.tangentialStiffness,
          l.tangentialDamping,
          l.friction,
          static_cast<double>(l.attraction),
          static_cast<double>(l.hertz),
          l.rootDamping,
          l.tangentialRootDamping,
          l.rollingFriction,
          l.rollingDamping,
          l.pullPerRadius,
          l.pullPerArea,
          p.share,
          p.depthShare,
          p.lossShare,
          p.pull,
          p.pullGrowth,
          static_cast<double>(p.exponent),
          p.fullDepth,
          p.adhesion,
          l.fixedShare};
}

/// Rebound over impact speed of a sphere of this mass on a plane, both of the material, at 2000 steps per contact.
double reboundOf(const MaterialProperties& material, double mass) {
  const double radius = 0.01, speed = 0.5;
  const ContactLaw law = mixedLaw(material, material, {}, mass);
  testing::SphereOnPlane sphere{law, radius, mass, {0, 0, radius}, {0, 0, -speed}};
  const double dt = contactTime(law, mass, radius, speed) / 2000;
  do sphere.step(dt);
  while (sphere.overlap() > 0);
  return sphere.velocity.z / speed;
}

TEST(MixedLaw, LinearSpringsAreInSeriesAndEqualOnesKeepTheirStiffness) {
  const MaterialProperties soft = linearMaterial(1e5), hard = linearMaterial(3e5);
  const ContactLaw law = mixedLaw(soft, hard);
  EXPECT_DOUBLE_EQ(law.stiffness, 1.5e5);
  EXPECT_DOUBLE_EQ(law.tangentialStiffness, 1.5e5 * 2 / 7);
  const double odd = 1e5 / 29;
  ASSERT_NE(2 * odd * odd / (odd + odd), odd) << "rounding";
  const MaterialProperties own = linearMaterial(odd);
  EXPECT_EQ(mixedLaw(own, own).stiffness, odd);
  PairProperties pair;
  pair.stiffness = 7e5;
  EXPECT_EQ(mixedLaw(soft, hard, pair).stiffness, 7e5);
}

TEST(MixedLaw, HertzCompliancesAddUp) {
  const ContactLaw law = mixedLaw(hertzMaterial(1e8, 0.2), hertzMaterial(2e7, 0.4));
  const double modulus = 1 / ((1 - 0.04) / 1e8 + (1 - 0.16) / 2e7);
  const double shear = 1 / ((2 - 0.2) * 2 * 1.2 / 1e8 + (2 - 0.4) * 2 * 1.4 / 2e7); // G = E / (2 (1 + nu))
  EXPECT_TRUE(law.hertz);
  EXPECT_NEAR(law.stiffness / (4.0 / 3 * modulus), 1, 1e-14);
  EXPECT_NEAR(law.tangentialStiffness / (8 * shear), 1, 1e-14);
  // Against a much stiffer material E / (1 - nu^2) remains.
  const ContactLaw onSteel = mixedLaw(hertzMaterial(2e7, 0.4), hertzMaterial(2e17, 0.3));
  EXPECT_NEAR(onSteel.stiffness / (4.0 / 3 * 2e7 / (1 - 0.16)), 1, 1e-9);
}

TEST(MixedLaw, EnergiesHaveTheirGeometricMeanAndCoefficientsTheSmaller) {
  MaterialProperties a = linearMaterial(1e5), b = linearMaterial(1e5);
  a.cohesion = 0.4, b.cohesion = 0.9;
  a.friction = 0.3, b.friction = 0.6;
  a.rollingFriction = 0.2, b.rollingFriction = 0.1;
  a.attraction = true;
  const ContactLaw law = mixedLaw(a, b);
  EXPECT_NEAR(law.pullPerRadius, 2 * base::kPi * 0.6, 1e-14);
  EXPECT_EQ(law.friction, 0.3);
  EXPECT_EQ(law.rollingFriction, 0.1);
  EXPECT_FALSE(law.attraction) << "both materials must allow it";
  a.adhesionRadius = 0.01, b.adhesionRadius = 0.04;
  const ContactLaw grown = mixedLaw(a, b);
  EXPECT_EQ(grown.pullPerRadius, 0);
  EXPECT_NEAR(grown.pull(0.01), 2 * base::kPi * 0.6 * 0.01, 1e-15) << "for two grains of 20 mm, the mean of the radii";
  PairProperties pair;
  pair.cohesion = 2, pair.friction = 0.7, pair.rollingFriction = 0;
  const ContactLaw given = mixedLaw(linearMaterial(1e5), b, pair);
  EXPECT_EQ(given.friction, 0.7);
  EXPECT_EQ(given.rollingFriction, 0);
  EXPECT_NEAR(given.pull(0.02), 2 * base::kPi * 2 * 0.02, 1e-14) << "for grains of 40 mm";
}

TEST(MixedLaw, ContactsReboundWithTheirRestitution) {
  // Symplectic Euler is of first order with dashpots: 2000 steps per contact leave less than 1e-3.
  for (const bool attraction : {false, true})
    for (const double restitution : {0.3, 0.8})
      for (MaterialProperties m : {linearMaterial(2e5), hertzMaterial(5e7, 0.3)}) {
        m.restitution = restitution, m.attraction = attraction;
        EXPECT_NEAR(reboundOf(m, 0.02), restitution, 2e-3) << attraction << m.hertzian();
      }
}

TEST(MixedLaw, RestitutionOfManyMassesIsThatOfEach) {
  MaterialProperties m = linearMaterial(2e5);
  m.restitution = 0.4;
  const ContactLaw any = mixedLaw(m, m);
  for (const double mass : {0.01, 3.0}) {
    EXPECT_NEAR(restitutionOf(any, mass, mass), 0.4, 1e-9);
    EXPECT_NEAR(restitutionOf(mixedLaw(m, m, {}, mass), mass, mass), 0.4, 1e-9);
  }
}

TEST(MixedLaw, IsSymmetricToTheLastBit) {
  MaterialProperties a = hertzMaterial(1e8 / 3, 0.21), b = hertzMaterial(2e7 / 7, 0.37);
  a.law = b.law = LawKind::eepa;
  for (MaterialProperties* m : {&a, &b}) {
    const double x = m == &a ? 1.0 / 3 : 0.7;
    m->cohesion = x, m->surfaceEnergy = 3 * x, m->plasticity = 0.5 * x, m->adhesionExponent = m == &a ? 1.5 : 2;
    m->friction = x, m->rollingFriction = 0.1 * x, m->restitution = x, m->adhesionRadius = 0.01 * x;
    m->stiffness = 1e5 * x, m->tangentialStiffnessRatio = 0.5 * x, m->tangentialDampingRatio = x;
    m->plasticDepth = 0.1 * x, m->adhesionStiffness = 1e4 * x, m->rollingDampingRatio = x;
  }
  for (const LawKind law : {LawKind::linear, LawKind::hertz, LawKind::eepa, LawKind::eepaLinear, LawKind::luding}) {
    a.law = b.law = law;
    for (const std::optional<double> mass : {std::optional<double>(), std::optional(0.3)})
      EXPECT_EQ(numbersOf(mixedLaw(a, b, {}, mass)), numbersOf(mixedLaw(b, a, {}, mass))) << static_cast<int>(law);
  }
}

TEST(MixedLaw, YieldsIfBothMaterialsDo) {
  MaterialProperties a = hertzMaterial(1e8, 0.25), b = a;
  a.law = LawKind::eepa, a.plasticity = 0.6, a.surfaceEnergy = 2, a.adhesionExponent = 2;
  EXPECT_EQ(mixedLaw(a, b).plastic.share, 0);
  b.law = LawKind::eepa, b.plasticity = 0.4, b.surfaceEnergy = 8;
  const auto p = mixedLaw(a, b).plastic;
  EXPECT_EQ(p.share, 0.4);
  EXPECT_NEAR(p.pull, 1.5 * base::kPi * 4 * std::sqrt(2 * std::pow(0.4, 2.0 / 3)), 1e-12);
  EXPECT_EQ(p.exponent, 4) << "the larger, in steps of 0.5";
  MaterialProperties c = linearMaterial(1e5), d = c;
  c.law = d.law = LawKind::luding;
  c.plasticDepth = 0.1, c.adhesionStiffness = 3e4, d.adhesionStiffness = 2e4;
  const auto luding = mixedLaw(c, d).plastic;
  EXPECT_DOUBLE_EQ(luding.fullDepth, 2 * 0.1 / MaterialProperties::kPlasticity);
  EXPECT_DOUBLE_EQ(luding.adhesion, 0.2) << "relative to the stiffness";
}

TEST(MixedLaw, LengthOfAContactAndOfAWaveAreThoseOfTheClosedForms) {
  const ContactLaw linear = mixedLaw(linearMaterial(1e5), linearMaterial(3e5));
  EXPECT_NEAR(contactTime(linear, 0.2, 0.01, 1), base::kPi * std::sqrt(0.2 / 1.5e5), 1e-15);
  EXPECT_EQ(stiffest(linear, 0.2, 0.01, 1).normalStiffness, linear.stiffness);
  // Hertz: deepest^(5/2) = (15/16) m v^2 / (E_eff sqrt(R)), and the contact lasts 2.9432 deepest / v.
  const MaterialProperties glass = hertzMaterial(7e7, 0.2);
  const ContactLaw hertz = mixedLaw(glass, glass);
  const double modulus = 7e7 / (2 * (1 - 0.04)), deepest = std::pow(15.0 / 16 * 0.2 * 4 / (modulus * 0.1), 0.4);
  EXPECT_NEAR(contactTime(hertz, 0.2, 0.01, 2) / (2.9432 * deepest / 2), 1, 1e-4);
  EXPECT_NEAR(stiffest(hertz, 0.2, 0.01, 2).normalStiffness / (2 * modulus * std::sqrt(0.01 * deepest)), 1, 1e-9);
  EXPECT_DOUBLE_EQ(rayleighTimeOf(glass, 0.01), rayleighTime(0.01, 2500, 7e7 / 2.4, 0.2));
  EXPECT_TRUE(std::isinf(rayleighTimeOf(linearMaterial(1e5), 0.01)));
}

TEST(MixedLaw, ErrorSaysWhichMaterialAndPropertyAreAtFault) {
  using Reason = MixingError::Reason;
  const auto expect = [](const MaterialProperties& a, const MaterialProperties& b, Reason reason, bool inSecond,
                         const std::string& key) {
    try {
      mixedLaw(a, b);
      ADD_FAILURE() << key;
    } catch (const MixingError& error) {
      EXPECT_EQ(error.reason, reason) << error.what();
      EXPECT_EQ(error.inSecond, inSecond) << error.what();
      EXPECT_EQ(error.key, key);
    }
  };
  const MaterialProperties linear = linearMaterial(1e5), hertz = hertzMaterial(1e8, 0.25);
  expect(linear, hertz, Reason::lawsDiffer, true, "law");
  MaterialProperties eepa = linear, luding = linear, damped = linear, bare = hertz;
  eepa.law = LawKind::eepaLinear, luding.law = LawKind::luding, damped.damping = 300, bare.young.reset();
  expect(eepa, luding, Reason::lawsDiffer, true, "law");
  expect(damped, linear, Reason::dampingBesideRestitution, false, "damping");
  expect(linear, damped, Reason::dampingBesideRestitution, true, "damping");
  EXPECT_EQ(mixedLaw(damped, linear, {}, 1e-9).damping,
            2 * std::sqrt(1e5 / 1e-9) * dampingRatioFor(MaterialProperties::kRestitution, false))
      << "the larger: both refer to one mass";
  expect(hertz, bare, Reason::youngMissing, true, "young");
  expect(bare, hertz, Reason::youngMissing, false, "young");
}

} // namespace
} // namespace grouser::contact
