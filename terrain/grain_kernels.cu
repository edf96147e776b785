// SPDX-License-Identifier: BSD-3-Clause
// Grain kernels, compiled for the lists of detail/kernel_lists.hpp, selected by kernel_choice.hpp.
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

template <const auto& kList, std::size_t... kPlace>
KernelList<kList[kPlace]..., kGeneral> kernelsIn(std::index_sequence<kPlace...>);
/// Kernels of a list, plus the general kernel.
template <const auto& kList> using KernelsOf = decltype(kernelsIn<kList>(std::make_index_sequence<kList.size()>{}));

/// Calls run<kSet>() for the feature set `wanted`.
template <unsigned... kSets, class Run> void runChosen(KernelList<kSets...>, unsigned wanted, const Run& run) {
  const bool found = ((kSets == wanted && (run.template operator()<kSets>(), true)) || ...);
  if (!found) throw std::logic_error("no grain kernel is compiled for the chosen features");
}

/// Runs a kernel with energy accounting if there is a ledger. On a CPU a thread accumulates several grains before it
/// adds to the shared sums.
template <template <unsigned, class> class Kernel, unsigned kSet, class Real>
void runBody(const base::Exec& exec, const char* name, const GrainKernelData& d, const ForceData<Real>& f,
             std::int64_t count) {
  using Body = Kernel<kSet, Real>;
  constexpr bool kOfStep = std::is_same_v<Body, GrainStep<kSet, Real>>;
  const Body body{{d, f}};
  if constexpr (detail::withoutLedger(kSet, kOfStep))
    if (!d.ledgerSums) return base::forEach(exec, name, count, body);
  if constexpr (detail::withLedger(kSet, kOfStep))
    if (d.ledgerSums)
      return base::forEach(exec, name, WithEnergyAccounting<Body>::items(exec, count),
                           WithEnergyAccounting<Body>{body, count});
  throw std::logic_error("the chosen grain kernel is not compiled with, or without, energy accounting");
}

} // namespace

template <> void runGrainStep(const base::Exec& exec, const GrainKernelData& d, const ForceData<float>& f,
                              std::int64_t count, const GrainModel& model) {
  const KernelChoice choice = stepKernel(d.features, model);
  if (exec.onCpu() && choice.lanes > 1 && !d.excluded) return runGrainSimd(exec, d, f, count, choice.lanes);
  runChosen(KernelsOf<detail::kStepKernels>{}, choice.compiledFor,
            [&]<unsigned kSet>() { runBody<GrainStep, kSet>(exec, "grain step", d, f, count); });
}
template <> void runGrainStep(const base::Exec& exec, const GrainKernelData& d, const ForceData<double>& f,
                              std::int64_t count, const GrainModel&) {
  runBody<GrainStep, kGeneral>(exec, "grain step", d, f, count); // the only kernel compiled in double
}

template <> void runBoundaryContacts(const base::Exec& exec, const GrainKernelData& d, const ForceData<float>& f,
                                     std::int64_t near, const GrainModel& model) {
  const KernelChoice choice = boundaryKernel(d.features, model);
  // The SIMD kernel does not check the flags of the previous step.
  if (exec.onCpu() && choice.lanes > 1 && !d.former) return runWallSimd(exec, d, f, near, choice.lanes);
  runChosen(KernelsOf<detail::kBoundaryKernels>{}, choice.compiledFor,
            [&]<unsigned kSet>() { runBody<BoundaryContacts, kSet>(exec, "boundary contacts", d, f, near); });
}
template <> void runBoundaryContacts(const base::Exec& exec, const GrainKernelData& d, const ForceData<double>& f,
                                     std::int64_t near, const GrainModel&) {
  runBody<BoundaryContacts, kGeneral>(exec, "boundary contacts", d, f, near);
}

} // namespace grouser::terrain
