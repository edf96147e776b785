// SPDX-License-Identifier: BSD-3-Clause
#include "terrain/grain_system.hpp"

#include "terrain/grain_entry.hpp"
#include "terrain/grain_kernel_data.cuh"

namespace grouser::terrain {

GrainSystem::GrainSystem(const base::Exec& device, const GrainModel& model, const Boundaries& around,
                         const std::vector<GrainSpec>& start, const PartitionOptions& partition)
    : exec(device), comm(partition.comm), constants(model, around, start),
      laws(exec, constants, boundaryLaws(model, around)), arrays(exec, constants), accounting(exec, constants),
      boundaries(exec, constants, around),
      neighbours(exec, constants.diameterUnits, constants.skinUnits, constants.historyWidth, constants.period,
                 static_cast<std::int64_t>(2 * constants.smallestRadius / constants.scale.unit)),
      impulses(ImpulseSolver::make(exec, constants)), count(0) {
  const std::vector<base::Position> places = placesOf(start, 0, constants);
  if (!comm.alone()) distribution = std::make_unique<GrainDistribution>(exec, partition, constants, places);
  arrays.append(entering(start, places));
  count = start.size();
  fixedCount = fixedAmong(start);
}

EnteringGrains GrainSystem::entering(const std::vector<GrainSpec>& grains,
                                     const std::vector<base::Position>& places) const {
  EnteringGrains own;
  for (std::size_t i = 0; i < grains.size(); ++i) {
    if (ownerOf(places[i]) != comm.rank()) continue;
    const base::Vec3f v = grains[i].velocity.as<float>(), w = grains[i].spin.as<float>();
    own.position.push_back(places[i]);
    own.motion.push_back(
        {{v.x, v.y, v.z, constants.storedRadius(grains[i])}, {w.x, w.y, w.z, static_cast<float>(grains[i].material)}});
    own.id.push_back(static_cast<std::uint32_t>(count + i));
  }
  checkDistinct(exec, own.position, own.id);
  return own;
}

std::vector<std::uint32_t> GrainSystem::ghostsOnHost() const {
  return ghosts() ? base::toHost(exec, ghosts(), arrays.slots()) : std::vector<std::uint32_t>(arrays.slots());
}

contact::RadiiInW GrainSystem::radii() const {
  const contact::Motion* const motion = arrays.fields().motion.now.data();
  contact::RadiiInW radii;
  if (constants.manyRadii()) radii.sphere = motion, radii.unitsPerLength = static_cast<float>(constants.scale.perMetre);
  if (constants.has(kFixed)) radii.fixed = motion;
  return radii;
}

GrainKernelData GrainSystem::kernelData() {
  GrainKernelData d{};
  const GrainModel& model = constants.model;
  const double dt = model.timeStep, r = model.radius;
  d.features = constants.features;
  d.timeStep = dt;
  d.diameter = static_cast<float>(2 * r);
  d.mass = model.mass, d.inertia = 0.4 * model.mass * r * r;
  d.unitLength = constants.scale.unit, d.unitsPerLength = static_cast<float>(constants.scale.perMetre);
  d.diameterUnits = constants.diameterUnits, d.diameterUnits2 = d.diameterUnits * d.diameterUnits;
  d.halfSkinUnits2 = constants.halfSkinUnits2();
  d.stepPerMass = dt / model.mass;
  d.stepPerInertia = dt / (0.4 * model.mass * r * r);
  d.unitsPerSpeed = dt * constants.scale.perMetre;
  d.maxOverlap = static_cast<float>(model.maxOverlap * r);
  d.maxOverlapShare = static_cast<float>(model.maxOverlap);
  d.maxSurfaceShare = static_cast<float>(model.maxSurfaceOverlap);
  const double maxSpeed = model.maxWay() * constants.smallestRadius / dt;
  d.maxSpeed2 = static_cast<float>(maxSpeed * maxSpeed);
  d.gravityStep = model.gravity * dt;
  d.period = constants.period;
  laws.describe(d);
  arrays.describe(d);
  accounting.describe(d);
  boundaries.describe(d);
  d.neighbours = neighbours.view();
  return d;
}

template <class Real> ForceData<Real> GrainSystem::forceData() {
  ForceData<Real> f = laws.forceData<Real>(constants);
  f.boundaryLoads = boundaries.loads<Real>();
  return f;
}
template ForceData<float> GrainSystem::forceData();
template ForceData<double> GrainSystem::forceData();

std::size_t GrainSystem::deviceBytes() const {
  return neighbours.bytes() + arrays.bytes() + boundaries.bytes() + (distribution ? distribution->bytes() : 0) +
         (impulses ? impulses->bytes() : 0);
}

} // namespace grouser::terrain
