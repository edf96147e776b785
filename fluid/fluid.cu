// SPDX-License-Identifier: BSD-3-Clause
#include "fluid/fluid.hpp"

#include "base/algorithms.hpp"
#include "base/error.hpp"
#include "base/gather.cuh"
#include "base/hash.hpp"
#include "fluid/fluid_faults.hpp"
#include "fluid/fluid_kernels.cuh"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace grouser::fluid {

namespace {
constexpr double kMaxShift = 0.1; ///< maximum shift per step [spacings]
} // namespace

Fluid::Fluid(const FluidSetup& setup, const base::Exec& exec, const contact::PartitionOptions& ranks)
    : model_(checkedModel(setup)), constants_(fluidConstants(setup)), exec_(exec),
      surfaceDivergence_(setup.surfaceDivergence), comm_(ranks.comm), rebalances_(ranks.rebalance),
      particles_(setup.particles.size()),
      lists_(
          exec,
          static_cast<std::int64_t>(std::ceil((model_.kernel().support() + model_.skin()) * constants_.scale.perMetre)),
          constants_.period),
      fixedMarkers_(static_cast<std::uint32_t>(setup.markers.size())), body_(exec, setup.bodies.size()),
      bodyLoad_(exec, setup.bodies.size()), flags_(exec, 1) {
  const auto positionOf = [this](const base::Vec3d& at) {
    return base::fromUnits(constants_.period.wrapped(base::toUnits(constants_.scale.fromMetres(at))));
  };
  std::vector<base::Position> everywhere;
  for (const FluidParticle& p : setup.particles) everywhere.push_back(positionOf(p.position));
  const std::vector<std::uint32_t> mine = divide(everywhere, ranks);
  const std::size_t particles = slots_ = mine.size();
  std::vector<base::Position> position;
  std::vector<base::Vec4f> motion;
  std::vector<PreciseMotion> precise;
  position.reserve(particles), motion.reserve(particles), precise.reserve(particles);
  const auto place = [&](const base::Position& at, const base::Vec3d& velocity, double compression) {
    position.push_back(at);
    const base::Vec3f v = velocity.as<float>();
    motion.push_back({v.x, v.y, v.z, static_cast<float>(compression)});
  };
  for (const std::uint32_t i : mine) {
    const FluidParticle& p = setup.particles[i];
    place(everywhere[i], p.velocity, p.compression);
    precise.push_back({p.velocity, p.compression});
  }
  for (const WallMarker& m : setup.markers) place(positionOf(m.position), m.velocity, 0);
  std::vector<std::uint32_t> bodyOf;
  std::vector<float> bodyContact;
  std::vector<base::Vec3d> bodyPoint;
  for (std::size_t b = 0; b < setup.bodies.size(); ++b) {
    const FluidBody& body = setup.bodies[b];
    bodyContact.push_back(body.touches ? 0.0F : constants_.contact);
    bodyName_.push_back(body.name), bodyReach_.push_back(0), body_.host()[b] = body.start;
    for (const base::Vec3d& p : body.markers) {
      place(positionOf(body.start.pose.toWorld(p)), {}, 0);
      bodyOf.push_back(static_cast<std::uint32_t>(b)), bodyPoint.push_back(p);
      bodyReach_[b] = std::max(bodyReach_[b], norm(p));
    }
  }
  bodyOf_ = base::Array(exec, bodyOf), bodyPoint_ = base::Array(exec, bodyPoint);
  bodyContact_ = base::Array(exec, bodyContact);
  const std::size_t markers = setup.markers.size() + bodyPoint.size();
  position_ = base::Array(exec, position), motion_ = base::Array(exec, motion), precise_ = base::Array(exec, precise);
  reference_ = base::Array<base::Position>(exec, particles);
  force_ = base::Array<base::Vec3l>(exec, particles);
  change_ = base::Array<CompressionChange>(exec, particles);
  losses_ = base::Array<Losses>(exec, particles);
  const std::size_t shifted = model_.shifting > 0 ? particles : 0;
  shift_ = base::Array<base::Vec3d>(exec, shifted), divergence_ = base::Array<float>(exec, shifted);
  ghostVelocity_ = base::Array<base::Vec3f>(exec, model_.viscosity > 0 ? markers : 0);
  markerForce_ = base::Array<base::Vec3l>(exec, markers);
  id_ = base::Array(exec, mine);
  body_.upload();
  placeBodies(0);
  rebuild();
  computeForces();
  losses_.zero();
  *flags_.host() = {kNoFault, 0, 0};
  bodyLoad_.download();
  base::synchronize(exec_);
  agree();
}

namespace {
FluidSetup withParticles(FluidSetup setup, const FluidState& state) {
  if (state.particles.size() != setup.particles.size())
    throw base::InputError("the state belongs to another fluid; resume with the scene that was run");
  for (std::size_t i = 0; i < setup.particles.size(); ++i) {
    const SavedParticle& p = state.particles[i];
    setup.particles[i] = {p.position, p.velocity, p.compression};
  }
  return setup;
}
} // namespace

