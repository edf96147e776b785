// SPDX-License-Identifier: BSD-3-Clause
// Energies and counts of the grains, from state functions.
#include "terrain/grain_ledger.hpp"

#include "contact/strongest_force.hpp"
#include "terrain/grain_kernel_data.cuh"

#include <algorithm>

namespace grouser::terrain {

using base::Vec3d;
using base::Vec3f;

namespace {

/// One grain's share of the ledger, in quanta.
template <class Real> struct MeasureGrain : GrainKernel<contact::kGeneral, Real> {
  using Kernel = GrainKernel<contact::kGeneral, Real>;
  using Kernel::d, Kernel::f, Kernel::has;
  using Law = contact::BasicLaw<Real>;

  base::FixedPoint energy, momentum;
  std::int64_t*
      sums; ///< kinetic, rotational, potential, elastic, dissipated, px, py, pz, 2 x contacts, boundary contacts
  std::uint64_t* extremes;    ///< complements of the deepest overlap [units] and the largest speed [um/s]
  const std::uint32_t* ghost; ///< null where there are none

  struct Held {
    double elastic = 0, deepest = 0;
    std::int64_t touching = 0, boundary = 0;
  };

  GROUSER_HD void operator()(int i) const {
    if (ghost && ghost[i]) return;
    const Vec3d v = d.velocity[i].xyz().template as<double>(), w = d.spin[i].xyz().template as<double>();
    const base::Vec3l u = base::toUnits(d.position[i]);
    const Vec3d x = u.template as<double>() * d.unitLength;
    const GrainSize<Real> size = Kernel::sizeOf(i);
    const double m = static_cast<double>(size.mass), radius = static_cast<double>(size.radius);
    Held held;
    measureGrains(i, size, held);
    measureBoundaries(i, x, size, held);
    const double inertia = 0.4 * m * radius * radius;
    const Vec3d gravity = d.gravityStep * (1.0 / d.timeStep);
    add(0, energy.quantise(0.5 * m * dot(v, v)));
    add(1, energy.quantise(0.5 * inertia * dot(w, w)));
    // Potential energy follows the unwrapped position: a grain that has crossed a periodic boundary has fallen farther.
    Vec3d way = x;
    if (has(kPeriodic)) {
      way.x += d.crossings[i].x * (static_cast<double>(d.period.length.x) * d.unitLength);
      way.y += d.crossings[i].y * (static_cast<double>(d.period.length.y) * d.unitLength);
    }
    add(2, energy.quantise(-m * dot(gravity, way)));
    add(3, energy.quantise(held.elastic));
    add(4, energy.quantise(d.dissipated ? d.dissipated[i] : 0.0));
    for (int a = 0; a < 3; ++a) add(5 + a, momentum.quantise(m * v[a]));
    add(8, held.touching);
    add(9, held.boundary);
    base::atomicMin64(extremes, ~static_cast<std::uint64_t>(held.deepest / d.unitLength));
    base::atomicMin64(extremes + 1, ~static_cast<std::uint64_t>(norm(v) * 1e6));
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
      const double distance = sqrt(static_cast<double>(distance2));
      const double overlap = static_cast<double>(reach * reach - distance2) / (reach + distance) * d.unitLength;
      const double ri = static_cast<double>(own.radius), rj = static_cast<double>(other.radius);
      const Law& law = has(kManyMaterials) ? f.pairLaws[own.material * d.materials + other.material] : f.law;
      const bool touched = d.neighbours.touching[i * d.neighbours.maskWords + k / 64] >> (k & 63u) & 1;
      const float* history =
          touched && Kernel::hasHistory() ? d.neighbours.history + at * Kernel::historyWidth() : nullptr;
      const double mi = static_cast<double>(own.mass), mj = static_cast<double>(other.mass);
      held.elastic += 0.5 * stored(law, overlap, ri * rj / (ri + rj), mi * mj / (mi + mj), history);
      held.deepest = overlap > held.deepest ? overlap : held.deepest;
      ++held.touching;
    }
  }

