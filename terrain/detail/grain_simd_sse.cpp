// SPDX-License-Identifier: BSD-3-Clause
#include "terrain/detail/boundary_simd.hpp"
#include "terrain/detail/grain_simd.hpp"

namespace grouser::terrain::detail {

__attribute__((flatten)) void stepSse(const GrainKernelData& d, const ForceData<float>& f, int first, int last) {
  runSimd<4>(d, f, first, last);
}

__attribute__((flatten)) void wallsSse(const GrainKernelData& d, const ForceData<float>& f, int first, int last) {
  runWalls<4>(d, f, first, last);
}

} // namespace grouser::terrain::detail
