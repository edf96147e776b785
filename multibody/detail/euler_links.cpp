// SPDX-License-Identifier: BSD-3-Clause
// Euler step of the bodies and their tree joints, four at a time (link_simd.hpp). The scheme is described in
// euler_step.cpp, which handles the rest: loop constraints, point springs, bushings, couplings.
#include "multibody/detail/euler_step.hpp"

#include "multibody/detail/index.hpp"
#include "multibody/detail/vector6.hpp"

#include <cmath>
#include <cstddef>

namespace grouser::multibody::detail {

namespace {

constexpr std::size_t kWidth = kLanes;

/// Rotation per step times the spread of the inertia [rad] above which the gyroscopic equation of each body is solved
/// by Newton's method within the iteration; below this value the iteration itself converges. The second value is for
/// the exact solution, as in RATTLE.
constexpr double kFastSpin = 0.3, kAnySpin = 1e-7;

GROUSER_SIMD Vec3L axisForce(const LinkLanes& b, int a) { return b.rows.force[at(b.axisRow[at(a)])]; }
GROUSER_SIMD Vec3L axisTorque(const LinkLanes& b, int a) { return b.rows.torque[at(b.axisRow[at(a)])]; }

/// Three and six consecutive numbers of each lane.
GROUSER_SIMD Vec3L gather3(const double* const (&row)[kLanes]) {
  Vec3L v;
#pragma GCC unroll 4
  for (std::size_t l = 0; l < kWidth; ++l) v.x[l] = row[l][0], v.y[l] = row[l][1], v.z[l] = row[l][2];
  return v;
}
GROUSER_SIMD void gather6(const double* const (&row)[kLanes], Vec3L& first, Vec3L& second) {
  Lanes low[4], high[4];
  gatherRows(row, 0, low);
  gatherRows(row, 2, high);
  first = {low[0], low[1], low[2]}, second = {low[3], high[2], high[3]};
}
GROUSER_SIMD void gatherNode(const std::vector<Vector6>& x, const std::array<int, kLanes>& node, int first,
                             Lanes (&out)[6]) {
  const double* row[kLanes];
  for (std::size_t l = 0; l < kWidth; ++l) row[l] = x[at(first + node[l])].data();
  Lanes low[4], high[4];
  gatherRows(row, 0, low);
  gatherRows(row, 4, high);
  out[0] = low[0], out[1] = low[1], out[2] = low[2], out[3] = low[3], out[4] = high[0], out[5] = high[1];
}
/// Idle lanes write the same values as the first lane.
GROUSER_SIMD void scatterNode(std::vector<Vector6>& x, const std::array<int, kLanes>& node, int first,
                              const Lanes (&in)[6]) {
  Lanes low[4] = {in[0], in[1], in[2], in[3]}, high[4] = {in[4], in[5], all(0), all(0)};
  base::transpose(low);
  base::transpose(high);
  for (std::size_t l = 0; l < kWidth; ++l) {
    double* const to = x[at(first + node[l])].data();
    base::store(to, low[l]);
    base::store(to + 4, high[l]);
  }
}

GROUSER_SIMD void gatherTwists(const State& state, const std::array<int, kLanes>& body, Vec3L& v, Vec3L& w) {
  static_assert(sizeof(Twist) == 6 * sizeof(double));
  const double* row[kLanes];
  for (std::size_t l = 0; l < kWidth; ++l)
    row[l] = at(body[l]) < state.twist.size() ? &state.twist[at(body[l])].v.x : kStill.data();
  gather6(row, v, w);
}

GROUSER_SIMD Lanes largestOf(const Lanes& largest, const Lanes& value) {
  // With this comparison, NaN counts as the largest gap.
  return value <= largest ? largest : value;
}

double largestLane(const Lanes& x) {
  double largest = 0;
  for (int l = 0; l < kLanes; ++l)
    if (!(x[l] <= largest)) largest = x[l];
  return largest;
}

/// Sums four numbers over the lanes.
GROUSER_SIMD Lanes sumsOf(const Lanes& a, const Lanes& b, const Lanes& c, const Lanes& d) {
  Lanes x[4] = {a, b, c, d};
  base::transpose(x);
  return (x[0] + x[1]) + (x[2] + x[3]);
}

/// Rate of an axis of B relative to A: rate of the child relative to the parent, times `side`.
GROUSER_SIMD Lanes axisRate(const LinkLanes& b, int a, const Vec3L& v, const Vec3L& w, const Vec3L& parentV,
                            const Vec3L& parentW) {
  const Vec3L& p = b.frames.p_B;
  const Vec3L there = (v + cross(w, p - b.com)) - (parentV + cross(parentW, p - b.parentCom));
  return b.side * (dot(axisForce(b, a), there) + dot(axisTorque(b, a), w - parentW));
}

} // namespace

/// Initial and external momentum.
GROUSER_SIMD_CLONES void EulerStep::startLinks(const State& state, const Loads& loads, double dt) {
  static_assert(sizeof(Wrench) == 6 * sizeof(double) && sizeof(Pose) == 7 * sizeof(double));
  const Vec3L gravity = all(loads.gravity);
  const Lanes h = all(dt);
  Vec3L impulse{}, moment{};
  for (std::size_t i = 0; i < steps_.size(); ++i) {
    const LinkLanes& b = system_.links()[i];
    LinkStep& s = steps_[i];
    const Lanes(&I)[6] = system_.inertiaOf(i);
    const double* row[kLanes];
    for (std::size_t l = 0; l < kWidth; ++l) row[l] = &loads.external[at(b.body[l])].force.x;
    Vec3L force, torque;
    gather6(row, force, torque);
    gatherTwists(state, b.body, s.v, s.w);
    for (std::size_t l = 0; l < kWidth; ++l) row[l] = &state.angularMomentum[at(b.body[l])].x;
    const Vec3L spin = gather3(row);
    for (std::size_t l = 0; l < kWidth; ++l) row[l] = &state.pose[at(b.body[l])].position.x;
    Lanes low[4], high[4];
    gatherRows(row, 0, low);
    gatherRows(row, 3, high);
    s.position = {low[0], low[1], low[2]};
    s.orientation = {high[0], high[1], high[2], high[3]};

    s.v0 = s.v, s.w0 = s.w, s.force = force, s.torque = torque;
    s.gyro = gyroscopicMomentum(I, s.w, dt);
    const Vec3L f = h * (force + b.mass * gravity);
    s.gyroLeft = (spin - timesInertia(I, s.w)) - s.gyro;
    const Vec3L m = s.gyroLeft + h * torque;
    scatterNode(x_, b.node, 0, {f.x, f.y, f.z, m.x, m.y, m.z});
    impulse += b.real * f;
    moment += b.real * (cross(s.position, f) + h * torque);
    for (Lanes& lambda : s.impulse) lambda = all(0);
  }
  const Lanes linear = sumsOf(impulse.x, impulse.y, impulse.z, impulse.z);
  const Lanes angular = sumsOf(moment.x, moment.y, moment.z, moment.z);
  fromOutside_ = {{linear[0], linear[1], linear[2]}, {angular[0], angular[1], angular[2]}};
}

/// Axis angles and rates before the step, and the known forces along the axes.
GROUSER_SIMD_CLONES void EulerStep::startLinkAxes(const State& state, double dt) {
  for (std::size_t i = 0; i < steps_.size(); ++i) {
    const LinkLanes& b = system_.links()[i];
    LinkStep& s = steps_[i];
    if (!b.joint) continue;
    gatherTwists(state, b.parent, s.parentV0, s.parentW0);
    if (b.axes == 0) continue;
    s.startCos = dot(b.frames.x_A, b.frames.x_B), s.startSin = dot(b.frames.y_A, b.frames.x_B);
    for (int a = 0; a < b.axes; ++a) {
      s.oldRate[a] = axisRate(b, a, s.v, s.w, s.parentV0, s.parentW0);
      // The known force of a spring acts along its row.
      for (int l = 0; l < b.count; ++l) {
        const double known = laws_[at(b.axis[at(a)][at(l)])].force;
        if (known == 0) continue;
        const auto get = [l](const Vec3L& v) { return Vec3d{v.x[l], v.y[l], v.z[l]}; };
        const double impulse_B = b.side[l] * dt * known;
        const Vec3d along = impulse_B * get(axisForce(b, a)), about = impulse_B * get(axisTorque(b, a));
        const Vec3d p = get(b.frames.p_B);
        add(x_[at(b.node[at(l)])], along, cross(p - get(b.com), along) + about);
        if (const int parent = b.parentNode[at(l)]; parent >= 0)
          add(x_[at(parent)], -along, -(cross(p - get(b.parentCom), along) + about));
      }
    }
  }
}

/// Residual of the momentum: after the new impulses it is I w + the gyroscopic part of the previous iterate.
void EulerStep::solveAngularVelocity(const Lanes (&inertia)[6], LinkStep& s, int l, double dt) {
  const auto get = [l](const Vec3L& v) { return Vec3d{v.x[l], v.y[l], v.z[l]}; };
  const auto put = [l](Vec3L& v, const Vec3d& value) { v.x[l] = value.x, v.y[l] = value.y, v.z[l] = value.z; };
  const double lower[6] = {inertia[0][l], inertia[1][l], inertia[2][l], inertia[3][l], inertia[4][l], inertia[5][l]};
  const Mat3d I{{{lower[0], lower[1], lower[2]}, {lower[1], lower[3], lower[4]}, {lower[2], lower[4], lower[5]}}};
  const Vec3d w = angularVelocityOf(I, I * get(s.w) + get(s.gyro), get(s.w), dt);
  const Vec3d gyro = gyroscopicMomentum(I, w, dt); // solved: no residual for the next iterate
  put(s.w, w);
  put(s.gyroLeft, get(s.gyroLeft) + (get(s.gyro) - gyro));
  put(s.gyro, gyro);
}

/// Adds the corrections to twists and impulses.
GROUSER_SIMD_CLONES void EulerStep::correctLinks(double dt) {
  const double fastSpin = options_.exactGyroscopics ? kAnySpin : kFastSpin;
  for (std::size_t i = 0; i < steps_.size(); ++i) {
    const LinkLanes& b = system_.links()[i];
    LinkStep& s = steps_[i];
    Lanes d[6];
    gatherNode(x_, b.node, 0, d);
    s.v += Vec3L{d[0], d[1], d[2]};
    s.w += Vec3L{d[3], d[4], d[5]};
    const LaneMask fast = all(dt) * squareRoot(norm2(s.w)) * s.spread > fastSpin;
    if (__builtin_expect(base::any(fast), 0))
      for (int l = 0; l < kLanes; ++l)
        if (fast[l] && !relinearised_) solveAngularVelocity(system_.inertiaOf(i), s, l, dt);
    if (!b.joint) continue;
    gatherNode(x_, b.constraint, system_.movableBodies(), d);
    for (int r = 0; r < 6; ++r) s.impulse[r] += d[r];
  }
}

/// Unpacks the iterate into arrays per body and joint.
void EulerStep::unpackIterate() {
  for (std::size_t i = 0; i < steps_.size(); ++i) {
    const LinkLanes& b = system_.links()[i];
    const LinkStep& s = steps_[i];
    for (int l = 0; l < b.count; ++l) {
      newTwist_[at(b.body[at(l)])] = {{s.v.x[l], s.v.y[l], s.v.z[l]}, {s.w.x[l], s.w.y[l], s.w.z[l]}};
      if (!b.joint) continue;
      for (std::size_t r = 0; r < 6; ++r) impulse_[at(b.constraint[at(l)])][r] = s.impulse[r][l];
    }
  }
}

void EulerStep::packTwists() {
  for (std::size_t i = 0; i < steps_.size(); ++i)
    for (std::size_t l = 0; l < kWidth; ++l) {
      LinkStep& s = steps_[i];
      const Twist& V = newTwist_[at(system_.links()[i].body[l])];
      s.v.x[l] = V.v.x, s.v.y[l] = V.v.y, s.v.z[l] = V.v.z;
      s.w.x[l] = V.w.x, s.w.y[l] = V.w.y, s.w.z[l] = V.w.z;
    }
}

GROUSER_SIMD_CLONES void EulerStep::moveLinks(double dt) {
  const Lanes h = all(dt);
  for (std::size_t i = 0; i < steps_.size(); ++i) {
    const LinkLanes& b = system_.links()[i];
    LinkStep& s = steps_[i];
    s.trial.p = s.position + h * s.v;
    s.newOrientation = turned(rotationBy(h * s.w), s.orientation);
    s.trial.R = matrixOf(s.newOrientation);
    const Mat3L& R = s.trial.R;
    Lanes c[3][4] = {{R.m[0][0], R.m[0][1], R.m[0][2], R.m[1][0]},
                     {R.m[1][1], R.m[1][2], R.m[2][0], R.m[2][1]},
                     {R.m[2][2], s.trial.p.x, s.trial.p.y, s.trial.p.z}};
    for (int part = 0; part < 3; ++part) {
      base::transpose(c[part]);
      for (std::size_t l = 0; l < kWidth; ++l)
        base::store(reinterpret_cast<double*>(&trial_[at(b.body[l])]) + 4 * part, c[part][l]);
    }
  }
}

/// Gaps of the joints as residuals; in the first iteration also the residuals of soft and driven axes.
GROUSER_SIMD_CLONES double EulerStep::setLinkGaps(double dt, bool first) {
  Lanes largest = all(0);
  const Lanes scale = all(-1 / dt);
  for (std::size_t i = 0; i < steps_.size(); ++i) {
    const LinkLanes& b = system_.links()[i];
    LinkStep& s = steps_[i];
    if (!b.joint) continue;
    FrameL parent, A, B;
    gatherFrames(trial_, b.parent, parent);
    b.sort(s.trial, parent, A, B);
    placeFrames(b.places, A, B, s.joint);
    Lanes error[6] = {};
    jointError(b.kind, s.joint, error);
    Lanes residual[6];
    for (int r = 0; r < 6; ++r) {
      largest = largestOf(largest, base::absolute(error[r]));
      residual[r] = scale * error[r];
    }
    if (first)
      for (int a = 0; a < b.axes; ++a) {
        Lanes wanted;
        for (std::size_t l = 0; l < kWidth; ++l) {
          const AxisLaw& law = laws_[at(b.axis[at(a)][l])];
          wanted[l] = law.driven ? law.speed : 0;
        }
        residual[b.axisRow[at(a)]] = wanted - s.oldRate[a];
      }
    scatterNode(x_, b.constraint, system_.movableBodies(), residual);
  }
  return largestLane(largest);
}

/// Passes the gyroscopic residual of an iterate to the next one.
void EulerStep::takeGyroResiduals() {
  for (std::size_t i = 0; i < steps_.size(); ++i)
    for (std::size_t l = 0; l < kWidth; ++l) {
      const Vector6& residual = x_[at(system_.links()[i].node[l])];
      Vec3L& left = steps_[i].gyroLeft;
      left.x[l] += residual[3], left.y[l] += residual[4], left.z[l] += residual[5];
    }
}

GROUSER_SIMD_CLONES double EulerStep::setLinkGyro(double dt) {
  Lanes largest = all(0);
  for (std::size_t i = 0; i < steps_.size(); ++i) {
    const LinkLanes& b = system_.links()[i];
    LinkStep& s = steps_[i];
    const Lanes(&I)[6] = system_.inertiaOf(i);
    const Vec3L g = gyroscopicMomentum(I, s.w, dt), residual = s.gyro - g;
    s.gyro = g;
    scatterNode(x_, b.node, 0, {all(0), all(0), all(0), residual.x, residual.y, residual.z});
    largest = largestOf(largest, all(3 * dt) / (I[0] + I[3] + I[5]) * squareRoot(norm2(residual)));
  }
  return largestLane(largest);
}

/// Work, momenta, readings and poses, once the impulses are known.
GROUSER_SIMD_CLONES void EulerStep::finishLinks(State& state, const Loads& loads, double dt) {
  LinkWork work{};
  for (std::size_t i = 0; i < steps_.size(); ++i) finishBodies(system_.links()[i], steps_[i], state, loads, dt, work);
  for (std::size_t i = 0; i < steps_.size(); ++i)
    if (system_.links()[i].joint) finishJoints(system_.links()[i], steps_[i], state, dt, work);
  Ledger& ledger = state.ledger;
  const Lanes works = sumsOf(work.gravity, work.external, work.drive, work.spring);
  const Lanes losses = sumsOf(work.dissipated, work.jointDamping, work.springDamping, work.stopDamping);
  const Lanes rest = sumsOf(work.kinetic, work.turnover, work.fall, work.fall);
  ledger.gravityWork += works[0];
  ledger.externalWork += works[1];
  ledger.driveWork += works[2];
  ledger.springWork += works[3];
  ledger.dissipated += losses[0];
  ledger.potentialGain += -dt * rest[2];
  stepLedger_ = {rest[0],   rest[1],  fromOutside_.v + work.ground, fromOutside_.w + work.groundMoment, losses[1],
                 losses[2], losses[3]};
}

/// Work of loads on four bodies, and their new state.
GROUSER_SIMD void EulerStep::finishBodies(const LinkLanes& b, const LinkStep& s, State& state, const Loads& loads,
                                          double dt, LinkWork& work) const {
  const Lanes half = all(0.5 * dt);
  const Vec3L path = half * (s.v0 + s.v), turn = half * (s.w0 + s.w);
  const Vec3L g = all(loads.gravity);
  const Lanes gravity = b.real * (b.mass * dot(g, path));
  const Lanes external = b.real * (dot(s.force, path) + dot(s.torque, turn));
  const Lanes gyroscopic = b.real * (all(1 / dt) * dot(turn, s.gyroLeft));
  work.gravity += gravity;
  work.external += external;
  work.kinetic += gravity + external + gyroscopic;
  work.turnover += base::absolute(gravity) + base::absolute(external) + base::absolute(gyroscopic);
  work.fall += b.real * (b.mass * dot(g, s.v));
  const Lanes v2 = norm2(s.v), turn2 = all(dt * dt) * norm2(s.w);
  const LaneMask sound = (v2 * 0.0 == 0.0) & (turn2 <= kLargestTurn * kLargestTurn);
  for (int l = 0; l < b.count; ++l) {
    const std::size_t body = at(b.body[at(l)]);
    if (!sound[l])
      checkTwist(model_.bodies()[body], {{s.v.x[l], s.v.y[l], s.v.z[l]}, {s.w.x[l], s.w.y[l], s.w.z[l]}}, state.time,
                 dt);
    state.angularMomentum[body] += Vec3d{dt * s.torque.x[l], dt * s.torque.y[l], dt * s.torque.z[l]};
    state.twist[body] = {{s.v.x[l], s.v.y[l], s.v.z[l]}, {s.w.x[l], s.w.y[l], s.w.z[l]}};
    state.pose[body] = {{s.trial.p.x[l], s.trial.p.y[l], s.trial.p.z[l]},
                        {s.newOrientation.w[l], s.newOrientation.x[l], s.newOrientation.y[l], s.newOrientation.z[l]}};
  }
}

/// Impulses of four joints, their work and readings.
GROUSER_SIMD void EulerStep::finishJoints(const LinkLanes& b, const LinkStep& s, State& state, double dt,
                                          LinkWork& work) const {
  Lanes total[6], newRate[2];
  for (int r = 0; r < 6; ++r) total[r] = s.impulse[r];
  Vec3L parentV, parentW;
  gatherTwists(state, b.parent, parentV, parentW);
  for (int a = 0; a < b.axes; ++a) {
    newRate[a] = axisRate(b, a, s.v, s.w, parentV, parentW);
    addAxis(b, s, a, newRate[a], dt, total[b.axisRow[at(a)]], work);
  }

  Vec3L force{}, torque{};
  for (std::size_t r = 0; r < 6; ++r) {
    force += b.rows.force[r] * total[r];
    torque += b.rows.torque[r] * total[r];
  }
  const Vec3L& p = b.frames.p_B;
  const Vec3L onChild = b.side * (cross(p - b.com, force) + torque);
  const Vec3L onParent = b.side * (cross(p - b.parentCom, force) + torque);
  const Lanes done = 0.5 * b.real *
                     (b.side * dot(force, (s.v0 + s.v) - (s.parentV0 + parentV)) + dot(onChild, s.w0 + s.w) -
                      dot(onParent, s.parentW0 + parentW));
  work.kinetic += done;
  work.turnover += base::absolute(done);
  for (int l = 0; l < b.count; ++l) {
    state.angularMomentum[at(b.body[at(l)])] += Vec3d{onChild.x[l], onChild.y[l], onChild.z[l]};
    if (b.parentNode[at(l)] >= 0)
      state.angularMomentum[at(b.parent[at(l)])] -= Vec3d{onParent.x[l], onParent.y[l], onParent.z[l]};
    else {
      const Vec3d onBodies = b.side[l] * Vec3d{force.x[l], force.y[l], force.z[l]};
      work.ground += onBodies;
      work.groundMoment +=
          cross(Vec3d{p.x[l], p.y[l], p.z[l]}, onBodies) + b.side[l] * Vec3d{torque.x[l], torque.y[l], torque.z[l]};
    }
    JointReading& reading = state.joint[at(b.constraint[at(l)])]; // joints are the first constraints
    reading.force = Vec3d{force.x[l], force.y[l], force.z[l]} * (1 / dt);
    reading.torque = Vec3d{torque.x[l], torque.y[l], torque.z[l]} * (1 / dt);
  }
  for (int a = 0; a < b.axes; ++a) readAxis(b, s, a, total[b.axisRow[at(a)]], newRate[a], state, dt);
}

/// Adds the known force of an axis to the impulse `total` of its row, and its work.
GROUSER_SIMD void EulerStep::addAxis(const LinkLanes& b, const LinkStep& s, int a, const Lanes& newRate, double dt,
                                     Lanes& total, LinkWork& work) const {
  const Lanes perTime = all(1 / dt), path = all(0.5 * dt) * (s.oldRate[a] + newRate);
  const double* row[kLanes];
  Lanes known[4], damping[4], driven;
  for (std::size_t l = 0; l < kWidth; ++l) {
    const AxisLaw& law = laws_[at(b.axis[at(a)][l])];
    row[l] = &law.force;
    driven[l] = law.driven ? 1 : 0;
  }
  // Force, known, driveForce, inverseCompliance; dampingPart, jointDamping, springDamping, stopDamping.
  constexpr std::size_t kDouble = sizeof(double);
  static_assert(offsetof(AxisLaw, force) == 0 && offsetof(AxisLaw, known) == kDouble &&
                offsetof(AxisLaw, driveForce) == 2 * kDouble && offsetof(AxisLaw, inverseCompliance) == 3 * kDouble &&
                offsetof(AxisLaw, dampingPart) == 4 * kDouble && offsetof(AxisLaw, jointDamping) == 5 * kDouble &&
                offsetof(AxisLaw, springDamping) == 6 * kDouble && offsetof(AxisLaw, stopDamping) == 7 * kDouble);
  gatherRows(row, 0, known);
  gatherRows(row, 4, damping);
  total += all(dt) * known[0];
  const Lanes drive = driven > 0.0 ? s.impulse[b.axisRow[at(a)]] * perTime : all(0);
  work.drive += b.real * ((drive + known[2]) * path);
  work.spring += b.real * ((known[1] - (known[3] - damping[0]) * perTime * newRate) * path);
  work.dissipated += b.real * (damping[0] * perTime * newRate * path);
  const Lanes each = b.real * (perTime * newRate * path);
  work.jointDamping += damping[1] * each;
  work.springDamping += damping[2] * each;
  work.stopDamping += damping[3] * each;
}

/// Position, rate and forces of one axis of four joints.
GROUSER_SIMD void EulerStep::readAxis(const LinkLanes& b, const LinkStep& s, int a, const Lanes& total,
                                      const Lanes& newRate, State& state, double dt) const {
  const int r = b.axisRow[at(a)];
  const bool slide = b.kind == ConstraintKind::kCylindrical && r == kSlideRow;
  Lanes position;
  if (slide || b.kind == ConstraintKind::kPrismatic) {
    position = dot(s.joint.z_A, s.joint.p_B - s.joint.p_A);
  } else {
    // The increment of the angle, as in axisPositionAfter().
    const Lanes &c0 = s.startCos, &s0 = s.startSin;
    const Lanes c1 = dot(s.joint.x_A, s.joint.x_B), s1 = dot(s.joint.y_A, s.joint.x_B);
    const Lanes sine = s1 * c0 - c1 * s0, cosine = c1 * c0 + s1 * s0;
    position = angleIncrement(sine, cosine);
    for (std::size_t l = 0; l < kWidth; ++l) position[l] = state.joint[at(b.constraint[l])].position + position[l];
  }
  const Lanes axisForce = total / all(dt);
  for (int l = 0; l < b.count; ++l) {
    const AxisLaw& law = laws_[at(b.axis[at(a)][at(l)])];
    const auto read = [&](auto& axis) {
      axis.position = position[l];
      axis.rate = newRate[l];
      axis.axisForce = axisForce[l];
      axis.driveForce = (law.driven ? s.impulse[r][l] / dt : 0) + law.driveForce;
      // Most axes have no spring; this saves a division.
      axis.springForce = law.springInverseCompliance == 0
                             ? law.springKnown
                             : law.springKnown - law.springInverseCompliance / dt * newRate[l];
    };
    const std::size_t source = at(b.constraint[at(l)]);
    if (slide)
      read(state.slide[source]);
    else
      read(state.joint[source]);
  }
}

} // namespace grouser::multibody::detail
