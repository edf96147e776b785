// SPDX-License-Identifier: BSD-3-Clause
#include "multibody/detail/soft_rows.hpp"

#include "multibody/detail/axis_laws.hpp"
#include "multibody/detail/axis_springs.hpp"
#include "multibody/detail/index.hpp"

#include <cmath>
#include <cstddef>

namespace grouser::multibody::detail {

namespace {

void add(SoftRow& row, const LinearSpring& spring) {
  row.stiffness += spring.stiffness;
  row.constant += spring.load + spring.stiffness * spring.rest;
  row.damping += spring.damping;
}

/// Mean force on one end stop over a stage, in the direction of the overlap; the axis receives the opposite force.
struct StopStage {
  double elastic = 0, damper = 0;
  double slope = 0; ///< derivative of both with respect to x1
};

/// `over0`, `over1`: overlap with this stop at the start and at the end of the stage, or 0.
StopStage stopStage(const AxisSpring& spring, double over0, double over1, double dx, double h) {
  const double k = spring.stopStiffness;
  StopStage stop;
  if (over0 * over1 > 0 || dx == 0) {
    stop.elastic = 0.5 * k * (over0 + over1);
    stop.slope = 0.5 * k;
  } else {
    // (V(x1) - V(x0)) / dx, if the axis is beyond the limit at one or both ends.
    stop.elastic = 0.5 * k * (over1 * over1 - over0 * over0) / dx;
    stop.slope = (k * over1 - stop.elastic) / dx;
  }
  stop.damper = spring.stopDamping * (over1 - over0) / h;
  if (over1 != 0) stop.slope += spring.stopDamping / h;
  // A stop is never adhesive: during separation its damper is limited by the spring force.
  if (stop.damper != 0 && (stop.elastic + stop.damper) * (over0 + over1) <= 0)
    stop.damper = -stop.elastic, stop.slope = 0;
  return stop;
}

template <class Use> void forEachStop(const AxisSpring& spring, double x0, double x1, double h, const Use& use) {
  const double over0 = overLimit(spring, x0), over1 = overLimit(spring, x1);
  if (over0 == 0 && over1 == 0) return;
  if (over0 * over1 >= 0) return use(stopStage(spring, over0, over1, x1 - x0, h));
  // The axis moves from one stop to the other within the stage.
  use(stopStage(spring, over0, 0, x1 - x0, h)), use(stopStage(spring, 0, over1, x1 - x0, h));
}

} // namespace

SoftRows::SoftRows(const Model& model, const ConstraintSystem& system, const std::vector<double>& driveStart)
    : model_(model), system_(system), driveStart_(driveStart), stopsOf_(system.axes().size()) {
  for (std::size_t s = 0; s < model.axisSprings().size(); ++s) {
    const AxisSpring& spring = model.axisSprings()[s];
    if (std::isfinite(spring.lowerLimit) || std::isfinite(spring.upperLimit))
      stopsOf_[at(system.axisOf(spring.joint, spring.axis))].push_back(static_cast<int>(s));
  }
}

void SoftRows::evaluate(const Loads& loads, double t, double h, std::vector<SoftRow>& rows) const {
  for (SoftRow& row : rows) row = {};
  for (std::size_t a = 0; a < rows.size(); ++a) {
    rows[a].stops = !stopsOf_[a].empty();
    add(rows[a], ownSpring(system_, model_, loads, system_.axes()[a]));
    const bool ofJoint = isJoint(system_.constraints()[at(system_.axes()[a].constraint)].kind);
    (ofJoint ? rows[a].jointDamping : rows[a].springDamping) = rows[a].damping;
  }
  for (std::size_t s = 0; s < model_.axisSprings().size(); ++s) {
    const AxisSpring& spring = model_.axisSprings()[s];
    SoftRow& row = rows[at(system_.axisOf(spring.joint, spring.axis))];
    add(row, linearSpring(spring, loads.axisSprings[s]));
    row.springDamping += spring.damping;
  }
  for (std::size_t d = 0; d < model_.drives().size(); ++d) {
    if (!loads.drives[d].on) continue;
    const Drive& drive = model_.drives()[d];
    SoftRow& row = rows[at(system_.axisOf(drive.joint, drive.axis))];
    if (drive.kind == DriveKind::kForce) {
      row.applied0 += drive.law.empty() ? loads.drives[d].force : drive.law.value(t);
      row.applied1 += drive.law.empty() ? loads.drives[d].force : drive.law.value(t + h);
      continue;
    }
    row.driven = true;
    row.relative = drive.law.empty();
    row.rate = row.relative ? loads.drives[d].speed : drivenRate(drive, t + h);
    row.target = row.relative ? h * row.rate : drivenPosition(drive, driveStart_[d], t + h);
    row.acceleration = row.relative                         ? 0
                       : drive.kind == DriveKind::kPosition ? drive.law.acceleration(t + h)
                                                            : drive.law.rate(t + h);
  }
}

ForceAndSlope SoftRows::stops(int axis, double x0, double x1, double h) const {
  ForceAndSlope sum;
  for (const int s : stopsOf_[at(axis)])
    forEachStop(model_.axisSprings()[at(s)], x0, x1, h, [&](const StopStage& stop) {
      sum.force -= stop.elastic + stop.damper;
      sum.slope += stop.slope;
    });
  return sum;
}

double SoftRows::stopForce(int axis, double x, double rate) const {
  double force = 0;
  for (const int s : stopsOf_[at(axis)]) {
    const AxisSpring& spring = model_.axisSprings()[at(s)];
    const double over = overLimit(spring, x), push = spring.stopStiffness * over + spring.stopDamping * rate;
    if (push * over > 0) force -= push;
  }
  return force;
}

double SoftRows::energy(const SoftRow& row, int axis, double x) const {
  double V = 0.5 * row.stiffness * x * x - row.constant * x;
  for (const int s : stopsOf_[at(axis)]) {
    const double over = overLimit(model_.axisSprings()[at(s)], x);
    V += 0.5 * model_.axisSprings()[at(s)].stopStiffness * over * over;
  }
  return V;
}

double SoftRows::stopLoss(int axis, double x0, double x1, double h) const {
  double loss = 0;
  for (const int s : stopsOf_[at(axis)])
    forEachStop(model_.axisSprings()[at(s)], x0, x1, h,
                [&](const StopStage& stop) { loss += stop.damper * (x1 - x0); });
  return loss;
}

} // namespace grouser::multibody::detail
