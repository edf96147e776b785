// SPDX-License-Identifier: BSD-3-Clause
#include "runs/simulation/vehicle_rig.hpp"

#include "base/error.hpp"
#include "base/math.hpp"
#include "runs/setup/grain_part_model.hpp"
#include "runs/setup/laws.hpp"
#include "runs/setup/placement.hpp"
#include "spheredecomp/decompose.hpp"
#include "spheredecomp/mesh.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <map>

namespace grouser::simulation {

using base::Vec3d;

namespace {

constexpr double kTrackMargin = 0.004; // [m] how far before touching a probe is listed
constexpr double kBedMargin = 0.008;   // [m] the same for grains, beyond their own skin

vehicle::DriverOptions driverOptions(const scene::Driver& d) {
  vehicle::DriverOptions options;
  options.tensionRamp = d.tensionRamp, options.weightRamp = d.weightRamp;
  options.driveStart = d.driveBegins(), options.driveRamp = d.driveRamp;
  const scene::SpeedTable table = d.speeds();
  options.speeds = {table.time, table.left, table.right};
  return options;
}

vehicle::AssemblyOptions assemblyOptions(const scene::Scene& scene, const vehicle::VehicleSpec& spec,
                                         const std::function<double(double, double)>& surfaceHeight) {
  const setup::Placement place = setup::placeVehicle(scene, spec);
  const double z = scene.terrain ? setup::groundUnder(spec, place, surfaceHeight) + scene.vehicle->clearance : 0.0;
  vehicle::AssemblyOptions options;
  options.fixChassis = scene.vehicle->chassis == scene::ChassisMount::fixed;
  options.pose_W = vehicle::placeOnGround(spec, place.x, place.y, z, 0, place.heading);
  return options;
}

/// The set that rank `root` has, on all ranks.
base::SphereSet shared(const base::Comm& comm, base::SphereSet set, int root) {
  if (comm.alone()) return set;
  struct Scalars {
    std::size_t surfaceCount;
    double spacing, radius, meshVolume, meshArea;
  };
  const Scalars mine{set.surfaceCount, set.spacing, set.radius, set.meshVolume, set.meshArea};
  const auto all = base::Comm::valuesOf<Scalars>(comm.broadcast(base::Comm::bytesOf(std::vector{mine}), root)).front();
  set.spheres = base::Comm::valuesOf<base::SetSphere>(comm.broadcast(base::Comm::bytesOf(set.spheres), root));
  set.name = comm.broadcast(set.name, root);
  set.surfaceCount = all.surfaceCount, set.spacing = all.spacing, set.radius = all.radius;
  set.meshVolume = all.meshVolume, set.meshArea = all.meshArea;
  return set;
}

} // namespace

VehicleRig::VehicleRig(const scene::Scene& scene, const base::Exec& exec, double timeStep, const setup::Ground& ground,
                       const std::function<double(double, double)>& surfaceHeight)
    : exec_(exec), side_(exec), timeStep_(timeStep), driver_(driverOptions(scene.driver)),
      surfaceHeight_(surfaceHeight), gravity_(scene.run.gravity) {
  if (ground.grains) comm_ = ground.grains->comm();
  if (!comm_.alone()) sharedGrains_ = ground.grains.get();
  const vehicle::VehicleSpec spec = vehicle::readVehicleSpec(scene.vehicle->spec);
  assembly_ = vehicle::assemble(spec, assemblyOptions(scene, spec, surfaceHeight));
  solver_ = std::make_unique<multibody::Solver>(assembly_.model);
  state_ = multibody::makeState(assembly_.model);
  loads_ = multibody::makeLoads(assembly_.model);
  observer_ = std::make_unique<vehicle::Observer>(assembly_);
  loadMeshes(scene);
  buildContacts(scene, ground);
}

void VehicleRig::loadMeshes(const scene::Scene& scene) {
  std::map<std::string, std::size_t> indexOf;
  spheredecomp::DecompositionOptions options;
  options.radius = scene.vehicle->sphereRadius;
  for (std::size_t p = 0; p < assembly_.parts.size(); ++p) {
    const vehicle::Part& part = assembly_.parts[p];
    const auto [at, fresh] = indexOf.emplace(part.mesh, meshes_.size());
    if (fresh) {
      meshes_.push_back(
          spheredecomp::importMesh((std::filesystem::path(assembly_.spec.meshFolder) / part.mesh).string()));
      const bool touches = part.kind != vehicle::PartKind::kChassis;
      // The ranks share the cutting.
      const int cutter = static_cast<int>(sets_.size()) % comm_.size();
      sets_.push_back(touches && cutter == comm_.rank() ? spheredecomp::decompose(meshes_.back(), part.mesh, options)
                                                        : base::SphereSet{});
      setFigures_.push_back({part.mesh, 0, 0});
    }
    meshOfPart_.push_back(at->second);
    ++setFigures_[at->second].instances;
    if (part.kind != vehicle::PartKind::kChassis) contactParts_.push_back(static_cast<int>(p));
  }
  for (std::size_t i = 0; i < sets_.size(); ++i) {
    sets_[i] = shared(comm_, std::move(sets_[i]), static_cast<int>(i) % comm_.size());
    setFigures_[i].spheres = sets_[i].spheres.size();
  }
}

void VehicleRig::buildContacts(const scene::Scene& scene, const setup::Ground& ground) {
  std::vector<const base::SphereSet*> sets;
  for (const base::SphereSet& set : sets_) sets.push_back(&set);
  std::vector<int> setOfPart, contactIndex(assembly_.parts.size(), -1);
  for (std::size_t c = 0; c < contactParts_.size(); ++c) {
    const auto p = static_cast<std::size_t>(contactParts_[c]);
    contactIndex[p] = static_cast<int>(c);
    setOfPart.push_back(static_cast<int>(meshOfPart_[p]));
    partReach_.push_back(contact::enclosingRadius(sets_[meshOfPart_[p]]) + norm(assembly_.parts[p].pose_B.position));
  }
  const std::size_t n = contactParts_.size();
  contactGraph_ = base::DoubleBufferedGraph(exec_);
  motion_ = base::Mirrored<contact::PartMotion>(exec_, n);
  travelled_ = base::Mirrored<double>(exec_, 2);
  loadSums_ = base::Mirrored<contact::PartLoad>(exec_, 2 * n);

  const vehicle::ContactSpec& spec = assembly_.spec.contact;
  // Ten thousand times the vehicle's weight on one part is beyond anything that could still be driven.
  const double largest = 1e4 * assembly_.mass * 9.81;
  quanta_.force = base::fixedPointFor(largest, 46);
  quanta_.torque = quanta_.moment = base::fixedPointFor(largest, 46);
  quanta_.energy = base::fixedPointFor(1e3, 50); // of one probe in one step: these sums begin anew every step
  quanta_.area = base::fixedPointFor(1, 40);
  groundForceQuantum_ = quanta_.force, groundTorqueQuantum_ = quanta_.torque;

  const contact::PatchLaw inside{spec.foundationModulus, spec.relaxationTime, spec.frictionInside,
                                 spec.tangentialRatio};
  std::vector<contact::PartPair> pairs;
  for (const vehicle::PartPair& pair : assembly_.pairs)
    pairs.push_back(
        {contactIndex[static_cast<std::size_t>(pair.shoe)], contactIndex[static_cast<std::size_t>(pair.other)]});
  trackMargin_ = kTrackMargin;
  track_ = std::make_unique<contact::PartPartContacts>(
      exec_, contact::PartPartContacts::Model{inside, quanta_, timeStep_, trackMargin_}, sets, setOfPart, pairs);

  if (ground.grains) {
    groundMargin_ = kBedMargin;
    const auto [model, materials] = setup::grainPartModel(
        scene, *ground.grains, timeStep_, groundMargin_, [&](const std::string& soil, std::optional<double> mass) {
          const std::string& part = scene.vehicle->material.empty() ? soil : scene.vehicle->material;
          contact::ContactLaw law = setup::pairLaw(scene, soil, part, mass);
          if (scene.vehicle->material.empty()) law.friction = spec.frictionGround;
          return law;
        });
    groundForceQuantum_ = model.force, groundTorqueQuantum_ = model.torque;
    std::vector<contact::GrainPart> parts;
    for (const int set : setOfPart) parts.push_back({set, {}, {}});
    bed_ = std::make_unique<contact::GrainPartContacts>(exec_, model, sets, parts, comm_, materials);
    ground.grains->onMigrate([this](const std::uint32_t* destination) { bed_->migrate(destination); });
  } else if (ground.rigid) {
    const contact::PatchLaw law{spec.foundationModulus, spec.relaxationTime, spec.frictionGround, spec.tangentialRatio};
    std::vector<int> shoes;
    for (const int part : assembly_.groundParts) shoes.push_back(contactIndex[static_cast<std::size_t>(part)]);
    groundMargin_ = kBedMargin;
    rigidGround_ = std::make_unique<terrain::GroundContacts>(
        exec_, terrain::GroundContacts::Model{law, quanta_, timeStep_, groundMargin_}, *ground.rigid, sets, setOfPart,
        shoes);
  }
}

/// Whole quanta, so that every order of ranks gives the same bits: all ranks move the vehicle alike.
void VehicleRig::sumOverRanks(contact::PartLoad* loads, std::size_t count) const {
  constexpr std::size_t kNumbers = sizeof(contact::PartLoad) / sizeof(std::int64_t);
  static_assert(kNumbers == 6 && sizeof(contact::PartLoad) % sizeof(std::int64_t) == 0);
  comm_.sum(&loads->force.x, count * kNumbers);
}

contact::PartMotion VehicleRig::motionOf(std::size_t c) const {
  const vehicle::Part& part = assembly_.parts[static_cast<std::size_t>(contactParts_[c])];
  const base::Pose pose = vehicle::partPose(part, state_);
  const auto body = static_cast<std::size_t>(part.body);
  return {pose.position, pose.orientation.matrix(), state_.pose[body].position, state_.twist[body].v,
          state_.twist[body].w};
}

void VehicleRig::setSurfacePoses() {
  for (std::size_t c = 0; c < contactParts_.size(); ++c) motion_.host()[c] = motionOf(c);
}

void VehicleRig::refreshLists(const terrain::Grains* grains, bool slotsChanged) {
  // Two parts approach each other at most as fast as both move relative to the hull.
  const bool trackIsDue = 2 * relativeTravel_ > trackMargin_;
  const bool groundIsDue = absoluteTravel_ > groundMargin_ || slotsChanged;
  if (!trackIsDue && !groundIsDue) return;
  motion_.upload();
  contactGraph_.forget();
  if (trackIsDue) {
    track_->refresh(motion_.device());
    relativeTravel_ = 0;
  }
  if (!groundIsDue) return;
  if (bed_) {
    bed_->refresh(setup::viewOf(*grains), motion_.device());
    grainLoads_ = bed_->grainLoads();
  }
  if (rigidGround_) rigidGround_->refresh(motion_.device());
  absoluteTravel_ = 0;
}

/// Work that every rank does alike: its time says nothing about the cuts.
template <class Work> void VehicleRig::asAllRanksDo(const Work& work) {
  if (!sharedGrains_) return work();
  const auto start = std::chrono::steady_clock::now();
  work();
  sharedGrains_->noteReplicated(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
}

void VehicleRig::computeContacts(const terrain::Grains* grains, StepObserver* observer) {
  noteTravel();
  if (observer) return computeInParts(grains, *observer);
  contactGraph_.from(grains ? grains->positions() : nullptr).run([this, grains] {
    uploadPoses();
    side_.fork();
    computeGroundContacts(grains, side_.exec());
    computeTrackContacts();
    side_.join();
    downloadLoads();
  });
}

/// The same one after another, for who wants to know how long each takes.
void VehicleRig::computeInParts(const terrain::Grains* grains, StepObserver& observer) {
  uploadPoses();
  observer.after(Stage::posesUploaded);
  computeTrackContacts();
  observer.after(Stage::trackContacts);
  computeGroundContacts(grains, exec_);
  observer.after(Stage::groundContacts);
  downloadLoads();
}

/// On the host: no record of work does that.
void VehicleRig::noteTravel() { travelled_.host()[0] = 2 * relativeTravel_, travelled_.host()[1] = absoluteTravel_; }

void VehicleRig::uploadPoses() {
  motion_.upload();
  travelled_.upload();
  loadSums_.device().zero();
}

void VehicleRig::downloadLoads() { loadSums_.download(); }

void VehicleRig::computeTrackContacts() {
  asAllRanksDo([this] { track_->compute(motion_.device(), travelled_.device().data(), loadSums_.device().data()); });
}

void VehicleRig::computeGroundContacts(const terrain::Grains* grains, const base::Exec& exec) {
  contact::PartLoad* groundLoads = loadSums_.device().data() + contactParts_.size();
  if (bed_) bed_->computeOn(exec, setup::viewOf(*grains), motion_.device(), groundLoads);
  if (rigidGround_) rigidGround_->compute(motion_.device(), travelled_.device().data() + 1, groundLoads);
}

void VehicleRig::collectLoads() {
  base::synchronize(exec_);
  const std::size_t n = contactParts_.size();
  const contact::PartLoad *track = loadSums_.host(), *ground = loadSums_.host() + n;
  if (bed_) sumOverRanks(loadSums_.host() + n, n);
  for (multibody::Wrench& wrench : loads_.external) wrench = {};
  groundForceSums_.resize(n);
  alarmForceSums_.resize(n);
  for (std::size_t c = 0; c < n; ++c) {
    const vehicle::Part& part = assembly_.parts[static_cast<std::size_t>(contactParts_[c])];
    multibody::Wrench& wrench = loads_.external[static_cast<std::size_t>(part.body)];
    wrench.force += quanta_.force.checked(track[c].force, "forces on a part") +
                    groundForceQuantum_.checked(ground[c].force, "forces on a part");
    wrench.torque += quanta_.torque.checked(track[c].torque, "torques on a part") +
                     groundTorqueQuantum_.checked(ground[c].torque, "torques on a part");
    impulseOnParts_ += ground[c].force;
    groundForceSums_[c] += ground[c].force;
    alarmForceSums_[c] += ground[c].force;
  }
  ++meanSteps_, ++alarmSteps_;
}

void VehicleRig::advance() {
  vehicle::applyControls(assembly_, driver_.at(state_.time), gravity_, loads_);
  asAllRanksDo([this] {
    solver_->step(state_, loads_, timeStep_);
    observer_->update(state_, timeStep_);
    trackTravel();
  });
}

void VehicleRig::trackTravel() {
  const auto hull = static_cast<std::size_t>(assembly_.chassis);
  const Vec3d hullPosition = state_.pose[hull].position;
  const multibody::Twist& hullTwist = state_.twist[hull];
  double relative = 0, absolute = 0;
  for (std::size_t c = 0; c < contactParts_.size(); ++c) {
    const auto body = static_cast<std::size_t>(assembly_.parts[static_cast<std::size_t>(contactParts_[c])].body);
    const multibody::Twist& twist = state_.twist[body];
    const Vec3d carried = hullTwist.v + cross(hullTwist.w, state_.pose[body].position - hullPosition);
    relative = std::max(relative, norm(twist.v - carried) + norm(twist.w - hullTwist.w) * partReach_[c]);
    absolute = std::max(absolute, norm(twist.v) + norm(twist.w) * partReach_[c]);
  }
  relativeTravel_ += relative * timeStep_;
  absoluteTravel_ += absolute * timeStep_;
}

vehicle::GroundLoads VehicleRig::meanGroundLoads(const std::vector<base::Vec3l>& sums, std::int64_t steps) const {
  vehicle::GroundLoads loads;
  if (!bed_ && !rigidGround_) return loads;
  loads.force.resize(assembly_.model.bodies().size());
  const double share = steps > 0 ? 1 / static_cast<double>(steps) : 0.0;
  for (std::size_t c = 0; c < sums.size(); ++c) {
    const vehicle::Part& part = assembly_.parts[static_cast<std::size_t>(contactParts_[c])];
    loads.force[static_cast<std::size_t>(part.body)] += groundForceQuantum_.value(sums[c]) * share;
  }
  return loads;
}

void VehicleRig::restartMeans() {
  groundForceSums_.assign(groundForceSums_.size(), {});
  meanSteps_ = 0;
}

vehicle::Observation VehicleRig::observe() const {
  return observer_->observe(state_, meanGroundLoads(groundForceSums_, meanSteps_), surfaceHeight_);
}

std::string VehicleRig::alarm() {
  const std::string alarm = observer_->alarm(state_, meanGroundLoads(alarmForceSums_, alarmSteps_));
  alarmForceSums_.assign(alarmForceSums_.size(), {});
  alarmSteps_ = 0;
  return alarm;
}

VehicleRig::Ledger VehicleRig::ledger() const {
  Ledger ledger;
  ledger.kinetic = multibody::totals(assembly_.model, state_, loads_).kinetic;
  ledger.driveWork = state_.ledger.driveWork;
  ledger.potentialGain = -(state_.ledger.gravityWork + state_.ledger.springWork);
  const contact::PatchBuffers::Ledger track = track_->ledger();
  ledger.elastic = track.elastic;
  ledger.dissipated = state_.ledger.dissipated + track.dissipated;
  ledger.patches = track.patches;
  if (rigidGround_) {
    const contact::PatchBuffers::Ledger ground = rigidGround_->ledger();
    ledger.elastic += ground.elastic, ledger.dissipated += ground.dissipated, ledger.patches += ground.patches;
  }
  if (bed_) {
    const contact::GrainPartContacts::Ledger bed = bed_->ledger();
    ledger.elastic += bed.elastic;
    ledger.grainContacts = bed.contacts;
    // Dissipation in contacts with grains is in the grains' own ledger.
    ledger.impulseOnGrains = bed.impulseOnGrains;
    ledger.impulseOnParts = groundForceQuantum_.value(impulseOnParts_) * timeStep_;
  }
  for (const Vec3d& force : meanGroundLoads(groundForceSums_, meanSteps_).force) ledger.groundForce += force;
  return ledger;
}

std::size_t VehicleRig::totalSpheres() const {
  std::size_t total = 0;
  for (const SetFigures& f : setFigures_) total += f.spheres * static_cast<std::size_t>(f.instances);
  return total;
}

} // namespace grouser::simulation
