// SPDX-License-Identifier: BSD-3-Clause
#include "terrain/soil_fields.hpp"

#include "contact/strongest_force.hpp"
#include "terrain/boundary_contacts.cuh"
#include "terrain/grain_step.cuh"
#include "terrain/grain_system.hpp"

#include <algorithm>
#include <limits>

namespace grouser::terrain {

using base::Vec3d;
using contact::ContactMoment;

namespace {

constexpr unsigned kMeasuring = contact::kGeneral | contact::kMeasured;

/// Sums of a cell. Positions are those of grain centres relative to the cell centre, in units of the cell edges.
enum CellSum : int {
  kVolume,         ///< volume of grains
  kGrains,         ///< number of movable grains
  kContacts,       ///< contacts of these grains
  kHeldGrains,     ///< number of grains with two contacts or more
  kHeldContacts,   ///< contacts of these grains
  kMassIn,         ///< mass of movable grains, as in all sums below
  kMomentumIn,     ///< [3]
  kFirst = 9,      ///< [3] mass times place
  kSecond = 12,    ///< [6] mass times place times place
  kTransport = 18, ///< [3][3] momentum times place
  kMoments = 27,   ///< [6]
  kCellSums = 33
};

/// Quanta of the sums.
struct CellScales {
  base::FixedPoint volume, count, mass, momentum, moment;
};

/// FieldGrid for device code, where std::array has no operator[].
struct CellLattice {
  Vec3d low, cell; ///< [m]
  int cells[3];
  bool periodic[2];

