// SPDX-License-Identifier: BSD-3-Clause
// The kernels of grains that are compiled, and the choice among them.
#include "terrain/grain_kernels.cuh"

#include "terrain/boundary_contacts.cuh"
#include "terrain/grain_simd.hpp"
#include "terrain/grain_step.cuh"

#include <type_traits>
#include <utility>

namespace grouser::terrain {

using contact::kCohesion;
using contact::kFriction;
using contact::kGeneral;
using contact::kHertz;
using contact::kPlastic;
using contact::kRollingFriction;

namespace {

template <unsigned... kSets> struct KernelList {};

/// Scenes have a ledger; benches leave it out.
constexpr unsigned kBed = kFriction | kBoundaries | kLedger;
/// Beds of soil: each of these, with and without.
constexpr unsigned soil(int which) {
  constexpr unsigned kEach[] = {kHertz, kRollingFriction, kManyRadii, kFixed, kLoads};
  unsigned features = kBed;
  for (int k = 0; k < 5; ++k) features |= which >> k & 1 ? kEach[k] : 0u;
  return features;
}
template <int... kWhich> KernelList<soil(kWhich)...> soilKernels(std::integer_sequence<int, kWhich...>);
using SoilKernels = decltype(soilKernels(std::make_integer_sequence<int, 32>{}));
using StepKernels =
    KernelList<kFriction | kBoundaries, kFriction | kBoundaries | kLoads, kFriction | kBoundaries | kFixed,
               kFriction | kBoundaries | kManyRadii, kFriction | kLedger, kFriction, kLedger, kBoundaries | kLedger,
               kBed | kPeriodic, kBed | kPeriodic | kRollingFriction, kBed | kPeriodic | kManyRadii,
               kBed | kPeriodic | kManyRadii | kRollingFriction, kBed | kSurfaces, kBed | kSurfaces | kRollingFriction,
               kFixed | kBed | kSurfaces, kFixed | kBed | kSurfaces | kManyRadii | kRollingFriction>;
constexpr unsigned kSoilWalls = kHertz | kFriction | kRollingFriction | kManyRadii;
/// The search on a floor needs many registers.
using BoundaryKernels =
    KernelList<0, kFriction, kFriction | kRollingFriction, kHertz | kFriction, kFloor, kFriction | kFloor,
               kFriction | kRollingFriction | kFloor, kHertz | kFriction | kFloor, kFriction | kSurfaces,
               kFriction | kRollingFriction | kSurfaces, kFriction | kSurfaces | kFloor,
               kFriction | kRollingFriction | kSurfaces | kFloor, kFriction | kManyRadii,
               kFriction | kManyRadii | kFloor, kFriction | kRollingFriction | kManyRadii,
               kFriction | kRollingFriction | kManyRadii | kFloor, kSoilWalls, kSoilWalls | kFloor,
               kSoilWalls | kSurfaces, kSoilWalls | kCohesion, kSoilWalls | kCohesion | kFloor,
               kSoilWalls | kCohesion | kSurfaces, kSoilWalls | kCohesion | kPlastic,
               kSoilWalls | kCohesion | kPlastic | kFloor, kSoilWalls | kCohesion | kPlastic | kSurfaces>;

/// Features that the kernel of walls and floor depends on.
constexpr unsigned kAtBoundaries = kHertz | kFriction | kRollingFriction | kCohesion | kPlastic | kManyRadii |
                                   kManyMaterials | kSurfaces | kFloor | kGeneral;

/// Elastic-plastic soils under a vehicle; those of a constant pull besides (`cohesion`) are of Hertz' law.
constexpr unsigned kYielding = kBed | kPlastic | kManyRadii | kRollingFriction, kEepa = kYielding | kHertz | kCohesion;
using PlasticKernels =
    KernelList<kYielding, kYielding | kFixed, kYielding | kLoads, kYielding | kFixed | kLoads, kYielding | kHertz,
               kYielding | kHertz | kFixed, kYielding | kHertz | kLoads, kYielding | kHertz | kFixed | kLoads, kEepa,
               kEepa | kFixed, kEepa | kLoads, kEepa | kFixed | kLoads>;

/// Soils of Hertz' law that stick, under a vehicle.
constexpr unsigned kSoil = kBed | kHertz | kManyRadii, kSticky = kSoil | kCohesion;
using CohesiveKernels = KernelList<kSticky, kSticky | kLoads, kSticky | kFixed, kSticky | kFixed | kLoads,
                                   kSticky | kRollingFriction, kSticky | kRollingFriction | kLoads,
                                   kSticky | kRollingFriction | kFixed, kSticky | kRollingFriction | kFixed | kLoads>;

/// What `grouser soil` does with them between periodic boundaries: sheared between toothed plates, which are parts;
/// settling on fixed grains; under a plate, which is a surface.
constexpr unsigned kSheared = (kSoil & ~kBoundaries) | kPeriodic | kLoads, kSettling = kSoil | kPeriodic | kFixed,
                   kPressed = kSettling | kSurfaces, kSlipping = kRollingFriction | kPlastic;
using BevameterKernels =
    KernelList<kSheared, kSheared | kRollingFriction, kSheared | kCohesion, kSheared | kCohesion | kRollingFriction,
               kSheared | kSlipping, kSheared | kSlipping | kCohesion, kSettling, kSettling | kRollingFriction,
               kSettling | kCohesion, kSettling | kCohesion | kRollingFriction, kSettling | kSlipping, kPressed,
               kPressed | kRollingFriction, kPressed | kCohesion, kPressed | kCohesion | kRollingFriction,
               kPressed | kSlipping, kPressed | kSlipping | kCohesion>;

template <unsigned... kSets> bool listed(KernelList<kSets...>, unsigned features) {
  return ((features == kSets) || ...);
}

/// Which of both a kernel is compiled for: with books or without. The step's features say so; of walls and floor beds
/// without books are compiled for the bench.
template <unsigned kSet> constexpr bool withBooks(bool ofStep) { return !ofStep || kSet & (kLedger | kGeneral); }
template <unsigned kSet> constexpr bool withoutBooks(bool ofStep) {
  return ofStep ? !(kSet & kLedger) || kSet & kGeneral : kSet == kFriction || kSet & kGeneral;
}

/// Returns whether it has run: a kernel that keeps books where there are some. On a CPU a thread takes several grains
/// before it adds to the books that all share.
template <template <unsigned, class> class Kernel, unsigned kSet, class Real>
bool runBody(const base::Exec& exec, const char* name, const GrainKernelData& d, const ForceData<Real>& f,
             std::int64_t count) {
  using Body = Kernel<kSet, Real>;
  constexpr bool kOfStep = std::is_same_v<Body, GrainStep<kSet, Real>>;
  const Body body{{d, f}};
  if constexpr (withoutBooks<kSet>(kOfStep))
    if (!d.books) return base::forEach(exec, name, count, body), true;
  if constexpr (withBooks<kSet>(kOfStep))
    if (d.books) {
      const std::int64_t items = exec.onCpu() ? (count + Booked<Body>::kOnCpu - 1) / Booked<Body>::kOnCpu : count;
      return base::forEachLooped(exec, name, items, Booked<Body>{body, count}), true;
    }
  return false;
}

template <template <unsigned, class> class Body, class Real, unsigned... kSets>
bool ranOneOf(KernelList<kSets...>, unsigned features, const base::Exec& exec, const char* name,
              const GrainKernelData& d, const ForceData<Real>& f, std::int64_t count) {
  return ((features == kSets && runBody<Body, kSets, Real>(exec, name, d, f, count)) || ...);
}

} // namespace

template <> void runGrainStep(const base::Exec& exec, const GrainKernelData& d, const ForceData<float>& f,
                              std::int64_t count, const GrainModel& model) {
  const unsigned features = model.specialised ? d.features & ~kFloor : kGeneral;
  if (const int width = exec.onCpu() ? simdWidth(features, f.law, model.mostSimdLanes) : 1; width > 1)
    return runGrainSimd(exec, d, f, count, width);
  if (ranOneOf<GrainStep>(SoilKernels{}, features, exec, "grain step", d, f, count)) return;
  if (ranOneOf<GrainStep>(PlasticKernels{}, features, exec, "grain step", d, f, count)) return;
  if (ranOneOf<GrainStep>(CohesiveKernels{}, features, exec, "grain step", d, f, count)) return;
  if (ranOneOf<GrainStep>(BevameterKernels{}, features, exec, "grain step", d, f, count)) return;
  if (ranOneOf<GrainStep>(StepKernels{}, features, exec, "grain step", d, f, count)) return;
  runBody<GrainStep, kGeneral>(exec, "grain step", d, f, count);
}
template <> void runGrainStep(const base::Exec& exec, const GrainKernelData& d, const ForceData<double>& f,
                              std::int64_t count, const GrainModel&) {
  runBody<GrainStep, kGeneral>(exec, "grain step", d, f, count); // in double all scenes take the general kernels
}

template <> void runBoundaryContacts(const base::Exec& exec, const GrainKernelData& d, const ForceData<float>& f,
                                     std::int64_t near, const GrainModel& model) {
  const unsigned features = model.specialised ? d.features & kAtBoundaries : kGeneral;
  if (const int width = exec.onCpu() && !d.former ? wallSimdWidth(features, model.mostSimdLanes) : 1; width > 1)
    return runWallSimd(exec, d, f, near, width);
  if (!ranOneOf<BoundaryContacts>(BoundaryKernels{}, features, exec, "boundary contacts", d, f, near))
    runBody<BoundaryContacts, kGeneral>(exec, "boundary contacts", d, f, near);
}
template <> void runBoundaryContacts(const base::Exec& exec, const GrainKernelData& d, const ForceData<double>& f,
                                     std::int64_t near, const GrainModel&) {
  runBody<BoundaryContacts, kGeneral>(exec, "boundary contacts", d, f, near);
}

bool hasOwnKernel(unsigned features, Precision precision) {
  features &= ~kFloor;
  return precision == Precision::single && (listed(SoilKernels{}, features) || listed(PlasticKernels{}, features) ||
                                            listed(CohesiveKernels{}, features) ||
                                            listed(BevameterKernels{}, features) || listed(StepKernels{}, features));
}

std::string featureText(unsigned features) {
  std::string text = features & kHertz ? "hertz" : "linear";
  const auto add = [&](unsigned feature, const char* name) {
    if (features & feature) text += std::string(", ") + name;
  };
  add(kFriction, "friction"), add(kRollingFriction, "rolling friction"), add(kCohesion, "cohesion");
  add(kPlastic, "plastic");
  add(kManyRadii, "many radii"), add(kManyMaterials, "many materials");
  add(kPeriodic, "periodic boundaries"), add(kBoundaries, "planes or floor"), add(kSurfaces, "moving surfaces");
  add(kFixed, "fixed grains"), add(kLoads, "rigid parts"), add(kLedger, "ledger");
  return text;
}

} // namespace grouser::terrain
