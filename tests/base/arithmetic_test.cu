// SPDX-License-Identifier: BSD-3-Clause
// Requirements of bitwise equal results on all machines: no fused multiply-add, and the project's own functions.
#include "base/array.hpp"
#include "base/bits.hpp"
#include "base/for_each.cuh"
#include "base/hash.hpp"
#include "base/math.hpp"
#include "base/moderate.hpp"
#include "tests/device_under_test.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>

namespace grouser::base {
namespace {

/// out = a b - c, which is 0 where the product is rounded before the difference, and its rounding error where it is
/// not.
template <class Real> struct ProductLess {
  const Real *a, *b, *c;
  Real* out;
  GROUSER_HD void operator()(int i) const { out[i] = a[i] * b[i] - c[i]; }
};

template <class Real> void expectNoFusedMultiplyAdd(const Exec& exec) {
  std::vector<Real> a, b, c;
  int inexact = 0;
  for (int i = 0; i < 64; ++i) {
    a.push_back(Real(1) + Real(i + 1) / Real(97)), b.push_back(Real(1) - Real(i + 1) / Real(89));
    volatile Real product = a.back() * b.back(); // rounded, whatever the compiler
    c.push_back(Real(product));
    inexact += std::fma(a.back(), b.back(), -c.back()) != 0;
  }
  ASSERT_GT(inexact, 32) << "these products show a fused multiply-add";
  const Array<Real> x(exec, a), y(exec, b), z(exec, c);
  Array<Real> out(exec, a.size());
  forEach(exec, "multiply and subtract", static_cast<std::int64_t>(a.size()),
          ProductLess<Real>{x.data(), y.data(), z.data(), out.data()});
  for (const Real difference : out.toHost()) EXPECT_EQ(difference, Real(0));
}

TEST(Arithmetic, ProductsAreRoundedBeforeTheyAreAdded) {
  expectNoFusedMultiplyAdd<float>(testExec(1));
  expectNoFusedMultiplyAdd<double>(testExec(2));
}

/// All functions of base/math.hpp at one place.
struct Functions {
  static constexpr int kEach = 9;
  double* out;
  GROUSER_HD void operator()(int i) const {
    const double x = -20 + 0.0397 * i, positive = 1e-3 + 0.03 * i, share = -1 + i / 512.0;
    double* o = out + kEach * static_cast<std::int64_t>(i);
    o[0] = base::sin(x), o[1] = base::cos(x), o[2] = base::tan(x), o[3] = base::atan(x),
    o[4] = base::atan2(x, positive);
    o[5] = base::atan2(::sqrt((1 - share) * (1 + share)), share), o[6] = base::exp(x), o[7] = base::log(positive),
    o[8] = base::pow(positive, 0.3);
  }
};

TEST(Arithmetic, FunctionsGiveTheSameBitsOnEveryMachine) {
  constexpr int kPlaces = 1024;
  const Exec exec = testExec(2);
  Array<double> out(exec, std::size_t{kPlaces} * Functions::kEach);
  forEach(exec, "functions", kPlaces, Functions{out.data()});
  StateHash hash;
  for (const double value : out.toHost()) {
    ASSERT_TRUE(std::isfinite(value));
    hash.add(std::bit_cast<std::uint64_t>(value));
  }
  EXPECT_EQ(hash.hex(), "563866200355d10c") << "a libm function, a fused multiply-add or another formula";
}

TEST(Arithmetic, FunctionsAreNearThoseOfTheLibrary) {
  const auto near = [](double own, double library) {
    EXPECT_NEAR(own, library, 9e-16 * std::max(1.0, std::fabs(library)));
  };
  for (int i = 0; i < 1024; ++i) {
    const double x = -20 + 0.0397 * i, positive = 1e-3 + 0.03 * i, share = -1 + i / 512.0;
    near(base::sin(x), std::sin(x)), near(base::cos(x), std::cos(x)), near(base::atan(x), std::atan(x));
    near(base::atan2(x, positive), std::atan2(x, positive)), near(base::asin(share), std::asin(share));
    EXPECT_NEAR(base::exp(x) / std::exp(x), 1, 4e-16 * 20);
    near(base::log(positive), std::log(positive));
  }
}

struct CubeRoots {
  double* out;
  GROUSER_HD void operator()(int i) const {
    const double x = base::pow(10.0, -12 + 0.02 * i);
    out[2 * i] = base::cubeRoot(x);
    out[2 * i + 1] = static_cast<double>(base::cubeRoot(static_cast<float>(x)));
  }
};

TEST(Arithmetic, CubeRootsAreNearThoseOfTheLibraryWithTheSameBitsOnEveryMachine) {
  constexpr int kPlaces = 1024;
  const Exec exec = testExec(2);
  Array<double> out(exec, std::size_t{kPlaces} * 2);
  forEach(exec, "cube roots", kPlaces, CubeRoots{out.data()});
  const std::vector<double> roots = out.toHost();
  StateHash hash;
  for (std::size_t i = 0; i < kPlaces; ++i) {
    const double exact = std::cbrt(base::pow(10.0, -12 + 0.02 * static_cast<double>(i)));
    EXPECT_NEAR(roots[2 * i] / exact, 1, 7e-16) << "three units in the last place";
    EXPECT_NEAR(roots[2 * i + 1] / exact, 1, 2.5e-7);
    hash.add(std::bit_cast<std::uint64_t>(roots[2 * i])), hash.add(std::bit_cast<std::uint64_t>(roots[2 * i + 1]));
  }
  EXPECT_EQ(hash.hex(), "f98baaf8a111e527") << "a fused multiply-add or another formula";
  EXPECT_EQ(base::cubeRoot(0.0), 0.0);
  EXPECT_EQ(base::cubeRoot(-1.0f), 0.0f);
}

/// Counts where a function of moderate numbers differs from the operator's correctly rounded result: all fractions of
/// two neighbouring powers of two for root and inverse, as many random pairs for the quotient.
struct ModerateNumbers {
  static constexpr int kCount = 1 << 24;
  std::uint32_t* differ;                               ///< [3]
  GROUSER_HD static float within(std::uint64_t bits) { // from 2^-60 to 2^60
    return bitsAs<float>(static_cast<std::uint32_t>(67 + bits % 120) << 23 |
                         static_cast<std::uint32_t>(bits >> 41 & 0x7FFFFF));
  }
  GROUSER_HD void operator()(int i) const {
    const auto n = static_cast<std::uint32_t>(i);
    const float x = bitsAs<float>((127u << 23) + n), far = within(mix(2 * n)), part = within(mix(2 * n + 1));
    if (moderateRoot(x) != sqrtf(x)) atomicAdd32(differ, 1);
    if (moderateInverse(x) != 1 / x || moderateInverse(far) != 1 / far) atomicAdd32(differ + 1, 1);
    if (moderateQuotient(part, far) != part / far) atomicAdd32(differ + 2, 1);
  }
  GROUSER_HD static std::uint64_t mix(std::uint64_t x) { // splitmix64's, S. Vigna 2015
    x += 0x9E3779B97F4A7C15ull;
    x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9ull;
    x = (x ^ (x >> 27)) * 0x94D049BB133111EBull;
    return x ^ (x >> 31);
  }
};

TEST(Arithmetic, ModerateNumbersAreRoundedAsAllOthers) {
  const Exec exec = testExec(2);
  Array<std::uint32_t> differ(exec, std::vector<std::uint32_t>(3));
  forEach(exec, "moderate numbers", ModerateNumbers::kCount, ModerateNumbers{differ.data()});
  EXPECT_EQ(differ.toHost(), std::vector<std::uint32_t>(3)) << "roots, inverses, quotients";
}

struct Shares {
  const float *part, *whole;
  float* out;
  GROUSER_HD void operator()(int i) const { out[i] = shareOf(part[i], whole[i]); }
};

TEST(Arithmetic, SharesAreQuotientsOfZerosToo) {
  const Exec exec = testExec(1);
  const std::vector<float> part{0.0f, -0.0f, 1.0f, 3.0f, 1e-42f}, whole{2.0f, 2.0f, 3.0f, 1e-30f, 7.0f};
  const Array<float> x(exec, part), y(exec, whole);
  Array<float> out(exec, part.size());
  forEach(exec, "shares", static_cast<std::int64_t>(part.size()), Shares{x.data(), y.data(), out.data()});
  const std::vector<float> share = out.toHost();
  for (std::size_t k = 0; k < part.size(); ++k)
    EXPECT_EQ(std::bit_cast<std::uint32_t>(share[k]), std::bit_cast<std::uint32_t>(part[k] / whole[k]));
}

} // namespace
} // namespace grouser::base
