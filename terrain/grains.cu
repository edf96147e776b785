// SPDX-License-Identifier: BSD-3-Clause
#include "terrain/grains.hpp"

#include "base/algorithms.hpp"
#include "base/fixed_point.hpp"
#include "terrain/grain_step.cuh"

#include <utility>

namespace grouser::terrain {

using base::Position;
using base::Vec3d;
using base::Vec3f;

namespace {

/// to[i] = from[order[i]], records of `width` elements each.
template <class T> struct Gather {
  const std::uint32_t* order;
  const T* from;
  T* to;
  int width = 1;
  GROUSER_HD void operator()(int i) const {
    for (int w = 0; w < width; ++w)
      to[static_cast<std::int64_t>(i) * width + w] = from[static_cast<std::int64_t>(order[i]) * width + w];
  }
};

struct KeepReference {
  const Position* position;
  base::Vec3<std::uint32_t>* reference;
  GROUSER_HD void operator()(int i) const { reference[i] = {position[i].x, position[i].y, position[i].z}; }
};

/// Marks the grains that may touch a wall or the floor before any grain has moved half the skin.
struct MarkNearBoundary {
  GrainKernelData d;
  double reach;               ///< radius plus half the skin [m]
  const std::uint32_t* ghost; ///< null where there are none
  std::uint32_t* mark;
  GROUSER_HD void operator()(int i) const {
    if (ghost && ghost[i]) {
      mark[i] = 0;
      return;
    }
    const Vec3d x = base::toUnits(d.position[i]).as<double>() * d.unitLength;
    bool near = d.hasFloor && !d.floor.clearOf(x, reach);
    for (int b = 0; b < d.wallCount; ++b) near = near || dot(d.walls[b].normal, x) - d.walls[b].offset < reach;
    mark[i] = near ? 1u : 0u;
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

/// Runs the step with just the features this scene has.
template <bool kFriction, bool kBoundaries>
void runStep(const base::Exec& exec, const GrainKernelData& d, std::int64_t count, bool loads, bool ledger) {
  if (loads && ledger)
    base::forEach(exec, "grain step", count, GrainStep<kFriction, kBoundaries, true, true>{d});
  else if (loads)
    base::forEach(exec, "grain step", count, GrainStep<kFriction, kBoundaries, true, false>{d});
  else if (ledger)
    base::forEach(exec, "grain step", count, GrainStep<kFriction, kBoundaries, false, true>{d});
  else
    base::forEach(exec, "grain step", count, GrainStep<kFriction, kBoundaries, false, false>{d});
}

/// One grain's share of the ledger, in quanta.
struct MeasureGrain {
  GrainKernelData d;
  base::FixedPoint energy, momentum;
  std::int64_t*
      sums; ///< kinetic, rotational, potential, elastic, dissipated, px, py, pz, 2 x contacts, boundary contacts
  std::uint64_t* extremes;    ///< complements of the deepest overlap [units] and the largest speed [um/s]
  const std::uint32_t* ghost; ///< null where there are none

  GROUSER_HD void operator()(int i) const {
    if (ghost && ghost[i]) return;
    const Vec3d v = d.velocity[i].xyz().as<double>(), w = d.spin[i].xyz().as<double>();
    const base::Vec3l u = base::toUnits(d.position[i]);
    const Vec3d x = u.as<double>() * d.unitLength;
    const double m = static_cast<double>(d.mass);
    const double inertia = 0.4 * m * d.radius * d.radius;
    double elastic = 0, deepest = 0;
    std::int64_t touching = 0, boundary = 0;
    for (std::uint32_t k = 0; k < d.neighbours.count[i]; ++k) {
      const std::int64_t at = d.neighbours.at(i, k);
      const std::int64_t distance2 =
          base::squaredNorm(base::difference(d.position[i], d.position[d.neighbours.slot[at]]));
      if (distance2 >= d.diameterUnits2) continue;
      const double distance = sqrt(static_cast<double>(distance2));
      const double overlap =
          static_cast<double>(d.diameterUnits2 - distance2) / (d.diameterUnits + distance) * d.unitLength;
      deepest = overlap > deepest ? overlap : deepest;
      const bool held = d.neighbours.shear && (d.neighbours.touching[i] >> k & 1);
      elastic += 0.5 * contact::storedEnergy(d.law, overlap, held ? d.neighbours.shear[at] : Vec3f{});
      ++touching;
    }
    for (int b = 0; b < d.wallCount; ++b) {
      const double overlap = d.radius - (dot(d.walls[b].normal, x) - d.walls[b].offset);
      if (overlap <= 0) continue;
      deepest = overlap > deepest ? overlap : deepest;
      elastic += contact::storedEnergy(d.walls[b].law, overlap, wallShear(i, b));
      ++boundary;
    }
    if (d.hasFloor && !d.floor.clearOf(x, d.radius)) {
      const double overlap = d.radius - d.floor.closestPoint(x).distance;
      if (overlap > 0) {
        deepest = overlap > deepest ? overlap : deepest;
        elastic += contact::storedEnergy(d.floorLaw, overlap, wallShear(i, d.wallCount));
        ++boundary;
      }
    }
    const Vec3d gravity = d.gravityStep * (1.0 / d.timeStep);
    add(0, energy.quantise(0.5 * m * dot(v, v)));
    add(1, energy.quantise(0.5 * inertia * dot(w, w)));
    add(2, energy.quantise(-m * dot(gravity, x)));
    add(3, energy.quantise(elastic));
    add(4, energy.quantise(d.dissipated ? d.dissipated[i] : 0.0));
    for (int a = 0; a < 3; ++a) add(5 + a, momentum.quantise(m * v[a]));
    add(8, touching);
    add(9, boundary);
    base::atomicMin64(extremes, ~static_cast<std::uint64_t>(deepest / d.unitLength));
    base::atomicMin64(extremes + 1, ~static_cast<std::uint64_t>(norm(v) * 1e6));
  }
  GROUSER_HD Vec3f wallShear(int i, int b) const {
    return d.wallShear && (d.wallTouching[i] >> b & 1) ? d.wallShear[static_cast<std::int64_t>(i) * d.boundaryCount + b]
                                                       : Vec3f{};
  }
  GROUSER_HD void add(int which, std::int64_t quanta) const { base::atomicAdd64(sums + which, quanta); }
};

} // namespace

GrainKernelData Grains::kernelData(const contact::GrainLoadsView* loads) {
  GrainKernelData d{};
  const double dt = model_.timeStep, r = model_.radius;
  d.radius = static_cast<float>(r), d.diameter = static_cast<float>(2 * r);
  d.unit = static_cast<float>(scale_.unit), d.unitLength = scale_.unit;
  d.timeStep = static_cast<float>(dt);
  d.mass = static_cast<float>(model_.mass), d.halfMass = static_cast<float>(0.5 * model_.mass);
  d.diameterUnits = diameterUnits_, d.diameterUnits2 = diameterUnits_ * diameterUnits_;
  d.halfSkinUnits2 = (skinUnits_ / 2) * (skinUnits_ / 2);
  d.stepPerMass = dt / model_.mass;
  d.stepPerInertia = dt / (0.4 * model_.mass * r * r);
  d.unitsPerSpeed = dt * scale_.perMetre;
  d.maxOverlap = static_cast<float>(model_.maxOverlap * r);
  const double maxSpeed = 0.5 * model_.skin * r / dt;
  d.maxSpeed2 = static_cast<float>(maxSpeed * maxSpeed);
  d.gravityStep = model_.gravity * dt;
  d.law = model_.law, d.floorLaw = model_.floorLaw;
  d.walls = walls_.data(), d.wallCount = static_cast<int>(walls_.size()), d.boundaryCount = boundaryCount_;
  d.hasFloor = hasFloor_, d.floor = floorView_;
  d.count = static_cast<std::int64_t>(slots_);
  d.position = position_[0].data(), d.nextPosition = position_[1].data();
  d.velocity = velocity_[0].data(), d.nextVelocity = velocity_[1].data();
  d.spin = spin_[0].data(), d.nextSpin = spin_[1].data();
  d.remainders = remainders_.data();
  d.id = id_.data();
  d.reference = reference_.data();
  d.neighbours = neighbours_.view();
  d.nearBoundary = nearBoundary_.data(), d.boundaryOf = boundaryOf_.data(), d.boundaryLoads = boundaryLoads_.data();
  d.wallShear = wallShear_.data(), d.wallTouching = wallTouching_.data();
  d.dissipated = dissipated_.data();
  if (loads) d.loads = *loads;
  d.flags = flags_.device().data();
  return d;
}

bool Grains::refreshNeighbours() {
  if (stale_) rebuild();
  return std::exchange(slotsChanged_, false);
}

void Grains::rebuild() {
  if (subdomain_) shareOut();
  neighbours_.sort(position_[0].data(), slots_);
  permute();
  if (subdomain_) {
    subdomain_->sorted(neighbours_.order(), slots_);
    origins_.origin = origin_.data(), origins_.ghost = subdomain_->ghostMarks();
  }
  neighbours_.build(position_[0].data(), id_.data(), subdomain_ ? &origins_ : nullptr);
  if (boundaryCount_ > 0) listNearBoundaries();
  reference_.resize(slots_);
  base::forEach(exec_, "keep reference", static_cast<std::int64_t>(slots_),
                KeepReference{position_[0].data(), reference_.data()});
  stale_ = false;
  slotsChanged_ = true;
  ++rebuilds_;
}

void Grains::listNearBoundaries() {
  const auto n = static_cast<std::int64_t>(slots_);
  base::Array<std::uint32_t> mark(exec_, slots_), before(exec_, slots_);
  boundaryOf_.resize(slots_);
  base::forEach(exec_, "mark grains near boundaries", n,
                MarkNearBoundary{kernelData(nullptr), model_.radius * (1 + 0.5 * model_.skin) + scale_.unit, ghosts(),
                                 mark.data()});
  const std::uint32_t total = base::exclusiveScan(exec_, mark.data(), before.data(), slots_);
  nearBoundary_.resize(total);
  boundaryLoads_.resize(total);
  base::forEach(exec_, "list grains near boundaries", n,
                ListNearBoundary{before.data(), n, total, nearBoundary_.data(), boundaryOf_.data()});
  base::synchronize(exec_);
}

void Grains::permute() {
  const std::uint32_t* order = neighbours_.order();
  const auto n = static_cast<std::int64_t>(slots_);
  const auto gather = [&]<class T>(base::Array<T>& from, base::Array<T>& to) {
    base::forEach(exec_, "permute grains", n, Gather<T>{order, from.data(), to.data()});
    from.swap(to);
  };
  gather(position_[0], position_[1]);
  gather(velocity_[0], velocity_[1]);
  gather(spin_[0], spin_[1]);
  const auto gatherOwn = [&]<class T>(base::Array<T>& array, int width = 1) {
    if (array.empty()) return;
    base::Array<T> to(exec_, array.size());
    base::forEach(exec_, "permute grains", n, Gather<T>{order, array.data(), to.data(), width});
    base::synchronize(exec_);
    array.swap(to);
  };
  gatherOwn(remainders_);
  gatherOwn(id_);
  gatherOwn(wallShear_, boundaryCount_);
  gatherOwn(wallTouching_);
  gatherOwn(dissipated_);
  gatherOwn(origin_);
}

void Grains::advanceGrains(const contact::GrainLoadsView* loads, const base::Array<std::uint32_t>* active) {
  GrainKernelData d = kernelData(loads);
  const std::int64_t count = active ? static_cast<std::int64_t>(active->size()) : d.count;
  if (active) d.active = active->data();
  const bool boundaries = boundaryCount_ > 0, withLoads = loads != nullptr;
  if (frictional_ && boundaries)
    runStep<true, true>(exec_, d, count, withLoads, model_.ledger);
  else if (frictional_)
    runStep<true, false>(exec_, d, count, withLoads, model_.ledger);
  else if (boundaries)
    runStep<false, true>(exec_, d, count, withLoads, model_.ledger);
  else
    runStep<false, false>(exec_, d, count, withLoads, model_.ledger);
}

void Grains::beginStep(const contact::GrainLoadsView* loads) {
  if (boundaryCount_ > 0) {
    const GrainKernelData d = kernelData(loads);
    const auto near = static_cast<std::int64_t>(nearBoundary_.size());
    if (frictional_)
      base::forEach(exec_, "boundary contacts", near, BoundaryContacts<true>{d});
    else
      base::forEach(exec_, "boundary contacts", near, BoundaryContacts<false>{d});
  }
  if (subdomain_) {
    // Grains that need no ghost go first: meanwhile the ghosts are on their way.
    advanceGrains(loads, &subdomain_->uniques());
    completeGhosts();
    advanceGrains(loads, &subdomain_->masters());
  } else {
    advanceGrains(loads, nullptr);
  }
  flags_.download();
  position_[0].swap(position_[1]);
  velocity_[0].swap(velocity_[1]);
  spin_[0].swap(spin_[1]);
}

GrainLedger Grains::ledger() {
  if (stale_) rebuild();
  completeGhosts();
  const double scale = model_.law.stiffness * model_.radius * model_.radius;
  MeasureGrain measure{kernelData(nullptr),
                       base::fixedPointFor(scale, 32),
                       base::fixedPointFor(model_.mass * 10, 32),
                       nullptr,
                       nullptr,
                       ghosts()};
  base::Array<std::int64_t> sums(exec_, 10);
  base::Array<std::uint64_t> extremes(exec_, std::vector<std::uint64_t>(2, ~std::uint64_t{0}));
  measure.sums = sums.data();
  measure.extremes = extremes.data();
  base::forEach(exec_, "measure grains", static_cast<std::int64_t>(slots_), measure);
  std::vector<std::int64_t> q = sums.toHost();
  std::vector<std::uint64_t> most = extremes.toHost();
  if (subdomain_) {
    subdomain_->comm().sum(q.data(), q.size());
    subdomain_->comm().minimum(most.data(), most.size());
  }
  GrainLedger ledger;
  ledger.kinetic = measure.energy.value(q[0]);
  ledger.rotational = measure.energy.value(q[1]);
  ledger.potential = measure.energy.value(q[2]);
  ledger.elastic = measure.energy.value(q[3]);
  ledger.dissipated = measure.energy.value(q[4]);
  ledger.momentum = measure.momentum.value({q[5], q[6], q[7]});
  ledger.contacts = q[8] / 2;
  ledger.boundaryContacts = q[9];
  ledger.deepestOverlap = static_cast<double>(~most[0]) * scale_.unit;
  ledger.fastest = static_cast<double>(~most[1]) * 1e-6;
  return ledger;
}

} // namespace grouser::terrain