Fluid::Fluid(const FluidSetup& setup, const FluidState& state, const base::Exec& exec,
             const contact::PartitionOptions& ranks)
    : Fluid(withParticles(setup, state), exec, ranks) {
  steps_ = state.steps;
  if (state.bodyLoads.size() != 2 * bodyLoad_.size())
    throw base::InputError("the state belongs to a fluid with different bodies; resume with the scene that was run");
  // Forces are evaluated at the mid-step velocities of the last step.
  std::vector<Losses> losses(slots_);
  std::vector<base::Vec3l> force(slots_);
  const std::vector<std::uint32_t> id = id_.toHost(), ghost = ghostMarks() ? base::toHost(exec_, ghostMarks(), slots_)
                                                                           : std::vector<std::uint32_t>(slots_);
  for (std::size_t i = 0; i < slots_; ++i) {
    if (ghost[i]) continue;
    losses[i] = state.particles[id[i]].losses;
    force[i] = constants_.acceleration.quantise(state.particles[id[i]].acceleration);
  }
  losses_.assign(losses), force_.assign(force);
  for (std::size_t b = 0; b < bodyLoad_.size(); ++b)
    bodyLoad_.host()[b] = {state.bodyLoads[2 * b], state.bodyLoads[2 * b + 1]};
}

FluidState Fluid::save() const {
  const std::vector<base::Position> position = byId(position_);
  const std::vector<PreciseMotion> precise = byId(precise_);
  const std::vector<Losses> losses = byId(losses_);
  const std::vector<base::Vec3l> force = byId(force_);
  FluidState state{steps_, {}, {}};
  state.particles.reserve(particles());
  for (std::size_t i = 0; i < particles_; ++i)
    state.particles.push_back({constants_.scale.toMetres(position[i]), precise[i].velocity, precise[i].compression,
                               constants_.acceleration.value(force[i]), losses[i]});
  for (std::size_t b = 0; b < bodyLoad_.size(); ++b)
    state.bodyLoads.insert(state.bodyLoads.end(), {bodyLoad_.host()[b].force, bodyLoad_.host()[b].torque});
  return state;
}

FluidView Fluid::view() {
  return {constants_,
          model_.timeStep,
          model_.gravity,
          model_.attraction,
          static_cast<std::uint32_t>(slots_),
          position_.data(),
          motion_.data(),
          precise_.data(),
          force_.data(),
          change_.data(),
          losses_.data(),
          shift_.data(),
          divergence_.data(),
          ghostVelocity_.data(),
          markerForce_.data(),
          id_.data(),
          reference_.data(),
          fixedMarkers_,
          body_.device().data(),
          bodyOf_.data(),
          bodyContact_.data(),
          bodyPoint_.data(),
          bodyLoad_.device().data(),
          lists_.rows(),
          flags_.device().data(),
          ghostMarks()};
}

template <class T> void Fluid::permute(base::Array<T>& array) {
  if (array.empty()) return;
  auto sorted = base::Array<T>::unset(exec_, slots_);
  base::forEach(exec_, "sort fluid", static_cast<std::int64_t>(slots_),
                base::Gather<T>{lists_.order(), array.data(), sorted.data()});
  base::copyOnDevice(exec_, array.data(), sorted.data(), slots_ * sizeof(T));
}

void Fluid::rebuild() {
  if (subdomain_) migrate();
  lists_.sort(position_.data(), slots_, markers());
  permute(position_), permute(motion_), permute(precise_), permute(force_), permute(losses_), permute(id_);
  if (subdomain_) subdomain_->sorted(lists_.order(), slots_);
  lists_.build(position_.data(), ghostMarks());
  markerForce_.zero(); // markers without fluid neighbours are not computed
  base::copyOnDevice(exec_, reference_.data(), position_.data(), slots_ * sizeof(base::Position));
  listEnded_ = false, bodiesMoved_ = 0;
  ++rebuilds_;
}

void Fluid::placeBodies(double before) {
  if (body_.size() == 0) return;
  base::forEach(exec_, "place markers", static_cast<std::int64_t>(bodyOf_.size()), PlaceMarkers{view(), before});
}

/// Applies the body motion of a step, and rebuilds the lists if they would expire before its end.
void Fluid::advanceBodies(const std::vector<BodyMotion>& bodies) {
  if (bodies.size() != bodyName_.size()) throw std::logic_error("one motion per body of the fluid is required");
  const double most = 0.5 * model_.skin();
  double moves = 0;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const double way = (norm(bodies[b].velocity) + norm(bodies[b].spin) * bodyReach_[b]) * model_.timeStep;
    if (!(way < most)) throw base::SimulationError(bodyFaultText(bodyName_[b], way, model_, steps_));
    moves = std::max(moves, way);
    body_.host()[b] = bodies[b];
  }
  if (bodiesMoved_ + moves > most) listEnded_ = true;
  if (listEnded_) rebuild();
  bodiesMoved_ += moves;
  body_.upload();
}

