// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/math.hpp"
#include "base/vec.hpp"

#include <cmath>
#include <type_traits>

/// Contact laws are templates over a number type: float, double or SIMD vectors of these (base/simd.hpp). Besides the
/// operators they use the functions below. Selections are written `mask ? a : b`, which works for both.
namespace grouser::base {

/// Traits of a number type; here of a scalar.
template <class T> struct NumberTraits {
  using Scalar = T;
  GROUSER_HD static T broadcast(T x) { return x; }
  GROUSER_HD static float squareRoot(float x) { return sqrtf(x); }
  GROUSER_HD static double squareRoot(double x) { return sqrt(x); }
  GROUSER_HD static T cubeRoot(T x) { return base::cubeRoot(x); }
  GROUSER_HD static bool any(bool mask) { return mask; }
};

/// float of floats side by side, double of doubles.
template <class T> using ScalarOf = typename NumberTraits<T>::Scalar;

/// The same number in every lane.
template <class T> GROUSER_HD T broadcast(ScalarOf<T> x) { return NumberTraits<T>::broadcast(x); }
template <class T> GROUSER_HD Vec3<T> broadcast(const Vec3<ScalarOf<T>>& v) {
  return {broadcast<T>(v.x), broadcast<T>(v.y), broadcast<T>(v.z)};
}

/// Correctly rounded everywhere (IEEE 754), so it keeps bits equal.
template <class T> GROUSER_HD T squareRoot(const T& x) { return NumberTraits<T>::squareRoot(x); }

/// part / whole, for whole > 0. A GPU's division has a slow path for what is zero or near the ends of a float's range:
/// a zero is divided as a one, which the compiler is not to know.
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

/// Whether a comparison holds in any lane.
template <class Mask> GROUSER_HD bool any(const Mask& mask) { return NumberTraits<Mask>::any(mask); }

/// mask ? a : b
template <class Mask, class T> GROUSER_HD Vec3<T> select(const Mask& mask, const Vec3<T>& a, const Vec3<T>& b) {
  return {mask ? a.x : b.x, mask ? a.y : b.y, mask ? a.z : b.z};
}

} // namespace grouser::base
