// SPDX-License-Identifier: BSD-3-Clause
// The kernels of grains: compiled for the lists of detail/kernel_lists.hpp, launched as kernel_choice.hpp says.
#include "terrain/grain_kernels.cuh"

#include "terrain/boundary_contacts.cuh"
#include "terrain/detail/kernel_lists.hpp"
#include "terrain/grain_simd.hpp"
#include "terrain/grain_step.cuh"
#include "terrain/kernel_choice.hpp"

#include <stdexcept>
#include <type_traits>
#include <utility>

namespace grouser::terrain {

using contact::kGeneral;

namespace {

template <unsigned... kSets> struct KernelList {};

template <std::size_t... kPlace>
KernelList<detail::kStepKernels[kPlace]..., kGeneral> stepKernels(std::index_sequence<kPlace...>);
template <std::size_t... kPlace>
KernelList<detail::kBoundaryKernels[kPlace]..., kGeneral> boundaryKernels(std::index_sequence<kPlace...>);
using StepKernels = decltype(stepKernels(std::make_index_sequence<detail::kStepKernels.size()>{}));
using BoundaryKernels = decltype(boundaryKernels(std::make_index_sequence<detail::kBoundaryKernels.size()>{}));

/// A kernel that keeps books where there are some. On a CPU a thread takes several grains before it adds to the books
/// that all share.
template <template <unsigned, class> class Kernel, unsigned kSet, class Real>
void runBody(const base::Exec& exec, const char* name, const GrainKernelData& d, const ForceData<Real>& f,
             std::int64_t count) {
  using Body = Kernel<kSet, Real>;
  constexpr bool kOfStep = std::is_same_v<Body, GrainStep<kSet, Real>>;
  const Body body{{d, f}};
  if constexpr (detail::withoutBooks(kSet, kOfStep))
    if (!d.books) return base::forEach(exec, name, count, body);
  if constexpr (detail::withBooks(kSet, kOfStep))
    if (d.books) {
      const std::int64_t items = exec.onCpu() ? (count + Booked<Body>::kOnCpu - 1) / Booked<Body>::kOnCpu : count;
      return base::forEachLooped(exec, name, items, Booked<Body>{body, count});
    }
  throw std::logic_error("a kernel of grains was chosen that is not compiled for scenes with, or without, books");
}

template <template <unsigned, class> class Kernel, unsigned... kSets>
void runChosen(KernelList<kSets...>, const KernelChoice& choice, const base::Exec& exec, const char* name,
               const GrainKernelData& d, const ForceData<float>& f, std::int64_t count) {
  const auto runIf = [&]<unsigned kSet>() {
    if (choice.compiledFor == kSet) runBody<Kernel, kSet>(exec, name, d, f, count);
  };
  (runIf.template operator()<kSets>(), ...);
}

} // namespace

template <> void runGrainStep(const base::Exec& exec, const GrainKernelData& d, const ForceData<float>& f,
                              std::int64_t count, const GrainModel& model) {
  const KernelChoice choice = stepKernel(d.features, model);
  if (exec.onCpu() && choice.lanes > 1) return runGrainSimd(exec, d, f, count, choice.lanes);
  runChosen<GrainStep>(StepKernels{}, choice, exec, "grain step", d, f, count);
}
template <> void runGrainStep(const base::Exec& exec, const GrainKernelData& d, const ForceData<double>& f,
                              std::int64_t count, const GrainModel&) {
  runBody<GrainStep, kGeneral>(exec, "grain step", d, f, count); // in double no other is compiled
}

template <> void runBoundaryContacts(const base::Exec& exec, const GrainKernelData& d, const ForceData<float>& f,
                                     std::int64_t near, const GrainModel& model) {
  const KernelChoice choice = boundaryKernel(d.features, model);
  // The lanes do not look at the flags of the step before.
  if (exec.onCpu() && choice.lanes > 1 && !d.former) return runWallSimd(exec, d, f, near, choice.lanes);
  runChosen<BoundaryContacts>(BoundaryKernels{}, choice, exec, "boundary contacts", d, f, near);
}
template <> void runBoundaryContacts(const base::Exec& exec, const GrainKernelData& d, const ForceData<double>& f,
                                     std::int64_t near, const GrainModel&) {
  runBody<BoundaryContacts, kGeneral>(exec, "boundary contacts", d, f, near);
}

} // namespace grouser::terrain