  GROUSER_HD void measureBoundaries(int i, const Vec3d& x, const GrainSize<Real>& size, Held& held) const {
    const double radius = static_cast<double>(size.radius);
    for (int b = 0; b < d.boundaryCount; ++b) {
      const double overlap = radius - distanceTo(b, x, radius);
      if (overlap <= 0) continue;
      const bool touched = d.boundaryContactMask[i] >> b & 1;
      const float* history =
          touched && Kernel::hasHistory()
              ? d.boundaryHistory + (static_cast<std::int64_t>(i) * d.boundaryCount + b) * Kernel::historyWidth()
              : nullptr;
      held.elastic += stored(f.boundaryLaws[b * d.materials + size.material], overlap, radius,
                             static_cast<double>(size.mass), history);
      held.deepest = overlap > held.deepest ? overlap : held.deepest;
      ++held.boundary;
    }
  }

  /// Of the floor only where it may be less than the radius.
  GROUSER_HD double distanceTo(int boundary, const Vec3d& x, double radius) const {
    if (boundary < d.wallCount) return dot(d.walls[boundary].normal, x) - d.walls[boundary].offset;
    const int surface = boundary - (d.boundaryCount - d.surfaceCount);
    if (surface >= 0) return gapTo(d.surfaces[surface], d.placements[surface].motion.toPart(x)).distance;
    return d.floor.clearOf(x, radius) ? 2 * radius : d.floor.closestPoint(x).distance;
  }

  /// `history`: null where the contact has none yet.
  GROUSER_HD double stored(const Law& law, double overlap, double effectiveRadius, double effectiveMass,
                           const float* history) const {
    const Vec3f shear = history ? loadVector(history) : Vec3f{};
    double energyHeld = contact::storedEnergy(law, overlap, effectiveRadius, shear.template as<Real>());
    if (has(contact::kRollingFriction) && history) {
      const auto c = contact::coefficientsOf<contact::kGeneral>(
          law, static_cast<Real>(overlap), static_cast<Real>(effectiveMass), static_cast<Real>(effectiveRadius));
      const Vec3d angle = loadVector(history + 3).template as<double>();
      const Real k = contact::rollingStiffness(law, c.normalStiffness, static_cast<Real>(effectiveRadius));
      energyHeld += 0.5 * static_cast<double>(k) * dot(angle, angle);
    }
    return energyHeld;
  }
  GROUSER_HD void add(int which, std::int64_t quanta) const { base::atomicAdd64(sums + which, quanta); }
};

} // namespace

GrainLedger measureLedger(GrainSystem& system) {
  const GrainModel& model = system.constants.model;
  const auto strongest = [&](const contact::ContactLaw& law) {
    return contact::strongestForce(law, model.radius, contact::kEnergyPress);
  };
  double force = strongest(model.law);
  for (const contact::ContactLaw& law : model.materials.grains) force = std::max(force, strongest(law));
  const base::FixedPoint energy = base::fixedPointFor(force * model.radius, 32);
  const base::FixedPoint momentum = base::fixedPointFor(model.mass * 10, 32);
  base::Array<std::int64_t> sums(system.exec, 10);
  base::Array<std::uint64_t> extremes(system.exec, std::vector<std::uint64_t>(2, ~std::uint64_t{0}));
  const auto measure = [&]<class Real>(const ForceData<Real>& f) {
    base::forEach(
        system.exec, "measure grains", static_cast<std::int64_t>(system.arrays.slots()),
        MeasureGrain<Real>{{system.kernelData(), f}, energy, momentum, sums.data(), extremes.data(), system.ghosts()});
  };
  if (model.precision == Precision::single)
    measure(system.forceData<float>());
  else
    measure(system.forceData<double>());
  std::vector<std::int64_t> q = sums.toHost();
  std::vector<std::uint64_t> most = extremes.toHost();
  system.comm.sum(q.data(), q.size());
  system.comm.minimum(most.data(), most.size());
  GrainLedger ledger;
  ledger.kinetic = energy.checked(q[0], "kinetic energies of the grains");
  ledger.rotational = energy.checked(q[1], "energies of rotation of the grains");
  ledger.potential = energy.checked(q[2], "potential energies of the grains");
  ledger.elastic = energy.checked(q[3], "elastic energies of the contacts");
  ledger.dissipated = energy.checked(q[4], "dissipated energies");
  ledger.momentum = momentum.checked({q[5], q[6], q[7]}, "momenta of the grains");
  ledger.contacts = q[8] / 2;
  ledger.boundaryContacts = q[9];
  ledger.deepestOverlap = static_cast<double>(~most[0]) * system.constants.scale.unit;
  ledger.fastest = static_cast<double>(~most[1]) * 1e-6;
  return ledger;
}

} // namespace grouser::terrain
