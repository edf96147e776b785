// SPDX-License-Identifier: BSD-3-Clause
#include "terrain/grains.hpp"

#include "base/error.hpp"
#include "base/math.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numeric>
#include <tuple>

namespace grouser::terrain {

using base::Position;
using base::Vec3d;
using base::Vec3f;

namespace {

/// Laws against walls, floor and surfaces, [walls, floor, surfaces][materials].
std::vector<contact::ContactLaw> boundaryLaws(const GrainModel& model, const Boundaries& boundaries) {
  if (model.materials.count() > 0) return model.materials.boundaries;
  std::vector<contact::ContactLaw> laws;
  for (const Wall& wall : boundaries.walls) laws.push_back(wall.law);
  if (boundaries.floor) laws.push_back(model.floorLaw);
  for (const RigidSurface& surface : boundaries.surfaces) laws.push_back(surface.law);
  return laws;
}

unsigned featuresOf(const GrainModel& model, const Boundaries& boundaries, bool manyRadii) {
  std::vector<contact::ContactLaw> laws = boundaryLaws(model, boundaries);
  if (model.materials.count() > 0)
    laws.insert(laws.end(), model.materials.grains.begin(), model.materials.grains.end());
  else
    laws.push_back(model.law);
  unsigned features = 0;
  bool linear = false;
  for (const contact::ContactLaw& law : laws) features |= law.features(), linear = linear || !law.hertz;
  if (linear && features & contact::kHertz) features |= contact::kGeneral; // each contact decides
  if (manyRadii) features |= kManyRadii;
  if (model.materials.count() > 0) features |= kManyMaterials;
  if (!boundaries.walls.empty() || boundaries.floor) features |= kBoundaries;
  if (boundaries.joined[0] || boundaries.joined[1]) features |= kPeriodic;
  if (!boundaries.surfaces.empty()) features |= kBoundaries | kSurfaces;
  if (model.ledger) features |= kLedger;
  return features;
}

int historyWidthOf(unsigned features) {
  return features & contact::kRollingFriction ? 6 : features & contact::kFriction ? 3 : 0;
}

double smallestOf(const GrainModel& model, const std::vector<GrainSpec>& start) {
  double least = model.smallestRadius > 0 ? model.smallestRadius : model.radius;
  for (const GrainSpec& g : start) least = g.radius > 0 ? std::min(least, g.radius) : least;
  return least;
}

/// The nearest radius [m] that is both a float and a whole number of units.
float storedRadius(double radius, const base::PositionScale& scale) {
  const auto nearest = static_cast<float>(radius);
  return static_cast<float>(std::floor(static_cast<double>(nearest) * scale.perMetre + 0.5) * scale.unit);
}

std::int64_t wholeUnits(double length, const base::PositionScale& scale) {
  return static_cast<std::int64_t>(std::floor(length * scale.perMetre + 0.5));
}

/// Joined sides in whole units. A grain must not touch two images of another: three cells of the search fit in between.
base::Period periodOf(const Boundaries& boundaries, const base::PositionScale& scale, std::int64_t reach) {
  base::Period period;
  for (int a = 0; a < 2; ++a) {
    const auto& sides = boundaries.joined[static_cast<std::size_t>(a)];
    if (!sides) continue;
    const auto [from, to] = *sides;
    if (!(std::fabs(from) < scale.limit() && std::fabs(to) < scale.limit()))
      throw base::InputError(
          fmt::format("periodic boundaries {} = {:g} m and {:g} m are farther than {:.6g} m from the origin", "xy"[a],
                      from, to, scale.limit()));
    period.low[a] = wholeUnits(from, scale), period.length[a] = wholeUnits(to, scale) - period.low[a];
    if (period.length[a] < 3 * reach)
      throw base::InputError(
          fmt::format("periodic boundaries {} = {:g} m and {:g} m are too near: a grain could touch another "
                      "from both sides; they must be at least {:.6g} m apart, three diameters and "
                      "skins",
                      "xy"[a], from, to, static_cast<double>(3 * reach) * scale.unit));
  }
  return period;
}

/// Throws InputError when two grains have the same place: no direction would push them apart.
void checkDistinct(const std::vector<Position>& position, const std::vector<std::uint32_t>& id) {
  std::vector<std::size_t> order(position.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto key = [&](std::size_t i) {
    const Position& p = position[i];
    return std::tuple(p.x, p.y, p.z, p.high);
  };
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return key(a) < key(b); });
  for (std::size_t k = 1; k < order.size(); ++k)
    if (key(order[k - 1]) == key(order[k]))
      throw base::InputError(fmt::format("grains {} and {} have the same position; move one of them",
                                         std::min(id[order[k - 1]], id[order[k]]),
                                         std::max(id[order[k - 1]], id[order[k]])));
}

/// Where the grains start; the first of them has the id `first`.
std::vector<Position> placesOf(const std::vector<GrainSpec>& start, std::size_t first, const base::PositionScale& scale,
                               double radius, const base::Period& period) {
  std::vector<Position> places(start.size());
  const double limit = scale.limit();
  for (std::size_t i = 0; i < start.size(); ++i) {
    const Vec3d& x = start[i].position;
    if (!(std::fabs(x.x) < limit && std::fabs(x.y) < limit && std::fabs(x.z) < limit))
      throw base::InputError(
          fmt::format("grain {} at ({}, {}, {}) m is farther than {:.6g} m from the origin, the range of "
                      "positions for grains of radius {} m; move the scene nearer to the origin",
                      first + i, x.x, x.y, x.z, limit, radius));
    places[i] = scale.fromMetres(x);
    for (int a = 0; a < 2; ++a)
      if (period.periodsBack(a, base::toUnits(places[i])[a]) != 0)
        throw base::InputError(fmt::format("grain {} at ({}, {}, {}) m lies outside the periodic boundaries {} = "
                                           "{:.9g} m and {:.9g} m; move it between them",
                                           first + i, x.x, x.y, x.z, "xy"[a],
                                           static_cast<double>(period.low[a]) * scale.unit,
                                           static_cast<double>(period.low[a] + period.length[a]) * scale.unit));
  }
  return places;
}

/// The first cuts: as many grains in each slab of an axis as in the others.
Partition startingPartition(const std::vector<Position>& position, const PartitionOptions& options,
                            const base::PositionScale& scale) {
  std::array<int, 3> wanted = options.subdomains;
  for (std::size_t a = 0; a < 3; ++a) {
    const int given = static_cast<int>(options.cuts[a].size()) + 1;
    if (given == 1) continue;
    if (wanted[a] != 0 && wanted[a] != given)
      throw base::InputError(fmt::format("parallel.cuts_{} gives {} planes, which make {} subdomains, but "
                                         "parallel.subdomains says {} along that axis; make them agree",
                                         "xyz"[a], given - 1, given, wanted[a]));
    wanted[a] = given;
  }
  base::Vec3l low{}, high{};
  for (std::size_t i = 0; i < position.size(); ++i) {
    const base::Vec3l u = base::toUnits(position[i]);
    low = i == 0 ? u : base::min(low, u), high = i == 0 ? u : base::max(high, u);
  }
  std::array<std::vector<std::int64_t>, 3> weights;
  std::array<double, 3> size{};
  for (int a = 0; a < 3; ++a) {
    const auto k = static_cast<std::size_t>(a);
    size[k] = static_cast<double>(high[a] - low[a]) + 1;
    weights[k].resize(kPartitionBins);
    const std::int64_t width = binWidth(low[a], high[a]);
    for (const Position& p : position) ++weights[k][static_cast<std::size_t>((base::toUnits(p)[a] - low[a]) / width)];
  }
  const Partition chosen(latticeShape(options.comm.size(), size, wanted), low, high, weights);
  std::array<std::vector<std::int64_t>, 3> cuts;
  for (int a = 0; a < 3; ++a) {
    const auto k = static_cast<std::size_t>(a);
    cuts[k] = chosen.cuts(a);
    for (std::size_t c = 0; c < options.cuts[k].size(); ++c) cuts[k][c] = wholeUnits(options.cuts[k][c], scale);
  }
  return Partition(cuts);
}

} // namespace

