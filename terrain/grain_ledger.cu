// SPDX-License-Identifier: BSD-3-Clause
// Energies and counts of the grains, from state functions.
#include "terrain/grain_ledger.hpp"

#include "base/summed_banks.hpp"
#include "contact/sphere_pair.hpp"
#include "contact/strongest_force.hpp"
#include "terrain/feet_search.hpp"
#include "terrain/grain_kernel_data.cuh"

#include <algorithm>
#include <array>
#include <iterator>

namespace grouser::terrain {

using base::Vec3d;
using base::Vec3f;

namespace {

/// Contribution of one grain to the ledger, in quanta.
template <class Real> struct MeasureGrain : GrainKernel<contact::kGeneral, Real> {
  static constexpr double kNanoseconds = 300;
  using Kernel = GrainKernel<contact::kGeneral, Real>;
  using Kernel::d, Kernel::f, Kernel::has;
  using Law = contact::BasicLaw<Real>;

  enum Sum {
    kKinetic,
    kRotational,
    kPotential,
    kElastic,
    kTouching,
    kAtBoundary,
    kMomentum,
    kAngular = kMomentum + 3,
    kSqueezedPairs = kAngular + 3,
    kSqueezedAtBoundary,
    kSums
  };
  static constexpr int kBanks = 64; // reduces conflicts between threads

  base::FixedPoint energy, momentum, angular;
  base::WideSum* sums; ///< [kBanks][kSums] in quanta; touching and squeezed pairs count twice
  /// Complements of the deepest overlap [units] and the maximum speed [nm/s]; index of the first sum whose range a
  /// grain exceeds.
  std::uint64_t* extremes;
  const std::uint32_t* ghost; ///< null without ghosts

  struct Held {
    double elastic = 0, deepest = 0;
    std::int64_t touching = 0, boundary = 0, squeezed = 0, squeezedAtBoundary = 0;
  };

  GROUSER_HD void operator()(int i) const {
    if (ghost && ghost[i]) return;
    // Includes remainders, as in the energy accounting.
    Vec3d v, w;
    const Remainders kept = d.remainders[i];
    const auto [speed, spin] = d.motion[i];
    base::Vec3l u = base::toUnits(d.position[i]);
    Vec3d x = u.template as<double>();
    for (int a = 0; a < 3; ++a) {
      v[a] = withRemainder(speed.xyz()[a], lowRemainder(kept.axis[a]));
      w[a] = withRemainder(spin.xyz()[a], highRemainder(kept.axis[a]));
      x[a] = (x[a] + placesKept(kept.position, a)) * d.unitLength;
    }
    const GrainSize<Real> size = Kernel::sizeOf(i);
    // A fixed grain contributes only the energy of contacts with surfaces.
    const bool fixed = has(kFixed) && isFixed(speed);
    const double m = fixed ? 0 : static_cast<double>(size.mass), radius = static_cast<double>(size.radius);
    Held held;
    measureGrains(i, size, held);
    measureBoundaries(i, x, size, fixed ? d.boundaryCount - d.surfaceCount : 0, held);
    const double inertia = 0.4 * m * radius * radius;
    const Vec3d gravity = d.gravityStep * (1.0 / d.timeStep);
    std::int64_t share[kSums];
    share[kKinetic] = energy.quantise(0.5 * m * dot(v, v));
    share[kRotational] = energy.quantise(0.5 * inertia * dot(w, w));
    // Potential energy follows the unwrapped position: a grain that crossed a periodic boundary has fallen farther.
    Vec3d way = x;
    if (has(kPeriodic)) {
      way.x += d.crossings[i].x * (static_cast<double>(d.period.length.x) * d.unitLength);
      way.y += d.crossings[i].y * (static_cast<double>(d.period.length.y) * d.unitLength);
    }
    share[kPotential] = energy.quantise(-m * dot(gravity, way));
    share[kElastic] = energy.quantise(held.elastic);
    share[kTouching] = held.touching, share[kAtBoundary] = held.boundary;
    share[kSqueezedPairs] = held.squeezed, share[kSqueezedAtBoundary] = held.squeezedAtBoundary;
    const Vec3d turning = cross(way, v) * m + w * inertia;
    for (int a = 0; a < 3; ++a) {
      share[kMomentum + a] = momentum.quantise(m * v[a]);
      share[kAngular + a] = angular.quantise(turning[a]);
    }
    add(i, share);
    base::atomicMin64(extremes, ~static_cast<std::uint64_t>(held.deepest / d.unitLength));
    base::atomicMin64(extremes + 1, ~static_cast<std::uint64_t>(norm(v) * 1e9));
  }

private:
  GROUSER_HD void measureGrains(int i, const GrainSize<Real>& own, Held& held) const {
    for (std::uint32_t k = 0; k < d.neighbours.count[i]; ++k) {
      const std::int64_t at = d.neighbours.at(i, k);
      const auto j = static_cast<int>(d.neighbours.slot[at]);
      const std::int64_t distance2 = base::squaredNorm(Kernel::apart(d.position[i], d.position[j]));
      const GrainSize<Real> other = Kernel::sizeOf(j);
      const std::int64_t reach = has(kManyRadii) ? own.units + other.units : d.diameterUnits;
      if (distance2 >= reach * reach) continue;
      const base::Vec3d apart = Kernel::apart(d.position[i], d.position[j]).template as<double>();
      const double overlap =
          contact::spherePair(apart, static_cast<double>(distance2), static_cast<double>(reach * reach - distance2),
                              static_cast<double>(reach), d.unitLength)
              .overlap;
      const double ri = static_cast<double>(own.radius), rj = static_cast<double>(other.radius);
      const Law& law = has(kManyMaterials) ? f.pairLaws[own.material * d.materials + other.material] : f.law;
      const bool touched = d.neighbours.touching[i * d.neighbours.maskWords + k / 64] >> (k & 63u) & 1;
      const float* history =
          touched && Kernel::hasHistory() ? d.neighbours.history + at * Kernel::historyWidth() : nullptr;
      const double mi = static_cast<double>(own.mass), mj = static_cast<double>(other.mass);
      // The other half belongs to the neighbour, unless it is fixed.
      const bool alone = has(kFixed) && isFixed(d.motion[j].velocity);
      held.elastic +=
          (alone ? 1 : 0.5) * stored(law, overlap, ri * rj / (ri + rj), alone ? mi : mi * mj / (mi + mj), history);
      held.deepest = overlap > held.deepest ? overlap : held.deepest;
      held.touching += alone ? 2 : 1;
      if (overlap > contact::kDeepOverlap * (ri < rj ? ri : rj)) held.squeezed += alone ? 2 : 1;
    }
  }

  GROUSER_HD void measureBoundaries(int i, const Vec3d& x, const GrainSize<Real>& size, int first, Held& held) const {
    const double radius = static_cast<double>(size.radius);
    for (int b = first; b < d.boundaryCount; ++b) {
      if (b == d.wallCount && d.floorPlaces > 0) {
        measureFloor(i, x, size, held);
        b += d.floorPlaces - 1;
      } else {
        measureBoundary(i, b, d.boundaryContactMask[i], radius - distanceTo(b, x), size, held);
      }
    }
  }

  GROUSER_HD void measureFloor(int i, const Vec3d& x, const GrainSize<Real>& size, Held& held) const {
    const double radius = static_cast<double>(size.radius);
    const std::uint32_t touched = d.boundaryContactMask[i];
    if (d.floor.clearOf(x, radius)) return;
    if (!d.floor.marks)
      return measureBoundary(i, d.wallCount, touched, radius - d.floor.closestPoint(x).distance, size, held);
    const float* normals = Kernel::hasHistory() && d.boundaryOf[i] > 0
                               ? d.floorNormals(std::int64_t{d.boundaryOf[i]} - 1, Kernel::historyWidth())
                               : nullptr;
    const PlacedFeet placed(d.floor, x, radius, touched >> d.wallCount, normals);
    const Feet& feet = placed.feet;
    const Law& law = Kernel::boundaryLaw(d.wallCount, size.material);
    const FeetLoads loads(feet, radius, law.hertz);
    for (int k = 0; k < feet.count; ++k) {
      const double overlap = radius - feet.foot[k].distance;
      measureBoundary(i, d.wallCount + placed.place[k], placed.goOn << d.wallCount, loads.overlap(k), size, held);
      held.deepest = overlap > held.deepest ? overlap : held.deepest;
      if (loads.merges() > 0) held.elastic += alone(law, overlap, radius) - alone(law, loads.overlap(k), radius);
    }
    for (int m = 0; m < loads.merges(); ++m) held.elastic -= alone(law, loads.merged(m), radius);
  }

  /// Energy of only the normal spring [J]; see FeetLoads.
  GROUSER_HD static double alone(const Law& law, double overlap, double radius) {
    return contact::storedEnergy(law, overlap, radius, base::Vec3<Real>{});
  }

  /// `touched`: bit mask of the boundaries whose contacts have a history.
  GROUSER_HD void measureBoundary(int i, int b, std::uint32_t touched, double overlap, const GrainSize<Real>& size,
                                  Held& held) const {
    if (overlap <= 0) return;
    const double radius = static_cast<double>(size.radius);
    const float* history = touched >> b & 1 && Kernel::hasHistory()
                               ? d.historyOf(std::int64_t{d.boundaryOf[i]} - 1, b, Kernel::historyWidth())
                               : nullptr;
    held.elastic +=
        stored(Kernel::boundaryLaw(b, size.material), overlap, radius, static_cast<double>(size.mass), history);
    held.deepest = overlap > held.deepest ? overlap : held.deepest;
    ++held.boundary;
    if (overlap > contact::kDeepOverlap * radius) ++held.squeezedAtBoundary;
  }

  /// Distance to a plane or a surface.
  GROUSER_HD double distanceTo(int boundary, const Vec3d& x) const {
    if (boundary < d.wallCount) return dot(d.walls[boundary].normal, x) - d.walls[boundary].offset;
    const int surface = boundary - (d.boundaryCount - d.surfaceCount);
    return gapTo(d.surfaces[surface], d.placements[surface].motion.toPart(x)).distance;
  }

  /// `history`: null if the contact has no history yet.
  GROUSER_HD double stored(const Law& law, double overlap, double effectiveRadius, double effectiveMass,
                           const float* history) const {
    const Vec3f shear = history ? loadVector(history) : Vec3f{};
    const bool plastic = has(contact::kPlastic);
    contact::BasicPlasticState<double> state{};
    if (plastic && history) state = loadPlastic<double>(Kernel::plasticIn(history));
    double energyHeld =
        contact::storedEnergy(law, overlap, effectiveRadius, shear.template as<Real>(), plastic ? &state : nullptr);
    if (has(contact::kRollingFriction) && history) {
      const auto c = contact::coefficientsOf<contact::kGeneral>(
          law, static_cast<Real>(overlap), static_cast<Real>(effectiveMass), static_cast<Real>(effectiveRadius));
      const Vec3d angle = loadVector(history + 3).template as<double>();
      const Real k = contact::rollingStiffness(law, c.normalStiffness, static_cast<Real>(effectiveRadius));
      energyHeld += 0.5 * static_cast<double>(k) * dot(angle, angle);
    }
    return energyHeld;
  }
  GROUSER_HD void add(int i, const std::int64_t (&share)[kSums]) const {
    constexpr std::int64_t kEnd = std::int64_t{1} << 57; // a warp sums 32 of them
    base::WideSum* const bank = sums + (i / 256 % kBanks) * kSums;
    for (int k = 0; k < kSums; ++k)
      if (share[k] >= kEnd || share[k] <= -kEnd) base::atomicMin64(extremes + 2, static_cast<std::uint64_t>(k));
#if defined(__CUDA_ARCH__)
    base::atomicAddTogether(bank, share);
#else
    for (int k = 0; k < kSums; ++k) base::atomicAddWide(bank + k, share[k]);
#endif
  }
};

} // namespace

namespace {

using Sums = MeasureGrain<float>;

/// Sums over all ranks; collective.
std::array<double, Sums::kSums> summed(const base::Array<base::WideSum>& banks, const base::Comm& comm) {
  const std::vector<base::WideSum> all = base::summedBanks(banks.toHost(), Sums::kSums, comm);
  std::array<double, Sums::kSums> values{};
  for (std::size_t k = 0; k < all.size(); ++k) values[k] = all[k].value();
  return values;
}

/// Throws SimulationError if a grain's contribution exceeds the range of a sum.
void checkRange(std::uint64_t sum) {
  static constexpr const char* kNames[] = {"kinetic energy", "energy of rotation", "potential energy",
                                           "elastic energy of the contacts"};
  if (sum == ~std::uint64_t{0}) return;
  throw base::SimulationError(std::string("the ") + (sum < std::size(kNames) ? kNames[sum] : "momentum") +
                              " of a grain exceeds its 64-bit range: the simulation is unstable, or the scene's values "
                              "differ too much in size; use a smaller time_step");
}

void addAccounting(GrainLedger& ledger, const GrainSystem& system) {
  const GrainModel& model = system.constants.model;
  const GrainEnergyAccounting::Totals totals = system.accounting.totals(system.comm);
  ledger.damped = totals.damped, ledger.rubbed = totals.rubbed, ledger.rolled = totals.rolled;
  ledger.slipped = totals.slipped, ledger.yielded = totals.yielded, ledger.stabilised = totals.stabilised;
  ledger.work = totals.work, ledger.turnover = totals.turnover;
  ledger.impulse = (model.gravity * totals.mass + totals.wallForce) * model.timeStep;
  ledger.angularImpulse = (cross(totals.moment, model.gravity) + totals.wallTorque) * model.timeStep;
}

} // namespace

GrainLedger measureLedger(GrainSystem& system) {
  const GrainModel& model = system.constants.model;
  const auto strongest = [&](const contact::ContactLaw& law) {
    return contact::strongestForce(law, model.radius, contact::kEnergyPress);
  };
  double force = strongest(model.law);
  for (const contact::ContactLaw& law : model.materials.grains) force = std::max(force, strongest(law));
  const base::FixedPoint energy = base::fixedPointFor(force * model.radius, 42);
  const base::FixedPoint momentum = base::fixedPointFor(model.mass * 10, 42);
  const base::FixedPoint angular = base::fixedPointFor(model.mass * 10 * 1e3 * model.radius, 42);
  base::Array<base::WideSum> sums(system.exec, std::size_t{Sums::kBanks} * Sums::kSums);
  base::Array<std::uint64_t> extremes(system.exec, std::vector<std::uint64_t>(3, ~std::uint64_t{0}));
  const auto measure = [&]<class Real>(const ForceData<Real>& f) {
    base::forEach(
        system.exec, "measure grains", static_cast<std::int64_t>(system.arrays.slots()),
        MeasureGrain<Real>{
            {system.kernelData(), f}, energy, momentum, angular, sums.data(), extremes.data(), system.ghosts()});
  };
  if (model.precision == Precision::single)
    measure(system.forceData<float>());
  else
    measure(system.forceData<double>());
  const auto q = summed(sums, system.comm);
  std::vector<std::uint64_t> most = extremes.toHost();
  system.comm.minimum(most.data(), most.size());
  checkRange(most[2]);
  GrainLedger ledger;
  ledger.kinetic = q[Sums::kKinetic] * energy.quantum, ledger.rotational = q[Sums::kRotational] * energy.quantum;
  ledger.potential = q[Sums::kPotential] * energy.quantum, ledger.elastic = q[Sums::kElastic] * energy.quantum;
  ledger.contacts = static_cast<std::int64_t>(q[Sums::kTouching]) / 2;
  ledger.boundaryContacts = static_cast<std::int64_t>(q[Sums::kAtBoundary]);
  ledger.squeezed = static_cast<std::int64_t>(q[Sums::kSqueezedPairs]) / 2;
  ledger.deepAtBoundaries = static_cast<std::int64_t>(q[Sums::kSqueezedAtBoundary]);
  for (int a = 0; a < 3; ++a) {
    const auto axis = static_cast<std::size_t>(a);
    ledger.momentum[a] = q[Sums::kMomentum + axis] * momentum.quantum;
    ledger.angularMomentum[a] = q[Sums::kAngular + axis] * angular.quantum;
  }
  ledger.deepestOverlap = static_cast<double>(~most[0]) * system.constants.scale.unit;
  ledger.fastest = static_cast<double>(~most[1]) * 1e-9;
  if (model.complementarity && model.complementarity->compliance == contact::Compliance::rigid) ledger.elastic = 0;
  addAccounting(ledger, system);
  return ledger;
}

} // namespace grouser::terrain
