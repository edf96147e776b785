// SPDX-License-Identifier: BSD-3-Clause
#include "multibody/detail/geometric_stiffness.hpp"

#include "base/random.hpp"
#include "multibody/detail/axis_laws.hpp"
#include "multibody/detail/index.hpp"
#include "multibody/detail/reactions.hpp"
#include "multibody/detail/rotation.hpp"
#include "multibody/detail/vector6.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

/// Rows of constraints and springs rotate with the bodies, so that forces lambda along them change with the positions q
/// even at constant magnitude:
///
///   f(q) = J(q)^T lambda,    K u = -d/ds f(q + s u),
///
/// the geometric stiffness of structures under load. For example, the stiffness against rotation of a chain link under
/// the tension T is T times its length [N m/rad]. Both integrators use the directions of f at the beginning of a step.
/// With the mobility A under the constraints and an eigenvalue omega^2 of A K, a transverse oscillation is therefore
/// stable for steps up to 2 / omega, as with explicit springs; springs implicit along their axis only add mass.
namespace grouser::multibody::detail {

namespace {

/// Step of the finite difference: rotation, or displacement / shortest spring or distance [rad]. Truncation error (the
/// square of this step) and round-off are below 1e-7 of the forces.
constexpr double kTurn = 1e-4;
/// Limits of the power iteration. The estimate increases to the eigenvalue; an accuracy of 1 % is sufficient.
constexpr int kIterations = 200, kMinIterations = 12;
constexpr double kSettled = 1e-5;

class GeometricStiffness {
public:
  GeometricStiffness(const ConstraintSystem& system, const Model& model, const ConstraintSystem::Part& part,
                     const std::vector<Pose>& poses, const RowForces& forces)
      : system_(system), model_(model), part_(part), poses_(poses), forces_(forces), work_(forces.size(), 0.0) {
    system.place(poses, frames_);
    for (const int k : part.constraints) {
      const Constraint& c = system.constraints()[at(k)];
      if (c.kind != ConstraintKind::kDistance && c.kind != ConstraintKind::kPointSpring) continue;
      const JointFrames f = framesOf(c, frames_[at(c.bodyA)], frames_[at(c.bodyB)]);
      if (const double length = norm(f.p_B - f.p_A); length > 0) shortest_ = std::min(shortest_, length);
    }
  }

  bool loaded() const {
    return std::any_of(part_.constraints.begin(), part_.constraints.end(), [&](int k) {
      return std::any_of(forces_[at(k)].begin(), forces_[at(k)].end(), [](double force) { return force != 0; });
    });
  }

  /// x <- -K u for the motion u = x of the part's bodies; row entries become 0.
  void apply(std::vector<Vector6>& x) {
    double fastest = 0;
    for (const int node : part_.bodies) {
      const double v = norm(linear(x[at(node)]));
      // Pure translation changes lever arms linearly, so the displacement need not be small.
      fastest = std::max({fastest, v / shortest_, norm(angular(x[at(node)])), 1e-6 * v});
    }
    motion_ = x;
    clear(x);
    if (!(fastest > 0)) return;
    const double s = kTurn / fastest;
    std::fill(work_.begin(), work_.end(), 0.0);
    for (const double side : {1.0, -1.0}) {
      for (const int node : part_.bodies) {
        const int b = system_.bodyOf(node);
        Pose X = poses_[at(b)];
        X.position += side * s * linear(motion_[at(node)]);
        X.orientation = (rotationBy(side * s * angular(motion_[at(node)])) * X.orientation).normalized();
        system_.placeBody(b, X, frames_);
      }
      for (const int k : part_.constraints) addForces(k, side / (2 * s), x);
    }
  }

  /// u . M u of the part's bodies.
  double size2(const std::vector<Vector6>& x) const {
    double sum = 0;
    for (const int node : part_.bodies) {
      const Vec3d v = linear(x[at(node)]), w = angular(x[at(node)]);
      sum += model_.bodies()[at(system_.bodyOf(node))].mass * norm2(v) + dot(w, system_.inertia(node) * w);
    }
    return sum;
  }

  /// Constraint with the most work in the last apply().
  int hardestWorking() const {
    int most = -1;
    for (const int k : part_.constraints)
      if (work_[at(k)] != 0 && (most < 0 || std::fabs(work_[at(k)]) > std::fabs(work_[at(most)]))) most = k;
    return most;
  }

