// SPDX-License-Identifier: BSD-3-Clause
// Contacts of parts with damping and rotation in general directions; and contact times in closed form.
#include "contact/grain_part_contacts.hpp"
#include "contact/patch_contacts.hpp"
#include "contact/restitution.hpp"
#include "contact/rolling_resistance.hpp"

#include "base/math.hpp"
#include "part_fixture.hpp"

#include <gtest/gtest.h>

namespace grouser::contact::testing {
namespace {

using base::Vec3d;

TEST(ContactTimes, AreThoseOfTheDampedSwing) {
  EXPECT_NEAR(contactDuration(100, 0, true), base::kPi / 100, 1e-15);
  EXPECT_NEAR(contactDuration(100, 0.6, true), base::kPi / 80, 1e-15);
  // Without attraction, until the force is zero: x'' = -x - 2 zeta x', in small steps.
  for (const double zeta : {0.1, 0.6, 1.0, 1.5}) {
    double x = 0, v = 1, t = 0;
    constexpr double kStep = 1e-5;
    while (t == 0 || x + 2 * zeta * v > 0) {
      const double a = -x - 2 * zeta * v, half = v + 0.5 * kStep * a;
      v += kStep * (-(x + 0.5 * kStep * v) - 2 * zeta * half), x += kStep * half, t += kStep;
    }
    EXPECT_NEAR(100 * contactDuration(100, zeta, false), t, 3 * kStep) << zeta;
  }
}

TEST(ContactTimes, OfARayleighWaveFollowItsSpeed) {
  // pi R sqrt(rho / G) / (0.1631 nu + 0.8766): 3.51240737e-4 s / 0.92553.
  EXPECT_NEAR(rayleighTime(0.01, 2500, 2e7, 0.3), base::kPi * 0.01 * std::sqrt(2500 / 2e7) / 0.92553, 1e-15);
}

TEST(EnclosingRadius, ReachesToTheRimOfTheOutermostDisc) {
  base::SphereSet set;
  set.spheres.resize(2);
  set.spheres[0].centre = {3, 0, 4}, set.spheres[0].radius = 0.5, set.spheres[0].flat = 0.25;
  set.spheres[1].centre = {0, 5.1, 0}, set.spheres[1].radius = 0.1;
  EXPECT_NEAR(enclosingRadius(set), 5.75, 1e-15);
}

TEST(RollingSpring, IsStiffAsTheArmSquared) {
  ContactLaw law;
  law.rollingFriction = 0.1;
  EXPECT_NEAR(rollingStiffness(law, 1e5, 0.02), 2.25 * 1e5 * 0.002 * 0.002, 1e-12);
  // 1 / I = 1 / (1.4 x 2 x 0.01^2) + 1 / (1.4 x 3 x 0.02^2).
  EXPECT_NEAR(rollingInertia(2.0, 0.01, 3.0, 0.02), 1 / (1 / 2.8e-4 + 1 / 1.68e-3), 1e-15);
}

TEST(SlidingContact, DissipatesTheForceTimesTheWayLessWhatTheSpringHolds) {
  ContactLaw law;
  law.stiffness = 1e5, law.tangentialStiffness = 1e5 * 2 / 7, law.tangentialDamping = 1000, law.friction = 0.4;
  const double m = 0.01, overlap = 1e-4, dt = 1e-6, v = 0.3, normal = law.stiffness * overlap;
  Vec3d shear;
  double booked = 0, work = 0, bookedBefore = 0, workBefore = 0;
  for (int n = 0; n < 1000; ++n) {
    const BasicContactGeometry<double> touch{{0, 0, -1}, overlap, {0.6 * v, -0.8 * v, 0}, m, 0.005};
    const auto r = contactForce<kGeneral>(law, touch, dt, shear);
    booked += r.damped + r.rubbed, work -= dot(r.force, touch.velocity) * dt;
    if (n < 600) { // 0.14 mm of spring elongation at 0.3 um per step
      bookedBefore = booked, workBefore = work;
      continue;
    }
    // On Coulomb's cone, against the slip; the spring has the length of that force.
    EXPECT_NEAR(r.force.x, -0.6 * 0.4 * normal, 1e-12 * normal);
    EXPECT_NEAR(r.force.y, 0.8 * 0.4 * normal, 1e-12 * normal);
    EXPECT_NEAR(r.force.z, normal, 1e-12 * normal);
    EXPECT_NEAR(norm(shear), 0.4 * normal / law.tangentialStiffness, 1e-15);
  }
  const double stored = 0.5 * 0.4 * normal * 0.4 * normal / law.tangentialStiffness;
  EXPECT_NEAR(booked - bookedBefore, work - workBefore, 1e-12 * work) << "all work is dissipated during sliding";
  EXPECT_NEAR(booked, work - stored, 1e-3 * work) << "the first steps stick: the spring's work uses its end force";
  // After reversal at a tenth of the speed it acts as a spring and a dashpot, up to the opposite limit.
  const double slow = 0.1 * v, ct = 1000 * m;
  for (int n = 1; n <= 20; ++n) {
    const BasicContactGeometry<double> touch{{0, 0, -1}, overlap, {-0.6 * slow, 0.8 * slow, 0}, m, 0.005};
    const auto r = contactForce<kGeneral>(law, touch, dt, shear);
    const double along = 0.6 * r.force.x - 0.8 * r.force.y; // positive: along the previous slip
    EXPECT_NEAR(along, -0.4 * normal + law.tangentialStiffness * slow * n * dt + ct * slow, 1e-12 * normal);
  }
}

/// A plate of 0.1 m on a large one, with a damped foundation.
TEST(PlateValues, DampAcrossAndAlong) {
  const base::Exec exec = base::cpuExec(1);
  const base::SphereSet small = plate(0.05, 0.005, 0.005), large = plate(0.2, 0.005, 0.008);
  PartPartContacts::Model model;
  const double modulus = 1e9, relaxation = 2e-3, ratio = 0.8, overlap = 1e-4;
  model.law = {modulus, relaxation, 10, ratio};
  model.quanta.force = model.quanta.torque = model.quanta.moment = model.quanta.energy = base::fixedPointFor(1e6, 44);
  model.quanta.area = base::fixedPointFor(1, 40);
  model.timeStep = 1e-4, model.margin = 0.003;
  PartPartContacts contacts(exec, model, {&small, &large}, {0, 1}, {{0, 1}});
  base::Array<PartLoad> loads(exec, 2);
  double area = 0;
  for (const base::SetSphere& s : small.spheres) area += s.normal.z < 0 ? s.area : 0;
  PartMotion a = atRest({0, 0, 0.03 - overlap}), b = atRest({});
  a.velocity = {0.02, 0, -0.01}, b.velocity = {0, 0.03, 0};
  const base::Array<PartMotion> motion(exec, std::vector<PartMotion>{a, b});
  contacts.refresh(motion);
  const base::Array<double> travelled(exec, std::vector<double>{model.margin});
  contacts.compute(motion, travelled.data(), loads.data());
  const Vec3d f = model.quanta.force.value(loads.at(0).force);
  // Approach at 10 mm/s; sliding at (20, -30) mm/s; the spring contains one step of this motion.
  const double kt = ratio * modulus * area, along = kt * (model.timeStep + relaxation);
  EXPECT_NEAR(f.z, modulus * area * (overlap + relaxation * 0.01), 1e-3 * f.z);
  EXPECT_NEAR(f.x, -along * 0.02, 1e-3 * along * 0.02);
  EXPECT_NEAR(f.y, along * 0.03, 1e-3 * along * 0.03);
}

TEST(GrainOnPartValues, SlipTakesTheSpinsAndVelocitiesOfBoth) {
  const base::Exec exec = base::cpuExec(1);
  const base::SphereSet set = plate(0.1, 0.008, 0.008);
  GrainPartModel model;
  const double R = 0.027, overlap = 2e-4, kt = 2e5;
  model.radius = R, model.mass = 0.2, model.timeStep = 1e-4, model.margin = 0.01;
  model.law.stiffness = 1e6, model.law.friction = 10, model.law.tangentialStiffness = kt;
  model.scale = base::positionScale(2 * R);
  model.force = model.torque = base::fixedPointFor(1e6 * R, 36), model.energy = base::fixedPointFor(10, 36);
  GrainPartContacts contacts(exec, model, {&set}, {{0, {}, {}}});
  const Vec3d x{0.01, -0.02, R - overlap}, v{0.03, 0.01, 0}, w{0.4, -0.7, 0.2}, V{-0.02, 0.05, 0}, W{0, 0, 0.9};
  const Vec3d centre{0.05, 0.04, -0.1};
  const base::Array<base::Position> position(exec, std::vector{model.scale.fromMetres(x)});
  const auto four = [](const Vec3d& a) {
    return base::Vec4f{static_cast<float>(a.x), static_cast<float>(a.y), static_cast<float>(a.z), 0};
  };
  const base::Array<Motion> flight(exec, std::vector{Motion{four(v), four(w)}});
  const base::Array<std::uint32_t> id(exec, 1);
  const GrainsView grains{position.data(), flight.data(), id.data(), 1};
  PartMotion part = atRest({});
  part.centre = centre, part.velocity = V, part.spin = W;
  const base::Array<PartMotion> motion(exec, std::vector<PartMotion>{part});
  base::Array<PartLoad> loads(exec, 1);
  contacts.refresh(grains, motion);
  contacts.compute(grains, motion, loads.data());
  const Vec3d f = model.force.value(loads.at(0).force); // on the part
  const Vec3d arm{0, 0, -(R - overlap)}, point = x + arm, slip = v + cross(w, arm) - V - cross(W, point - centre);
  // One step of elongation; floats.
  EXPECT_NEAR(f.x, kt * slip.x * model.timeStep, 1e-3 * kt * norm(slip) * model.timeStep);
  EXPECT_NEAR(f.y, kt * slip.y * model.timeStep, 1e-3 * kt * norm(slip) * model.timeStep);
  EXPECT_NEAR(f.z, -1e6 * overlap, 1e-3 * 1e6 * overlap);
  const Vec3d torque = model.torque.value(loads.at(0).torque);
  EXPECT_NEAR(norm(torque - cross(point - centre, f)), 0, 1e-4 * norm(torque)) << "about its centre of mass";
}

} // namespace
} // namespace grouser::contact::testing
