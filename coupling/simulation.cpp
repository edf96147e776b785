// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/simulation.hpp"

#include "base/error.hpp"
#include "contact/contact_law.hpp"
#include "coupling/fluid_domain.hpp"
#include "coupling/grains_in_vehicle.hpp"
#include "coupling/ground_kinds.hpp"
#include "coupling/ledger_entries.hpp"
#include "coupling/obstacles.hpp"
#include "coupling/placed_on_bed.hpp"
#include "terrain/grain_faults.hpp"
#include "terrain/grain_removal.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <utility>

namespace grouser::coupling {

namespace {

/// Describes a moving body with the middle of a shape beside the terrain and its lowest point below the edge, where
/// there is no ground to carry it; empty without such a body.
std::string besideTerrain(const MechanismSetup& setup, const multibody::Model& model,
                          const std::vector<base::Pose>& poses, const std::vector<Obstacle>& obstacles,
                          const terrain::HeightField& ground) {
  const terrain::Rectangle& area = ground.area();
  for (const BodyShape& s : setup.shapes) {
    if (model.bodies()[s.body].fixed) continue;
    const base::Pose pose = multibody::compose(poses[s.body], s.pose_B);
    const base::Vec3d& p = pose.position;
    const double x = std::clamp(p.x, area.xMin, area.xMax), y = std::clamp(p.y, area.yMin, area.yMax);
    const auto isUnder = [&p](const Obstacle& o) { return std::isfinite(topOf(o.surface, p.x, p.y)); };
    if ((x == p.x && y == p.y) || std::any_of(obstacles.begin(), obstacles.end(), isUnder)) continue;
    const base::Mat3d turned = pose.orientation.matrix();
    const double below = farthestAlong(s, {-turned.m[2][0], -turned.m[2][1], -turned.m[2][2]});
    if (p.z - below <= ground.height(x, y))
      return fmt::format("body \"{}\" is beside the terrain at ({:.4g}, {:.4g}, {:.4g}) m, x = {:g} to {:g} m and y = "
                         "{:g} to {:g} m, where no ground carries it; enlarge terrain.size, or move the body",
                         model.bodies()[s.body].name, p.x, p.y, p.z, area.xMin, area.xMax, area.yMin, area.yMax);
  }
  return {};
}

} // namespace

Simulation::Simulation(SimulationSetup setup, const base::Exec& exec, const SettleProgress& progress,
                       const base::Comm& comm, SettledBeds* beds, SphereSets* spheres)
    : setup_(std::move(setup)), exec_(exec), comm_(comm), gravity_(setup_.gravity) {
  if (hasBed()) {
    const BedSetup& bed = *bedGround().grains->bed;
    const bool kept = beds && bed.settle.timeLimit > 0;
    SettledGround settled =
        kept ? beds->settle(bedGround(), exec, progress, comm) : settledGround(bedGround(), exec, progress, comm);
    laid_ = std::move(settled.ground), settled_ = settled.report;
    keepSurface(laid_, exec);
    if (bed.settle.timeLimit > 0) {
      laid_.structure = structureOf(laid_);
      checkStructure(bed, *laid_.structure);
    }
    if (isPutOnBed()) {
      lifts_ = liftsOnto(*laid_.grains, setup_.ground, comm);
      lift(setup_.ground, lifts_);
      requireRoom(*laid_.grains, setup_.ground, comm);
      extendBedToScene(laid_, setup_.ground, exec, comm);
    }
    if (setup_.mechanism && setup_.mechanism->aboveBed) {
      lifts_.push_back(liftOnto(*laid_.grains, setup_.ground, *setup_.mechanism, comm));
      setup_.mechanism->model.translate({0, 0, lifts_.back()});
    }
  } else {
    laid_ = buildGround(setup_.ground, exec, comm);
  }
  makeActingGround();
  if (setup_.vehicle) makeVehicle(spheres);
  if (setup_.mechanism && !setup_.vehicle) makeMechanism(spheres);
  if (laid_.grains) laid_.grains->setSteps(0);
  makeSurfaces(nullptr);
  if (isPutOnBed()) putGrains(laid_, setup_.ground);
  if (setup_.vehicle && laid_.grains)
    requireApartFromVehicle(*setup_.ground.grains, *vehicle_, setup_.vehicle->soilTouchesShoesOnly);
  if (setup_.mechanism) requireRoomForBodies();
  makeMeshContacts(spheres);
  makeFluid(nullptr);
  start_ = wholeLedger();
  addGrains();
}

Simulation::~Simulation() = default;

/// Calls `advance`; adds the cause found from energies and parts to the message of a grain fault.
template <class Advance> void Simulation::namingCause(const Advance& advance) {
  try {
    advance();
  } catch (const terrain::GrainFault& fault) {
    const base::Alarm alarm = alarmOf(fault);
    if (alarm.empty()) throw;
    throw base::SimulationError(fault.fact + "; " + alarm.text, alarm.cause);
  }
}

/// Collects the contact loads on bodies; adds step and time to the message of an excessive overlap.
void Simulation::collectLoads() {
  try {
    touching_->collectLoads();
  } catch (const base::SimulationError& error) {
    if (error.cause() != base::Cause::excessiveOverlap) throw;
    throw base::SimulationError(fmt::format("step {}, time {:.4g} s: {}", steps_, time(), error.what()), error.cause());
  }
}

void Simulation::step(StepObserver* observer) {
  const auto done = [observer](Stage stage) {
    if (observer) observer->after(stage);
  };
  if (touching_) touching_->setSurfacePoses();
  done(Stage::surfacePoses);
  const bool listsEnded = ground_ && ground_->refreshLists();
  done(Stage::neighbourList);
  if (touching_) touching_->refreshLists(listsEnded);
  done(Stage::partLists);
  if (ground_) ground_->beginUncoupled();
  done(Stage::boundaries);
  if (touching_) touching_->computeContacts(observer);
  if (touching_) base::synchronize(exec_), collectLoads();
  addFluidLoads();
  done(Stage::partLoads);
  // The complementarity solver needs all other loads on the bodies.
  const bool solved = touching_ && touching_->contacts().solves();
  if (solved) touching_->actuate(), touching_->solveContacts();
  if (surfaces_) surfaces_->computeContacts(*laid_.grains, steps_, listsEnded);
  if (ground_) ground_->beginStep();
  done(Stage::grainStep);
  // The device computes the ground while the host solves vehicle or mechanism.
  BodiesInContact* const bodies = movingBodies();
  if (bodies && !solved) bodies->actuate();
  if (bodies) bodies->advance();
  if (fluid_) fluid_->advance(touching_ ? &touching_->state() : nullptr);
  done(Stage::multibody);
  if (ground_) namingCause([&] { ground_->endStep(); });
  if (surfaces_) surfaces_->advance(*laid_.grains, steps_);
  done(Stage::grainStepEnded);
  ++steps_;
  takeOutCrushed();
  addGrains();
  if (setup_.mechanism && laid_.surface && !laid_.grains && steps_ % VehicleRig::kAlarmInterval == 0)
    if (const std::string fault = besideTerrain(*setup_.mechanism, touching_ ? touching_->model() : mechanism_->model(),
                                                touching_ ? touching_->state().pose : mechanism_->state().pose,
                                                setup_.ground.obstacles, *laid_.surface);
        !fault.empty())
      throw base::SimulationError(fmt::format("step {}, time {:.4g} s: {}", steps_, time(), fault),
                                  base::Cause::offTerrain);
  if (vehicle_ && steps_ % VehicleRig::kAlarmInterval == 0) checkAlarm();
  afterStep();
  done(Stage::checks);
}

BodiesInContact* Simulation::movingBodies() {
  if (vehicle_) return vehicle_.get();
  return mechanism_.get();
}

/// `last`: true if the next step must not be launched ahead.
void Simulation::stepAhead(bool last) {
  vehicle_->setSurfacePoses();
  if (!ahead_->nextIsLaunched()) {
    const bool listsEnded = ground_->refreshLists();
    vehicle_->refreshLists(listsEnded);
  } else if (!vehicle_->contacts().listsAreValid()) {
    throw base::SimulationError(
        fmt::format("step {}, time {:.4g} s: a part of the vehicle was thrown: in one step it moved "
                    "more than four times as far as in the step before; use a smaller "
                    "time_step or gentler driving",
                    steps_, time()),
        base::Cause::thrownPart);
  }
  ahead_->begin();
  // After an alarm the state of this step must still be available.
  const bool mayAlarm = (steps_ + 1) % VehicleRig::kAlarmInterval == 0;
  if (!last && !mayAlarm) ahead_->launchNext();
  ahead_->computeOnHost();
  ahead_->awaitLoads();
  collectLoads();
  vehicle_->actuate();
  vehicle_->advance();
  namingCause([&] { ahead_->end(); });
  ++steps_;
  if (steps_ % VehicleRig::kAlarmInterval == 0) checkAlarm();
  afterStep();
}

/// True if a step involves only grains and vehicle, so that work can be launched ahead.
bool Simulation::canStepAhead() const {
  return vehicle_ && granular_ && !fluid_ && !surfaces_ && vehicle_->contacts().surfaces() == 0 && !mechanism_ &&
         setup_.ground.grains->sources.empty() && !setup_.crushes() && terrain::GrainsAhead::canLaunch(*laid_.grains);
}

std::int64_t Simulation::advance(std::int64_t most) {
  const bool grainsAlone =
      laid_.grains && !vehicle_ && !mechanism_ && !surfaces_ && setup_.ground.grains->sources.empty();
  const std::int64_t toLook = EnergyGuard::kInterval - steps_ % EnergyGuard::kInterval;
  if (!grainsAlone && steps_ > 0 && canStepAhead()) {
    if (!ahead_) ahead_ = std::make_unique<StepsAhead>(exec_, *granular_, *vehicle_);
    const std::int64_t count = std::min(most, toLook);
    try {
      for (std::int64_t k = 1; k <= count; ++k) {
        stepAhead(k == count);
        if (!vehicle_->ended().empty()) return k; // at an alarm check, before which no step is launched
      }
    } catch (...) {
      ahead_->callOff();
      throw;
    }
    return count;
  }
  if (!grainsAlone) {
    step();
    return 1;
  }
  std::int64_t taken = 0;
  namingCause([&] { taken = laid_.grains->advance(std::min(most, toLook)); });
  steps_ += taken;
  afterStep();
  return taken;
}

/// Creates the ground from laid_ and the setup; without ground the vehicle hangs.
void Simulation::makeActingGround() {
  ground_ = makeGround(laid_, setup_.ground, exec_);
  granular_ = dynamic_cast<GranularGround*>(ground_.get());
}

/// Creates the vehicle; `lift` as in VehicleRig.
void Simulation::makeVehicle(SphereSets* spheres, std::optional<double> lift) {
  const auto bare = ground_ ? ground_->surface() : std::function<double(double, double)>{};
  vehicle_ = std::make_unique<VehicleRig>(setup_, exec_, ground_.get(), withObstacles(bare, setup_.ground.obstacles),
                                          spheres, lift);
  touching_ = vehicle_.get();
}

void Simulation::makeMechanism(SphereSets* spheres) {
  mechanism_ = std::make_unique<Mechanism>(*setup_.mechanism, setup_.timeStep, exec_, ground_.get(),
                                           setup_.ground.obstacles, spheres);
  if (mechanism_->touches()) touching_ = mechanism_.get();
}

void Simulation::makeFluid(const FluidDomainState* former) {
  if (!setup_.fluid) return;
  const multibody::Model* model = touching_ ? &touching_->model() : nullptr;
  const multibody::State* bodies = touching_ ? &touching_->state() : nullptr;
  if (vehicle_ && norm(model->bodies()[0].pose.position - setup_.fluid->chassis->position) > 1e-6)
    throw base::InputError("the vehicle starts on an obstacle, but the fluid requires a start on the ground; move "
                           "vehicle.position");
  fluid_ = std::make_unique<FluidDomain>(*setup_.fluid, model, bodies, exec_, comm_, former);
}

void Simulation::addFluidLoads() {
  if (!fluid_ || !touching_) return;
  const base::Vec3d force = fluid_->addLoads(touching_->stepLoads());
  if (vehicle_) vehicle_->setFluidForce(force);
}

/// Throws InputError if a body of the mechanism initially overlaps something.
void Simulation::requireRoomForBodies() {
  const multibody::Model& model = vehicle_ ? vehicle_->model() : mechanism_->model();
  if (laid_.grains) requireRoom(*laid_.grains, *setup_.mechanism, model, comm_);
  requireApart(*setup_.mechanism, model, setup_.ground.obstacles, laid_.rigid ? &*laid_.rigid : nullptr);
  if (!laid_.surface || laid_.grains || setup_.mechanism->shapes.empty()) return;
  std::vector<base::Pose> poses;
  for (const multibody::Body& body : model.bodies()) poses.push_back(body.pose);
  if (const std::string fault = besideTerrain(*setup_.mechanism, model, poses, setup_.ground.obstacles, *laid_.surface);
      !fault.empty())
    throw base::InputError(fmt::format("{}: {}", setup_.mechanism->place, fault));
}

/// Creates the surfaces and passes the poses of this step to the grains. The grains were created with the poses of t =
/// 0, so in a resumed run this precedes any contact computation.
void Simulation::makeSurfaces(const SurfaceStates* former) {
  if (!laid_.grains || setup_.ground.surfaces.empty()) return;
  surfaces_ = std::make_unique<Surfaces>(setup_.ground, setup_.gravity, setup_.timeStep);
  if (former) surfaces_->restore(*former);
  surfaces_->place(*laid_.grains, steps_);
}

void Simulation::makeMeshContacts(SphereSets* spheres) {
  if (!surfaces_) return;
  surfaces_->makeMeshContacts(exec_, *laid_.grains, spheres);
  granular_->meetMeshes(surfaces_->grainLoads());
}

/// Adds grains of the sources that enter before the next step. Their energies are added to the ledger's start, so that
/// they do not count as a change.
void Simulation::addGrains() {
  if (!laid_.grains || setup_.ground.grains->sources.empty()) return;
  const std::vector<terrain::GrainSpec> entering = setup_.ground.grains->sources.enteringAt(steps_);
  if (entering.empty()) return;
  const Ledger before = wholeLedger();
  laid_.grains->add(entering);
  start_.move(before, wholeLedger());
}

/// Removes grains crushed to their centre in this step, since they could pass through a part. The elastic energy of
/// their contacts with parts counts as dissipated; the ledger keeps their other energies.
void Simulation::takeOutCrushed() {
  if (!setup_.crushes()) return;
  GrainsOnParts* onParts = granular_->onParts();
  const std::vector<std::uint32_t> ids = onParts ? onParts->endedGrains() : surfaces_->endedGrains();
  if (ids.empty()) return;
  if (onParts)
    onParts->takeOut(ids);
  else
    surfaces_->takeOut(ids);
  const Ledger before = wholeLedger();
  const double mass = terrain::removeGrains(*laid_.grains, ids);
  const Ledger after = wholeLedger();
  start_.move(before, after);
  taken_.grains += static_cast<double>(ids.size()), taken_.mass += mass;
  taken_.energy += before.kinetic - after.kinetic + before.potential - after.potential + before.elastic - after.elastic;
  taken_.momentum += before.momentum - after.momentum;
}

void Simulation::checkAlarm() {
  const base::Alarm alarm = vehicle_->alarm(steps_);
  if (!alarm.empty())
    throw base::SimulationError(fmt::format("step {}, time {:.4g} s: {}", steps_, time(), alarm.text), alarm.cause);
}

Ledger Simulation::wholeLedger() {
  Ledger l;
  if (ground_) ground_->addTo(l);
  if (vehicle_) vehicle_->addTo(l);
  if (surfaces_) surfaces_->addTo(l);
  if (mechanism_) mechanism_->addTo(l);
  if (fluid_) enterFluid(l, fluid_->totals());
  return l;
}

Ledger Simulation::ledger() {
  Ledger l = wholeLedger();
  l.countFrom(start_);
  return l;
}

/// Sets poses and lists, as at the start of step().
terrain::SoilFields fieldsOf(Simulation& s, const terrain::FieldGrid& grid) {
  if (!s.granular_) throw std::logic_error("soil fields require grains");
  terrain::Grains& grains = *s.laid_.grains;
  contact::PartMomentsView onParts;
  if (s.touching_) s.touching_->setSurfacePoses();
  const bool listsEnded = s.granular_->refreshLists();
  if (s.touching_) s.touching_->refreshLists(listsEnded);
  if (s.surfaces_) onParts = s.surfaces_->measure(grains, s.steps_, listsEnded);
  if (s.touching_) onParts = s.touching_->stepContacts().measure(*s.granular_->onParts(), grains.view());
  return terrain::fieldsOf(grains, grid, onParts);
}

/// Returns the grain that has stopped the run, with its contacts, including vehicle and meshes.
PressedGrain Simulation::pressed(std::uint32_t grain) {
  PressedGrain pressed = pressedGrain(
      *laid_.grains, setup_.ground, [this](std::size_t i) { return surfaces_->pose(i, steps_); }, grain);
  std::vector<std::pair<std::string, double>> parts;
  if (touching_) parts = granular_->onParts()->pressing(grain);
  if (surfaces_) parts = surfaces_->meshesPressing(grain);
  for (const auto& [name, overlap] : parts) pressed.by.insert(pressed.by.begin(), {name, overlap, {}, true});
  return pressed;
}

std::optional<DeepestPartOverlap> Simulation::deepestPartOverlap() const {
  if (granular_ && touching_) return granular_->onParts()->deepestPartOverlap();
  return surfaces_ ? surfaces_->deepestPartOverlap() : std::nullopt;
}

/// Hertz contacts are stiffer than assumed for the time step if grains move faster than run.impact_speed.
std::string Simulation::impactNote(const Ledger& now) const {
  if (!laid_.grains || !setup_.ground.grains->impactSpeed) return {};
  const double chosen = *setup_.ground.grains->impactSpeed;
  if (now.fastestGrain <= chosen) return {};
  return fmt::format(
      " (grains move at up to {:.3g} m/s, hertz contacts assume run.impact_speed = {:g} m/s: raise it to the impact "
      "speed)",
      now.fastestGrain, chosen);
}

base::Alarm Simulation::alarmOf(const terrain::GrainFault& fault) {
  using terrain::Fault;
  if (fault.fault != Fault::overlap && fault.fault != Fault::speed && fault.fault != Fault::through) return {};
  const Ledger now = ledger();
  if (const std::string verdict = energyVerdict(now); !verdict.empty())
    return {fmt::format("{}: the step of {:.4g} s is too long for these contacts; use a smaller time_step{}", verdict,
                        timeStep(), impactNote(now)),
            base::Cause::unstableContacts};
  const PressedGrain grain = pressed(fault.id);
  if (fault.fault == Fault::speed) {
    if (!grain.fallsFreely(gravity_)) return {};
    return {"it falls without contact: add a floor or walls that hold it, or end the run earlier",
            base::Cause::lostGrain};
  }
  std::string by = grain.sentence();
  if (const PressedGrain::Presser* through = fault.fault == Fault::through ? grain.rigidPresser() : nullptr)
    by = fmt::format("{} overlaps it by {:.3g} mm of its radius of {:.3g} mm{}", through->name, 1e3 * through->overlap,
                     1e3 * grain.radius, by.empty() ? by : "; " + by);
  return {fmt::format("{}the energies balance, so the time step is not the cause: use stiffer contacts (material "
                      "stiffness or young), larger grains, less load or lower speed (it moves at {:.3g} m/s), or {}",
                      by.empty() ? by : by + "; ", norm(grain.velocity),
                      vehicle_ && fault.fault == Fault::through
                          ? "keep soil out of the running gear (vehicle.soil_contact)"
                          : "raise run.max_overlap"),
          base::Cause::excessiveOverlap};
}

/// Updates ledger and guard after each step.
void Simulation::afterStep() {
  // The elastic energy of part contacts is that at the start of the last step: after step 1, at the start of the run.
  if (steps_ == 1) start_.elastic += partsElastic();
  // A fluid has its own fault checks, and its walls may add or remove energy.
  if (fluid_ || steps_ % EnergyGuard::kInterval != 0) return;
  const Ledger now = ledger();
  checkEnergy(now);
  guard_.look(now);
}

double Simulation::partsElastic() const {
  return (touching_ ? touching_->contacts().ledger().elastic() : 0.0) + (surfaces_ ? surfaces_->meshElastic() : 0.0);
}

void Simulation::checkEnergy() {
  if (fluid_) return;
  const Ledger now = ledger();
  // Within a grain contact the energy error oscillates: the gain of a few steps is lost in the following ones.
  const bool early =
      (!mechanism_ || mechanism_->touches()) && steps_ % EnergyGuard::kInterval < EnergyGuard::kOneContact;
  if (early && std::isfinite(now.integrationError) && std::isfinite(now.turnover)) return;
  checkEnergy(now);
}

double Simulation::energyHeld(const Ledger& now) const {
  return std::fabs(start_.kinetic + now.kinetic) + std::fabs(start_.elastic + now.elastic) + weightHeld();
}

/// Grains at rest on stiff contacts have almost no energy, but the position resolution makes their weight do work.
double Simulation::weightHeld() const {
  if (!laid_.grains) return 0;
  const terrain::GrainModel& model = laid_.grains->model();
  const double one = hasBed() ? setup_.ground.grains->bed->restEnergy : model.mass * norm(model.gravity) * model.radius;
  return one * static_cast<double>(laid_.grains->count() - laid_.grains->system().fixedCount);
}

std::optional<double> Simulation::solverError() const {
  if (!laid_.grains || !laid_.grains->model().complementarity) return {};
  const terrain::GrainModel& model = laid_.grains->model();
  const auto grains = static_cast<double>(laid_.grains->count() - laid_.grains->system().fixedCount);
  double mass = model.mass * grains + (vehicle_ ? vehicle_->carriedMass() : 0); // carried by grains
  if (setup_.mechanism && !vehicle_)
    for (const multibody::Body& body : setup_.mechanism->model.bodies()) mass += body.fixed ? 0 : body.mass;
  for (const SurfaceSetup& surface : setup_.ground.surfaces) mass += surface.free ? surface.free->mass : 0;
  const terrain::ImpulseReport& last = laid_.grains->system().impulses->report(); // relaxed: contacts dilate
  const double residual = std::max(model.complementarity->residual, last.relaxed ? 0.0 : last.residual);
  // The residual presses six contacts per grain by its way in a step, which store this energy until the next steps.
  const double way = residual * model.timeStep;
  double pressed = contact::storedEnergy(model.law, way, model.radius, base::Vec3d{});
  for (const contact::ContactLaw& law : model.materials.grains)
    pressed = std::max(pressed, contact::storedEnergy(law, way, model.radius, base::Vec3d{}));
  return EnergyGuard::solverError(mass * norm(gravity_), residual, model.timeStep) + 6 * grains * pressed;
}

std::string Simulation::energyVerdict(const Ledger& now) const {
  return guard_.judge(now, energyHeld(now), solverError());
}

void Simulation::checkEnergy(const Ledger& now) {
  const std::string verdict = energyVerdict(now);
  if (verdict.empty()) return;
  const bool alone = mechanism_ && !mechanism_->touches();
  std::string remedy = "the time step is too long for this motion: use a smaller time_step";
  if (!alone) remedy = "the contacts are unstable: use a smaller time_step or softer contacts" + impactNote(now);
  if (const std::string note = alone ? mechanism_->bounceNote() : ""; !note.empty()) remedy += "; " + note;
  if (mechanism_ && !mechanism_->tensionStepWarning().empty()) remedy += "; " + mechanism_->tensionStepWarning();
  if (vehicle_ && now.dissipated.ofParts() > now.dissipated.ofGrains())
    remedy += "; shoe contacts dissipated most on " + mostDissipatingPart(vehicle_->assembly(), vehicle_->save());
  throw EnergyAlarm(fmt::format("step {}, time {:.4g} s: {}; {}", steps_, time(), verdict, remedy));
}

FluidDomain* fluidOf(const Simulation& simulation) { return simulation.fluid_.get(); }

std::vector<spheredecomp::CutReport> cutReports(const Simulation& simulation) {
  std::vector<spheredecomp::CutReport> all;
  const auto add = [&](const std::vector<spheredecomp::CutReport>& more) {
    all.insert(all.end(), more.begin(), more.end());
  };
  if (const VehicleRig* vehicle = simulation.vehicle())
    add(vehicle->parts().cutReports()), add(vehicle->bodyCuts()), add(obstacleReports(vehicle->contacts()));
  if (const Mechanism* mechanism = simulation.mechanism(); mechanism && mechanism->touches())
    add(mechanism->bodyCuts()), add(obstacleReports(mechanism->contacts()));
  if (simulation.surfaces()) add(simulation.surfaces()->cutReports());
  return all;
}

} // namespace grouser::coupling
