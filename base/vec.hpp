// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/host_device.hpp"

#include <cmath>
#include <cstdint>

namespace grouser::base {

/// Vector with three components in a right-handed frame: x forward, y left, z up.
template <class T> struct Vec3 {
  T x{}, y{}, z{};

  GROUSER_HD Vec3& operator+=(const Vec3& b) {
    x += b.x, y += b.y, z += b.z;
    return *this;
  }
  GROUSER_HD Vec3& operator-=(const Vec3& b) {
    x -= b.x, y -= b.y, z -= b.z;
    return *this;
  }
  GROUSER_HD Vec3& operator*=(T s) {
    x *= s, y *= s, z *= s;
    return *this;
  }
  GROUSER_HD T& operator[](int i) { return i == 0 ? x : i == 1 ? y : z; }
  GROUSER_HD const T& operator[](int i) const { return i == 0 ? x : i == 1 ? y : z; }
  template <class U> GROUSER_HD Vec3<U> as() const { return {static_cast<U>(x), static_cast<U>(y), static_cast<U>(z)}; }
  friend GROUSER_HD bool operator==(const Vec3& a, const Vec3& b) { return a.x == b.x && a.y == b.y && a.z == b.z; }
};

template <class T> GROUSER_HD Vec3<T> operator+(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class T> GROUSER_HD Vec3<T> operator-(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class T> GROUSER_HD Vec3<T> operator-(const Vec3<T>& a) { return {-a.x, -a.y, -a.z}; }
template <class T> GROUSER_HD Vec3<T> operator*(const Vec3<T>& a, T s) { return {a.x * s, a.y * s, a.z * s}; }
template <class T> GROUSER_HD Vec3<T> operator*(T s, const Vec3<T>& a) { return {s * a.x, s * a.y, s * a.z}; }
template <class T> GROUSER_HD T dot(const Vec3<T>& a, const Vec3<T>& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
template <class T> GROUSER_HD Vec3<T> cross(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class T> GROUSER_HD T norm2(const Vec3<T>& a) { return dot(a, a); }
/// Euclidean length. The square root is correctly rounded on every processor (IEEE 754), so results are reproducible.
GROUSER_HD float norm(const Vec3<float>& a) { return sqrtf(dot(a, a)); }
GROUSER_HD double norm(const Vec3<double>& a) { return sqrt(dot(a, a)); }
/// Unit vector along `a`; `a` must not be zero.
template <class T> GROUSER_HD Vec3<T> normalized(const Vec3<T>& a) { return a * (T(1) / norm(a)); }
/// Component-wise minimum and maximum.
template <class T> GROUSER_HD Vec3<T> min(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.x < b.x ? a.x : b.x, a.y < b.y ? a.y : b.y, a.z < b.z ? a.z : b.z};
}
template <class T> GROUSER_HD Vec3<T> max(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.x > b.x ? a.x : b.x, a.y > b.y ? a.y : b.y, a.z > b.z ? a.z : b.z};
}

/// Four floats in one aligned 16-byte load; `w` is available to the caller.
struct alignas(16) Vec4f {
  float x, y, z, w;
  GROUSER_HD Vec3<float> xyz() const { return {x, y, z}; }
};

/// 3x3 matrix, row-major: m[row][column].
template <class T> struct Mat3 {
  T m[3][3]{};

  GROUSER_HD static Mat3 identity() { return {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}; }
  GROUSER_HD static Mat3 diagonal(const Vec3<T>& d) { return {{{d.x, 0, 0}, {0, d.y, 0}, {0, 0, d.z}}}; }
};

template <class T> GROUSER_HD Vec3<T> operator*(const Mat3<T>& a, const Vec3<T>& v) {
  return {a.m[0][0] * v.x + a.m[0][1] * v.y + a.m[0][2] * v.z, a.m[1][0] * v.x + a.m[1][1] * v.y + a.m[1][2] * v.z,
          a.m[2][0] * v.x + a.m[2][1] * v.y + a.m[2][2] * v.z};
}
/// Product of the transpose of `a` and `v`; does not form the transpose.
template <class T> GROUSER_HD Vec3<T> transposedTimes(const Mat3<T>& a, const Vec3<T>& v) {
  return {a.m[0][0] * v.x + a.m[1][0] * v.y + a.m[2][0] * v.z, a.m[0][1] * v.x + a.m[1][1] * v.y + a.m[2][1] * v.z,
          a.m[0][2] * v.x + a.m[1][2] * v.y + a.m[2][2] * v.z};
}
template <class T> GROUSER_HD Mat3<T> operator*(const Mat3<T>& a, const Mat3<T>& b) {
  Mat3<T> c;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) c.m[i][j] = a.m[i][0] * b.m[0][j] + a.m[i][1] * b.m[1][j] + a.m[i][2] * b.m[2][j];
  return c;
}
template <class T> GROUSER_HD Mat3<T> operator+(const Mat3<T>& a, const Mat3<T>& b) {
  Mat3<T> c;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) c.m[i][j] = a.m[i][j] + b.m[i][j];
  return c;
}
/// The matrix S with S w = cross(v, w).
template <class T> GROUSER_HD Mat3<T> skew(const Vec3<T>& v) {
  return {{{0, -v.z, v.y}, {v.z, 0, -v.x}, {-v.y, v.x, 0}}};
}

using Vec3d = Vec3<double>;
using Vec3f = Vec3<float>;
using Vec3i = Vec3<std::int32_t>;
using Vec3l = Vec3<std::int64_t>;
using Mat3d = Mat3<double>;

/// Unit quaternion, scalar first; R(q) transforms body components to world components (R_WB).
struct Quat {
  double w{1}, x{0}, y{0}, z{0};

  GROUSER_HD Quat conjugate() const { return {w, -x, -y, -z}; }
  GROUSER_HD Quat normalized() const {
    const double s = 1.0 / sqrt(w * w + x * x + y * y + z * z);
    return {w * s, x * s, y * s, z * s};
  }
  /// Rotation matrix of a unit quaternion.
  GROUSER_HD Mat3d matrix() const {
    return {{{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
             {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
             {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}}};
  }
};

GROUSER_HD Quat operator*(const Quat& a, const Quat& b) {
  return {a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
          a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}
GROUSER_HD Vec3d rotate(const Quat& q, const Vec3d& v) { return q.matrix() * v; }

/// Pose of a frame B in the world W: a point is p_W = position + R(orientation) p_B.
struct Pose {
  Vec3d position;   ///< [m]
  Quat orientation; ///< body to world

  GROUSER_HD Vec3d toWorld(const Vec3d& p_B) const { return position + rotate(orientation, p_B); }
  GROUSER_HD Vec3d toBody(const Vec3d& p_W) const { return transposedTimes(orientation.matrix(), p_W - position); }
};

} // namespace grouser::base