Grains::Grains(const base::Exec& exec, const GrainModel& model, Boundaries boundaries,
               const std::vector<GrainSpec>& start, const PartitionOptions& partition)
    : exec_(exec), model_(model), scale_(base::positionScale(2 * model.radius)), comm_(partition.comm),
      count_(start.size()), slots_(0), smallestRadius_(smallestOf(model, start)),
      diameterUnits_(wholeUnits(2 * model.radius, scale_)),
      skinUnits_(wholeUnits(model.skin * smallestRadius_, scale_)),
      features_(featuresOf(model, boundaries, smallestRadius_ != model.radius || model.materials.count() > 0)),
      historyWidth_(historyWidthOf(features_)),
      boundaryCount_(static_cast<int>(boundaries.walls.size() + boundaries.surfaces.size()) +
                     (boundaries.floor ? 1 : 0)),
      period_(periodOf(boundaries, scale_, diameterUnits_ + skinUnits_)),
      neighbours_(exec, diameterUnits_, skinUnits_, historyWidth_, period_) {
  // Overlaps are whole units: a grain a thousand times smaller would see its own in steps of 1e-5 of its size.
  if (smallestRadius_ < 1e-3 * model.radius)
    throw base::InputError(fmt::format("radii from {:g} m to {:g} m in one scene; the largest may be 1000 times the "
                                       "smallest",
                                       smallestRadius_, model.radius));
  if (boundaryCount_ > 32)
    throw base::InputError(
        fmt::format("{} planes and other surfaces, the floor among them; at most 32 are possible", boundaryCount_));
  const std::vector<Position> all = placesOf(start, 0, scale_, model.radius, period_);
  if (!comm_.alone()) {
    subdomain_ = std::make_unique<Subdomain>(exec, partition, diameterUnits_ + skinUnits_, period_);
    subdomain_->setPartition(startingPartition(all, partition, scale_));
  }
  std::vector<Position> position;
  std::vector<Vec4f> velocity, spin;
  std::vector<std::uint32_t> id;
  const PartitionView owner = subdomain_ ? subdomain_->partition().view() : Partition().view();
  for (std::size_t i = 0; i < count_; ++i) {
    if (owner.ownerOf(base::toUnits(all[i])) != comm_.rank()) continue;
    const Vec3f v = start[i].velocity.as<float>(), w = start[i].spin.as<float>();
    position.push_back(all[i]);
    velocity.push_back({v.x, v.y, v.z, radiusInW(start[i])});
    spin.push_back({w.x, w.y, w.z, static_cast<float>(start[i].material)});
    id.push_back(static_cast<std::uint32_t>(i));
  }
  checkDistinct(position, id); // two at one place have one owner
  slots_ = position.size();
  position_[0] = base::Array<Position>(exec, position);
  velocity_[0] = base::Array<Vec4f>(exec, velocity);
  spin_[0] = base::Array<Vec4f>(exec, spin);
  position_[1] = base::Array<Position>(exec, slots_);
  velocity_[1] = base::Array<Vec4f>(exec, slots_);
  spin_[1] = base::Array<Vec4f>(exec, slots_);
  remainders_ = base::Array<Remainders>(exec, slots_);
  id_ = base::Array<std::uint32_t>(exec, id);
  reference_ = base::Array<base::Vec3<std::uint32_t>>(exec, slots_);
  const std::size_t perBoundary = boundaryCount_ > 0 ? slots_ : 0;
  boundaryHistory_ = base::Array<float>(exec, perBoundary * static_cast<std::size_t>(boundaryCount_ * historyWidth_));
  boundaryContactMask_ = base::Array<std::uint32_t>(exec, perBoundary);
  nearBoundary_ = base::Array<std::uint32_t>(exec);
  boundaryOf_ = base::Array<std::uint32_t>(exec, perBoundary);
  dissipated_ = base::Array<double>(exec, model.ledger ? slots_ : 0);
  crossings_ = base::Array<Crossings>(exec, period_.any() ? slots_ : 0);
  origin_ = base::Array<std::uint32_t>(exec), arrivedRows_ = base::Array<std::uint32_t>(exec);
  flags_ = base::Mirrored<StepFlags>(exec, kStepsPerGraph);
  std::fill_n(flags_.host(), flags_.size(), kNoFlags);
  flags_.upload();
  stepGraph_ = base::DoubleBufferedGraph(exec);
  side_ = base::SideStream(exec, true);
  walls_ = base::Array<Wall>(exec, boundaries.walls);
  std::vector<double> massPerCube;
  for (const double density : model.materials.density) massPerCube.push_back(density * (4.0 / 3 * base::kPi));
  if (massPerCube.empty()) massPerCube.push_back(model.mass / (model.radius * model.radius * model.radius));
  massPerCube_ = base::Array<double>(exec, massPerCube);
  if (model.precision == Precision::single)
    makeForces(single_, boundaryLaws(model, boundaries));
  else
    makeForces(double_, boundaryLaws(model, boundaries));
  if (boundaries.floor) {
    hasFloor_ = true;
    floorHeights_ = base::Array<double>(exec, boundaries.floor->heights());
    floorView_ = boundaries.floor->view();
    floorView_.heights = floorHeights_.data();
  }
  makeSurfaces(boundaries);
}