  explicit CellLattice(const FieldGrid& g)
      : low(g.low), cell(g.cell), cells{g.cells[0], g.cells[1], g.cells[2]}, periodic{g.periodic[0], g.periodic[1]} {}
};

/// Contact moments of the grains near walls, floor and surfaces, by list index.
template <class Real> struct MeasureBoundaries : BoundaryContacts<kMeasuring, Real> {
  ContactMoment* moments;
  GROUSER_HD void operator()(int k) const {
    WallAccumulator accumulator;
    moments[k] = this->run(k, accumulator).moment;
  }
};

/// Adds one grain to the cells that it overlaps.
template <class Real> struct AddToCells : GrainStep<kMeasuring, Real> {
  static constexpr double kNanoseconds = 500;
  using Step = GrainStep<kMeasuring, Real>;
  using Step::d, Step::f, Step::has;

  CellLattice grid;
  CellScales scales;
  const std::uint32_t* ghost; ///< null without ghosts
  const ContactMoment* atBoundaries;
  contact::PartMomentsView onParts;
  std::int64_t* sums; ///< [cells][kCellSums]

  GROUSER_HD void operator()(int i) const {
    if (ghost && ghost[i]) return;
    const GrainSize<Real> size = Step::sizeOf(i);
    const double radius = static_cast<double>(size.radius);
    const bool moves = !(has(kFixed) && isFixed(d.motion[i].velocity));
    const ContactMoment moment = moves ? momentOf(i, size) : ContactMoment{};
    const Vec3d x = base::toUnits(d.position[i]).template as<double>() * d.unitLength;
    Cut cut[3];
    for (int a = 0; a < 3; ++a) cut[a] = cutAlong(a, x[a], radius);
    for (int corner = 0; corner < 8; ++corner) {
      const int side[3] = {corner & 1, corner >> 1 & 1, corner >> 2};
      double share = 1;
      std::int64_t at = 0;
      Vec3d place;
      for (int a = 2; a >= 0; --a) {
        int cell = cut[a].first + side[a];
        share *= cut[a].share[side[a]];
        place[a] = cut[a].at - (static_cast<double>(cell) + 0.5);
        if (a < 2 && grid.periodic[a]) cell = cell < 0 ? cell + grid.cells[a] : cell % grid.cells[a];
        if (cell < 0 || cell >= grid.cells[a]) share = 0;
        at = at * grid.cells[a] + cell;
      }
      if (share > 0) add(i, size, moves, moment, share, place, sums + at * kCellSums);
    }
  }

private:
  /// Splits a grain along one axis: the two cells beside the plane nearest to it, and its volume fractions there.
  struct Cut {
    double at; ///< its centre, in cells from the low corner
    int first;
    double share[2];
  };
  /// Cells are at least as large as a grain, so no other plane cuts it.
  GROUSER_HD Cut cutAlong(int axis, double x, double radius) const {
    const double at = (x - grid.low[axis]) / grid.cell[axis];
    constexpr double kFar = 1e9; // [cells] larger values have no integer
    const double bounded = at > -kFar ? at < kFar ? at : kFar : -kFar;
    const double plane = floor(bounded + 0.5);
    const double t = (bounded - plane) * grid.cell[axis] / radius, beyond = t > -1 ? t < 1 ? t : 1 : -1;
    const double above = 0.25 * (2 + beyond * (3 - beyond * beyond)); // volume of a spherical segment
    return {bounded, static_cast<int>(plane) - 1, {1 - above, above}};
  }

  GROUSER_HD ContactMoment momentOf(int i, const GrainSize<Real>& size) const {
    const auto [velocity, spin] = d.motion[i];
    const typename Step::Side own{size, velocity.xyz().template as<Real>(), spin.xyz().template as<Real>()};
    const base::Position p = d.position[i];
    typename Step::Sum sum;
    for (std::uint32_t k = 0; k < d.neighbours.count[i]; ++k) {
      const std::int64_t at = d.neighbours.at(i, k);
      const std::uint32_t j = d.neighbours.slot[at];
      const std::int64_t distance2 = base::squaredNorm(Step::apart(p, d.position[j]));
      const std::int64_t reach2 = has(kManyRadii) ? Step::squareOf(d.neighbours.reach[at]) : d.diameterUnits2;
      if (distance2 >= reach2 || distance2 == 0) continue;
      const bool held = d.neighbours.touching[i * d.neighbours.maskWords + k / 64] >> (k & 63u) & 1;
      // The boundary kernel writes history; redirect it to a copy.
      float history[contact::historyWidth(contact::kRollingFriction | contact::kPlastic)] = {};
      const float* kept = Step::historyAt(at);
      for (int w = 0; kept && w < Step::historyWidth(); ++w) history[w] = kept[w];
      Step::touchNeighbour(kept ? history : nullptr, at, j, held, p, own, sum);
    }
    if (const std::uint32_t place = has(kBoundaries) ? d.boundaryOf[i] : 0) sum.moment += atBoundaries[place - 1];
    if (const std::uint32_t range = onParts.range ? onParts.range[i] : 0)
      for (std::uint32_t k = 0; k < (range & 255u); ++k) sum.moment += onParts.moment[(range >> 8) + k];
    return sum.moment;
  }

  GROUSER_HD void add(int i, const GrainSize<Real>& size, bool moves, const ContactMoment& moment, double share,
                      const Vec3d& place, std::int64_t* cell) const {
    const auto sum = [cell](int which, const base::FixedPoint& scale, double value) {
      base::atomicAdd64(cell + which, scale.quantise(value));
    };
    constexpr double kUnitBall = 4.1887902047863905; // 4 pi / 3
    const double radius = static_cast<double>(size.radius);
    sum(kVolume, scales.volume, share * (kUnitBall * radius * radius * radius));
    if (!moves) return;
    sum(kGrains, scales.count, share);
    sum(kContacts, scales.count, share * moment.contacts);
    if (moment.contacts >= 2)
      sum(kHeldGrains, scales.count, share), sum(kHeldContacts, scales.count, share * moment.contacts);
    const double mass = share * static_cast<double>(size.mass);
    const Vec3d momentum = d.motion[i].velocity.xyz().template as<double>() * mass;
    sum(kMassIn, scales.mass, mass);
    int second = kSecond;
    for (int a = 0; a < 3; ++a) {
      sum(kMomentumIn + a, scales.momentum, momentum[a]);
      sum(kFirst + a, scales.mass, mass * place[a]);
      for (int b = a; b < 3; ++b) sum(second++, scales.mass, mass * place[a] * place[b]);
      for (int b = 0; b < 3; ++b) sum(kTransport + 3 * a + b, scales.momentum, momentum[a] * place[b]);
    }
    for (int k = 0; k < 6; ++k) sum(kMoments + k, scales.moment, share * moment.of[k]);
  }
};

/// Buffers for the output of a boundary step: springs, touching bits and loads.
template <class Real> struct BoundaryCopies {
  base::Array<float> springs;
  base::Array<std::uint32_t> mask;
  base::Array<BoundaryLoad<Real>> loads;
  base::Array<Vec3d> fromSurfaces;
  base::Array<contact::PartLoad> surfaceLoads;

  BoundaryCopies(const base::Exec& exec, std::size_t slots, std::size_t listed, GrainKernelData& d, ForceData<Real>& f)
      : springs(copyOf(exec, d.boundaryHistory, listed * static_cast<std::size_t>(d.boundaryRow))),
        mask(copyOf(exec, d.boundaryContactMask, slots)), loads(exec, listed), fromSurfaces(exec, listed),
        surfaceLoads(exec, static_cast<std::size_t>(d.surfaceCount)) {
    d.boundaryHistory = springs.data(), d.boundaryContactMask = mask.data(), d.fromSurfaces = fromSurfaces.data();
    d.surfaceLoads = surfaceLoads.data(), f.boundaryLoads = loads.data();
  }
  template <class T> static base::Array<T> copyOf(const base::Exec& exec, const T* from, std::size_t count) {
    auto copy = base::Array<T>::unset(exec, count);
    if (count > 0) base::copyOnDevice(exec, copy.data(), from, count * sizeof(T));
    return copy;
  }
};

template <class Real> void addGrains(GrainSystem& system, const FieldGrid& grid, const CellScales& scales,
                                     const contact::PartMomentsView& onParts, std::int64_t* sums) {
  const base::Exec& exec = system.exec;
  const std::size_t slots = system.arrays.slots(),
                    listed = system.boundaries.any() ? system.boundaries.grainsListed() : 0;
  GrainKernelData d = system.kernelData();
  ForceData<Real> f = system.forceData<Real>();
  d.ledgerSums = nullptr;
  base::Array<ContactMoment> atBoundaries(exec, listed);
  {
    GrainKernelData copied = d;
    ForceData<Real> copiedForces = f;
    const BoundaryCopies<Real> copies(exec, listed > 0 ? slots : 0, listed, copied, copiedForces);
    MeasureBoundaries<Real> measure{{{copied, copiedForces}}, atBoundaries.data()};
    base::forEach(exec, "measure contacts of boundaries", static_cast<std::int64_t>(listed), measure);
    base::synchronize(exec); // before the copies are destroyed
  }
  AddToCells<Real> add{{{d, f}}, CellLattice(grid), scales, system.ghosts(), atBoundaries.data(), onParts, sums};
  base::forEach(exec, "measure fields", static_cast<std::int64_t>(slots), add);
  base::synchronize(exec);
}

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// Symmetric gradient of the velocity by least squares: (sum m v x) (sum m x x)^-1 about the centre of mass. `of`:
/// converted sums of the cell.
Tensor6 strainRateOf(const double* of, const Vec3d& edge) {
  const double mass = of[kMassIn];
  Tensor6 none;
  none.fill(kNone);
  if (!(mass > 0)) return none;
  double c[3][3], g[3][3];
  for (int a = 0, k = kSecond; a < 3; ++a)
    for (int b = a; b < 3; ++b) c[a][b] = c[b][a] = of[k++] / mass - of[kFirst + a] / mass * (of[kFirst + b] / mass);
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b)
      g[a][b] = of[kTransport + 3 * a + b] / mass - of[kMomentumIn + a] / mass * (of[kFirst + b] / mass);
  const Vec3d row[3] = {{c[0][0], c[0][1], c[0][2]}, {c[1][0], c[1][1], c[1][2]}, {c[2][0], c[2][1], c[2][2]}};
  const Vec3d adjoint[3] = {cross(row[1], row[2]), cross(row[2], row[0]), cross(row[0], row[1])};
  const double determinant = dot(row[0], adjoint[0]);
  // A filled cell has about 1/12^3; far below that the grains are nearly coplanar.
  if (!(determinant > 1e-7)) return none;
  double gradient[3][3];
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) gradient[a][b] = dot({g[a][0], g[a][1], g[a][2]}, adjoint[b]) / (determinant * edge[b]);
  Tensor6 rate{};
  for (std::size_t a = 0, k = 0; a < 3; ++a)
    for (std::size_t b = a; b < 3; ++b) rate[k++] = 0.5 * (gradient[a][b] + gradient[b][a]);
  return rate;
}

