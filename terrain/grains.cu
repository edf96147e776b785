// SPDX-License-Identifier: BSD-3-Clause
#include "terrain/grains.hpp"

#include "base/error.hpp"
#include "base/fixed_point.hpp"
#include "terrain/grain_step.cuh"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace grouser::terrain {

using base::Position;
using base::Vec3d;
using base::Vec3f;

namespace {

constexpr StepFlags kNoFlags{~std::uint64_t{0}, 0, 0};

/// to[i] = from[order[i]]
template <class T> struct Gather {
  const std::uint32_t* order;
  const T* from;
  T* to;
  GROUSER_HD void operator()(int i) const { to[i] = from[order[i]]; }
};

struct KeepReference {
  const Position* position;
  base::Vec3<std::uint32_t>* reference;
  GROUSER_HD void operator()(int i) const { reference[i] = {position[i].x, position[i].y, position[i].z}; }
};

/// Runs the step with just the features this scene has.
template <bool kFriction, bool kBoundaries>
void runStep(const base::Exec& exec, const GrainKernelData& d, bool loads, bool ledger) {
  if (loads && ledger) base::forEach(exec, "grain step", d.count, GrainStep<kFriction, kBoundaries, true, true>{d});
  else if (loads) base::forEach(exec, "grain step", d.count, GrainStep<kFriction, kBoundaries, true, false>{d});
  else if (ledger) base::forEach(exec, "grain step", d.count, GrainStep<kFriction, kBoundaries, false, true>{d});
  else base::forEach(exec, "grain step", d.count, GrainStep<kFriction, kBoundaries, false, false>{d});
}

bool anyFriction(const GrainModel& model, const Boundaries& boundaries) {
  bool friction = model.law.friction > 0 || (boundaries.floor && model.floorLaw.friction > 0);
  for (const Wall& wall : boundaries.walls) friction = friction || wall.law.friction > 0;
  return friction;
}

std::int64_t wholeUnits(double length, const base::PositionScale& scale) {
  return static_cast<std::int64_t>(std::floor(length * scale.perMetre + 0.5));
}

/// One grain's share of the ledger, in quanta.
struct MeasureGrain {
  GrainKernelData d;
  base::FixedPoint energy, momentum;
  std::int64_t* sums; ///< kinetic, rotational, potential, elastic, dissipated, px, py, pz, 2 x contacts, boundary contacts
  std::uint64_t* extremes; ///< complements of the deepest overlap [units] and the largest speed [um/s]

  GROUSER_HD void operator()(int i) const {
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
      const double overlap = static_cast<double>(d.diameterUnits2 - distance2) / (d.diameterUnits + distance) * d.unitLength;
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
    return d.wallShear && (d.wallTouching[i] >> b & 1) ? d.wallShear[b * d.count + i] : Vec3f{};
  }
  GROUSER_HD void add(int which, std::int64_t quanta) const { base::atomicAdd64(sums + which, quanta); }
};

} // namespace

Grains::Grains(const base::Exec& exec, const GrainModel& model, Boundaries boundaries,
               const std::vector<GrainStart>& start)
    : exec_(exec), model_(model), scale_(base::positionScale(2 * model.radius)), count_(start.size()),
      diameterUnits_(wholeUnits(2 * model.radius, scale_)), skinUnits_(wholeUnits(model.skin * model.radius, scale_)),
      frictional_(anyFriction(model, boundaries)),
      boundaryCount_(static_cast<int>(boundaries.walls.size()) + (boundaries.floor ? 1 : 0)),
      neighbours_(exec, diameterUnits_, skinUnits_, frictional_) {
  if (boundaryCount_ > 31) throw base::InputError(fmt::format("{} planes; at most 31 are possible", boundaryCount_));
  std::vector<Position> position(count_);
  std::vector<Vec4f> velocity(count_), spin(count_);
  std::vector<std::uint32_t> id(count_);
  const double limit = scale_.limit();
  for (std::size_t i = 0; i < count_; ++i) {
    const Vec3d& x = start[i].position;
    if (!(std::fabs(x.x) < limit && std::fabs(x.y) < limit && std::fabs(x.z) < limit))
      throw base::InputError(fmt::format("grain {} at ({}, {}, {}) m is farther than {:.6g} m from the origin, the range of "
                                         "positions for grains of radius {} m; move the scene nearer to the origin",
                                         i, x.x, x.y, x.z, limit, model.radius));
    position[i] = scale_.fromMetres(x);
    const Vec3f v = start[i].velocity.as<float>(), w = start[i].spin.as<float>();
    velocity[i] = {v.x, v.y, v.z, 0};
    spin[i] = {w.x, w.y, w.z, 0};
    id[i] = static_cast<std::uint32_t>(i);
  }
  position_[0] = base::Array<Position>(exec, position);
  velocity_[0] = base::Array<Vec4f>(exec, velocity);
  spin_[0] = base::Array<Vec4f>(exec, spin);
  position_[1] = base::Array<Position>(exec, count_);
  velocity_[1] = base::Array<Vec4f>(exec, count_);
  spin_[1] = base::Array<Vec4f>(exec, count_);
  remainders_ = base::Array<Remainders>(exec, count_);
  id_ = base::Array<std::uint32_t>(exec, id);
  reference_ = base::Array<base::Vec3<std::uint32_t>>(exec, count_);
  const std::size_t perBoundary = boundaryCount_ > 0 ? count_ : 0;
  wallShear_ = base::Array<Vec3f>(exec, frictional_ ? perBoundary * boundaryCount_ : 0);
  wallTouching_ = base::Array<std::uint32_t>(exec, perBoundary);
  dissipated_ = base::Array<double>(exec, model.ledger ? count_ : 0);
  flags_ = base::Array<StepFlags>(exec, {kNoFlags});
  walls_ = base::Array<Wall>(exec, boundaries.walls);
  if (boundaries.floor) {
    hasFloor_ = true;
    floorHeights_ = base::Array<double>(exec, boundaries.floor->heights());
    floorView_ = boundaries.floor->view();
    floorView_.heights = floorHeights_.data();
  }
}

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
  d.walls = walls_.data(), d.wallCount = static_cast<int>(walls_.size());
  d.hasFloor = hasFloor_, d.floor = floorView_;
  d.count = static_cast<std::int64_t>(count_);
  d.position = position_[0].data(), d.nextPosition = position_[1].data();
  d.velocity = velocity_[0].data(), d.nextVelocity = velocity_[1].data();
  d.spin = spin_[0].data(), d.nextSpin = spin_[1].data();
  d.remainders = remainders_.data();
  d.id = id_.data();
  d.reference = reference_.data();
  d.neighbours = neighbours_.view();
  d.wallShear = wallShear_.data(), d.wallTouching = wallTouching_.data();
  d.dissipated = dissipated_.data();
  if (loads) d.loads = *loads;
  d.flags = flags_.data();
  return d;
}

