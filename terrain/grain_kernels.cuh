// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "terrain/grain_kernel_data.cuh"

namespace grouser::terrain {

/// Runs one step of `count` grains by the kernel compiled for the features of `d`, or the general one, as permitted by
/// `model`. `Real`: float or double.
template <class Real> void runGrainStep(const base::Exec& exec, const GrainKernelData& d, const ForceData<Real>& f,
                                        std::int64_t count, const GrainModel& model);

/// Computes the forces of walls and floor on the `near` grains listed near them.
template <class Real> void runBoundaryContacts(const base::Exec& exec, const GrainKernelData& d,
                                               const ForceData<Real>& f, std::int64_t near, const GrainModel& model);

} // namespace grouser::terrain