CellScales scalesOf(const GrainModel& model) {
  double force = contact::strongestForce(model.law, model.radius, contact::kForcePress);
  for (const contact::ContactLaw& law : model.materials.grains)
    force = std::max(force, contact::strongestForce(law, model.radius, contact::kForcePress));
  constexpr int kBits = 40; // range for four million of the largest grains in a cell
  return {base::fixedPointFor(4.2 * model.radius * model.radius * model.radius, kBits), base::fixedPointFor(1, kBits),
          base::fixedPointFor(model.mass, kBits), base::fixedPointFor(10 * model.mass, kBits),
          base::fixedPointFor(force * model.radius, 42)};
}

/// Converts the sums of a cell to their units.
std::array<double, kCellSums> valuesOf(const std::int64_t* sums, const CellScales& scales) {
  std::array<double, kCellSums> of{};
  for (int k = 0; k < kCellSums; ++k) {
    const bool transported = (k >= kMomentumIn && k < kFirst) || (k >= kTransport && k < kMoments);
    const base::FixedPoint& scale = k == kVolume    ? scales.volume
                                    : k < kMassIn   ? scales.count
                                    : k >= kMoments ? scales.moment
                                    : transported   ? scales.momentum
                                                    : scales.mass;
    of[static_cast<std::size_t>(k)] = scale.checked(sums[k], "a field of the soil over a cell");
  }
  return of;
}

} // namespace

