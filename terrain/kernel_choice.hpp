// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "terrain/grain_model.hpp"

#include <string>

namespace grouser::terrain {

/// Kernel selected for grains with given features. All kernels produce identical bits.
struct KernelChoice {
  /// Features for which it was compiled; contact::kGeneral: all features, tested at run time.
  unsigned compiledFor = contact::kGeneral;
  int lanes = 1;                        ///< number of contacts computed at once by this machine's CPU; 1: scalar kernel
  const char* noSimd = nullptr;         ///< reason why SIMD is not used on any CPU; null: SIMD if the CPU has lanes
  unsigned simdFor = contact::kGeneral; ///< features the SIMD kernel was compiled for; walls have no general one

  bool general() const { return compiledFor == contact::kGeneral; }
  bool simdGeneral() const { return simdFor == contact::kGeneral; }
};

/// Selects the kernel of the grain step. Only this function decides: the launches (grain_kernels.cu), `grouser plan`
/// and tests call it. It needs no device. `features`: featuresOf(), plus kLoads with rigid parts.
KernelChoice stepKernel(unsigned features, const GrainModel& model);
/// Selects the kernel of walls, floor and surfaces.
KernelChoice boundaryKernel(unsigned features, const GrainModel& model);

/// Text of the features, e.g. "linear, friction, planes or floor".
std::string featureText(unsigned features);
/// Text of the choice: features, precision, specialised or general kernel, and SIMD on this machine's CPU. For the
/// general kernel it names a feature, if any, without which there is a specialised kernel.
std::string stepKernelText(unsigned features, const GrainModel& model);
std::string boundaryKernelText(unsigned features, const GrainModel& model);

} // namespace grouser::terrain