bool Grains::refreshNeighbours() {
  if (!stale_) return false;
  neighbours_.sort(position_[0].data(), count_);
  permute();
  neighbours_.build(position_[0].data(), id_.data());
  base::forEach(exec_, "keep reference", static_cast<std::int64_t>(count_),
                KeepReference{position_[0].data(), reference_.data()});
  stale_ = false;
  ++rebuilds_;
  return true;
}

void Grains::permute() {
  const std::uint32_t* order = neighbours_.order();
  const auto n = static_cast<std::int64_t>(count_);
  const auto gather = [&]<class T>(base::Array<T>& from, base::Array<T>& to) {
    base::forEach(exec_, "permute grains", n, Gather<T>{order, from.data(), to.data()});
    from.swap(to);
  };
  gather(position_[0], position_[1]);
  gather(velocity_[0], velocity_[1]);
  gather(spin_[0], spin_[1]);
  const auto gatherOwn = [&]<class T>(base::Array<T>& array) {
    if (array.empty()) return;
    base::Array<T> to(exec_, array.size());
    for (std::size_t first = 0; first < array.size(); first += count_)
      base::forEach(exec_, "permute grains", n, Gather<T>{order, array.data() + first, to.data() + first});
    base::synchronize(exec_);
    array.swap(to);
  };
  gatherOwn(remainders_);
  gatherOwn(id_);
  gatherOwn(wallShear_);
  gatherOwn(wallTouching_);
  gatherOwn(dissipated_);
}

void Grains::beginStep(const contact::GrainLoadsView* loads) {
  const GrainKernelData d = kernelData(loads);
  const bool boundaries = boundaryCount_ > 0, withLoads = loads != nullptr;
  if (frictional_ && boundaries) runStep<true, true>(exec_, d, withLoads, model_.ledger);
  else if (frictional_) runStep<true, false>(exec_, d, withLoads, model_.ledger);
  else if (boundaries) runStep<false, true>(exec_, d, withLoads, model_.ledger);
  else runStep<false, false>(exec_, d, withLoads, model_.ledger);
  position_[0].swap(position_[1]);
  velocity_[0].swap(velocity_[1]);
  spin_[0].swap(spin_[1]);
}

void Grains::endStep() {
  ++steps_;
  checkFlags();
}

void Grains::checkFlags() {
  const StepFlags flags = flags_.at(0);
  if (flags.stale) stale_ = true;
  if (flags.stale || flags.fault != ~std::uint64_t{0}) flags_.assign({kNoFlags});
  if (flags.fault == ~std::uint64_t{0}) return;
  const auto fault = static_cast<Fault>(flags.fault >> 56);
  const auto id = static_cast<std::size_t>(flags.fault & 0xFFFFFFFFFFFFFFull);
  const GrainSnapshot s = snapshot();
  const Vec3d x = s.position[id];
  const double speed = norm(s.velocity[id].as<double>());
  const std::string where = fmt::format("step {}, time {:.6g} s: grain {} at ({:.6g}, {:.6g}, {:.6g}) m", steps_,
                                        static_cast<double>(steps_) * model_.timeStep, id, x.x, x.y, x.z);
  if (fault == Fault::overlap)
    throw base::SimulationError(fmt::format("{} overlaps by more than {:.3g} of its radius; use stiffer contacts "
                                            "(material stiffness) or a smaller time_step",
                                            where, model_.maxOverlap));
  if (fault == Fault::speed)
    throw base::SimulationError(fmt::format("{} moves at {:.4g} m/s, more than half the neighbour list's skin in one "
                                            "step; use a smaller time_step or a larger skin",
                                            where, speed));
  throw base::SimulationError(where + " has a velocity that is no number; use a smaller time_step");
}