FieldGrid fieldGrid(const Vec3d& low, const Vec3d& high, double edge, const PeriodicBoundaries& periodic) {
  FieldGrid grid{low, {}, {}, {}};
  for (int a = 0; a < 3; ++a) {
    constexpr double kRounding = 1e-9, kMax = 1e9; // maximum number of grains per cell; more than any device can store
    const double extent = high[a] - low[a];
    const double whole = std::clamp(std::floor(extent / edge + kRounding), 1.0, kMax);
    grid.cells[static_cast<std::size_t>(a)] = static_cast<int>(whole);
    grid.cell[a] = std::max(extent / whole, edge * (1 - kRounding));
  }
  for (std::size_t a = 0; a < 2; ++a)
    if (periodic[a])
      grid.periodic[a] =
          low[static_cast<int>(a)] == (*periodic[a])[0] && high[static_cast<int>(a)] == (*periodic[a])[1];
  return grid;
}

SoilFields measureFields(GrainSystem& system, const FieldGrid& grid, const contact::PartMomentsView& onParts) {
  const GrainModel& model = system.constants.model;
  const CellScales scales = scalesOf(model);
  base::Array<std::int64_t> onDevice(system.exec, grid.count() * kCellSums);
  onDevice.zero();
  if (model.precision == Precision::single)
    addGrains<float>(system, grid, scales, onParts, onDevice.data());
  else
    addGrains<double>(system, grid, scales, onParts, onDevice.data());
  std::vector<std::int64_t> sums = onDevice.toHost();
  system.comm.sum(sums.data(), sums.size());
  SoilFields fields;
  fields.grid = grid;
  const double volume = grid.cellVolume();
  const auto ratio = [](double of, double to) { return to > 0 ? of / to : kNone; };
  for (std::size_t c = 0; c < grid.count(); ++c) {
    const auto of = valuesOf(sums.data() + c * kCellSums, scales);
    fields.porosity.push_back(1 - of[kVolume] / volume);
    fields.coordination.push_back(ratio(of[kContacts], of[kGrains]));
    fields.mechanicalCoordination.push_back(ratio(of[kHeldContacts], of[kHeldGrains]));
    const double mass = of[kMassIn];
    fields.velocity.push_back(
        {ratio(of[kMomentumIn], mass), ratio(of[kMomentumIn + 1], mass), ratio(of[kMomentumIn + 2], mass)});
    fields.strainRate.push_back(strainRateOf(of.data(), grid.cell));
    Tensor6 stress{};
    for (std::size_t k = 0; k < 6; ++k) stress[k] = of[kMoments + k] / volume;
    fields.stress.push_back(stress);
  }
  return fields;
}

} // namespace grouser::terrain
