// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "terrain/grain_model.hpp"

#include <string>

namespace grouser::terrain {

/// The kernel that grains of some features take. All kernels give the same bits.
struct KernelChoice {
  /// What it was compiled for: just these features, or contact::kGeneral for all, which decides as it runs.
  unsigned compiledFor = contact::kGeneral;
  int lanes = 1;                ///< contacts that this machine's CPU computes side by side; 1: the scalar kernel
  const char* noSimd = nullptr; ///< why no CPU computes them side by side; null: it does where it has lanes
  unsigned simdFor = contact::kGeneral; ///< features that the SIMD kernel was compiled for; walls have no general one

  bool general() const { return compiledFor == contact::kGeneral; }
  bool simdGeneral() const { return simdFor == contact::kGeneral; }
};

/// Of the grains' step. The only place where this is decided: the launches (grain_kernels.cu), `grouser plan` and tests
/// ask it, and no device is needed. `features`: featuresOf(), and kLoads with rigid parts.
KernelChoice stepKernel(unsigned features, const GrainModel& model);
/// Of walls, floor and surfaces.
KernelChoice boundaryKernel(unsigned features, const GrainModel& model);

/// The features in words: "linear, friction, planes or floor".
std::string featureText(unsigned features);
/// The choices in words: features, precision, whether the kernel is their own, and SIMD on this machine's CPU. Where
/// the general kernel is taken they name a feature without which there is another, if there is one.
std::string stepKernelText(unsigned features, const GrainModel& model);
std::string boundaryKernelText(unsigned features, const GrainModel& model);

} // namespace grouser::terrain
