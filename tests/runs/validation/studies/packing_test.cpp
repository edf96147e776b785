// SPDX-License-Identifier: BSD-3-Clause
// Macroscopic studies on samples small enough for a test.
#include "runs/validation/studies/packing.hpp"

#include <gtest/gtest.h>

namespace grouser::studies {
namespace {

TEST(StudyPacking, FrictionlessIsDenserAndHoldsMoreContacts) {
  virtual_tests::SampleGrains smooth, rough;
  smooth.friction = 0, smooth.stiffness = rough.stiffness = 1e4; // softer: a longer step
  const Packing dense = pourPacking(smooth, 480, 6, 1), loose = pourPacking(rough, 480, 6, 1);
  // Random close packing 0.634 to 0.64, isostatic 6; a small sample scatters by 0.005, and soft grains overlap.
  EXPECT_NEAR(dense.solidFraction, 0.637, 0.015);
  EXPECT_NEAR(dense.coordinationWithoutRattlers, 6.2, 0.5);
  // Poured with friction: 0.58 to 0.62; coordination between 4, with infinite friction, and 6.
  EXPECT_NEAR(loose.solidFraction, 0.60, 0.02);
  EXPECT_NEAR(loose.coordinationWithoutRattlers, 4.9, 0.5);
  EXPECT_LT(loose.overlap, 2e-3);
}

} // namespace
} // namespace grouser::studies
