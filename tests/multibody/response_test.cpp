// SPDX-License-Identifier: BSD-3-Clause
// Compares impulse responses with full steps.
#include "mechanisms.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace grouser::multibody::test {
namespace {

/// A ring of links with damped joints, and a body tied to one link by a spring.
Mechanism dampedRing() {
  Mechanism m;
  RingSpec spec;
  spec.links = 10, spec.damping = 0.3;
  addRing(m.model, spec);
  const int free = m.model.addBody(makeBody("free", 2, kWheelInertia, {{3, 0, 0}, aboutY(0.3)}));
  PointSpring spring;
  spring.name = "spring", spring.bodyA = free, spring.bodyB = 4;
  spring.stiffness = 4e4, spring.damping = 20, spring.restLength = 2.5;
  m.model.addPointSpring(spring);
  m.start();
  return m;
}

/// Impulses on three bodies [N s], [N m s].
std::vector<Wrench> impulsesOn(const Model& model, double scale = 1) {
  std::vector<Wrench> p(model.bodies().size());
  p[1] = {scale * Vec3d{0.2, 0, 0.1}, scale * Vec3d{0.001, 0.01, 0}};
  p[6] = {scale * Vec3d{-0.1, 0.05, 0.3}, {}};
  p[10] = {scale * Vec3d{0, 0.3, -0.2}, scale * Vec3d{0.02, 0, 0.01}};
  return p;
}

double difference(const std::vector<Twist>& a, const std::vector<Twist>& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max({most, length(a[i].v - b[i].v), length(a[i].w - b[i].w)});
  return most;
}

/// Largest difference between the twists at the end of a step and the twists predicted by the response.
double errorOfPrediction(double dt) {
  Mechanism m = dampedRing();
  Solver solver(m.model);
  for (int i = 0; i < 20; ++i) solver.step(m.state, m.loads, 1e-4);
  const std::vector<Wrench> p = impulsesOn(m.model, 0.2);
  std::vector<Twist> predicted, change;
  solver.startResponse(m.state, m.loads, dt, predicted);
  solver.respond(p, change);
  for (std::size_t b = 0; b < change.size(); ++b) predicted[b].v += change[b].v, predicted[b].w += change[b].w;
  for (std::size_t b = 0; b < p.size(); ++b) m.loads.external[b] = {p[b].force * (1 / dt), p[b].torque * (1 / dt)};
  solver.step(m.state, m.loads, dt);
  return difference(predicted, m.state.twist);
}

TEST(MultibodyResponse, PredictsTheStepToFirstOrder) {
  const double coarse = errorOfPrediction(2e-4), fine = errorOfPrediction(2.5e-5);
  EXPECT_LT(coarse, 0.1);  // twists reach 5 rad/s
  EXPECT_GT(coarse, 1e-7); // Newton's method corrects it
  EXPECT_LT(fine, coarse / 8);
}

TEST(MultibodyResponse, IsLinearSymmetricAndBoundedByFreeBodies) {
  Mechanism m = dampedRing();
  Solver solver(m.model);
  std::vector<Twist> free, once, twice;
  solver.startResponse(m.state, m.loads, 1e-3, free);
  const std::vector<Wrench> p = impulsesOn(m.model);
  solver.respond(p, once);
  solver.respond(impulsesOn(m.model, 2), twice);
  std::vector<Wrench> q(p.size());
  q[3] = {{0.1, 0, -0.4}, {0, 0.02, 0}};
  std::vector<Twist> byQ;
  solver.respond(q, byQ);
  double energy = 0, without = 0, pq = 0, qp = 0;
  for (std::size_t b = 0; b < p.size(); ++b) {
    EXPECT_NEAR(length(twice[b].v - 2.0 * once[b].v), 0, 1e-12);
    energy += dot(p[b].force, once[b].v) + dot(p[b].torque, once[b].w);
    const Body& body = m.model.bodies()[b];
    const Mat3d R = body.pose.orientation.matrix();
    const Vec3d torque_B = base::transposedTimes(R, p[b].torque);
    without += norm2(p[b].force) / body.mass;
    for (int a = 0; a < 3; ++a) without += torque_B[a] * torque_B[a] / body.inertia_B.m[a][a];
    pq += dot(p[b].force, byQ[b].v) + dot(p[b].torque, byQ[b].w);
    qp += dot(q[b].force, once[b].v) + dot(q[b].torque, once[b].w);
  }
  EXPECT_GT(energy, 0);
  EXPECT_LT(energy, without);
  EXPECT_NEAR(pq, qp, 1e-10);
  EXPECT_GT(std::fabs(pq), 1e-4);
}

TEST(MultibodyResponse, DoesNotChangeTheStep) {
  Mechanism a = dampedRing(), b = dampedRing();
  Solver plain(a.model), asked(b.model);
  for (int i = 0; i < 50; ++i) {
    std::vector<Twist> twists;
    asked.startResponse(b.state, b.loads, 1e-4, twists);
    asked.respond(impulsesOn(b.model), twists);
    plain.step(a.state, a.loads, 1e-4), asked.step(b.state, b.loads, 1e-4);
  }
  EXPECT_EQ(a.state.save(), b.state.save());
}

TEST(MultibodyResponse, IsNotOfRattle) {
  Mechanism m = dampedRing();
  SolverOptions options;
  options.integrator = Integrator::kRattle;
  Solver solver(m.model, options);
  std::vector<Twist> twists;
  EXPECT_THROW(solver.startResponse(m.state, m.loads, 1e-4, twists), std::logic_error);
}

} // namespace
} // namespace grouser::multibody::test