void Grains::add(const std::vector<GrainSpec>& more) {
  finishGhostUpdate();
  const std::vector<Position> all = placesOf(more, count_, scale_, model_.radius, period_);
  if (insertionOverlapAlarm_)
    if (const std::optional<InsertionOverlap> insertionOverlap = insertionOverlapOf(more))
      insertionOverlapAlarm_(*insertionOverlap);
  std::vector<Position> position;
  std::vector<Vec4f> velocity, spin;
  std::vector<std::uint32_t> id;
  const PartitionView owner = subdomain_ ? subdomain_->partition().view() : Partition().view();
  for (std::size_t i = 0; i < more.size(); ++i) {
    if (owner.ownerOf(base::toUnits(all[i])) != comm_.rank()) continue;
    const Vec3f v = more[i].velocity.as<float>(), w = more[i].spin.as<float>();
    position.push_back(all[i]);
    velocity.push_back({v.x, v.y, v.z, radiusInW(more[i])});
    spin.push_back({w.x, w.y, w.z, static_cast<float>(more[i].material)});
    id.push_back(static_cast<std::uint32_t>(count_ + i));
  }
  checkDistinct(position, id);
  const std::size_t before = slots_, fresh = position.size();
  const auto append = [&]<class T>(base::Array<T>& array, const std::vector<T>& values) {
    if (values.empty()) return;
    array.resizeKeeping(before * values.size() / fresh + values.size());
    base::copyToDevice(exec_, array.data() + before * values.size() / fresh, values.data(), values.size() * sizeof(T));
  };
  append(position_[0], position), append(velocity_[0], velocity), append(spin_[0], spin), append(id_, id);
  append(remainders_, std::vector<Remainders>(fresh));
  if (model_.ledger) append(dissipated_, std::vector<double>(fresh));
  if (period_.any()) append(crossings_, std::vector<Crossings>(fresh));
  const auto boundaries = static_cast<std::size_t>(boundaryCount_);
  if (boundaries > 0) append(boundaryContactMask_, std::vector<std::uint32_t>(fresh));
  append(boundaryHistory_, std::vector<float>(fresh * boundaries * static_cast<std::size_t>(historyWidth_)));
  slots_ += fresh, count_ += more.size();
  position_[1].resize(slots_), velocity_[1].resize(slots_), spin_[1].resize(slots_);
  if (subdomain_) subdomain_->appended(fresh);
  invalidateNeighbours();
}

