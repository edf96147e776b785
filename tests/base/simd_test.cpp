// SPDX-License-Identifier: BSD-3-Clause
#include "base/simd_rows.hpp"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <vector>

namespace grouser::base {
namespace {

template <class V> V counted(int first) {
  V v{};
  for (int l = 0; l < kWidthOf<V>; ++l) v[l] = static_cast<ScalarOf<V>>(first + l);
  return v;
}

TEST(Simd, BroadcastKeepsEveryBit) {
  for (const float x : {0.0f, -0.0f, 1e-42f, -3.5f, std::numeric_limits<float>::infinity()}) {
    const auto v = broadcast<Simd<float, 8>>(x);
    for (int l = 0; l < 8; ++l) EXPECT_EQ(std::bit_cast<std::uint32_t>(v[l]), std::bit_cast<std::uint32_t>(x));
  }
}

TEST(Simd, SquareRootIsThatOfTheNumberAlone) {
  const auto v = counted<Simd<float, 16>>(2);
  const auto w = counted<Simd<double, 4>>(2);
  for (int l = 0; l < 16; ++l) EXPECT_EQ(squareRoot(v)[l], std::sqrt(v[l]));
  for (int l = 0; l < 4; ++l) EXPECT_EQ(squareRoot(w)[l], std::sqrt(w[l]));
}

/// One lane at a time.
template <class V> void expectMasks() {
  for (int l = 0; l < kWidthOf<V>; ++l) {
    const auto mask = counted<V>(0) == broadcast<V>(static_cast<ScalarOf<V>>(l));
    EXPECT_EQ(laneBits(mask), 1u << l);
    EXPECT_TRUE(any(mask));
    EXPECT_EQ(laneBits(!mask), ((1u << kWidthOf<V>)-1) ^ 1u << l);
  }
  EXPECT_FALSE(any(counted<V>(0) < V{}));
  EXPECT_EQ(laneBits(counted<V>(0) < V{}), 0u);
}
TEST(Simd, MasksHaveABitForEachLane) {
  expectMasks<Simd<float, 4>>();
  expectMasks<Simd<float, 8>>();
  expectMasks<Simd<float, 16>>();
  expectMasks<Simd<double, 4>>();
  EXPECT_TRUE(any(true));
  EXPECT_FALSE(any(false));
}

TEST(Simd, ChoosesLaneByLane) {
  using V = Simd<float, 4>;
  const V x = counted<V>(0);
  const auto small = x < broadcast<V>(2);
  const Vec3<V> v = select(small, Vec3<V>{x, x, x}, broadcast<V>(Vec3f{7, 8, 9}));
  EXPECT_EQ(v.x[1], 1);
  EXPECT_EQ(v.x[2], 7);
  EXPECT_EQ(v.z[3], 9);
  EXPECT_EQ(absolute(V{-1, 2, -3, 0})[2], 3);
  EXPECT_EQ(clamped(Int4{-9, 2, 9, 3}, -4, 3)[0], -4);
  EXPECT_EQ(clamped(Int4{-9, 2, 9, 3}, -4, 3)[2], 3);
}

template <class V> void expectTransposed() {
  V r[4];
  for (int k = 0; k < 4; ++k) r[k] = counted<V>(100 * k);
  transpose(r);
  for (int k = 0; k < 4; ++k)
    for (int l = 0; l < kWidthOf<V>; ++l) EXPECT_EQ(r[k][l], 100 * (l % 4) + l / 4 * 4 + k) << k << " " << l;
  transpose(r);
  for (int k = 0; k < 4; ++k) EXPECT_FALSE(any(r[k] != counted<V>(100 * k)));
}
TEST(Simd, TransposesBlocksOfFour) {
  expectTransposed<Simd<float, 4>>();
  expectTransposed<Simd<float, 8>>();
  expectTransposed<Simd<std::int32_t, 16>>();
  expectTransposed<Simd<double, 4>>();
}

/// Numbers of one item share a lane, and return to their row.
template <class V> void expectRows() {
  constexpr int kWidth = kWidthOf<V>;
  std::array<Float4, kWidth> rows, back{};
  for (std::size_t i = 0; i < kWidth; ++i) rows[i] = counted<Float4>(static_cast<int>(10 * i));
  V lanes[4];
  loadRows(rows.data(), lanes);
  for (int l = 0; l < kWidth; ++l)
    for (int k = 0; k < 4; ++k) EXPECT_EQ(lanes[k][l], lanes[0][l] + static_cast<float>(k));
  storeRows(back.data(), lanes);
  for (std::size_t i = 0; i < kWidth; ++i) EXPECT_FALSE(any(rows[i] != back[i]));
}
TEST(Simd, RowsGoIntoLanesAndBack) {
  expectRows<Simd<float, 4>>();
  expectRows<Simd<float, 8>>();
  expectRows<Simd<float, 16>>();
}

template <int kWidth> void expectGathered() {
  std::array<Int4, 40> records;
  for (std::size_t i = 0; i < 40; ++i) records[i] = counted<Int4>(static_cast<int>(10 * i));
  std::array<std::uint32_t, kWidth> which;
  for (std::size_t l = 0; l < kWidth; ++l) which[l] = static_cast<std::uint32_t>(39 - 2 * l);
  Simd<std::int32_t, kWidth> out[4];
  gatherRows<kWidth>(records.data(), which.data(), out);
  for (int k = 0; k < 4; ++k)
    for (int l = 0; l < kWidth; ++l) EXPECT_EQ(out[k][l], 10 * (39 - 2 * l) + k);
}
TEST(Simd, GathersRecordsByTheirNumbers) {
  expectGathered<4>();
  expectGathered<8>();
  expectGathered<16>();
  const double row[8] = {0, 1, 2, 3, 4, 5, 6, 7};
  const double* const rows[4] = {row, row + 1, row + 2, row + 3};
  Double4 out[4];
  gatherRows(rows, 1, out);
  for (int k = 0; k < 4; ++k)
    for (int l = 0; l < 4; ++l) EXPECT_EQ(out[k][l], 1 + k + l);
}

template <class V> void expectMarked() {
  for (const unsigned marks : {0u, 1u, 0x8u, 0x5u, 0xFu}) {
    std::array<std::int32_t, 2 * kWidthOf<V>> to{};
    storeMarked(to.data(), counted<V>(50), marks);
    std::size_t n = 0;
    for (int l = 0; l < kWidthOf<V>; ++l) {
      if (!(marks >> l & 1u)) continue;
      EXPECT_EQ(to[n++], 50 + l);
    }
  }
}
TEST(Simd, StoresWhatIsMarkedSideBySide) {
  expectMarked<Simd<std::int32_t, 4>>();
  expectMarked<Simd<std::int32_t, 8>>();
  expectMarked<Simd<std::int32_t, 16>>();
}

TEST(Simd, ThreeNumbersLeaveTheFourthAlone) {
  float four[4] = {1, 2, 3, 4};
  EXPECT_EQ(load3(four)[2], 3);
  EXPECT_EQ(load3(four)[3], 0) << "not the following number";
  store3(four, Float4{5, 6, 7, 8});
  EXPECT_EQ(four[2], 7);
  EXPECT_EQ(four[3], 4);
}

TEST(Simd, ConvertsAsOneNumberDoes) {
  const Float4 x{1.5f, -2.75f, 3e9f, -0.0f};
  const Double4 y{1.5, -2.75, 0.49999999, -7.99};
  for (int l = 0; l < 4; ++l) {
    EXPECT_EQ(toDouble(x)[l], static_cast<double>(x[l]));
    EXPECT_EQ(toFloat(y)[l], static_cast<float>(y[l]));
    EXPECT_EQ(toInt(y)[l], static_cast<std::int32_t>(y[l]));
    EXPECT_EQ(roundedDown(y)[l], std::floor(y[l]));
    EXPECT_EQ(convert<std::int64_t>(Int4{} - 5)[l], std::int64_t{-5});
  }
}

} // namespace
} // namespace grouser::base
