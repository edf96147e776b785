// SPDX-License-Identifier: BSD-3-Clause
#include "terrain/detail/grain_simd.hpp"

namespace grouser::terrain::detail {

__attribute__((flatten)) void stepAvx512(const GrainKernelData& d, const ForceData<float>& f, int first, int last) {
  runSimd<16>(d, f, first, last);
}

} // namespace grouser::terrain::detail