float Grains::radiusInW(const GrainSpec& grain) const {
  return manyRadii() ? storedRadius(grain.radius > 0 ? grain.radius : model_.radius, scale_) : 0.0f;
}

template <class Real>
void Grains::makeForces(Forces<Real>& forces, const std::vector<contact::ContactLaw>& boundaries) {
  using Law = contact::BasicLaw<Real>;
  const auto converted = [&](const std::vector<contact::ContactLaw>& laws) {
    std::vector<Law> out;
    for (const contact::ContactLaw& law : laws) out.push_back(law.template as<Real>());
    return base::Array<Law>(exec_, out);
  };
  forces.pairs = converted(model_.materials.grains);
  forces.boundaries = converted(boundaries);
  forces.boundaryLoads = base::Array<BoundaryLoad<Real>>(exec_);
}

bool Grains::manyRadii() const { return (features_ & kManyRadii) != 0; }

contact::RadiiInW Grains::radii() const {
  return manyRadii() ? contact::RadiiInW{velocity_[0].data(), static_cast<float>(scale_.perMetre)}
                     : contact::RadiiInW{};
}

void Grains::setPartition(const Partition& partition) {
  if (!subdomain_) return;
  subdomain_->setPartition(partition);
  invalidateNeighbours();
}

void Grains::endStep() {
  readFlags(1);
  if (!geometries_.empty()) collectSurfaceLoads();
  if (subdomain_ && !stale_) subdomain_->haloExchange().send(); // a rebuild would fetch them anew
}

/// Whether the next steps need no host in between. A CPU gains nothing by it, and its lanes do not ask whether an
/// earlier step was the last; without them it can. The first step after a rebuild has no ghosts under way.
bool Grains::canBatchSteps() const {
  const bool lanes = exec_.onCpu() && model_.mostSimdLanes > 1;
  if (lanes || !geometries_.empty()) return false;
  return !subdomain_ || (subdomain_->stepsTogether() && subdomain_->haloExchange().underWay());
}

std::int64_t Grains::advance(std::int64_t most) {
  if (refreshNeighbours()) slotsChanged_ = true; // nobody else has been told
  if (most < kStepsPerGraph || !canBatchSteps()) {
    step();
    return 1;
  }
  if (subdomain_) subdomain_->haloExchange().arrive();
  const unsigned bufferIndex = subdomain_ ? subdomain_->haloExchange().bufferIndex() : 0;
  stepGraph_.from(position_[0].data(), bufferIndex).run([this] { launchSteps(); });
  return readFlags(kStepsPerGraph);
}

