// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/surfaces.hpp"

#include "base/error.hpp"
#include "coupling/ledger_entries.hpp"

#include <cmath>
#include <fmt/format.h>
#include <utility>

namespace grouser::coupling {

using base::Vec3d;

void MovedMeshes::begin(std::vector<terrain::SurfacePose> poses) {
  poses_ = std::move(poses);
  bodyOfPart_.resize(poses_.size()), inverses_.resize(poses_.size());
  for (std::size_t k = 0; k < poses_.size(); ++k)
    bodyOfPart_[k] = static_cast<std::uint32_t>(k), inverses_[k].mass = poses_[k].inverseMass;
}

void MovedMeshes::respond(const std::vector<contact::BodyImpulse>& impulses,
                          std::vector<contact::BodyVelocity>& velocities) {
  velocities.resize(poses_.size());
  for (std::size_t k = 0; k < poses_.size(); ++k) {
    const terrain::SurfacePose& pose = poses_[k];
    const double gained = pose.gains + pose.inverseMass * dot(pose.axis, impulses[k].linear);
    velocities[k] = {pose.motion.velocity + pose.axis * gained, pose.motion.spin};
  }
}

Surfaces::Surfaces(const GroundSetup& setup, const Vec3d& gravity, double timeStep)
    : setup_(setup), surfaces_(setup.surfaces), gravity_(gravity), timeStep_(timeStep) {
  for (const SurfaceSetup& s : surfaces_)
    if (!s.mesh) ++shapes_;
  states_.surfaces.resize(surfaces_.size());
}

Vec3d Surfaces::freeAxis(std::size_t i) const { return surfaces_[i].free ? surfaces_[i].free->axis : Vec3d{}; }

terrain::SurfacePose Surfaces::placement(std::size_t i, std::int64_t step) const {
  const SurfaceMotion::State law = surfaces_[i].motion.at(static_cast<double>(step) * timeStep_);
  const SurfaceState& s = states_.surfaces[i];
  const Vec3d centre = law.centre + freeAxis(i) * s.offset, velocity = law.velocity + freeAxis(i) * s.speed;
  terrain::SurfacePose pose{
      {centre, (law.turned * surfaces_[i].start.orientation).matrix(), centre, velocity, law.spin},
      law.turned.matrix()};
  if (const auto& free = surfaces_[i].free) {
    pose.axis = free->axis, pose.inverseMass = 1 / free->mass;
    const double given = free->loadAt(static_cast<double>(step) * timeStep_);
    pose.gains = (dot(gravity_, free->axis) + given / free->mass) * timeStep_;
  }
  return pose;
}

base::Pose Surfaces::pose(std::size_t i, std::int64_t step) const {
  const SurfaceMotion::State law = surfaces_[i].motion.at(static_cast<double>(step) * timeStep_);
  return {law.centre + freeAxis(i) * states_.surfaces[i].offset, law.turned * surfaces_[i].start.orientation};
}

void Surfaces::makeMeshContacts(const base::Exec& exec, terrain::Grains& grains, SphereSets* kept) {
  if (shapes_ == surfaces_.size()) return;
  meshes_ = std::make_unique<MeshContacts>(setup_, exec, grains, kept);
  if (!states_.patches.sums.empty()) meshes_->restore(states_.patches);
}

std::vector<contact::PartMotion> Surfaces::meshMotions(std::int64_t step) const {
  std::vector<contact::PartMotion> motions;
  for (std::size_t i = shapes_; i < surfaces_.size(); ++i) motions.push_back(placement(i, step).motion);
  return motions;
}

void Surfaces::computeContacts(const terrain::Grains& grains, std::int64_t step, bool slotsChanged) {
  if (!meshes_) return;
  terrain::ImpulseSolver* const solver = grains.system().impulses.get();
  if (!solver) return meshes_->computeContacts(grains, meshMotions(step), slotsChanged);
  std::vector<terrain::SurfacePose> poses;
  std::vector<contact::PartMotion> motions;
  for (std::size_t i = shapes_; i < surfaces_.size(); ++i)
    poses.push_back(placement(i, step)), motions.push_back(poses.back().motion);
  movedMeshes_.begin(std::move(poses));
  solver->setParts(meshes_->parts(grains, motions, slotsChanged, movedMeshes_));
}

contact::PartMomentsView Surfaces::measure(const terrain::Grains& grains, std::int64_t step, bool slotsChanged) {
  return meshes_ ? meshes_->measure(grains, meshMotions(step), slotsChanged) : contact::PartMomentsView{};
}

SurfaceStates Surfaces::save() const {
  SurfaceStates states = states_;
  if (meshes_) states.patches = meshes_->save();
  return states;
}

void Surfaces::place(terrain::Grains& grains, std::int64_t step) const {
  std::vector<terrain::SurfacePose> placements;
  for (std::size_t i = 0; i < shapes_; ++i) placements.push_back(placement(i, step));
  grains.setSurfacePoses(placements);
}

/// A surface that moves more than half a radius in a step could pass through a grain without contact.
void Surfaces::checkSpeed(std::size_t i, std::int64_t step, double smallestRadius) const {
  const bool plane = surfaces_[i].geometry.shape == terrain::SurfaceShape::plane;
  const double across = plane ? std::fabs(dot(freeAxis(i), placement(i, step).normal())) : 1;
  const double speed = std::fabs(states_.surfaces[i].speed), most = 0.5 * smallestRadius / timeStep_;
  if (speed * across <= most) return;
  throw base::SimulationError(fmt::format("step {}, time {:.6g} s: the loaded surface {} moves at {:.4g} m/s, more "
                                          "than half the smallest grain's radius in a step ({:.4g} m/s): it could "
                                          "pass through a grain without contact; lower its load, raise its mass, "
                                          "or use a smaller time_step",
                                          step, static_cast<double>(step) * timeStep_, surfaces_[i].name, speed, most));
}

/// Meshes have many corners, which are checked only at intervals.
void Surfaces::checkPlace(std::size_t i, std::int64_t step) const {
  constexpr std::int64_t kInterval = 50;
  const terrain::PeriodicBoundaries& sides = setup_.grains->boundaries.periodic;
  if ((!sides[0] && !sides[1]) || !surfaces_[i].moves || (surfaces_[i].mesh && step % kInterval != 0)) return;
  const std::string fault = faultAtBoundaries(surfaces_[i], pose(i, step), sides, setup_.grains->model.radius);
  if (!fault.empty())
    throw base::SimulationError(fmt::format("step {}, time {:.6g} s: {} {}; change its motion", step,
                                            static_cast<double>(step) * timeStep_, surfaces_[i].name, fault));
}

void Surfaces::advance(terrain::Grains& grains, std::int64_t step) {
  const double time = static_cast<double>(step) * timeStep_;
  if (meshes_ && grains.system().impulses) meshes_->collect();
  for (std::size_t i = 0; i < surfaces_.size(); ++i) {
    const terrain::SurfaceLoad& load =
        i < shapes_ ? grains.system().boundaries.surfaceLoads()[i] : meshes_->loads()[i - shapes_];
    const SurfaceMotion::State law = surfaces_[i].motion.at(time);
    SurfaceState& s = states_.surfaces[i];
    const Vec3d centre = law.centre + freeAxis(i) * s.offset;
    double power = -dot(load.force, law.velocity) - dot(load.torque, law.spin);
    if (const auto& free = surfaces_[i].free) {
      // Symplectic Euler, as for the grains.
      const double mass = free->mass, given = free->loadAt(time), before = s.speed;
      s.speed += (dot(load.force + gravity_ * mass, freeAxis(i)) + given) / mass * timeStep_;
      s.offset += s.speed * timeStep_;
      s.turnover += 0.5 * mass * std::fabs(s.speed * s.speed - before * before);
      checkSpeed(i, step, grains.system().constants.smallestRadius);
      power += given * 0.5 * (before + s.speed);
    }
    checkPlace(i, step + 1);
    s.work += power * timeStep_;
    s.impulse -= load.force * timeStep_;
    s.angularImpulse -= (load.torque + cross(centre, load.force)) * timeStep_;
    s.force += load.force, s.torque += load.torque, s.power += power;
    s.pivotTorque += load.torque + cross(law.centre - law.pivot, load.force);
  }
  ++states_.meanSteps;
  place(grains, step + 1);
}

Surfaces::Observation Surfaces::observe(std::size_t i, std::int64_t step) const {
  const SurfaceState& s = states_.surfaces[i];
  const double share = states_.meanSteps > 0 ? 1 / static_cast<double>(states_.meanSteps) : 0.0;
  return {s.force * share, s.torque * share, s.pivotTorque * share, s.power * share, pose(i, step).position};
}

std::vector<std::pair<std::string, double>> Surfaces::meshesPressing(std::uint32_t grain) const {
  std::vector<std::pair<std::string, double>> named;
  if (!meshes_) return named;
  for (const contact::GrainPartContacts::Press& p : meshes_->pressing(grain))
    named.emplace_back(fmt::format("mesh '{}'", surfaces_[shapes_ + static_cast<std::size_t>(p.part)].name),
                       static_cast<double>(p.overlap));
  return named;
}

std::optional<DeepestPartOverlap> Surfaces::deepestPartOverlap() const {
  if (!meshes_) return {};
  const auto most = meshes_->mostPressed();
  if (!most) return DeepestPartOverlap{};
  return DeepestPartOverlap{static_cast<int>(shapes_) + most->part, most->grain, most->share};
}

void Surfaces::restartMeans() {
  if (meshes_) meshes_->resetDeepestOverlap();
  for (SurfaceState& s : states_.surfaces) s.force = s.torque = s.pivotTorque = {}, s.power = 0;
  states_.meanSteps = 0;
}

void Surfaces::addTo(Ledger& ledger) const {
  if (meshes_) {
    const contact::GrainPartContacts::Ledger m = meshes_->ledger();
    ledger.elastic += m.elastic;
    enterGrainParts(ledger, m);
  }
  for (std::size_t i = 0; i < surfaces_.size(); ++i) {
    const SurfaceState& s = states_.surfaces[i];
    ledger.driveWork += s.work;
    ledger.momentumResidual -= s.impulse, ledger.angularResidual -= s.angularImpulse;
    if (!surfaces_[i].free) continue;
    const double mass = surfaces_[i].free->mass, kinetic = 0.5 * mass * s.speed * s.speed;
    ledger.kinetic += kinetic, ledger.work += kinetic, ledger.turnover += s.turnover;
    ledger.potential -= mass * dot(gravity_, freeAxis(i)) * s.offset;
  }
}

void Surfaces::restore(const SurfaceStates& states) {
  if (states.surfaces.size() != surfaces_.size())
    throw base::InputError("the checkpoint belongs to another scene; resume with the scene that was run");
  states_ = states;
}

} // namespace grouser::coupling