void Grains::stop() {
  velocity_[0].zero();
  spin_[0].zero();
  remainders_.zero();
}

GrainSnapshot Grains::snapshot() const {
  const auto position = position_[0].toHost();
  const auto velocity = velocity_[0].toHost(), spin = spin_[0].toHost();
  const auto id = id_.toHost();
  GrainSnapshot s;
  s.position.resize(count_), s.velocity.resize(count_), s.spin.resize(count_);
  for (std::size_t i = 0; i < count_; ++i) {
    s.position[id[i]] = scale_.toMetres(position[i]);
    s.velocity[id[i]] = velocity[i].xyz();
    s.spin[id[i]] = spin[i].xyz();
  }
  return s;
}

std::vector<std::uint32_t> Grains::stateWords() const {
  const auto position = position_[0].toHost();
  const auto velocity = velocity_[0].toHost(), spin = spin_[0].toHost();
  const auto remainders = remainders_.toHost();
  const auto id = id_.toHost();
  const auto wallTouching = wallTouching_.toHost();
  const auto wallShear = wallShear_.toHost();
  const bool listed = rebuilds_ > 0;
  const auto lists = listed ? neighbours_.toHost() : contact::NeighbourList::HostCopy{};
  std::vector<std::uint32_t> slotOf(count_);
  for (std::size_t i = 0; i < count_; ++i) slotOf[id[i]] = static_cast<std::uint32_t>(i);

  std::vector<std::uint32_t> words;
  words.reserve(count_ * 24);
  const auto put = [&words](const auto& value) {
    static_assert(sizeof value % 4 == 0);
    std::uint32_t raw[sizeof value / 4];
    std::memcpy(raw, &value, sizeof value);
    words.insert(words.end(), raw, raw + sizeof value / 4);
  };
  for (std::size_t g = 0; g < count_; ++g) {
    const std::size_t i = slotOf[g];
    put(position[i]), put(velocity[i].xyz()), put(spin[i].xyz()), put(remainders[i]);
    for (std::size_t k = 0; listed && k < lists.count[i]; ++k) {
      if (!(lists.touching[i] >> k & 1)) continue;
      const auto at = static_cast<std::size_t>(lists.at(i, static_cast<std::uint32_t>(k)));
      put(id[lists.slot[at]]);
      if (!lists.shear.empty()) put(lists.shear[at]);
    }
    if (wallTouching.empty()) continue;
    put(wallTouching[i]);
    for (int b = 0; b < boundaryCount_ && !wallShear.empty(); ++b)
      if (wallTouching[i] >> b & 1) put(wallShear[static_cast<std::size_t>(b) * count_ + i]);
  }
  return words;
}

GrainLedger Grains::ledger() {
  if (rebuilds_ == 0) refreshNeighbours();
  const double scale = model_.law.stiffness * model_.radius * model_.radius;
  MeasureGrain measure{kernelData(nullptr), base::fixedPointFor(scale, 32), base::fixedPointFor(model_.mass * 10, 32),
                       nullptr, nullptr};
  base::Array<std::int64_t> sums(exec_, 10);
  base::Array<std::uint64_t> extremes(exec_, std::vector<std::uint64_t>(2, ~std::uint64_t{0}));
  measure.sums = sums.data();
  measure.extremes = extremes.data();
  base::forEach(exec_, "measure grains", static_cast<std::int64_t>(count_), measure);
  const std::vector<std::int64_t> q = sums.toHost();
  GrainLedger ledger;
  ledger.kinetic = measure.energy.value(q[0]);
  ledger.rotational = measure.energy.value(q[1]);
  ledger.potential = measure.energy.value(q[2]);
  ledger.elastic = measure.energy.value(q[3]);
  ledger.dissipated = measure.energy.value(q[4]);
  ledger.momentum = measure.momentum.value({q[5], q[6], q[7]});
  ledger.contacts = q[8] / 2;
  ledger.boundaryContacts = q[9];
  const std::vector<std::uint64_t> most = extremes.toHost();
  ledger.deepestOverlap = static_cast<double>(~most[0]) * scale_.unit;
  ledger.fastest = static_cast<double>(~most[1]) * 1e-6;
  return ledger;
}

std::size_t Grains::deviceBytes() const {
  std::size_t total = neighbours_.bytes() + remainders_.bytes() + id_.bytes() + reference_.bytes() +
                      wallShear_.bytes() + wallTouching_.bytes() + dissipated_.bytes();
  for (int k = 0; k < 2; ++k) total += position_[k].bytes() + velocity_[k].bytes() + spin_[k].bytes();
  return total;
}

} // namespace grouser::terrain
