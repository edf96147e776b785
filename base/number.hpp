// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/math.hpp"
#include "base/vec.hpp"

#include <cmath>
#include <type_traits>

/// Number types of the contact laws, which are templates over float, double and SIMD vectors of both (base/simd.hpp).
/// Selections are written `mask ? a : b`, valid for scalars and vectors; other operations are below.
namespace grouser::base {

/// Traits of a number type; the primary template is for scalars.
template <class T> struct NumberTraits {
  using Scalar = T;
  GROUSER_HD static T broadcast(T x) { return x; }
  GROUSER_HD static float squareRoot(float x) { return sqrtf(x); }
  GROUSER_HD static double squareRoot(double x) { return sqrt(x); }
  GROUSER_HD static T cubeRoot(T x) { return base::cubeRoot(x); }
  GROUSER_HD static bool any(bool mask) { return mask; }
};

/// Scalar type of a number type: float for vectors of floats, double for vectors of doubles.
template <class T> using ScalarOf = typename NumberTraits<T>::Scalar;

/// Sets every lane to the same number.
template <class T> GROUSER_HD T broadcast(ScalarOf<T> x) { return NumberTraits<T>::broadcast(x); }
template <class T> GROUSER_HD Vec3<T> broadcast(const Vec3<ScalarOf<T>>& v) {
  return {broadcast<T>(v.x), broadcast<T>(v.y), broadcast<T>(v.z)};
}

/// Square root, correctly rounded on every processor (IEEE 754), so results are bitwise reproducible.
template <class T> GROUSER_HD T squareRoot(const T& x) { return NumberTraits<T>::squareRoot(x); }

/// part / whole, for whole > 0. Division on a GPU has a slow path for zero and for values near the limits of the float
/// range; therefore 1 is divided instead of 0. The expression prevents the compiler from undoing this.
template <class T> GROUSER_HD T shareOf(const T& part, const T& whole) {
  if constexpr (std::is_floating_point_v<T>) {
    T dividend = part == 0 ? T(1) : part;
#if defined(__CUDA_ARCH__)
    if constexpr (sizeof(T) == sizeof(float))
      asm("" : "+f"(dividend));
    else
      asm("" : "+d"(dividend));
#endif
    const T share = dividend / whole;
    return part == 0 ? part : share;
  } else {
    return part / whole;
  }
}

/// base::cubeRoot(), lane by lane.
template <class T> GROUSER_HD T cubeRootOf(const T& x) { return NumberTraits<T>::cubeRoot(x); }

/// True if the comparison is true in any lane.
template <class Mask> GROUSER_HD bool any(const Mask& mask) { return NumberTraits<Mask>::any(mask); }

/// Component-wise mask ? a : b.
template <class Mask, class T> GROUSER_HD Vec3<T> select(const Mask& mask, const Vec3<T>& a, const Vec3<T>& b) {
  return {mask ? a.x : b.x, mask ? a.y : b.y, mask ? a.z : b.z};
}

} // namespace grouser::base