/// Waits for the `steps` given to the device. Returns how many were taken: a list that is no longer valid, or a fault,
/// ends them early.
int Grains::readFlags(int steps) {
  base::synchronize(exec_);
  const StepFlags* const flag = flags_.host();
  int taken = 1;
  while (taken < steps && !flag[taken - 1].raised()) ++taken;
  StepFlags last = flag[taken - 1];
  if (last.raised()) {
    std::fill_n(flags_.host(), flags_.size(), kNoFlags);
    flags_.upload();
  }
  if (subdomain_ && steps == 1) {
    std::uint64_t all[] = {last.fault, last.stale ? 0u : 1u};
    comm_.minimum(all, 2);
    last.fault = all[0], last.stale = all[1] == 0;
  } else if (subdomain_) { // the GPUs have agreed
    subdomain_->haloExchange().countRuns(taken - (last.stale ? 1 : 0));
    if (last.stale) subdomain_->haloExchange().discard();
  }
  steps_ += taken;
  if ((steps - taken) % 2 != 0) swapBuffers(); // they have been swapped for all of the steps
  if (last.stale) stale_ = true;
  if (last.fault != kNoFault) stopFor(last.fault);
  return taken;
}

void Grains::stopFor(std::uint64_t key) const {
  const auto fault = static_cast<Fault>(key >> 56);
  const auto id = static_cast<std::uint32_t>(key & 0xFFFFFFFFFFFFFFull);
  // Only the rank that integrates the grain knows where it is.
  const std::vector<std::uint32_t> ids = id_.toHost();
  const std::vector<std::uint32_t> roles =
      ghosts() ? base::toHost(exec_, ghosts(), slots_) : std::vector<std::uint32_t>();
  double found[4] = {-1e300, -1e300, -1e300, -1e300}; // place and speed
  for (std::size_t i = 0; i < slots_; ++i) {
    if (ids[i] != id || (!roles.empty() && roles[i])) continue;
    const Vec3d x = scale_.toMetres(position_[0].at(i));
    found[0] = x.x, found[1] = x.y, found[2] = x.z, found[3] = norm(velocity_[0].at(i).xyz().as<double>());
  }
  comm_.maximum(found, 4);
  const std::string where =
      fmt::format("step {}, time {:.6g} s: grain {} at ({:.6g}, {:.6g}, {:.6g}) m", steps_,
                  static_cast<double>(steps_) * model_.timeStep, id, found[0], found[1], found[2]);
  if (fault == Fault::overlap)
    throw base::SimulationError(fmt::format("{} overlaps by more than {:.3g} of its radius; use stiffer contacts "
                                            "(material stiffness) or a smaller time_step",
                                            where, model_.maxOverlap));
  if (fault == Fault::range)
    throw base::SimulationError(
        fmt::format("{} leaves the range of positions, {:.6g} m from the origin; give the scene a "
                    "floor or walls that hold it",
                    where, scale_.limit()));
  if (fault == Fault::speed)
    throw base::SimulationError(fmt::format("{} moves at {:.4g} m/s, more than half the neighbour list's skin in one "
                                            "step; use a smaller time_step or a larger skin",
                                            where, found[3]));
  throw base::SimulationError(where + " has a velocity that is no number; use a smaller time_step");
}

void Grains::stop() {
  std::vector<Vec4f> velocity = velocity_[0].toHost(), spin = spin_[0].toHost();
  for (Vec4f& v : velocity) v = {0, 0, 0, v.w};
  for (Vec4f& w : spin) w = {0, 0, 0, w.w};
  velocity_[0].assign(velocity), spin_[0].assign(spin);
  remainders_.zero();
}

std::size_t Grains::deviceBytes() const {
  std::size_t total = neighbours_.bytes() + remainders_.bytes() + id_.bytes() + reference_.bytes() +
                      boundaryHistory_.bytes() + boundaryContactMask_.bytes() + dissipated_.bytes() +
                      crossings_.bytes() + nearBoundary_.bytes() + boundaryOf_.bytes() + single_.boundaryLoads.bytes() +
                      double_.boundaryLoads.bytes() + fromSurfaces_.bytes() + origin_.bytes() + arrivedRows_.bytes() +
                      (subdomain_ ? subdomain_->bytes() : 0);
  for (int k = 0; k < 2; ++k) total += position_[k].bytes() + velocity_[k].bytes() + spin_[k].bytes();
  return total;
}

} // namespace grouser::terrain