void Fluid::computeContinuity() {
  const auto n = static_cast<std::int64_t>(slots_);
  if (model_.shifting > 0)
    base::forEach(exec_, "continuity and shifting", n, Continuity<true>{view()});
  else
    base::forEach(exec_, "continuity", n, Continuity<false>{view()});
}

void Fluid::computeForces() {
  const base::Array<std::uint32_t>& wet = lists_.wetMarkers();
  base::forEach(exec_, "wall pressures", static_cast<std::int64_t>(wet.size()), Extrapolate{view(), wet.data()});
  base::forEach(exec_, "store stress", static_cast<std::int64_t>(slots_), StoreStress{view()});
  base::forEach(exec_, "fluid forces", static_cast<std::int64_t>(slots_), Force{view()});
  bodyLoad_.device().zero();
  base::forEach(exec_, "wall forces", static_cast<std::int64_t>(wet.size()),
                WallForce{view(), wet.data(), 1 / model_.spacing});
}

void Fluid::step(const std::vector<BodyMotion>& bodies) {
  advanceBodies(bodies);
  const auto n = static_cast<std::int64_t>(slots_);
  *flags_.host() = {kNoFault, 0, 0};
  flags_.upload();
  const double skin = model_.skin(), shiftFactor = model_.shifting * model_.kernel().length() * model_.timeStep;
  const double greatestShift = model_.shifting > 0 ? kMaxShift * model_.spacing : 0.0;
  base::forEach(exec_, "fluid kick", n, Kick{view()});
  base::forEach(exec_, "fluid drift", n, Drift{view()});
  agreeOnSpeed();
  placeBodies(0.5 * model_.timeStep);
  updateGhosts();
  computeContinuity();
  placeBodies(0);
  base::forEach(exec_, "fluid compression and drift", n,
                CompressAndDrift{view(), skin, shiftFactor, greatestShift, surfaceDivergence_});
  updateGhosts();
  computeForces();
  base::forEach(exec_, "fluid kick", n, Kick{view(), 0.5 * skin - greatestShift});
  flags_.download(), bodyLoad_.download();
  base::synchronize(exec_);
  agree();
  ++steps_;
  checkFlags();
}

void Fluid::checkFlags() {
  const FluidFlags& flags = *flags_.host();
  if (flags.fault != kNoFault) {
    const FluidSnapshot now = snapshot();
    const auto id = static_cast<std::uint32_t>(flags.fault);
    throw base::SimulationError(
        faultText(flags.fault, model_, steps_, {now.position[id], now.velocity[id], now.compression[id]}));
  }
  listEnded_ = flags.listEnded != 0;
}

std::vector<base::Vec3d> Fluid::markerForces() const {
  std::vector<base::Vec3l> quanta = markerForce_.toHost();
  if (subdomain_) comm_.sum(&quanta.data()->x, 3 * quanta.size());
  std::vector<base::Vec3d> forces;
  forces.reserve(markers());
  for (const base::Vec3l& f : quanta) forces.push_back(constants_.acceleration.value(f) * model_.mass());
  return forces;
}

std::vector<BodyLoad> Fluid::bodyLoads() const {
  const double mass = model_.mass();
  std::vector<BodyLoad> loads;
  for (std::size_t b = 0; b < bodyLoad_.size(); ++b) {
    const BodyLoadQuanta& q = bodyLoad_.host()[b];
    loads.push_back(
        {constants_.acceleration.checked(q.force, "forces of the fluid on a body") * mass,
         constants_.acceleration.checked(q.torque, "torques of the fluid on a body") * (mass * model_.spacing)});
  }
  return loads;
}

base::Vec3l Fluid::forceBalance() const {
  base::Vec3l sum{};
  for (const base::Vec3l& f : byId(force_)) sum += f;
  base::Vec3l ofMarkers{};
  for (const base::Vec3l& f : markerForce_.toHost()) ofMarkers += f;
  comm_.sum(&ofMarkers.x, 3);
  sum += ofMarkers;
  return sum;
}

FluidSnapshot Fluid::snapshot() const {
  FluidSnapshot s;
  for (const base::Position& p : byId(position_)) s.position.push_back(constants_.scale.toMetres(p));
  for (const PreciseMotion& m : byId(precise_))
    s.velocity.push_back(m.velocity), s.compression.push_back(m.compression);
  return s;
}

std::uint64_t Fluid::hash() const {
  const std::vector<base::Position> position = byId(position_);
  const std::vector<PreciseMotion> precise = byId(precise_);
  const std::vector<base::Vec3l> force = byId(force_);
  base::StateHash hash;
  const auto add = [&hash](const auto& record) {
    std::uint64_t words[sizeof record / 8];
    std::memcpy(words, &record, sizeof record);
    for (const std::uint64_t w : words) hash.add(w);
  };
  for (std::size_t i = 0; i < particles_; ++i) add(position[i]), add(precise[i]), add(force[i]);
  return hash.value();
}

} // namespace grouser::fluid
