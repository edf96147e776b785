// SPDX-License-Identifier: BSD-3-Clause
#include "contact/linear_law.hpp"

#include <gtest/gtest.h>

namespace grouser::contact {
namespace {

using base::Vec3f;

LinearLaw law() { return {1e5f, 800.0f, 3e4f, 400.0f, 0.5f, false}; }

TEST(LinearLaw, SpringTurnsIntoTheTangentPlane) {
  // A spring left from a contact whose normal has since turned by 0.6 rad, at rest: all of its force is tangential.
  Vec3f shear{1e-5f, 0, 0};
  const Touch touch{{0.6f, 0.8f, 0}, 1e-3f, {}, 0.1f};
  const Reaction r = linearForce(law(), touch, 1e-5f, shear);
  EXPECT_NEAR(dot(shear, touch.normal), 0, 1e-12) << "float round-off of 1e-5";
  EXPECT_NEAR(dot(r.force, touch.normal), -law().stiffness * touch.overlap, 1e-4) << "the spring adds nothing to it";
}

TEST(LinearLaw, SwappingTheSidesChangesOnlyTheSign) {
  Vec3f shear{2e-6f, -3e-6f, 1e-6f}, mirrored = -shear;
  Touch touch{base::normalized(Vec3f{0.3f, -0.5f, 0.7f}), 1e-4f, {0.2f, 0.1f, -0.4f}, 0.1f};
  const Reaction r = linearForce(law(), touch, 1e-5f, shear);
  touch.normal = -touch.normal, touch.velocity = -touch.velocity;
  const Reaction other = linearForce(law(), touch, 1e-5f, mirrored);
  EXPECT_EQ(r.force, -other.force);
  EXPECT_EQ(shear, -mirrored);
  EXPECT_EQ(r.dissipated, other.dissipated);
}

TEST(LinearLaw, NeverPullsUnlessAllowed) {
  Vec3f shear{};
  const Touch parting{{0, 0, 1}, 1e-6f, {0, 0, -1}, 0.1f};
  LinearLaw l = law();
  EXPECT_EQ(linearForce(l, parting, 1e-5f, shear).force.z, 0);
  l.attraction = true;
  EXPECT_GT(linearForce(l, parting, 1e-5f, shear).force.z, 0);
}

} // namespace
} // namespace grouser::contact
