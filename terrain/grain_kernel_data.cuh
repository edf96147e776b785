// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/for_each.cuh"
#include "base/period.hpp"
#include "contact/grain_loads.hpp"
#include "contact/neighbour_list.hpp"
#include "contact/rolling_resistance.hpp"
#include "terrain/grain_books.hpp"
#include "terrain/grain_model.hpp"
#include "terrain/grain_records.hpp"
#include "terrain/rigid_surface.hpp"

namespace grouser::terrain {

/// State and constants independent of the force precision, passed by value.
struct GrainKernelData {
  // Constants.
  unsigned features;
  std::int64_t diameterUnits, diameterUnits2, halfSkinUnits2;
  double timeStep, stepPerMass, stepPerInertia, unitsPerSpeed; // dt, dt/m, dt/I, dt/unit
  double unitLength, mass, inertia;                            ///< [m]; largest grain: [kg], [kg m2]
  float unitsPerLength;                                        ///< a power of two
  float diameter, maxOverlap, maxSpeed2;
  float maxOverlapShare;   ///< maximum allowed overlap / radius of each grain, if radii differ [-]
  float maxSurfaceShare;   ///< same for walls, floor and surfaces, whether or not radii differ [-]
  base::Vec3d gravityStep; // g dt
  const Wall* walls;
  int wallCount, boundaryCount; ///< number of planes; of planes, floor contacts and surfaces, in this order
  HeightFieldView floor;
  int floorPlaces; ///< maximum floor contacts of a grain: 1, or Feet::kMax on a floor with tight hollows
  base::Period period;
  const SurfaceGeometry* surfaces;
  const SurfacePose* placements; ///< poses of the surfaces in this step
  int surfaceCount;
  base::FixedPoint surfaceForce, surfaceTorque; ///< quanta of the surface loads
  int materials;                                ///< at least 1
  const double* massPerCube;                    ///< [materials] mass / radius^3 [kg/m3], if masses differ
  std::int64_t count;                           ///< slots
  const std::uint32_t* active;                  ///< slots of this launch, duplicates adjacent; null: all
  const std::uint32_t* excluded;                ///< by slot: nonzero if another launch advances this grain; null: none

  // State. Positions and motions are read from `now`, as by neighbours, and written to `next`.
  const base::Position* position;
  const Motion* motion;
  base::Position* nextPosition;
  Motion* nextMotion;
  Remainders* remainders;
  const std::uint32_t* id;
  base::Vec3<std::uint32_t>* reference; ///< low words of the positions at the last rebuild
  Crossings* crossings;                 ///< crossings of periodic boundaries; null without them
  contact::NeighbourView neighbours;
  const std::uint32_t* nearBoundary; ///< slots of the grains that may reach walls or floor before the next rebuild
  const std::uint32_t* boundaryOf;   ///< by slot: 1 + index in that list, 0 for all others
  /// [list index]: [boundary][history values as for neighbours], then the normals of the floor contacts [3 each] if
  /// there are several. `boundaryRow`: values per grain.
  float* boundaryHistory;
  int boundaryRow;
  std::uint32_t* boundaryContactMask; ///< bit mask of boundaries in contact
  base::Vec3d* fromSurfaces;          ///< [N] forces of the surfaces, by index in the list of grains near boundaries
  contact::PartLoad* surfaceLoads;    ///< sums of this step
  base::WideSum* ledgerSums;          ///< [kLedgerBanks][kLedgerSums]; null without a ledger
  LedgerScale ledgerScale;
  contact::GrainLoadsView loads;
  StepFlags* flags;        ///< flags of this step
  const StepFlags* former; ///< flags of the previous step in a batch, or null; if any is set, this step is skipped

