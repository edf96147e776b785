// SPDX-License-Identifier: BSD-3-Clause
// Ramps and controls with unique values, separately left and right.
#include "vehicle/assembly.hpp"
#include "vehicle/driver.hpp"

#include "base/math.hpp"
#include "vehicle/spec_file.hpp"

#include <gtest/gtest.h>

using namespace grouser;

TEST(SmoothRamp, IsTheCubicWithoutSlopeAtItsEnds) {
  // 3 s^2 - 2 s^3 with s = (t - 2) / 0.4.
  for (const auto& [time, wanted] : {std::pair{2.1, 0.15625}, {2.2, 0.5}, {2.3, 0.84375}, {2.36, 0.972}})
    EXPECT_NEAR(vehicle::smoothRamp(time, 2, 0.4), wanted, 1e-12) << time;
  EXPECT_EQ(vehicle::smoothRamp(1.9, 2, 0.4), 0);
  EXPECT_EQ(vehicle::smoothRamp(2.4, 2, 0.4), 1);
}

TEST(Controls, GoToTheTensionersBarsAndSprocketsOfTheirSide) {
  const vehicle::Assembly v =
      vehicle::assemble(vehicle::readVehicleSpec(GROUSER_SOURCE_DIR "/assets/vehicles/light_tracked.toml"));
  multibody::Loads loads = multibody::makeLoads(v.model);
  vehicle::Controls controls;
  controls.tension = 0.25, controls.weight = 0.5, controls.sprocketSpeed = {3, -7};
  vehicle::applyControls(v, controls, {1, -2, -8}, loads);
  EXPECT_EQ(loads.gravity, (base::Vec3d{0.5, -1, -4}));
  for (std::size_t track = 0; track < 2; ++track) {
    const vehicle::Track& t = v.tracks[track];
    EXPECT_EQ(t.y > 0, track == 0) << "left first";
    EXPECT_EQ(loads.axisSprings[static_cast<std::size_t>(t.tensioner)].loadFactor, 0.25);
    for (const int bar : t.armSprings) EXPECT_EQ(loads.axisSprings[static_cast<std::size_t>(bar)].loadFactor, 0.5);
    // 5 kN on the wheel at the end of an arm of 0.25 m inclined by 20 degrees; the bar resists it.
    const multibody::AxisSpring& bar = v.model.axisSprings()[static_cast<std::size_t>(t.armSprings[1])];
    EXPECT_NEAR(bar.preload, -5000 * 0.25 * base::cos(base::kPi / 9), 1e-9);
    EXPECT_EQ(loads.drives[static_cast<std::size_t>(t.drive)].speed, track == 0 ? 3 : -7);
  }
}
