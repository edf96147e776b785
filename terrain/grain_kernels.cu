// SPDX-License-Identifier: BSD-3-Clause
// The kernels of grains that are compiled, and the choice among them.
#include "terrain/grain_kernels.cuh"

#include "terrain/boundary_contacts.cuh"
#include "terrain/grain_simd.hpp"
#include "terrain/grain_step.cuh"

namespace grouser::terrain {

using contact::kCohesion;
using contact::kFriction;
using contact::kGeneral;
using contact::kHertz;
using contact::kRollingFriction;

namespace {

template <unsigned... kSets> struct KernelList {};

/// Scenes have a ledger; benches leave it out.
constexpr unsigned kBed = kFriction | kBoundaries | kLedger;
using StepKernels =
    KernelList<kBed, kBed | kLoads, kFriction | kBoundaries, kFriction | kBoundaries | kLoads, kFriction | kLedger,
               kFriction, kLedger, kBoundaries | kLedger, kBed | kRollingFriction, kBed | kLoads | kRollingFriction,
               kBed | kManyRadii, kBed | kManyRadii | kRollingFriction, kHertz | kBed, kHertz | kBed | kLoads,
               kHertz | kBed | kRollingFriction, kHertz | kBed | kManyRadii | kRollingFriction, kBed | kPeriodic,
               kBed | kSurfaces, kBed | kSurfaces | kRollingFriction,
               // The same on a floor of fixed grains, which is what a bed stands on.
               kFixed | kBed, kFixed | kBed | kLoads, kFixed | kBed | kRollingFriction,
               kFixed | kBed | kLoads | kRollingFriction, kFixed | kBed | kManyRadii,
               kFixed | kBed | kManyRadii | kLoads, kFixed | kBed | kManyRadii | kRollingFriction,
               kFixed | kBed | kManyRadii | kLoads | kRollingFriction>;
/// The search on a floor needs many registers.
using BoundaryKernels =
    KernelList<0, kFriction, kFriction | kRollingFriction, kHertz | kFriction, kFloor, kFriction | kFloor,
               kFriction | kRollingFriction | kFloor, kHertz | kFriction | kFloor, kFriction | kSurfaces,
               kFriction | kRollingFriction | kSurfaces, kFriction | kSurfaces | kFloor,
               kFriction | kRollingFriction | kSurfaces | kFloor>;
/// In double all scenes take the general kernels.
using NoKernels = KernelList<>;

/// Features that the kernel of walls and floor depends on.
constexpr unsigned kAtBoundaries =
    kHertz | kFriction | kRollingFriction | kCohesion | kManyRadii | kManyMaterials | kSurfaces | kFloor | kGeneral;

template <unsigned... kSets> bool listed(KernelList<kSets...>, unsigned features) {
  return ((features == kSets) || ...);
}

/// With or without books. On a CPU a thread takes several grains before it adds to the books that all share.
template <class Body, class Real> void runBody(const base::Exec& exec, const char* name, const GrainKernelData& d,
                                               const ForceData<Real>& f, std::int64_t count) {
  const Body body{{d, f}};
  if (!d.books) return base::forEach(exec, name, count, body);
  const std::int64_t items = exec.onCpu() ? (count + Booked<Body>::kOnCpu - 1) / Booked<Body>::kOnCpu : count;
  base::forEach(exec, name, items, Booked<Body>{body, count});
}

template <template <unsigned, class> class Body, class Real, unsigned... kSets>
void runOneOf(KernelList<kSets...>, unsigned features, const base::Exec& exec, const char* name,
              const GrainKernelData& d, const ForceData<Real>& f, std::int64_t count) {
  const bool special = ((features == kSets && (runBody<Body<kSets, Real>>(exec, name, d, f, count), true)) || ...);
  if (!special) runBody<Body<kGeneral, Real>>(exec, name, d, f, count);
}

} // namespace

template <> void runGrainStep(const base::Exec& exec, const GrainKernelData& d, const ForceData<float>& f,
                              std::int64_t count, const GrainModel& model) {
  const unsigned features = model.specialised ? d.features & ~kFloor : kGeneral;
  if (const int width = exec.onCpu() ? simdWidth(features, f.law, model.mostSimdLanes) : 1; width > 1)
    return runGrainSimd(exec, d, f, count, width);
  runOneOf<GrainStep>(StepKernels{}, features, exec, "grain step", d, f, count);
}
template <> void runGrainStep(const base::Exec& exec, const GrainKernelData& d, const ForceData<double>& f,
                              std::int64_t count, const GrainModel&) {
  runOneOf<GrainStep>(NoKernels{}, d.features, exec, "grain step", d, f, count);
}

template <> void runBoundaryContacts(const base::Exec& exec, const GrainKernelData& d, const ForceData<float>& f,
                                     std::int64_t near, const GrainModel& model) {
  const unsigned features = model.specialised ? d.features & kAtBoundaries : kGeneral;
  runOneOf<BoundaryContacts>(BoundaryKernels{}, features, exec, "boundary contacts", d, f, near);
}
template <> void runBoundaryContacts(const base::Exec& exec, const GrainKernelData& d, const ForceData<double>& f,
                                     std::int64_t near, const GrainModel&) {
  runOneOf<BoundaryContacts>(NoKernels{}, d.features & kAtBoundaries, exec, "boundary contacts", d, f, near);
}

bool hasOwnKernel(unsigned features, Precision precision) {
  return precision == Precision::single && listed(StepKernels{}, features & ~kFloor);
}

std::string featureText(unsigned features) {
  std::string text = features & kHertz ? "hertz" : "linear";
  const auto add = [&](unsigned feature, const char* name) {
    if (features & feature) text += std::string(", ") + name;
  };
  add(kFriction, "friction"), add(kRollingFriction, "rolling friction"), add(kCohesion, "cohesion");
  add(kManyRadii, "many radii"), add(kManyMaterials, "many materials");
  add(kPeriodic, "periodic boundaries"), add(kBoundaries, "planes or floor"), add(kSurfaces, "moving surfaces");
  add(kFixed, "fixed grains"), add(kLoads, "rigid parts"), add(kLedger, "ledger");
  return text;
}

} // namespace grouser::terrain