  /// Springs of a grain at one of its boundaries; `place`: index in the list of grains near boundaries.
  GROUSER_HD float* historyOf(std::int64_t place, int boundary, int width) const {
    return boundaryHistory + place * boundaryRow + boundary * width;
  }
  GROUSER_HD float* floorNormals(std::int64_t place, int width) const { return historyOf(place, boundaryCount, width); }
  /// Law index of a boundary [walls, floor, surfaces]; all floor contacts have the same index.
  GROUSER_HD int lawOf(int boundary) const {
    if (boundary <= wallCount || floorPlaces <= 1) return boundary;
    return boundary < wallCount + floorPlaces ? wallCount : boundary - floorPlaces + 1;
  }
};

/// Accounts for an energy of slot i in this step [J] that occurs in few scenes: kPlasticDissipation and later sums.
GROUSER_HD void addRare(const GrainKernelData& d, int i, LedgerSum sum, double energy) {
  if (energy == 0) return;
  RareAccumulator accumulator;
  accumulator.add(sum, wholeQuanta(d.ledgerScale.perEnergy * energy));
  addToBank(d.ledgerSums, i / 32, accumulator);
}

/// Constants in the force precision, passed by value.
template <class Real> struct ForceData {
  Real radius, unit, timeStep, halfMass, mass, diameterUnits;
  Real massPerCube;                            ///< mass / radius^3 for a single material [kg/m3]
  contact::BasicLaw<Real> law;                 ///< grain-grain law of a single material
  const contact::BasicLaw<Real>* pairLaws;     ///< [materials][materials], for several materials
  const contact::BasicLaw<Real>* boundaryLaws; ///< [walls, floor, surfaces][materials]
  BoundaryLoad<Real>* boundaryLoads;           ///< by index in the list of grains near boundaries
};

/// Size of one grain, with its own radius or the common radius.
template <class Real> struct GrainSize {
  Real radius, mass;
  std::int64_t units; ///< radius in whole units of length; 0 if all are equal
  int material;       ///< 0 for a single material
};

GROUSER_HD base::Vec3f loadVector(const float* at) { return {at[0], at[1], at[2]}; }
GROUSER_HD void storeVector(float* at, const base::Vec3f& v) { at[0] = v.x, at[1] = v.y, at[2] = v.z; }
/// Spring stored in axes that have rotated by `turned` since the start; null: in world axes.
template <class Real> GROUSER_HD base::Vec3<Real> turnedSpring(const float* history, const base::Mat3d* turned) {
  const base::Vec3f kept = loadVector(history);
  return turned ? (*turned * kept.as<double>()).template as<Real>() : kept.template as<Real>();
}
template <class Real>
GROUSER_HD void storeTurned(float* history, const base::Mat3d* turned, const base::Vec3<Real>& spring) {
  storeVector(history, turned ? transposedTimes(*turned, spring.template as<double>()).template as<float>()
                              : spring.template as<float>());
}
template <class Real> GROUSER_HD contact::BasicPlasticState<Real> loadPlastic(const float* at) {
  return {static_cast<Real>(at[0]), static_cast<Real>(at[1])};
}
template <class Real> GROUSER_HD void storePlastic(float* at, const contact::BasicPlasticState<Real>& state) {
  at[0] = static_cast<float>(state.deepest), at[1] = static_cast<float>(state.origin);
}

/// Common base of all grain kernels: features and grain size.
template <unsigned kFeatures, class Real> struct GrainKernel {
  GrainKernelData d;
  ForceData<Real> f;

  /// Features of the force functions called by this kernel.
  static constexpr unsigned kLaw =
      kFeatures & (contact::kGeneral | contact::kHertz | contact::kFriction | contact::kRollingFriction |
                   contact::kCohesion | contact::kManyMasses | contact::kPlastic);

  GROUSER_HD bool has(unsigned feature) const {
    return kFeatures & contact::kGeneral ? (d.features & feature) != 0 : (kFeatures & feature) != 0;
  }
  /// Exact vector from grain i to the nearest image of grain j.
  GROUSER_HD base::Vec3i apart(const base::Position& i, const base::Position& j) const {
    return has(kPeriodic) ? d.period.apart(i, j).template as<std::int32_t>() : base::difference(i, j);
  }
  /// True if this step of a batch must be skipped: the previous step has raised a flag, on this rank or (after the
  /// reduction) on another. The flags are final, since the kernels of that step precede this one in the stream.
  GROUSER_HD bool ended() const { return d.former && (d.former->stale || d.former->fault != kNoFault); }
  GROUSER_HD bool hasHistory() const { return has(contact::kFriction | contact::kRollingFriction | contact::kPlastic); }
  GROUSER_HD int historyWidth() const {
    return contact::historyWidth(kFeatures & contact::kGeneral ? d.features : kFeatures);
  }
  /// Returns the plastic state within a contact's history.
  template <class Float> GROUSER_HD Float* plasticIn(Float* history) const {
    return history + contact::plasticPlace(kFeatures & contact::kGeneral ? d.features : kFeatures);
  }

  /// Raises a fault; the smallest key of a step is kept.
  GROUSER_HD void raise(Fault fault, int i) const {
    base::atomicMin64(&d.flags->fault, static_cast<std::uint64_t>(fault) << 56 | d.id[i]);
  }
  /// Law between a boundary and a grain of a given material.
  GROUSER_HD const contact::BasicLaw<Real>& boundaryLaw(int boundary, int material) const {
    return f.boundaryLaws[d.lawOf(boundary) * d.materials + material];
  }
  /// Adds to a surface load the opposite of `quanta`, the force on a grain, and of `torque` [N m] about its centre.
  GROUSER_HD void loadSurface(int surface, const base::Vec3l& quanta, const base::Vec3d& torque) const {
    contact::PartLoad& load = d.surfaceLoads[surface];
    for (int a = 0; a < 3; ++a) {
      base::atomicAdd64(&load.force[a], -quanta[a]);
      base::atomicAdd64(&load.torque[a], d.surfaceTorque.quantise(torque[a]));
    }
  }

  /// `radiusInW`: value of velocity.w.
  GROUSER_HD GrainSize<Real> sizeOf(float radiusInW, float material) const {
    if (!has(kManyRadii)) return {f.radius, f.mass, 0, 0};
    const float radius = fabsf(radiusInW);
    const int m = has(kManyMaterials) ? static_cast<int>(material) : 0;
    const Real r = static_cast<Real>(radius);
    // Radii are whole units and representable as float: both conversions are exact.
    const Real perCube = has(kManyMaterials) ? static_cast<Real>(d.massPerCube[m]) : f.massPerCube;
    return {r, perCube * r * r * r, static_cast<std::int64_t>(radius * d.unitsPerLength), m};
  }
  GROUSER_HD GrainSize<Real> sizeOf(int i) const {
    return has(kManyRadii) ? sizeOf(d.motion[i].velocity.w, has(kManyMaterials) ? d.motion[i].spin.w : 0.0f)
                           : sizeOf(0, 0);
  }
};

} // namespace grouser::terrain
