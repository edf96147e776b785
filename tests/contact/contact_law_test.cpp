// SPDX-License-Identifier: BSD-3-Clause
#include "contact_fixture.hpp"

#include <gtest/gtest.h>

namespace grouser::contact {
namespace {

using base::Vec3f;

using testing::hertz, testing::linear;

TEST(ContactLaw, SpringTurnsIntoTheTangentPlane) {
  // Spring of a contact at rest, after its normal has rotated by 0.6 rad: the whole spring force is tangential.
  Vec3f shear{1e-5f, 0, 0};
  const ContactGeometry touch{{0.6f, 0.8f, 0}, 1e-3f, {}, 0.1f};
  const auto law = linear<float>();
  const Reaction r = contactForce<kFriction>(law, touch, 1e-5f, shear);
  EXPECT_NEAR(dot(shear, touch.normal), 0, 1e-12) << "float round-off of 1e-5";
  EXPECT_NEAR(dot(r.force, touch.normal), -law.stiffness * touch.overlap, 1e-4) << "the spring adds no normal force";
}

template <unsigned kFeatures> void expectMirrored(const BasicLaw<float>& law) {
  Vec3f shear{2e-6f, -3e-6f, 1e-6f}, mirrored = -shear;
  ContactGeometry touch{base::normalized(Vec3f{0.3f, -0.5f, 0.7f}), 1e-4f, {0.2f, 0.1f, -0.4f}, 0.1f, 0.01f};
  const Reaction r = contactForce<kFeatures>(law, touch, 1e-5f, shear);
  touch.normal = -touch.normal, touch.velocity = -touch.velocity;
  const Reaction other = contactForce<kFeatures>(law, touch, 1e-5f, mirrored);
  EXPECT_EQ(r.force, -other.force);
  EXPECT_EQ(shear, -mirrored);
  EXPECT_EQ(r.damped, other.damped);
  EXPECT_EQ(r.rubbed, other.rubbed);
  EXPECT_EQ(r.slipped, other.slipped);
}

TEST(ContactLaw, SwappingTheSidesChangesOnlyTheSign) {
  expectMirrored<kFriction>(linear<float>());
  expectMirrored<kFriction | kHertz>(hertz<float>());
  BasicLaw<float> sticky = hertz<float>();
  sticky.pullPerRadius = 1;
  expectMirrored<kFriction | kHertz | kCohesion>(sticky);
}

TEST(ContactLaw, NeverPullsUnlessAllowed) {
  Vec3f shear{};
  const ContactGeometry parting{{0, 0, 1}, 1e-6f, {0, 0, -1}, 0.1f, 0.01f};
  auto l = linear<float>();
  EXPECT_EQ(contactForce<kFriction>(l, parting, 1e-5f, shear).force.z, 0);
  l.attraction = true;
  EXPECT_GT(contactForce<kFriction>(l, parting, 1e-5f, shear).force.z, 0);
  auto h = hertz<float>();
  h.rootDamping = 1e9f;
  EXPECT_EQ((contactForce<kHertz | kFriction>(h, parting, 1e-5f, shear).force.z), 0);
}

/// The specialised function and the general one, which branches at run time.
template <unsigned kFeatures, class T> void expectSameBits(const BasicLaw<T>& law) {
  base::Vec3<T> shear{T(2e-6), T(-3e-6), T(1e-6)}, other = shear;
  const BasicContactGeometry<T> touch{
      base::normalized(base::Vec3<T>{T(0.3), T(-0.5), T(0.7)}), T(1e-4), {T(0.2), T(0.1), T(-0.4)}, T(0.1), T(0.01)};
  const auto special = contactForce<kFeatures>(law, touch, T(1e-5), shear);
  const auto general = contactForce<kGeneral>(law, touch, T(1e-5), other);
  EXPECT_EQ(special.force, general.force);
  EXPECT_EQ(special.damped, general.damped);
  EXPECT_EQ(special.rubbed, general.rubbed);
  EXPECT_EQ(special.slipped, general.slipped);
  EXPECT_EQ(shear, other);
}

TEST(ContactLaw, GeneralFunctionGivesTheBitsOfTheSpecialOnes) {
  expectSameBits<kFriction>(linear<float>());
  expectSameBits<kFriction | kHertz>(hertz<float>());
  expectSameBits<kFriction | kHertz>(hertz<double>());
  auto smooth = linear<float>();
  smooth.friction = 0;
  expectSameBits<0>(smooth);
  auto many = linear<double>();
  many.damping = 0, many.rootDamping = 30, many.tangentialDamping = 0, many.tangentialRootDamping = 10;
  expectSameBits<kFriction | kManyMasses>(many);
  auto sticky = linear<float>();
  sticky.pullPerRadius = 3;
  expectSameBits<kFriction | kCohesion>(sticky);
}

TEST(ContactLaw, FrictionOfStickySurfacesIsLimitedByWhatPresses) {
  // Just touching: the net force is attractive, but the surfaces are pressed together by the cohesion.
  auto law = linear<double>();
  law.damping = law.tangentialDamping = 0, law.pullPerRadius = 1000;
  base::Vec3d shear{1, 0, 0}; // far above the limit
  const BasicContactGeometry<double> touch{{0, 0, 1}, 1e-5, {}, 0.1, 0.01};
  const auto r = contactForce<kFriction | kCohesion>(law, touch, 1e-6, shear);
  EXPECT_NEAR(r.force.z, 10 - 1, 1e-12) << "pull 1000 N/m x 0.01 m, minus k overlap";
  EXPECT_NEAR(r.force.x, -0.5 * 1, 1e-12) << "friction x k overlap";
}

TEST(ContactLaw, PullThatGrowsWithTheRadiusGoesWithItsSquare) {
  auto law = linear<double>();
  law.damping = law.tangentialDamping = law.friction = 0, law.pullPerArea = 2000;
  EXPECT_EQ(law.features() & kCohesion, kCohesion);
  for (const double radius : {0.01, 0.02, 0.05}) {
    base::Vec3d shear;
    const BasicContactGeometry<double> touch{{0, 0, 1}, 1e-5, {}, 0.1, radius};
    const double pull = contactForce<kCohesion>(law, touch, 1e-6, shear).force.z + law.stiffness * 1e-5;
    EXPECT_NEAR(pull, 2000 * radius * radius, 1e-12);
    EXPECT_NEAR(storedEnergy(law, 1e-5, radius, shear), 0.5 * law.stiffness * 1e-10 - 1e-5 * pull, 1e-16);
  }
  const auto less = law.pulling(0.25);
  EXPECT_EQ(less.pullPerArea, 500);
  EXPECT_EQ(less.stiffness, law.stiffness);
}

} // namespace
} // namespace grouser::contact
