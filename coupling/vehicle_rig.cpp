// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/vehicle_rig.hpp"

#include "base/error.hpp"
#include "base/math.hpp"
#include "base/rounded.hpp"
#include "spheredecomp/mesh_query.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <map>

namespace grouser::coupling {

using base::Vec3d;

namespace {

/// Places the vehicle on the ground, raised by `lift` [m].
vehicle::Assembly assembled(const VehicleSetup& setup, const std::function<double(double, double)>& surfaceHeight,
                            double lift) {
  const Placement& place = setup.place;
  base::Pose pose_W = setup.onTerrain ? setDown(setup.spec, place, setup.clearance, surfaceHeight)
                                      : vehicle::placeOnGround(setup.spec, place.x, place.y, 0, 0, place.heading);
  pose_W.position.z += lift;
  return assembleAt(setup, pose_W);
}

/// Adds the bodies of the scene; hitched bodies move with the vehicle to its position.
vehicle::Assembly withBodies(vehicle::Assembly assembly, const std::optional<MechanismSetup>& bodies) {
  if (!bodies) return assembly;
  const base::Pose chassis = assembly.model.bodies()[static_cast<std::size_t>(assembly.chassis)].pose;
  assembly.model.append(bodies->model, bodies->ofVehicle, bodies->hitched, bodies->chassis, chassis);
  return assembly;
}

/// Mass of the vehicle and of all other moving bodies [kg].
double massOf(const vehicle::Assembly& assembly, const std::optional<MechanismSetup>& bodies) {
  double mass = assembly.mass;
  for (std::size_t b = bodies ? bodies->ofVehicle.bodies : assembly.model.bodies().size();
       b < assembly.model.bodies().size(); ++b)
    if (const multibody::Body& body = assembly.model.bodies()[b]; !body.fixed) mass += body.mass;
  return mass;
}

GroundTraits traitsOf(const Ground* ground) { return ground ? ground->traits() : GroundTraits{}; }

/// True if contacts need spheres of the hull only.
bool shapesAlone(const SimulationSetup& setup) {
  const GroundSetup& ground = setup.ground;
  return setup.vehicle->shapes && !ground.grains && !ground.otherKind && ground.obstacles.empty();
}

/// Throws InputError if a shape of a body initially overlaps a part of the vehicle, in either direction.
void requireApartFromVehicle(const ContactParts& all, const VehicleParts& vehicle, const MechanismSetup& setup,
                             const multibody::Model& model) {
  constexpr double kMax = 0.02; // [-] fraction of half the thickness of the shape
  const std::size_t first = all.count() - setup.shapes.size();
  std::map<std::size_t, spheredecomp::MeshQuery> queries; // by mesh
  for (const ContactParts::Pair& pair : all.pairs) {
    const auto p = static_cast<std::size_t>(pair.part);
    if (p >= first) continue;
    const ContactPart& part = all.parts[p];
    const BodyShape& s = setup.shapes[static_cast<std::size_t>(pair.other) - first];
    const base::Pose& body = model.bodies()[part.body].pose;
    const base::Pose X_P = multibody::compose(body, part.pose_B),
                     X_S = multibody::compose(model.bodies()[s.body].pose, s.pose_B);
    if (norm(body.position - X_S.position) > part.reach + norm(halfExtent(s.shape))) continue;
    const std::size_t index = vehicle.meshOfPart(vehicle.partOf(p));
    const base::TriangleMesh& mesh = vehicle.meshes()[index];
    double deepest = 0;
    for (const Vec3d& v : mesh.vertices) deepest = std::max(deepest, -distanceFrom(s, X_S.toBody(X_P.toWorld(v))));
    const spheredecomp::MeshQuery& query = queries.try_emplace(index, mesh).first->second;
    for (const contact::SurfaceSample& q : surfacePoints(s))
      deepest = std::max(deepest, -query.signedDistance(X_P.toBody(X_S.toWorld(q.centre.as<double>()))));
    if (deepest > kMax * halfThickness(s))
      throw base::InputError(
          fmt::format("{}: body \"{}\" overlaps the {} of the vehicle by {:.3g} m at the start, more "
                      "than {:.3g} m; move the body or vehicle.position",
                      s.place, model.bodies()[s.body].name, part.name, deepest, kMax * halfThickness(s)));
  }
}

/// Lift [m] at which no shoe overlaps the ground and no part overlaps an obstacle.
double liftFor(const SimulationSetup& setup, const Ground* ground, const VehicleParts& parts,
               const std::function<double(double, double)>& surfaceHeight) {
  const VehicleSetup& vehicle = *setup.vehicle;
  double lift = 0;
  if (vehicle.onTerrain && ground) lift = ground->clearance(assembled(vehicle, surfaceHeight, 0));
  if (setup.ground.obstacles.empty()) return lift;
  const vehicle::Assembly assembly = assembled(vehicle, surfaceHeight, lift);
  return lift + liftOffObstacles(assembly.model, parts.touching(assembly, false), setup.ground.obstacles);
}

/// Shoe at the edge of the terrain, with its position.
struct ShoeAtEdge {
  const vehicle::Part* shoe;
  Vec3d place;
};
/// Distances of a point from the four edges of the terrain [m]; negative outside.
std::array<double, 4> marginsOf(const terrain::Rectangle& area, const Vec3d& p) {
  return {p.x - area.xMin, area.xMax - p.x, p.y - area.yMin, area.yMax - p.y};
}

/// First shoe closer to an edge of the terrain than `within`, given for each edge.
std::optional<ShoeAtEdge> shoeAtEdge(const std::optional<terrain::Rectangle>& area, const vehicle::Assembly& assembly,
                                     const multibody::State& state, const std::array<double, 4>& within) {
  if (!area) return {};
  for (const int index : assembly.groundParts) {
    const vehicle::Part& part = assembly.parts[static_cast<std::size_t>(index)];
    const Vec3d& p = state.pose[static_cast<std::size_t>(part.body)].position;
    const std::array<double, 4> margins = marginsOf(*area, p);
    for (std::size_t side = 0; side < 4; ++side)
      if (margins[side] < within[side]) return ShoeAtEdge{&part, p};
  }
  return {};
}

/// Distance of a shoe from each edge at which the stop condition `edge` ends the run: a vehicle placed closer than
/// `edge` must come even closer.
std::array<double, 4> edgesToMeet(const std::optional<terrain::Rectangle>& area, const vehicle::Assembly& assembly,
                                  double edge) {
  constexpr double kNearer = 0.05; // [m] more than the variation of the shoe positions at the ends of a loop
  std::array<double, 4> edges{edge, edge, edge, edge};
  for (const int index : assembly.groundParts) {
    const auto body = static_cast<std::size_t>(assembly.parts[static_cast<std::size_t>(index)].body);
    const std::array<double, 4> margins = marginsOf(*area, assembly.model.bodies()[body].pose.position);
    for (std::size_t side = 0; side < 4; ++side) edges[side] = std::min(edges[side], margins[side] - kNearer);
  }
  return edges;
}

/// Message about a shoe that has left the terrain; empty if all shoes are on it.
std::string offTerrain(const std::optional<terrain::Rectangle>& area, const vehicle::Assembly& assembly,
                       const multibody::State& state) {
  const std::optional<ShoeAtEdge> at = shoeAtEdge(area, assembly, state, {});
  if (!at) return {};
  return fmt::format("the {} left the terrain at ({:.2f}, {:.2f}) m; enlarge terrain.size, move vehicle.position, "
                     "shorten run.duration, or set stop.edge to end the run earlier",
                     at->shoe->name, at->place.x, at->place.y);
}

} // namespace

VehicleRig::VehicleRig(const SimulationSetup& setup, const base::Exec& exec, Ground* ground,
                       const std::function<double(double, double)>& surfaceHeight, SphereSets* kept,
                       std::optional<double> lift)
    : timeStep_(setup.timeStep), largestTurn_(setup.vehicle->largestTurn), stop_(setup.vehicle->stop),
      gravity_(setup.gravity), area_(setup.ground.area), surfaceHeight_(surfaceHeight),
      parts_(std::make_unique<VehicleParts>(assembled(*setup.vehicle, surfaceHeight, 0), *setup.vehicle,
                                            traitsOf(ground).comm, kept, traitsOf(ground).smallestGrain,
                                            shapesAlone(setup))),
      lift_(lift ? *lift : liftFor(setup, ground, *parts_, surfaceHeight)),
      assembly_(withBodies(assembled(*setup.vehicle, surfaceHeight, lift_), setup.mechanism)),
      solver_(std::make_unique<multibody::Solver>(assembly_.model)), driver_(setup.vehicle->driver),
      thickestStone_(setup.vehicle->thickestStone), heading_(setup.vehicle->place.heading),
      observer_(std::make_unique<vehicle::Observer>(assembly_, observerOptions())),
      carried_(massOf(assembly_, setup.mechanism)), blows_(carried_ * norm(gravity_)), gear_{assembly_, *parts_} {
  replicated_ = traitsOf(ground).replicated;
  state_ = multibody::makeState(assembly_.model), loads_ = multibody::makeLoads(assembly_.model);
  contactParts_ = parts_->touching(assembly_, setup.vehicle->soilTouchesShoesOnly);
  if (setup.mechanism) addBodies(*setup.mechanism, assembly_.model, traitsOf(ground), kept);
  if (setup.mechanism && !lift) requireApartFromVehicle(contactParts_, *parts_, *setup.mechanism, assembly_.model);
  contacts_ =
      std::make_unique<PartContacts>(contactParts_, &gear_, setup.ground.obstacles, exec, timeStep_, ground, kept);
  if (setup.vehicle->hitch) towing_.emplace(*setup.vehicle->hitch);
}

/// Driver commands in this step; without a course and without engines they depend on time only.
vehicle::Controls VehicleRig::controls() {
  vehicle::Controls controls = driver_.course()
                                   ? driver_.step(state_.time, timeStep_, vehicle::hullMotion(assembly_, state_))
                                   : driver_.at(state_.time);
  commands_.layOver(controls);
  if (driver_.options().drive == vehicle::SprocketDrive::engine) vehicle::addEngineTorques(assembly_, state_, controls);
  return controls;
}

void VehicleRig::actuate() {
  asked_ = controls();
  vehicle::applyControls(assembly_, asked_, gravity_, loads_);
  replicated_.run([this] {
    if (towing_) towing_->pull(assembly_, state_, driver_, timeStep_, gravity_, loads_);
    applied_.add(state_, loads_);
  });
}

void VehicleRig::advance() {
  replicated_.run([this] {
    solver_->step(state_, loads_, timeStep_);
    applied_.accountWork(state_, timeStep_);
    if (towing_) towing_->accountWork(assembly_, state_, timeStep_);
    observer_->update(state_, timeStep_);
    if (watch_) watch_->observer.update(state_, timeStep_);
    contacts_->trackTravel(state_);
  });
}

vehicle::GroundLoads VehicleRig::groundLoads(const ForceMeans& means) const {
  vehicle::GroundLoads loads;
  if (contacts_->onGround() || contacts_->surfaces() > 0)
    loads.force = meanForces(means, assembly_.model.bodies().size());
  return loads;
}

vehicle::ObserverOptions VehicleRig::observerOptions() const {
  return {.stone = thickestStone_, .heading = heading_, .gravity = gravity_, .step = timeStep_};
}

vehicle::Observation VehicleRig::observe(Means of) const {
  const bool watched = of == Means::watch && watch_;
  const vehicle::Observer& observer = watched ? watch_->observer : *observer_;
  vehicle::Observation seen =
      observer.observe(state_, groundLoads(watched ? watch_->forces : rowMeans_), surfaceHeight_);
  if (towing_) {
    seen.drawbarPull = 0.0 - seen.along.of(towing_->observe(watched ? Means::watch : Means::rows).force);
  } else {
    // Ground force minus the component that balances the weight on a slope.
    const double c = base::cos(seen.heading), s = base::sin(seen.heading);
    const Vec3d weight = gravity_ * (assembly_.mass * driver_.at(state_.time).weight);
    seen.drawbarPull += seen.along.of({weight.x * c + weight.y * s, 0, weight.z});
  }
  seen.blows = blows_;
  return seen;
}

void VehicleRig::restartMeans(Means of) {
  if (towing_) towing_->restartMeans(of);
  if (of == Means::rows) {
    rowMeans_.restart();
    observer_->restartMeans();
    return;
  }
  if (!watch_) watch_.emplace(Watch{*observer_});
  watch_->observer.restartMeans(), watch_->forces.restart();
}

Vec3d VehicleRig::groundForce(const ForceMeans& means) const {
  Vec3d sum;
  for (const Vec3d& force : groundLoads(means).force) sum += force;
  return sum;
}

/// Reports to a waiting driver whether the vehicle is at rest.
std::string VehicleRig::judgeRest() {
  if (!driver_.waits() || !contacts_->onGround()) return {};
  const double g = norm(gravity_);
  const Vec3d down = g > 0 ? gravity_ * (1 / g) : Vec3d{0, 0, -1};
  return driver_.judge(state_.time, dot(state_.twist[assembly_.chassis].v, down),
                       g > 0 ? -dot(groundForce(alarmMeans_) + fluidForce_, down) / (carried_ * g) : 0.0);
}

/// Same check as for mechanisms: parts with a large rotation per step could pass teeth and plates without contact.
std::string VehicleRig::judgeTurns() const {
  std::size_t quickest = 0;
  double rate = 0;
  for (std::size_t b = 0; b < state_.twist.size(); ++b)
    if (const double w = norm(state_.twist[b].w); !(w <= rate)) rate = w, quickest = b;
  if (rate * timeStep_ <= largestTurn_) return {};
  return fmt::format("{} rotates by {:.4g} rad a step, more than {:.4g} rad (run.steps_per_period = {:g} steps a "
                     "turn), so its contacts are not resolved; drive more gently (driver), or set run.time_step to "
                     "{} s or less",
                     assembly_.model.bodies()[quickest].name, rate * timeStep_, largestTurn_,
                     2 * base::kPi / largestTurn_, base::roundedDown(largestTurn_ / rate, 4));
}

/// Same check as for mechanisms: transverse oscillations of the tensioned track and other loaded joints.
std::string VehicleRig::judgeTension() {
  std::string part;
  const double r = timeStep_ * solver_->geometricStiffnessRate(state_, loads_, &part) / solver_->stabilityLimit();
  if (swings_.bears(r, kTensionInterval)) return {};
  return fmt::format("transverse oscillations of tensioned joints may have grown {:g} times: the time step stays above "
                     "the stability limit, now {:.3g} times ({}); set run.time_step to {} s or less, or lower the "
                     "tension (idler.preload of the vehicle file, driver)",
                     SwingGrowth::kMax, r, part, base::roundedDown(0.5 * timeStep_ / r, 4));
}

/// True if the hull moves at less than a twentieth of the speed of every track with a turning sprocket.
bool VehicleRig::stalls() const {
  constexpr double kShare = 0.05, kTurns = 0.01; // [-], [m/s]
  const std::optional<double> start = driver_.driveStart();
  if (!start || state_.time < driver_.rampEnds(*start)) return false;
  bool driven = false;
  for (std::size_t i = 0; i < assembly_.tracks.size(); ++i) {
    const multibody::JointReading& sprocket = state_.joint[assembly_.tracks[i].sprocketJoint];
    const double speed = std::fabs(sprocket.rate) * assembly_.spec.pitchRadius();
    if (speed < kTurns) continue;
    driven = true;
    if (std::fabs(vehicle::trackSpeed(assembly_, static_cast<int>(i), state_)) >= kShare * speed) return false;
  }
  return driven;
}

/// Depends only on the state, so that a resumed run ends at the same step.
std::string VehicleRig::judgeEnd() const {
  const auto origin = [](const base::Pose& hull, const Vec3d& centre) { return hull.toWorld(-centre); };
  const auto hull = static_cast<std::size_t>(assembly_.chassis);
  const Vec3d& centre = assembly_.spec.chassis.centre;
  const Vec3d way = origin(state_.pose[hull], centre) - origin(assembly_.model.bodies()[hull].pose, centre);
  const double distance = std::sqrt(way.x * way.x + way.y * way.y);
  if (stop_.distance && distance >= *stop_.distance)
    return fmt::format("stop.distance: the vehicle is {:.3f} m from its start", distance);
  if (const auto at = stop_.edge && area_
                          ? shoeAtEdge(area_, assembly_, state_, edgesToMeet(area_, assembly_, *stop_.edge))
                          : std::nullopt)
    return fmt::format("stop.edge: the {} is at ({:.2f}, {:.2f}) m, within {:g} m of the terrain's edge",
                       at->shoe->name, at->place.x, at->place.y, *stop_.edge);
  const double stalled = static_cast<double>(stalledSteps_) * timeStep_;
  if (stop_.immobile && stalled >= *stop_.immobile)
    return fmt::format("stop.immobile: for {:.3g} s the hull has moved at less than a twentieth of the speed of the "
                       "driven tracks",
                       stalled);
  return {};
}

base::Alarm VehicleRig::alarm(std::int64_t step) {
  using base::Cause;
  // Checked before the track: these faults can throw the track.
  base::Alarm alarm{step % kTensionInterval == 0 ? judgeTension() : "", Cause::growingSwings};
  if (alarm.empty()) alarm = {judgeTurns(), Cause::fastTurn};
  if (alarm.empty()) alarm = observer_->alarm(state_, groundLoads(alarmMeans_));
  if (alarm.empty()) alarm = {judgeRest(), Cause::noRest};
  if (const double g = norm(gravity_); g > 0) blows_.add(state_.time, -dot(groundForce(alarmMeans_), gravity_) / g);
  alarmMeans_.restart();
  stalledSteps_ = stalls() ? stalledSteps_ + kAlarmInterval : 0;
  ended_ = judgeEnd();
  if (alarm.empty() && ended_.empty()) alarm = {offTerrain(area_, assembly_, state_), Cause::offTerrain};
  return alarm;
}

void VehicleRig::addTo(Ledger& ledger) const {
  multibody::Balance bodies = bodiesBalance();
  bodies.driveWork += (towing_ ? towing_->work() : 0) + applied_.work();
  enter(ledger, bodies, bodies.potentialGain, bodies.elasticGain);
}

VehicleState VehicleRig::save() const {
  VehicleState s;
  s.lift = lift_;
  s.bodies = state_.save();
  s.observers = observer_->save();
  s.driver = driver_.save();
  s.asked = vehicle::Handover{!asked_.held, state_.time, asked_.sprocketSpeed, asked_.torque,
                              vehicle::hullMotion(assembly_, state_).speed}
                .save();
  if (towing_) s.hitch = towing_->save(), s.hitchSums = towing_->saveSums();
  s.appliedWork = applied_.save();
  contacts_->save(s.contacts);
  s.groundForces = rowMeans_.sums, s.meanSteps = rowMeans_.steps;
  s.alarmForces = alarmMeans_.sums, s.alarmSteps = alarmMeans_.steps;
  s.judged = swings_.save();
  const std::vector<double> blows = blows_.save();
  s.judged.insert(s.judged.end(), blows.begin(), blows.end());
  s.stalledSteps = stalledSteps_;
  return s;
}

void VehicleRig::restore(const VehicleState& s) {
  const std::size_t most = contactParts_.count() + contacts_->surfaces(), swings = swings_.save().size();
  if (s.groundForces.size() > most || s.alarmForces.size() > most ||
      (s.judged.size() != swings && s.judged.size() != swings + vehicle::BlowMeter::kNumbers))
    throw base::InputError("the checkpoint belongs to another vehicle; resume with the scene that was run");
  state_.restore(s.bodies);
  observer_->restore(s.observers);
  driver_.restore(s.driver);
  const vehicle::Handover asked = vehicle::Handover::of(s.asked);
  asked_.held = !asked.driven, asked_.sprocketSpeed = asked.sprocketSpeed, asked_.torque = asked.torque;
  if (towing_) towing_->restore(s.hitch, s.hitchSums);
  applied_.restore(s.appliedWork);
  contacts_->restore(s.contacts);
  rowMeans_ = {s.groundForces, s.meanSteps};
  alarmMeans_ = {s.alarmForces, s.alarmSteps};
  swings_.restore(s.judged[0], s.judged[1]);
  stalledSteps_ = s.stalledSteps;
  if (s.judged.size() > swings) // older files have no impact data
    blows_.restore({s.judged.begin() + static_cast<std::ptrdiff_t>(swings), s.judged.end()});
  if (std::llround(state_.time / timeStep_) % kAlarmInterval == 0) ended_ = judgeEnd();
}

} // namespace grouser::coupling
