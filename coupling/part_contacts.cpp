// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/part_contacts.hpp"

#include "base/carry.hpp"
#include "base/error.hpp"
#include "coupling/grains_on_parts.hpp"
#include "terrain/grains_ahead.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>

namespace grouser::coupling {

using base::Vec3d;

namespace {

constexpr double kTrackMargin = 0.004;  // [m] gap at which a sample is listed
constexpr double kGroundMargin = 0.008; // [m] same for ground and obstacles
constexpr double kAhead = 0.0005;       // [m] minimum travel permitted in a step launched ahead

} // namespace

PartContacts::PartContacts(const ContactParts& parts, const RunningGear* gear, const std::vector<Obstacle>& obstacles,
                           const base::Exec& exec, double timeStep, Ground* ground, SphereSets* kept)
    : parts_(parts), running_(gear), exec_(exec), side_(exec, true), graph_(exec), ground_(ground),
      timeStep_(timeStep) {
  if (ground_) traits_ = ground_->traits();
  const std::size_t n = parts.count();
  travelled_ = base::Mirrored<double>(exec_, 2);
  // Loads above 1e4 times the total weight on one part do not occur in a valid run.
  const double largest = 1e4 * parts.weight;
  quanta_.force = base::fixedPointFor(largest, 46);
  quanta_.torque = quanta_.moment = base::fixedPointFor(largest, 46);
  quanta_.energy = base::fixedPointFor(1e3, 50); // energy of one sample in one step: these sums cover one step only
  quanta_.area = base::fixedPointFor(1, 40);
  groundQuanta_ = {quanta_.force, quanta_.torque};
  if (running_) makeTrack();
  if (ground_)
    groundQuanta_ =
        ground_->meet({parts_, running_ ? &running_->assembly : nullptr, quanta_, timeStep_, kGroundMargin});
  makeObstacles(obstacles, kept);
  motion_ = base::Mirrored<contact::PartMotion>(exec_, n + surfaces());
  if (obstacles_) std::copy(obstacles_->motions().begin(), obstacles_->motions().end(), motion_.host() + n);
  loadSums_ = base::Mirrored<contact::PartLoad>(exec_, 2 * n + 1);
  gearLoads_.resize(gear_ ? n : 0);
  groundLoads_.resize(traits_.onHost ? n + 1 : 0);
  surfaceLoads_.resize(obstacles_ ? n + surfaces() : 0);
}

void PartContacts::makeTrack() {
  const auto& [assembly, surfaces] = *running_;
  const vehicle::ContactSpec& spec = assembly.spec.contact;
  const contact::PatchLaw law{spec.foundationModulus, spec.relaxationTime, spec.frictionInside, spec.tangentialRatio};
  if (surfaces.shapes()) {
    gear_ = std::make_unique<ShapedGear>(assembly, surfaces, ShapedGear::Model{law, quanta_, timeStep_});
    return;
  }
  std::vector<contact::PartPair> pairs;
  for (const vehicle::PartPair& pair : assembly.pairs)
    pairs.push_back({surfaces.contactIndex(pair.shoe), surfaces.contactIndex(pair.other)});
  track_ = std::make_unique<contact::PartPartContacts>(
      exec_, contact::PartPartContacts::Model{law, quanta_, timeStep_, kTrackMargin}, parts_.surfaces,
      parts_.surfaceOfPart(), pairs);
}

void PartContacts::makeObstacles(const std::vector<Obstacle>& obstacles, SphereSets* kept) {
  const bool hullTouches =
      std::any_of(parts_.parts.begin(), parts_.parts.end(), [](const ContactPart& part) { return part.isHull; });
  obstacles_ = ObstacleContacts::make(parts_, obstacles, hullTouches ? traits_.hullGround : nullptr,
                                      {quanta_, timeStep_}, traits_.comm, kept);
}

void PartContacts::setPoses(const multibody::State& state) {
  for (std::size_t c = 0; c < parts_.count(); ++c) motion_.host()[c] = parts_.motionOf(c, state);
}

/// Upper bound of the approach of two parts: the sum of both motions relative to the hull.
bool PartContacts::trackHasLeft() const { return track_ && 2 * relativeTravel_ > kTrackMargin; }
bool PartContacts::groundHasLeft() const { return ground_ && !traits_.onHost && absoluteTravel_ > kGroundMargin; }

void PartContacts::refreshLists(bool groundListsEnded) {
  const bool trackIsDue = trackHasLeft(),
             groundIsDue = groundHasLeft() || (ground_ && !traits_.onHost && groundListsEnded);
  if (!trackIsDue && !groundIsDue) return;
  ++listings_;
  motion_.upload();
  graph_.forget();
  if (trackIsDue) {
    track_->refresh(motion_.device());
    relativeTravel_ = 0;
  }
  if (!groundIsDue) return;
  ground_->refreshContacts(motion_.device());
  absoluteTravel_ = 0;
}

void PartContacts::compute(StepObserver* observer) {
  noteTravel();
  if (observer) return computeInParts(*observer);
  if (usesDevice())
    graph_.from(ground_ ? ground_->buffer() : nullptr).run([this] {
      uploadPoses();
      // These run concurrently: they write to different parts of loadSums_ and only read the poses.
      side_.fork();
      computeGround(side_.exec());
      computeTrack();
      side_.join();
      downloadLoads();
    });
  computeOnHost();
}

/// Computes the contacts sequentially, without graph and side stream, so that an observer can time each kind.
void PartContacts::computeInParts(StepObserver& observer) {
  if (usesDevice()) uploadPoses();
  observer.after(Stage::posesUploaded);
  computeTrack();
  computeGear();
  observer.after(Stage::trackContacts);
  computeGround(exec_);
  computeRigid();
  observer.after(Stage::groundContacts);
  if (usesDevice()) downloadLoads();
}

void PartContacts::computeOnHost() {
  computeGear();
  computeRigid();
}

/// Writes the travel to the pinned memory copied by uploadPoses(). Must stay outside the graph, since host code in a
/// graph runs only during recording.
void PartContacts::noteTravel() { travelled_.host()[0] = 2 * relativeTravel_, travelled_.host()[1] = absoluteTravel_; }

void PartContacts::uploadPoses() {
  base::carry(exec_, std::array{base::Parcel{motion_.device().data(), motion_.host(), motion_.bytes()},
                                base::Parcel{travelled_.device().data(), travelled_.host(), travelled_.bytes()},
                                base::Parcel{loadSums_.device().data(), nullptr, loadSums_.bytes()}});
}

void PartContacts::downloadLoads() {
  base::carry(exec_, std::array{base::Parcel{loadSums_.host(), loadSums_.device().data(), loadSums_.bytes()}});
}

/// Computes contacts of shoes with sprocket, wheels, rollers and idler: samples on the device.
void PartContacts::computeTrack() {
  if (!track_) return;
  traits_.replicated.run(
      [this] { track_->compute(motion_.device(), travelled_.device().data(), loadSums_.device().data()); });
}

/// Computes gear contacts from part shapes on the host.
void PartContacts::computeGear() {
  if (!gear_) return;
  std::fill(gearLoads_.begin(), gearLoads_.end(), contact::PartLoad{});
  traits_.replicated.run([this] { gear_->compute(motion_.host(), gearLoads_.data()); });
}

void PartContacts::computeGround(const base::Exec& exec) {
  if (!ground_ || traits_.onHost) return;
  ground_->compute(exec, motion_.device(), travelled_.device().data() + 1, loadSums_.device().data() + parts_.count());
}

/// Computes contacts with rigid ground and fixed surfaces on the host, including those of the hull.
void PartContacts::computeRigid() {
  std::fill(groundLoads_.begin(), groundLoads_.end(), contact::PartLoad{});
  std::fill(surfaceLoads_.begin(), surfaceLoads_.end(), contact::PartLoad{});
  traits_.replicated.run([this] {
    if (traits_.onHost) ground_->computeOnHost(motion_.host(), groundLoads_.data());
    if (obstacles_) obstacles_->compute(motion_.host(), surfaceLoads_.data());
  });
}

namespace {
void add(const base::FixedPoint& force, const base::FixedPoint& torque, const contact::PartLoad& load,
         multibody::Wrench& wrench) {
  wrench.force += force.checked(load.force, "forces on a part");
  wrench.torque += torque.checked(load.torque, "torques on a part");
}
} // namespace

void PartContacts::collect(multibody::Loads& loads) {
  const contact::PartLoad* track = gear_ ? gearLoads_.data() : track_ ? loadSums_.host() : nullptr;
  if (obstacles_) obstacles_->requireShallow(parts_);
  for (multibody::Wrench& wrench : loads.external) wrench = {};
  if (!traits_.solves) sumGroundLoads();
  for (std::size_t c = 0; c < parts_.count(); ++c) {
    multibody::Wrench& wrench = loads.external[parts_.parts[c].body];
    if (track) add(quanta_.force, quanta_.torque, track[c], wrench);
    if (!traits_.solves) addGroundLoad(c, wrench);
    if (obstacles_) add(quanta_.force, quanta_.torque, surfaceLoads_[c], wrench);
  }
}

void PartContacts::solve(contact::BodyResponse& bodies, multibody::Loads& loads) {
  ground_->solve(bodies);
  base::carry(exec_, std::array{base::Parcel{groundLoads(), loadSums_.device().data() + parts_.count(),
                                             (parts_.count() + 1) * sizeof(contact::PartLoad)}});
  base::synchronize(exec_);
  sumGroundLoads();
  for (std::size_t c = 0; c < parts_.count(); ++c) addGroundLoad(c, loads.external[parts_.parts[c].body]);
}

/// Integer sums are identical on all ranks, in any order, so every rank moves the vehicle identically.
void PartContacts::sumGroundLoads() {
  const std::size_t n = parts_.count();
  contact::PartLoad* const ground = groundLoads();
  constexpr std::size_t kNumbers = sizeof(contact::PartLoad) / sizeof(std::int64_t);
  static_assert(kNumbers == 6 && sizeof(contact::PartLoad) % sizeof(std::int64_t) == 0);
  if (ground_ && !traits_.onHost) traits_.comm.sum(&ground->force.x, (n + 1) * kNumbers);
  if (ground_) ground_->collect(ground[n]);
}

void PartContacts::addGroundLoad(std::size_t part, multibody::Wrench& wrench) {
  const contact::PartLoad& load = groundLoads()[part];
  add(groundQuanta_.force, groundQuanta_.torque, load, wrench);
  impulseOnParts_ += load.force;
  angularOnParts_ += (groundQuanta_.torque.value(load.torque) +
                      cross(motion_.host()[part].centre, groundQuanta_.force.value(load.force))) *
                     timeStep_;
}

contact::PartLoad* PartContacts::groundLoads() {
  return traits_.onHost ? groundLoads_.data() : loadSums_.host() + parts_.count();
}

base::Vec3l PartContacts::inGroundQuanta(const base::Vec3l& force) const {
  return groundQuanta_.force.quantise(quanta_.force.value(force));
}

base::Vec3l PartContacts::groundForce(std::size_t index) const {
  const std::size_t n = parts_.count();
  base::Vec3l force{};
  if (index < n) force = traits_.onHost ? groundLoads_[index].force : (loadSums_.host() + n + index)->force;
  if (obstacles_) force += inGroundQuanta(surfaceLoads_[index].force);
  return force;
}

void PartContacts::trackTravel(const multibody::State& state) {
  const auto speedOf = [&](std::size_t c, const multibody::Twist& twist) {
    return norm(twist.v) + norm(twist.w) * parts_.parts[c].reach;
  };
  double absolute = 0, relative = 0;
  for (std::size_t c = 0; c < parts_.count(); ++c)
    absolute = std::max(absolute, speedOf(c, state.twist[parts_.parts[c].body]));
  if (track_) {
    const auto hull = static_cast<std::size_t>(running_->assembly.chassis);
    const multibody::Twist& carrier = state.twist[hull];
    for (std::size_t c = 0; c < parts_.count(); ++c) {
      const std::size_t body = parts_.parts[c].body;
      const Vec3d carried = carrier.v + cross(carrier.w, state.pose[body].position - state.pose[hull].position);
      relative = std::max(relative, speedOf(c, {state.twist[body].v - carried, state.twist[body].w - carrier.w}));
    }
  }
  lastRelative_ = relative * timeStep_, lastAbsolute_ = absolute * timeStep_;
  relativeTravel_ += lastRelative_;
  absoluteTravel_ += lastAbsolute_;
}

/// In a step launched ahead a part may move up to four times as far as in the previous step.
bool PartContacts::listsAreValid(bool ahead) const {
  if (!ahead) return !trackHasLeft() && !groundHasLeft();
  const bool track = !track_ || 2 * (relativeTravel_ + std::max(4 * lastRelative_, kAhead / 2)) <= kTrackMargin;
  return track && absoluteTravel_ + std::max(4 * lastAbsolute_, kAhead) <= kGroundMargin;
}

contact::PartMomentsView PartContacts::measure(GrainsOnParts& onGrains, const contact::GrainsView& grains) {
  motion_.upload();
  return onGrains.contacts().measure(grains, motion_.device());
}

void PartContacts::launchAhead(base::Gate& gate, terrain::GrainsAhead& grains, GrainsOnParts& onGrains) {
  contact::GrainPartContacts& bed = onGrains.contacts();
  const base::Watch watch = grains.flagsBefore();
  contact::PartLoad *const track = loadSums_.device().data(), *const ground = track + parts_.count();
  grains.launchUncoupled(onGrains.loads());
  side_.fork();
  gate.carryBefore(side_.exec(), watch,
                   std::array{base::Parcel{track, nullptr, loadSums_.bytes()},
                              track_ ? track_->clearedSums() : base::Parcel{}, bed.clearedSums(), bed.clearedCount()});
  gate.pass(exec_, watch,
            std::array{base::Parcel{motion_.device().data(), motion_.host(), motion_.bytes()},
                       base::Parcel{travelled_.device().data(), travelled_.host(), travelled_.bytes()}});
  side_.join();
  side_.fork();
  if (track_)
    track_->computeOnCleared(side_.exec(), motion_.device(), travelled_.device().data(), track, gate.calledOff());
  bed.computeOnCleared(exec_, grains.view(), motion_.device(), ground, gate.calledOff());
  side_.fork(); // the host receives the loads while the grains advance
  gate.signal(side_.exec(), base::Gate::kFirst, std::array{base::Parcel{loadSums_.host(), track, loadSums_.bytes()}});
  grains.launchGrains(onGrains.loads());
  side_.join();
  grains.joinGrains();
  gate.signal(exec_, base::Gate::kSecond, std::array{grains.flagsAfter()});
}

ContactLedger PartContacts::ledger() const {
  ContactLedger ledger;
  if (track_) ledger.rigid = track_->ledger();
  if (gear_) ledger.rigid = gear_->ledger();
  if (ground_) ground_->addContactsTo(ledger);
  if (obstacles_) ledger.rigid += obstacles_->ledger();
  if (traits_.hasMomentum) {
    ledger.angularOnParts = angularOnParts_;
    ledger.impulseOnParts = groundQuanta_.force.value(impulseOnParts_) * timeStep_;
  }
  return ledger;
}

ListedContacts PartContacts::listed() const {
  ListedContacts listed = ground_ ? ground_->listed() : ListedContacts{};
  if (track_) listed.samples += track_->samplesListed();
  return listed;
}

void PartContacts::save(ContactsState& s) const {
  if (track_) s.track = track_->save();
  if (gear_) s.track = gear_->save();
  if (ground_) ground_->saveContacts(s);
  if (obstacles_) s.surfaces = obstacles_->save();
  s.impulseOnParts = impulseOnParts_;
  s.angularOnParts = angularOnParts_;
}

void PartContacts::restore(const ContactsState& s) {
  if (track_) track_->restore(s.track);
  if (gear_) gear_->restore(s.track);
  if (ground_) ground_->restoreContacts(s);
  if (obstacles_) obstacles_->restore(s.surfaces);
  impulseOnParts_ = s.impulseOnParts;
  angularOnParts_ = s.angularOnParts;
  relativeTravel_ = absoluteTravel_ = kNeverListed;
}

std::vector<spheredecomp::CutReport> obstacleReports(const PartContacts& contacts) {
  return contacts.obstacles_ ? contacts.obstacles_->cutReports() : std::vector<spheredecomp::CutReport>{};
}

} // namespace grouser::coupling
