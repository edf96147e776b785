// SPDX-License-Identifier: BSD-3-Clause
#include "base/array.hpp"
#include "base/carry.hpp"
#include "tests/device_under_test.hpp"

#include <gtest/gtest.h>

#include <array>
#include <stdexcept>

namespace grouser::base {
namespace {

TEST(Carry, ThereAndBackAgainBesideZeros) {
  const Exec exec = testExec(2);
  Mirrored<double> sent(exec, 1001), back(exec, 1001);
  Array<std::uint64_t> cleared(exec, std::vector<std::uint64_t>(333, 7));
  for (std::size_t i = 0; i < sent.size(); ++i) sent.host()[i] = 0.5 * static_cast<double>(i), back.host()[i] = -1;
  carry(exec, std::array{Parcel{sent.device().data(), sent.host(), sent.bytes()}, Parcel{nullptr, nullptr, 0},
                         Parcel{cleared.data(), nullptr, 332 * 8}});
  carry(exec, std::array{Parcel{back.host(), sent.device().data(), back.bytes()}});
  synchronize(exec);
  for (std::size_t i = 0; i < sent.size(); ++i) ASSERT_EQ(back.host()[i], 0.5 * static_cast<double>(i));
  const std::vector<std::uint64_t> left = cleared.toHost();
  for (std::size_t i = 0; i < 332; ++i) ASSERT_EQ(left[i], 0u);
  EXPECT_EQ(left[332], 7u);
}

TEST(Carry, RefusesWhatOneLaunchCannotTake) {
  double x = 0;
  EXPECT_THROW(carry(cpuExec(1), std::array{Parcel{&x, nullptr, 4}}), std::logic_error);
  EXPECT_THROW(carry(cpuExec(1), std::array<Parcel, 5>{}), std::logic_error);
}

} // namespace
} // namespace grouser::base
