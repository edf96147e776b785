// SPDX-License-Identifier: BSD-3-Clause
// Dissipation of a contact in one step is the work done on it minus the energy gain of its springs.
#include "base/random.hpp"
#include "contact_fixture.hpp"

#include <gtest/gtest.h>

namespace grouser::contact::testing {
namespace {

using base::Vec3d;

/// Platform-independent numbers from -1 to 1.
class Numbers {
public:
  double next() { return 2 * base::uniform(17, 3, 0, count_++) - 1; }
  Vec3d across() { return {next(), next(), 0}; }

private:
  std::uint32_t count_ = 0;
};

/// Tangential energy only: stored with the spring minus stored without it.
double tangentialEnergy(const BasicLaw<double>& law, double overlap, double radius, const Vec3d& shear) {
  return storedEnergy(law, overlap, radius, shear) - storedEnergy(law, overlap, radius, Vec3d{});
}

TEST(ContactBooks, SlidingLosesItsWorkLessWhatItsSpringGains) {
  Numbers numbers;
  const double dt = 1e-6, mass = 0.01, radius = 0.005;
  for (BasicLaw<double> law : {linear<double>(), hertz<double>()}) {
    law.tangentialDamping = law.tangentialRootDamping = 0;
    int slid = 0;
    for (int n = 0; n < 2000; ++n) {
      const double overlap = 1e-4 * (1.5 + numbers.next()), approach = 0.5 * numbers.next();
      const double limit = law.friction * (law.hertz ? law.stiffness * std::sqrt(radius * overlap) : law.stiffness) *
                           overlap,
                   kt = law.hertz ? law.tangentialStiffness * std::sqrt(radius * overlap) : law.tangentialStiffness;
      // Springs from zero to the limit, and steps of the same size.
      const Vec3d before = numbers.across() * (0.7 * limit / kt), slip = numbers.across() * (limit / kt / dt);
      Vec3d shear = before;
      const auto r =
          contactForce<kGeneral>(law, {{0, 0, 1}, overlap, slip + Vec3d{0, 0, approach}, mass, radius}, dt, shear);
      const Vec3d force{r.force.x, r.force.y, 0};
      const double work = -dot(force, slip) * dt, turned = kt * dot(before, before);
      if (norm(before * r.change.kept + slip * dt) * kt <= law.friction * r.pressing) { // it sticks
        EXPECT_EQ(r.rubbed, 0);
        EXPECT_GE(r.slipped, 0);
        if (!law.hertz) {
          EXPECT_EQ(r.slipped, 0);
        }
        continue;
      }
      ++slid;
      // The previous overlap was smaller by the travel of this step.
      const double gained = tangentialEnergy(law, overlap, radius, shear) -
                            tangentialEnergy(law, overlap - approach * dt, radius, before);
      EXPECT_NEAR(r.rubbed + r.slipped, work - gained, 1e-12 * (work + turned));
      EXPECT_NEAR(norm(force), law.friction * r.pressing, 1e-12 * r.pressing);
    }
    EXPECT_GT(slid, 500);
  }
}

TEST(ContactBooks, SlidingIsNotDampedToo) {
  BasicLaw<double> law = linear<double>();
  Vec3d shear;
  const auto r = contactForce<kGeneral>(law, {{0, 0, 1}, 1e-4, {3, 0, 0}, 0.01, 0.005}, 1e-6, shear);
  EXPECT_NEAR(norm(Vec3d{r.force.x, r.force.y, 0}), 0.5 * 1e5 * 1e-4, 1e-12) << "its dashpot alone exceeds the cone";
  EXPECT_EQ(r.damped, 0);
}

TEST(ContactBooks, RollingAtItsLimitLosesItsWorkLessWhatItsSpringGains) {
  Numbers numbers;
  BasicLaw<double> law = linear<double>();
  law.rollingFriction = 0.2, law.rollingDamping = 0;
  const double dt = 1e-5, radius = 0.005, inertia = 1e-7, pressing = 10;
  const double limit = 0.2 * radius * pressing, stiffness = rollingStiffness(law, 1e5, radius);
  int slid = 0;
  for (int n = 0; n < 1000; ++n) {
    const Vec3d before = numbers.across() * (0.7 * limit / stiffness);
    const Vec3d spin = numbers.across() * (limit / stiffness / dt) + Vec3d{0, 0, 40 * numbers.next()};
    Vec3d angle = before;
    double lost = 0;
    const Vec3d torque = rollingTorque(law, {{0, 0, 1}, spin, radius, inertia}, pressing, 1e5, dt, angle, lost);
    const double work = -dot(torque, spin) * dt;
    const double gained = 0.5 * stiffness * (dot(angle, angle) - dot(before, before));
    if (norm(torque) < limit * (1 - 1e-12)) {
      EXPECT_EQ(lost, 0) << "a spring without a dashpot loses nothing";
      continue;
    }
    ++slid;
    EXPECT_NEAR(lost, work - gained, 1e-12 * limit);
  }
  EXPECT_GT(slid, 200);
}

TEST(ContactBooks, RollingDashpotsTakeWhatTheyBrake) {
  BasicLaw<double> law = linear<double>();
  law.rollingFriction = 0.2, law.rollingDamping = 0.5;
  const double dt = 1e-5, radius = 0.005, inertia = 1e-6, stiffness = rollingStiffness(law, 1e5, radius);
  const double dashpot = 2 * 0.5 * std::sqrt(inertia * stiffness), spin = 0.05;
  Vec3d angle;
  double lost = 0;
  const Vec3d torque = rollingTorque(law, {{0, 0, 1}, Vec3d{spin, 0, 0}, radius, inertia}, 10.0, 1e5, dt, angle, lost);
  EXPECT_NEAR(torque.x, -stiffness * spin * dt - dashpot * spin, 1e-12);
  // With the mid-step spin of a sphere rotating about its centre, 7/2 times the compliance.
  EXPECT_NEAR(lost, dashpot * spin * (spin + 1.75 * torque.x * dt / inertia) * dt, 1e-18);
  EXPECT_GT(lost, 0);
}

} // namespace
} // namespace grouser::contact::testing
