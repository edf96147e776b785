// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace grouser::multibody::detail {

/// Anderson acceleration (1965, J. ACM 12:547; as in Walker and Ni 2011, SIAM J. Numer. Anal. 49:1715) of z <- z +
/// f(z), which also converges if the plain iteration diverges in a few directions. From the last changes dZ of the
/// iterate and dF of its correction it computes
///   gamma = argmin |f - dF gamma|,   z <- z + f - (dZ + dF) gamma.
/// For a linear problem this is equivalent to GMRES.
class AndersonAcceleration {
public:
  static constexpr std::size_t kMemory = 8;

  /// Allocates storage for vectors of `size` numbers.
  explicit AndersonAcceleration(std::size_t size) : lastZ_(size), lastF_(size) {
    for (std::size_t j = 0; j < kMemory; ++j) dZ_[j].resize(size), dF_[j].resize(size), q_[j].resize(size);
  }

  void reset() { count_ = 0, started_ = false; }

  /// Improves the correction `f` of the iterate `z` in place; uses the first n entries. `weight` >= 0: norm weights.
  void improve(const std::vector<double>& z, std::vector<double>& f, const std::vector<double>& weight, std::size_t n) {
    if (started_) {
      // Drop the oldest pair.
      if (count_ == kMemory) {
        std::rotate(dZ_.begin(), dZ_.begin() + 1, dZ_.end());
        std::rotate(dF_.begin(), dF_.begin() + 1, dF_.end());
        --count_;
      }
      for (std::size_t i = 0; i < n; ++i) dZ_[count_][i] = z[i] - lastZ_[i], dF_[count_][i] = f[i] - lastF_[i];
      ++count_;
    }
    started_ = true;
    std::copy(z.begin(), z.begin() + static_cast<std::ptrdiff_t>(n), lastZ_.begin());
    std::copy(f.begin(), f.begin() + static_cast<std::ptrdiff_t>(n), lastF_.begin());
    const auto dot = [&](const std::vector<double>& a, const std::vector<double>& b) {
      double sum = 0;
      for (std::size_t i = 0; i < n; ++i) sum += weight[i] * a[i] * b[i];
      return sum;
    };
    // Modified Gram-Schmidt, newest pair first; s_j is the combination of dZ + dF that corresponds to q_j.
    std::array<bool, kMemory> used{};
    std::array<std::array<double, kMemory>, kMemory> R{};
    std::array<double, kMemory> target{};
    for (std::size_t j = count_; j-- > 0;) {
      std::vector<double>& q = q_[j];
      std::copy(dF_[j].begin(), dF_[j].begin() + static_cast<std::ptrdiff_t>(n), q.begin());
      const double before = dot(q, q);
      for (std::size_t m = count_; m-- > j + 1;) {
        if (!used[m]) continue;
        R[m][j] = dot(q_[m], q);
        for (std::size_t i = 0; i < n; ++i) q[i] -= R[m][j] * q_[m][i];
      }
      const double size = dot(q, q);
      if (!(size > 1e-16 * before)) continue;
      used[j] = true;
      R[j][j] = std::sqrt(size);
      for (std::size_t i = 0; i < n; ++i) q[i] /= R[j][j];
      target[j] = dot(q, lastF_);
    }
    // gamma by back substitution: the last column processed is j = 0.
    std::array<double, kMemory> gamma{};
    for (std::size_t j = 0; j < count_; ++j) {
      if (!used[j]) continue;
      double g = target[j];
      for (std::size_t m = 0; m < j; ++m)
        if (used[m]) g -= R[j][m] * gamma[m];
      gamma[j] = g / R[j][j];
      for (std::size_t i = 0; i < n; ++i) f[i] -= gamma[j] * (dZ_[j][i] + dF_[j][i]);
    }
  }

private:
  std::size_t count_ = 0;
  bool started_ = false;
  std::vector<double> lastZ_, lastF_;
  std::array<std::vector<double>, kMemory> dZ_, dF_, q_;
};

} // namespace grouser::multibody::detail
