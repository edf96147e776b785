// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/fluid_domain.hpp"

#include "base/error.hpp"

namespace grouser::coupling {

using base::Vec3d;

namespace {

fluid::Fluid makeFluid(const fluid::FluidSetup& setup, const FluidDomainState* former, const base::Exec& exec) {
  return former ? fluid::Fluid(setup, former->fluid, exec) : fluid::Fluid(setup, exec);
}

} // namespace

FluidDomain::FluidDomain(const FluidDomainSetup& setup, const multibody::Model* model, const multibody::State* bodies,
                         const base::Exec& exec, const FluidDomainState* former)
    : setup_(setup), fluid_(makeFluid(withBodies(model, bodies, former), former, exec)) {}

fluid::FluidSetup FluidDomain::withBodies(const multibody::Model* model, const multibody::State* bodies,
                                          const FluidDomainState* former) {
  fluid::FluidSetup all = setup_.fluid;
  if (former && former->accelerations.size() != 6 * setup_.bodies.size())
    throw base::InputError("the fluid of the checkpoint has other bodies; resume with the scene that was run");
  for (std::size_t k = 0; k < setup_.bodies.size(); ++k) {
    const BodyInFluid& b = setup_.bodies[k];
    Follower f{b.body, 1 / (1 + b.gain), bodies->twist[b.body], {}, {}};
    if (former) {
      const double* a = former->accelerations.data() + 6 * k;
      f.acceleration = {a[0], a[1], a[2]}, f.angularAcceleration = {a[3], a[4], a[5]};
    }
    followers_.push_back(f);
    names_.push_back(model->bodies()[b.body].name);
    all.bodies.push_back({"body \"" + names_.back() + "\"", b.markers, motionOf(f, *bodies)});
  }
  return all;
}

fluid::BodyMotion FluidDomain::motionOf(const Follower& f, const multibody::State& state) const {
  const multibody::Twist& V = state.twist[f.body];
  return {state.pose[f.body], V.v, V.w, f.acceleration, f.angularAcceleration};
}

FluidDomainState FluidDomain::save() const {
  FluidDomainState state{fluid_.save(), {}};
  for (const Follower& f : followers_)
    for (const Vec3d& a : {f.acceleration, f.angularAcceleration})
      state.accelerations.insert(state.accelerations.end(), {a.x, a.y, a.z});
  return state;
}

void FluidDomain::addLoads(multibody::Loads& loads) const {
  const std::vector<fluid::BodyLoad> ofFluid = bodyLoads();
  for (std::size_t k = 0; k < followers_.size(); ++k) {
    multibody::Wrench& wrench = loads.external[followers_[k].body];
    wrench.force += ofFluid[k].force, wrench.torque += ofFluid[k].torque;
  }
}

void FluidDomain::advance(const multibody::State* bodies) {
  const double perStep = 1 / fluid_.model().timeStep;
  std::vector<fluid::BodyMotion> motions;
  for (Follower& f : followers_) {
    const multibody::Twist& now = bodies->twist[f.body];
    f.acceleration += f.relaxation * ((now.v - f.before.v) * perStep - f.acceleration);
    f.angularAcceleration += f.relaxation * ((now.w - f.before.w) * perStep - f.angularAcceleration);
    f.before = now;
    motions.push_back(motionOf(f, *bodies));
  }
  fluid_.step(motions);
  totals_.reset();
}

const fluid::FluidTotals& FluidDomain::totals() {
  if (!totals_) totals_ = fluid_.totals();
  return *totals_;
}

std::vector<double> FluidDomain::probe() {
  std::vector<Vec3d> points, feet;
  for (const FluidProbePoint& p : setup_.probes) (p.level ? feet : points).push_back(p.position);
  const std::vector<double> pressures = points.empty() ? std::vector<double>{} : fluid_.pressuresAt(points);
  const std::vector<double> levels = feet.empty() ? std::vector<double>{} : fluid_.levelsAt(feet, setup_.top);
  std::vector<double> values;
  std::size_t point = 0, foot = 0;
  for (const FluidProbePoint& p : setup_.probes) values.push_back(p.level ? levels[foot++] : pressures[point++]);
  return values;
}

} // namespace grouser::coupling
