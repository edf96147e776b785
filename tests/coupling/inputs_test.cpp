// SPDX-License-Identifier: BSD-3-Clause
#include "coupling/inputs.hpp"

#include "base/error.hpp"

#include <gtest/gtest.h>

namespace grouser::coupling {
namespace {

Input speed(std::int64_t step, std::int32_t side, double value) {
  return {step, InputKind::sprocketSpeed, side, false, {value}};
}

TEST(Inputs, ActUntilTheyAreSetAgainOrReleased) {
  Inputs inputs;
  inputs.set(speed(0, 0, 1));
  inputs.set(speed(10, 0, 2));
  inputs.set(speed(10, 1, 3));
  EXPECT_EQ(inputs.now(InputKind::sprocketSpeed, 0)->front(), 2);
  EXPECT_EQ(inputs.now(InputKind::sprocketSpeed, 1)->front(), 3);
  EXPECT_FALSE(inputs.now(InputKind::throttle, 0));
  inputs.set({20, InputKind::sprocketSpeed, 0, true, {}});
  EXPECT_FALSE(inputs.now(InputKind::sprocketSpeed, 0));
  EXPECT_EQ(inputs.series().size(), 4u);
}

TEST(Inputs, OfOneStepTheLastCounts) {
  Inputs inputs;
  inputs.set(speed(5, 0, 1)), inputs.set(speed(5, 1, 4)), inputs.set(speed(5, 0, 2));
  ASSERT_EQ(inputs.series().size(), 2u);
  EXPECT_EQ(inputs.series().front().value.front(), 2);
}

TEST(Inputs, TheHashIsOfWhatActsInWhateverOrderItWasSet) {
  Inputs one, other, none;
  one.set(speed(0, 0, 1)), one.set(speed(0, 1, 2));
  other.set(speed(0, 1, 7)), other.set(speed(3, 1, 2)), other.set(speed(3, 0, 1));
  EXPECT_EQ(one.words(), other.words());
  EXPECT_TRUE(none.words().empty());
  other.set(speed(3, 0, 1.5));
  EXPECT_NE(one.words(), other.words()) << "another speed";
  other.set({4, InputKind::sprocketSpeed, 0, true, {}}), other.set({4, InputKind::sprocketSpeed, 1, true, {}});
  EXPECT_TRUE(other.words().empty());
}

TEST(Inputs, AreRestoredAsTheyWereSaved) {
  Inputs inputs, again;
  inputs.set({7, InputKind::bodyLoad, 3, false, {1, -2, 3e-7, 4, 5, 0.1}});
  inputs.set({9, InputKind::gravity, 0, false, {0, 0, -1.62}});
  again.restore(inputs.save());
  EXPECT_EQ(again.series(), inputs.series());
  EXPECT_EQ(again.words(), inputs.words());
  EXPECT_THROW(again.restore({1, 2, 3}), base::InputError);
  std::vector<double> unknown = inputs.save();
  unknown[1] = 99; // a kind of a later program version
  EXPECT_THROW(again.restore(unknown), base::InputError);
}

} // namespace
} // namespace grouser::coupling
