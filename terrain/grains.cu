// SPDX-License-Identifier: BSD-3-Clause
#include "terrain/grains.hpp"

#include "base/algorithms.hpp"
#include "base/gather.cuh"
#include "terrain/grain_kernels.cuh"

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <utility>

namespace grouser::terrain {

using base::Position;
using base::Vec3d;
using base::Vec3f;

namespace {

struct KeepReference {
  const Position* position;
  base::Vec3<std::uint32_t>* reference;
  GROUSER_HD void operator()(int i) const { reference[i] = {position[i].x, position[i].y, position[i].z}; }
};

/// Marks the grains that may touch a wall, the floor or a surface before any grain has moved half the skin and any
/// surface has left its room.
struct MarkNearBoundary {
  GrainKernelData d;
  double reach; ///< what grains may move, and the radius where all have one [m]
  bool manyRadii;
  double way;                 ///< that surfaces may move before the next list [m]
  const std::uint32_t* ghost; ///< null where there are none
  std::uint32_t* mark;
  GROUSER_HD void operator()(int i) const {
    if (ghost && ghost[i]) {
      mark[i] = 0;
      return;
    }
    const Vec3d x = base::toUnits(d.position[i]).as<double>() * d.unitLength;
    const double within = reach + (manyRadii ? static_cast<double>(d.velocity[i].w) : 0.0);
    bool near = (d.features & kFloor) && !d.floor.clearOf(x, within);
    for (int b = 0; b < d.wallCount; ++b) near = near || dot(d.walls[b].normal, x) - d.walls[b].offset < within;
    for (int s = 0; s < d.surfaceCount; ++s) near = near || nearSurface(s, x, within);
    mark[i] = near ? 1u : 0u;
    // A surface that jumps away leaves nothing to go on with.
    if (d.surfaceCount > 0 && !near) d.boundaryContactMask[i] = 0;
  }

private:
  GROUSER_HD bool nearSurface(int s, const Vec3d& x, double within) const {
    const contact::PartMotion& motion = d.placements[s].motion;
    const SurfaceTravel room = roomOf(d.surfaces[s], way);
    return gapTo(d.surfaces[s], motion.toPart(x)).distance < within + room.way + room.turn * norm(x - motion.centre);
  }
};

/// From the counts before each slot to places: the list, and the place of each slot in it.
struct ListNearBoundary {
  const std::uint32_t* before;
  std::int64_t count;
  std::uint32_t total;
  std::uint32_t *list, *placeOf;
  GROUSER_HD void operator()(int i) const {
    const std::uint32_t next = i + 1 < count ? before[i + 1] : total;
    placeOf[i] = next > before[i] ? next : 0u;
    if (next > before[i]) list[before[i]] = static_cast<std::uint32_t>(i);
  }
};

} // namespace

/// `place`: of the step among those that go at once.
GrainKernelData Grains::kernelData(const contact::GrainLoadsView* loads, int place) {
  GrainKernelData d{};
  const double dt = model_.timeStep, r = model_.radius;
  d.features = features_ | (loads ? kLoads : 0u) | (hasFloor_ ? kFloor : 0u);
  d.mostSimdLanes = model_.mostSimdLanes;
  d.timeStep = dt;
  d.diameter = static_cast<float>(2 * r);
  d.unitLength = scale_.unit, d.unitsPerLength = static_cast<float>(scale_.perMetre);
  d.diameterUnits = diameterUnits_, d.diameterUnits2 = diameterUnits_ * diameterUnits_;
  d.halfSkinUnits2 = (skinUnits_ / 2) * (skinUnits_ / 2);
  d.stepPerMass = dt / model_.mass;
  d.stepPerInertia = dt / (0.4 * model_.mass * r * r);
  d.unitsPerSpeed = dt * scale_.perMetre;
  d.maxOverlap = static_cast<float>(model_.maxOverlap * r);
  d.maxOverlapShare = static_cast<float>(model_.maxOverlap);
  const double maxSpeed = 0.5 * model_.skin * smallestRadius_ / dt;
  d.maxSpeed2 = static_cast<float>(maxSpeed * maxSpeed);
  d.gravityStep = model_.gravity * dt;
  d.walls = walls_.data(), d.wallCount = static_cast<int>(walls_.size()), d.boundaryCount = boundaryCount_;
  d.floor = floorView_;
  d.period = period_, d.crossings = crossings_.data();
  d.surfaces = surfaces_.data(), d.surfaceCount = static_cast<int>(geometries_.size());
  d.placements = placements_.device().data(), d.surfaceLoads = surfaceSums_.device().data();
  d.surfaceForce = surfaceForce_, d.surfaceTorque = surfaceTorque_, d.fromSurfaces = fromSurfaces_.data();
  d.materials = static_cast<int>(massPerCube_.size()), d.massPerCube = massPerCube_.data();
  d.count = static_cast<std::int64_t>(slots_);
  d.position = position_[0].data(), d.nextPosition = position_[1].data();
  d.velocity = velocity_[0].data(), d.nextVelocity = velocity_[1].data();
  d.spin = spin_[0].data(), d.nextSpin = spin_[1].data();
  d.remainders = remainders_.data();
  d.id = id_.data();
  d.reference = reference_.data();
  d.neighbours = neighbours_.view();
  d.nearBoundary = nearBoundary_.data(), d.boundaryOf = boundaryOf_.data();
  d.boundaryHistory = boundaryHistory_.data(), d.boundaryContactMask = boundaryContactMask_.data();
  d.dissipated = dissipated_.data();
  if (loads) d.loads = *loads;
  d.flags = flags_.device().data() + place;
  d.former = place > 0 ? d.flags - 1 : nullptr;
  return d;
}

template <class Real> ForceData<Real> Grains::forceData(Forces<Real>& forces) {
  const auto real = [](double value) { return static_cast<Real>(value); };
  return {real(model_.radius),        real(scale_.unit),   real(model_.timeStep),
          real(0.5 * model_.mass),    real(model_.mass),   real(static_cast<double>(diameterUnits_)),
          model_.law.as<Real>(),      forces.pairs.data(), forces.boundaries.data(),
          forces.boundaryLoads.data()};
}
template ForceData<float> Grains::forceData(Forces<float>&);
template ForceData<double> Grains::forceData(Forces<double>&);

bool Grains::refreshNeighbours() {
  if (stale_)
    rebuild();
  else if (surfacesHaveLeft())
    listNearBoundaries();
  return std::exchange(slotsChanged_, false);
}

void Grains::rebuild() {
  if (boundariesBegun_) throw std::logic_error("grains are listed anew while their walls are being touched");
  if (subdomain_) migrate();
  neighbours_.sort(position_[0].data(), slots_);
  permute();
  if (subdomain_) {
    subdomain_->sorted(neighbours_.order(), slots_);
    origins_.origin = origin_.data(), origins_.ghost = subdomain_->ghostMarks();
  }
  neighbours_.build(position_[0].data(), id_.data(), subdomain_ ? &origins_ : nullptr, radii());
  if (boundaryCount_ > 0) listNearBoundaries();
  reference_.resize(slots_);
  base::forEach(exec_, "keep reference", static_cast<std::int64_t>(slots_),
                KeepReference{position_[0].data(), reference_.data()});
  stale_ = false;
  slotsChanged_ = true;
  stepGraph_.forget();
  ++rebuilds_;
}

void Grains::listNearBoundaries() {
  const auto n = static_cast<std::int64_t>(slots_);
  base::Array<std::uint32_t> mark(exec_, slots_), before(exec_, slots_);
  boundaryOf_.resize(slots_);
  // Between rebuilds, when surfaces ask for a list, a grain may have moved half the skin already and come back.
  const double skin = (geometries_.empty() ? 0.5 : 1.0) * model_.skin * smallestRadius_;
  const double reach = (manyRadii() ? 0 : model_.radius) + skin + scale_.unit;
  base::forEach(exec_, "mark grains near boundaries", n,
                MarkNearBoundary{kernelData(nullptr), reach, manyRadii(), surfaceWay(), ghosts(), mark.data()});
  const std::uint32_t total = base::exclusiveScan(exec_, mark.data(), before.data(), slots_);
  nearBoundary_.resize(total);
  if (model_.precision == Precision::single)
    single_.boundaryLoads.resize(total);
  else
    double_.boundaryLoads.resize(total);
  if (!geometries_.empty()) {
    fromSurfaces_.resize(total);
    listedAt_.assign(placements_.host(), placements_.host() + placements_.size());
    ++surfaceListings_;
  }
  base::forEach(exec_, "list grains near boundaries", n,
                ListNearBoundary{before.data(), n, total, nearBoundary_.data(), boundaryOf_.data()});
}

void Grains::permute() {
  const std::uint32_t* order = neighbours_.order();
  const auto n = static_cast<std::int64_t>(slots_);
  const auto gather = [&]<class T>(base::Array<T>& from, base::Array<T>& to) {
    base::forEach(exec_, "permute grains", n, base::Gather<T>{order, from.data(), to.data()});
    from.swap(to);
  };
  gather(position_[0], position_[1]);
  gather(velocity_[0], velocity_[1]);
  gather(spin_[0], spin_[1]);
  // By way of one place for all, and back: an array that changed its memory at each rebuild would ask for more of it.
  std::size_t most = 0;
  const auto atMost = [&]<class T>(const base::Array<T>& array) { most = std::max(most, array.size() * sizeof(T)); };
  atMost(remainders_), atMost(id_), atMost(boundaryHistory_), atMost(boundaryContactMask_), atMost(dissipated_);
  atMost(crossings_), atMost(origin_);
  base::Array<std::byte> place = base::Array<std::byte>::unset(exec_, most);
  const auto gatherOwn = [&]<class T>(base::Array<T>& array, int width = 1) {
    if (array.empty()) return;
    T* const to = reinterpret_cast<T*>(place.data());
    base::forEach(exec_, "permute grains", n, base::Gather<T>{order, array.data(), to, width});
    base::copyOnDevice(exec_, array.data(), to, array.size() * sizeof(T));
  };
  gatherOwn(remainders_);
  gatherOwn(id_);
  gatherOwn(boundaryHistory_, boundaryCount_ * historyWidth_);
  gatherOwn(boundaryContactMask_);
  gatherOwn(dissipated_);
  gatherOwn(crossings_);
  gatherOwn(origin_);
}

template <class Real> void Grains::advanceGrains(const base::Exec& exec, Forces<Real>& forces,
                                                 const contact::GrainLoadsView* loads, int place,
                                                 const base::Array<std::uint32_t>* active) {
  GrainKernelData d = kernelData(loads, place);
  const std::int64_t count = active ? static_cast<std::int64_t>(active->size()) : d.count;
  if (active) d.active = active->data();
  runGrainStep(exec, d, forceData(forces), count, model_.specialised);
}

/// On a CPU by their list, in lanes. A GPU's threads would wait for the list before they could ask for anything.
template <class Real>
void Grains::advanceUniques(Forces<Real>& forces, const contact::GrainLoadsView* loads, int place) {
  if (exec_.onCpu()) return advanceGrains(exec_, forces, loads, place, &subdomain_->uniques());
  GrainKernelData d = kernelData(loads, place);
  d.role = subdomain_->roles();
  runGrainStep(exec_, d, forceData(forces), d.count, model_.specialised);
}

void Grains::computeBoundaryContacts(const base::Exec& exec, const contact::GrainLoadsView* loads, int place) {
  if (!geometries_.empty()) surfaceSums_.device().zero();
  if (boundaryCount_ == 0) return;
  const auto near = static_cast<std::int64_t>(nearBoundary_.size());
  if (model_.precision == Precision::single)
    runBoundaryContacts(exec, kernelData(loads, place), forceData(single_), near, model_.specialised);
  else
    runBoundaryContacts(exec, kernelData(loads, place), forceData(double_), near, model_.specialised);
}

void Grains::beginBoundaries() {
  if (!geometries_.empty()) return; // nobody has placed the surfaces yet
  side_.fork();
  computeBoundaryContacts(side_.exec(), nullptr, 0);
  boundariesBegun_ = true;
}

template <class Real> void Grains::stepWith(Forces<Real>& forces, const contact::GrainLoadsView* loads, int place) {
  if (std::exchange(boundariesBegun_, false))
    side_.join();
  else
    computeBoundaryContacts(exec_, loads, place);
  if (!subdomain_) return advanceGrains(exec_, forces, loads, place, nullptr);
  // Uniques need no ghost, and go while the ghosts' new states are on their way. Beside them, and first where both
  // could go, the masters, whose own new states others will need.
  side_.fork();
  advanceUniques(forces, loads, place);
  finishGhostUpdate(side_.exec());
  advanceGrains(side_.exec(), forces, loads, place, &subdomain_->masters());
  subdomain_->haloExchange().pack(side_.exec(), ghostFields(1));
  side_.join();
}

void Grains::launchStep(const contact::GrainLoadsView* loads, int place) {
  if (model_.precision == Precision::single)
    stepWith(single_, loads, place);
  else
    stepWith(double_, loads, place);
  swapBuffers();
}

void Grains::swapBuffers() {
  position_[0].swap(position_[1]);
  velocity_[0].swap(velocity_[1]);
  spin_[0].swap(spin_[1]);
}

void Grains::beginStep(const contact::GrainLoadsView* loads) {
  launchStep(loads, 0);
  flags_.download();
  if (!geometries_.empty()) surfaceSums_.download();
}

/// Without a host in between: it is the GPUs that agree after each step whether that was the last.
void Grains::launchSteps() {
  for (int place = 0; place < kStepsPerGraph; ++place) {
    launchStep(nullptr, place);
    if (!subdomain_) continue;
    subdomain_->agreement().run(exec_, reinterpret_cast<std::uint64_t*>(flags_.device().data() + place));
    subdomain_->haloExchange().publish();
  }
  flags_.download();
}

} // namespace grouser::terrain