  void clear(std::vector<Vector6>& x) const {
    for (const int node : part_.bodies) x[at(node)] = {};
    for (const int k : part_.constraints) x[at(system_.movableBodies() + k)] = {};
    for (const int c : part_.couplings) x[at(system_.couplingNode(c))] = {};
  }

private:
  /// Adds the fraction `share` of the forces of constraint k at the current frames.
  void addForces(int k, double share, std::vector<Vector6>& x) {
    const Constraint& c = system_.constraints()[at(k)];
    const Frame &A = frames_[at(c.bodyA)], &B = frames_[at(c.bodyB)];
    const JointFrames f = framesOf(c, A, B);
    const RowDirections rows = rowDirections(c, f);
    Vec3d force, torque;
    for (std::size_t r = 0; r < 6; ++r) {
      force += share * forces_[at(k)][r] * rows.force[r];
      torque += share * forces_[at(k)][r] * rows.torque[r];
    }
    const auto act = [&](int node, const Vec3d& F, const Vec3d& M) {
      if (node < 0) return;
      add(x[at(node)], F, M);
      work_[at(k)] += dot(F, linear(motion_[at(node)])) + dot(M, angular(motion_[at(node)]));
    };
    act(c.nodeB, force, cross(f.p_B - B.p, force) + torque);
    act(c.nodeA, -force, -(cross(f.p_B - A.p, force) + torque));
  }

  const ConstraintSystem& system_;
  const Model& model_;
  const ConstraintSystem::Part& part_;
  const std::vector<Pose>& poses_;
  const RowForces& forces_;
  std::vector<Frame> frames_;
  std::vector<Vector6> motion_;
  std::vector<double> work_;                                  ///< one per constraint
  double shortest_ = std::numeric_limits<double>::infinity(); ///< spring or distance [m]
};

} // namespace

void findRowForces(const ConstraintSystem& system, const Model& model, const ConstraintSystem::Part& part,
                   const std::vector<Frame>& frames, const State& state, const Loads& loads, const SoftRows& softRows,
                   std::vector<Vector6>& x, RowForces& forces) {
  std::vector<SoftRow> soft(system.axes().size());
  softRows.evaluate(loads, state.time, 0, soft);
  std::vector<double> force(soft.size(), 0.0);
  for (const int k : part.constraints)
    for (int a = system.firstAxis(k); a < system.firstAxis(k + 1); ++a) {
      const bool joint = isJoint(system.constraints()[at(k)].kind);
      const double position = joint ? axisPositionIn(state, system, a) : system.positionOfAxis(a, frames);
      const double rate = system.rateOfAxis(a, state.twist);
      force[at(a)] =
          softRows.springForce(soft[at(a)], a, position, rate) - soft[at(a)].damping * rate + soft[at(a)].applied0;
    }
  solveReactions(system, model, part, frames, state, loads, soft, force, x);

  for (const int k : part.constraints) {
    forces[at(k)] = x[at(system.movableBodies() + k)];
    for (int a = system.firstAxis(k); a < system.firstAxis(k + 1); ++a)
      forces[at(k)][at(system.axes()[at(a)].row)] += force[at(a)];
  }
  for (const int c : part.couplings) {
    const CouplingRow& row = system.couplings()[at(c)];
    const Axis &one = system.axes()[at(row.axis1)], &two = system.axes()[at(row.axis2)];
    const double mu = x[at(system.couplingNode(c))][0];
    forces[at(two.constraint)][at(two.row)] += mu;
    forces[at(one.constraint)][at(one.row)] -= row.ratio * mu;
  }
}

/// Power iteration u <- A K u. In the norm of kinetic energy, A K is symmetric if forces balance, and |A K u| / |u|
/// increases to the largest absolute eigenvalue.
double highestGeometricFrequency(const ConstraintSystem& system, const Model& model, const ConstraintSystem::Part& part,
                                 const std::vector<Pose>& poses, const RowForces& forces, std::vector<Vector6>& x,
                                 int& constraint) {
  constraint = -1;
  GeometricStiffness stiffness(system, model, part, poses, forces);
  if (!stiffness.loaded()) return 0;

  // The response to random impulses contains every mode. The name is part of the seed.
  stiffness.clear(x);
  for (const int node : part.bodies) {
    const Body& body = model.bodies()[at(system.bodyOf(node))];
    const auto impulse = [&](std::uint64_t i) {
      return base::uniform(0, base::purpose("multibody.pull"), static_cast<std::uint64_t>(node), i) - 0.5;
    };
    const Mat3d& I = system.inertia(node);
    set(x[at(node)], std::sqrt(body.mass) * Vec3d{impulse(0), impulse(1), impulse(2)},
        std::sqrt(I.m[0][0] + I.m[1][1] + I.m[2][2]) * Vec3d{impulse(3), impulse(4), impulse(5)});
  }
  system.solve(part, x);

  double highest = 0;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    const double size = std::sqrt(stiffness.size2(x));
    if (!(size > 0 && std::isfinite(size))) break;
    for (const int node : part.bodies)
      for (double& v : x[at(node)]) v /= size;
    stiffness.apply(x);
    system.solve(part, x);
    const double now = std::sqrt(stiffness.size2(x));
    const bool settled = now - highest <= kSettled * now;
    highest = std::max(highest, now);
    if (settled && iteration >= kMinIterations) break;
  }
  constraint = stiffness.hardestWorking();
  return highest;
}

} // namespace grouser::multibody::detail
