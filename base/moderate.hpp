// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/number.hpp"

#include <type_traits>

namespace grouser::base {

/// Branch-free square root, quotient and inverse of numbers from 2^-60 to 2^60 on a GPU. The results are correctly
/// rounded, by an approximation and Newton steps with fused multiply-adds, like the compiler's fast paths (P. Markstein
/// 1990, IBM J. Res. Dev. 34:111). tests/base/arithmetic_test.cu compares them with the operators.
template <class T> GROUSER_HD T moderateRoot(const T& x) {
#if defined(__CUDA_ARCH__)
  if constexpr (std::is_same_v<T, float>) {
    float inverse;
    asm("rsqrt.approx.ftz.f32 %0, %1;" : "=f"(inverse) : "f"(x));
    const float root = x * inverse;
    return __fmaf_rn(__fmaf_rn(-root, root, x), 0.5f * inverse, root);
  }
#endif
  return squareRoot(x);
}
template <class T> GROUSER_HD T moderateInverse(const T& x) {
#if defined(__CUDA_ARCH__)
  if constexpr (std::is_same_v<T, float>) {
    float inverse;
    asm("rcp.approx.ftz.f32 %0, %1;" : "=f"(inverse) : "f"(x));
    return __fmaf_rn(inverse, -__fmaf_rn(x, inverse, -1.0f), inverse);
  }
#endif
  return ScalarOf<T>(1) / x;
}
template <class T> GROUSER_HD T moderateQuotient(const T& part, const T& whole) {
#if defined(__CUDA_ARCH__)
  if constexpr (std::is_same_v<T, float>) {
    const float inverse = moderateInverse(whole), quotient = part * inverse;
    return __fmaf_rn(__fmaf_rn(-quotient, whole, part), inverse, quotient);
  }
#endif
  return part / whole;
}

} // namespace grouser::base
