// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "terrain/grain_model.hpp"

#include <string>

namespace grouser::terrain {

/// The kernel for grains with given features. All kernels give the same bits.
struct KernelChoice {
  /// Features that it was compiled for, or contact::kGeneral for all, tested at run time.
  unsigned compiledFor = contact::kGeneral;
  int lanes = 1;                ///< contacts that this machine's CPU computes side by side; 1: the scalar kernel
  const char* noSimd = nullptr; ///< reason why no CPU uses SIMD; null: SIMD if the CPU has lanes
  unsigned simdFor = contact::kGeneral; ///< features that the SIMD kernel was compiled for; walls have no general one

  bool general() const { return compiledFor == contact::kGeneral; }
  bool simdGeneral() const { return simdFor == contact::kGeneral; }
};

/// Kernel of the grains' step. The only place of this decision: the launches (grain_kernels.cu), `grouser plan` and
/// tests call it, without a device. `features`: featuresOf(), and kLoads with rigid parts.
KernelChoice stepKernel(unsigned features, const GrainModel& model);
/// Kernel of walls, floor and surfaces.
KernelChoice boundaryKernel(unsigned features, const GrainModel& model);

/// Text of the features: "linear, friction, planes or floor".
std::string featureText(unsigned features);
/// Text of the choice: features, precision, specialised or general kernel, and SIMD on this machine's CPU. For the
/// general kernel it names a feature without which there is a specialised one, if any.
std::string stepKernelText(unsigned features, const GrainModel& model);
std::string boundaryKernelText(unsigned features, const GrainModel& model);

} // namespace grouser::terrain
