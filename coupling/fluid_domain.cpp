// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/fluid_domain.hpp"

#include "base/error.hpp"

#include <algorithm>
#include <array>

namespace grouser::coupling {

using base::Vec3d;

namespace {

constexpr std::size_t kNumbers = 18; ///< numbers saved per body

fluid::Fluid makeFluid(const fluid::FluidSetup& setup, const FluidDomainState* former, const base::Exec& exec,
                       contact::PartitionOptions ranks, const base::Comm& comm) {
  ranks.comm = comm;
  return former ? fluid::Fluid(setup, former->fluid, exec, ranks) : fluid::Fluid(setup, exec, ranks);
}

} // namespace

/// Vectors saved per body.
template <class Follower> static auto numbersOf(Follower& f) {
  return std::array{&f.acceleration, &f.angularAcceleration, &f.before.v, &f.before.w, &f.sum.v, &f.sum.w};
}

FluidDomain::FluidDomain(const FluidDomainSetup& setup, const multibody::Model* model, const multibody::State* bodies,
                         const base::Exec& exec, const base::Comm& comm, const FluidDomainState* former)
    : setup_(setup), fluid_(makeFluid(withBodies(model, bodies, former), former, exec, setup.partition, comm)),
      waited_(former ? former->waited : 0) {}

fluid::FluidSetup FluidDomain::withBodies(const multibody::Model* model, const multibody::State* bodies,
                                          const FluidDomainState* former) {
  fluid::FluidSetup all = setup_.fluid;
  if (former && former->bodies.size() != kNumbers * setup_.bodies.size())
    throw base::InputError("the fluid in the checkpoint has different bodies; resume with the scene that was run");
  for (std::size_t k = 0; k < setup_.bodies.size(); ++k) {
    const BodyInFluid& b = setup_.bodies[k];
    const auto column = std::find(columns_.begin(), columns_.end(), b.column);
    Follower f{.body = b.body,
               .about = b.about,
               .column = static_cast<std::size_t>(column - columns_.begin()),
               .relaxation = 1 / (1 + b.gain),
               .before = bodies->twist[b.body]};
    if (column == columns_.end()) columns_.push_back(b.column);
    if (former) {
      const double* n = former->bodies.data() + kNumbers * k;
      for (Vec3d* v : numbersOf(f)) *v = {n[0], n[1], n[2]}, n += 3;
    }
    followers_.push_back(f);
    all.bodies.push_back(
        {"body \"" + model->bodies()[b.body].name + "\"", b.markers, motionOf(f, *bodies, f.before), b.touches});
  }
  return all;
}

fluid::BodyMotion FluidDomain::motionOf(const Follower& f, const multibody::State& state,
                                        const multibody::Twist& mean) const {
  return {state.pose[f.body], mean.v, mean.w, f.acceleration, f.angularAcceleration};
}

FluidDomainState FluidDomain::save() const {
  FluidDomainState state{fluid_.save(), {}, waited_};
  for (const Follower& f : followers_)
    for (const Vec3d* v : numbersOf(f)) state.bodies.insert(state.bodies.end(), {v->x, v->y, v->z});
  return state;
}

Vec3d FluidDomain::addLoads(multibody::Loads& loads) const {
  const std::vector<fluid::BodyLoad> ofFluid = bodyLoads();
  Vec3d sum;
  for (std::size_t k = 0; k < followers_.size(); ++k) {
    multibody::Wrench& wrench = loads.external[followers_[k].body];
    wrench.force += ofFluid[k].force, wrench.torque += ofFluid[k].torque;
    sum += ofFluid[k].force;
  }
  return sum;
}

std::vector<fluid::BodyLoad> FluidDomain::columnLoads(const multibody::State* bodies) const {
  std::vector<fluid::BodyLoad> sums(columns_.size());
  const std::vector<fluid::BodyLoad> ofFluid = bodyLoads();
  for (std::size_t k = 0; k < followers_.size(); ++k) {
    const Follower& f = followers_[k];
    const Vec3d arm = bodies->pose[f.body].position - bodies->pose[f.about].position;
    sums[f.column].force += ofFluid[k].force;
    sums[f.column].torque += ofFluid[k].torque + cross(arm, ofFluid[k].force);
  }
  return sums;
}

void FluidDomain::advance(const multibody::State* bodies) {
  for (Follower& f : followers_) f.sum.v += bodies->twist[f.body].v, f.sum.w += bodies->twist[f.body].w;
  if (++waited_ < setup_.stepsPerStep) return;
  const double perStep = 1 / fluid_.model().timeStep, share = 1.0 / static_cast<double>(waited_);
  std::vector<fluid::BodyMotion> motions;
  for (Follower& f : followers_) {
    const multibody::Twist& now = bodies->twist[f.body];
    f.acceleration += f.relaxation * ((now.v - f.before.v) * perStep - f.acceleration);
    f.angularAcceleration += f.relaxation * ((now.w - f.before.w) * perStep - f.angularAcceleration);
    motions.push_back(motionOf(f, *bodies, {f.sum.v * share, f.sum.w * share}));
    f.before = now, f.sum = {};
  }
  waited_ = 0;
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
