// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle/wrap.hpp"

#include "base/error.hpp"
#include "base/math.hpp"
#include "tests/vehicle/attitude.hpp"
#include "tests/vehicle/ground_shoes.hpp"
#include "vehicle/spec_file.hpp"

#include <gtest/gtest.h>

using namespace grouser;
using vehicle::VehicleSpec;
using vehicle::Wrap;

namespace {

using grouser::vehicle::testing::kDegree;
const std::string kVehicle = GROUSER_SOURCE_DIR "/assets/vehicles/light_tracked.toml";

std::string refusal(const VehicleSpec& spec) {
  try {
    vehicle::wrapTrack(spec);
  } catch (const base::InputError& error) {
    return error.what();
  }
  return "";
}

} // namespace

TEST(Wrap, LightVehicle_ClosesToRoundOff) {
  const VehicleSpec spec = vehicle::readVehicleSpec(kVehicle);
  const Wrap wrap = vehicle::wrapTrack(spec);
  ASSERT_EQ(wrap.pins.size(), 46u);
  // Round-off of points 3 m from the origin: some ulp of 4e-16 each.
  EXPECT_LE(wrap.closure(), 5e-15);
}

TEST(Wrap, LightVehicle_MatchesTheKnownSolution) {
  const Wrap wrap = vehicle::wrapTrack(vehicle::readVehicleSpec(kVehicle));
  EXPECT_EQ(wrap.counts.sprocket, 5);
  EXPECT_EQ(wrap.counts.rearStrand, 4);
  EXPECT_EQ(wrap.counts.ground, 12);
  EXPECT_EQ(wrap.counts.frontStrand, 3);
  EXPECT_EQ(wrap.counts.idler, 5);
  EXPECT_EQ(wrap.counts.top, 17);
  // Number of digits of the known values.
  EXPECT_NEAR(wrap.idlerX, 2.747351, 5e-7);
  EXPECT_NEAR(wrap.idlerFirstAngle / kDegree, -77.86, 5e-3);
  EXPECT_NEAR(wrap.kinks[3] / kDegree, 10.4, 0.05);
  EXPECT_NEAR(wrap.kinks[4] / kDegree, 6.0, 0.05);
}

TEST(Wrap, GroundRun_LiesUnderAllRoadWheels) {
  const VehicleSpec spec = vehicle::readVehicleSpec(kVehicle);
  const Wrap wrap = vehicle::wrapTrack(spec);
  for (int i = test::firstGroundShoe(wrap); i <= test::lastGroundShoe(wrap); ++i) {
    EXPECT_EQ(wrap.shoeCentre(i).z, spec.groundPinHeight());
    EXPECT_EQ(wrap.shoeAngle(i), 0.0);
  }
  EXPECT_LE(wrap.pins[test::firstGroundShoe(wrap)].x, spec.roadWheel.firstX);
  EXPECT_GE(wrap.pins[test::lastGroundShoe(wrap) + 1].x, spec.roadWheel.firstX + 4 * spec.roadWheel.spacing);
}

TEST(Wrap, EngagedPins_LieInTheSprocketsGaps) {
  const VehicleSpec spec = vehicle::readVehicleSpec(kVehicle);
  const Wrap wrap = vehicle::wrapTrack(spec);
  for (int i = 0; i <= wrap.counts.sprocket; ++i) {
    const double angle = base::atan2(wrap.pins[i].z, wrap.pins[i].x) - wrap.sprocketPhase;
    const double gaps = angle / (36 * kDegree);
    EXPECT_NEAR(gaps, std::floor(gaps + 0.5), 1e-13);
  }
}

TEST(Wrap, PlatesOnTheIdler_TouchItsRim) {
  const VehicleSpec spec = vehicle::readVehicleSpec(kVehicle);
  const Wrap wrap = vehicle::wrapTrack(spec);
  const int first = test::lastGroundShoe(wrap) + 1 + wrap.counts.frontStrand;
  for (int i = first; i < first + wrap.counts.idler; ++i) {
    const vehicle::PlanePoint c = wrap.shoeCentre(i);
    const double middle =
        std::sqrt((c.x - wrap.idlerX) * (c.x - wrap.idlerX) + (c.z - spec.idler.z) * (c.z - spec.idler.z));
    EXPECT_NEAR(middle - spec.shoe.plateTop, spec.idler.radius, 1e-14);
  }
}

TEST(Wrap, LongerVehicleOfFortyEightShoes_Closes) {
  VehicleSpec spec = vehicle::readVehicleSpec(kVehicle);
  spec.shoe.count = 48;
  spec.roadWheel.spacing += spec.shoe.pitch / 4;
  spec.idler.x += spec.shoe.pitch;
  const Wrap wrap = vehicle::wrapTrack(spec);
  EXPECT_EQ(wrap.pins.size(), 48u);
  EXPECT_EQ(wrap.counts.ground, 13);
  EXPECT_LE(wrap.closure(), 1e-14);
}

TEST(Wrap, WheelFurtherBack_StillStandsOnTheGroundRun) {
  // Four pitches of rear strand reach the ground at x = 0.517 m, behind a wheel at 0.545 m but ahead of one at 0.50 m.
  VehicleSpec spec = vehicle::readVehicleSpec(kVehicle);
  spec.roadWheel.firstX = 0.50;
  const Wrap wrap = vehicle::wrapTrack(spec);
  EXPECT_EQ(wrap.counts.rearStrand, 3);
  EXPECT_LE(wrap.pins[test::firstGroundShoe(wrap)].x, 0.50);
}

TEST(Wrap, OddTeeth_TurnTheSprocketByHalfATooth) {
  VehicleSpec spec = vehicle::readVehicleSpec(kVehicle);
  spec.sprocket.teeth = 11;
  spec.idler.slideMin = -0.08, spec.idler.slideMax = 0.08;
  const Wrap wrap = vehicle::wrapTrack(spec);
  const double gap = 2 * base::kPi / 11;
  for (int i = 0; i <= wrap.counts.sprocket; ++i) {
    const double angle = base::atan2(wrap.pins[i].z, wrap.pins[i].x) - wrap.sprocketPhase;
    EXPECT_NEAR(angle / gap, std::floor(angle / gap + 0.5), 1e-13);
  }
}

TEST(Wrap, TwoShoesTooMany_IsRefusedWithTheRemedy) {
  VehicleSpec spec = vehicle::readVehicleSpec(kVehicle);
  spec.shoe.count = 48;
  const std::string text = refusal(spec);
  EXPECT_NE(text.find("set idler.x = 2.88"), std::string::npos) << text;
  EXPECT_NE(text.find("shoe.count"), std::string::npos) << text;
}

TEST(Wrap, HalfTheShoes_IsRefusedWithTheGap) {
  VehicleSpec spec = vehicle::readVehicleSpec(kVehicle);
  spec.shoe.count = 24;
  const std::string text = refusal(spec);
  EXPECT_NE(text.find("does not close"), std::string::npos) << text;
  EXPECT_NE(text.find("set shoe.count = 46"), std::string::npos) << text;
}

TEST(Wrap, PlaneRotation_TurnsXTowardsZ) {
  const base::Vec3d x = base::rotate(vehicle::planeRotation(0.3), {1, 0, 0});
  EXPECT_NEAR(x.x, base::cos(0.3), 1e-16);
  EXPECT_NEAR(x.z, base::sin(0.3), 1e-16);
}
