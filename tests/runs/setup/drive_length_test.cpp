// SPDX-License-Identifier: BSD-3-Clause
// Warnings on runs too short for means over steady driving.
#include "runs/setup/drive_length.hpp"
#include "runs/setup/load_scene.hpp"

#include "base/math.hpp"
#include "runs/scene/scene.hpp"
#include "vehicle/spec_file.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fmt/format.h>

namespace grouser::setup {
namespace {

/// Tension and weight are complete at 0.45 s; then the drive ramps up over 0.3 s. Ten teeth per turn.
scene::Scene driven(const std::string& driver, double duration) {
  return parseScene(fmt::format("version = 1\n[run]\nduration = {}\n[material.steel]\nstiffness = 1e6\n[terrain]\n"
                                "kind = \"rigid\"\nheightmap = \"heightmaps/flat.png\"\nsize = [20, 3]\n"
                                "height_range = [0, 0]\nmaterial = \"steel\"\n[vehicle]\n"
                                "spec = \"vehicles/light_tracked.toml\"\nposition = [4, 0]\n{}",
                                duration, driver),
                    GROUSER_SOURCE_DIR "/tests/scenes/rigid.toml");
}
/// Number of teeth for an angle in radians.
double teeth(double radians) { return radians * 10 / (2 * base::kPi); }

/// Midpoints of 2000 parts of a smooth ramp and of straight lines: to 1e-5.
TEST(DriveLength, TeethAreThoseOfTheSpeedsBehindTheRamps) {
  const std::string plain = "[driver]\nsprocket_speed = 2\n";
  EXPECT_NEAR(requestedTeeth(driven(plain, 1)), teeth(2 * (0.55 - 0.15)), 1e-5);
  EXPECT_NEAR(requestedTeeth(driven("[driver]\nsprocket_speed = -2\n", 1)), teeth(2 * (0.55 - 0.15)), 1e-5)
      << "in reverse";
  EXPECT_NEAR(requestedTeeth(driven("[driver]\nleft = 0\nright = -3\n", 1.45)), teeth(3 * 0.85), 1e-5)
      << "the faster one";
  EXPECT_NEAR(requestedTeeth(driven("[driver]\nsprocket_speed = 2\ndrive_start = 0.9\n", 1.45)), teeth(2 * 0.4), 1e-5);
  EXPECT_NEAR(requestedTeeth(driven("[driver.table]\ntime = [0, 1, 2]\nleft = [0, 2, -2]\nright = [0, 2, -2]\n", 2.45)),
              teeth(2), 1e-5)
      << "back and forth";
  EXPECT_NEAR(requestedTeeth(driven("[driver.course]\nspeed = 1\nacceleration = 2\n", 1.45)),
              teeth(0.75 / (10 * 0.154 / (2 * base::kPi))), 1e-5);
  // On a circle of 2 m the outer track, about 0.9 m from the middle, travels farther by that share.
  const scene::Scene circle = driven("[driver.course]\nspeed = 1\nacceleration = 2\nradius = -2\n", 1.45);
  const double offset = vehicle::readVehicleSpec(GROUSER_SOURCE_DIR "/assets/vehicles/light_tracked.toml").trackOffset;
  ASSERT_GT(offset, 0.5);
  EXPECT_NEAR(requestedTeeth(circle), teeth(0.75 * (1 + offset / 2) / (10 * 0.154 / (2 * base::kPi))), 1e-5);
  EXPECT_EQ(requestedTeeth(driven(plain, 0.4)), 0);
  EXPECT_TRUE(std::isinf(requestedTeeth(driven("[driver]\ndrive = \"torque\"\ntorque = 500\n", 1))));
}

TEST(DriveLength, AShortDriveIsSaidBefore) {
  const std::string never = shortDriveWarning(driven("[driver]\nsprocket_speed = 2\n", 0.4));
  EXPECT_EQ(never, "the vehicle never drives (its sprockets start at 0.45 s at the earliest, the run ends at 0.4 s); "
                   "raise run.duration");
  const std::string half = shortDriveWarning(driven("[driver]\nsprocket_speed = 2\ndrive_start = 0.5\n", 1));
  EXPECT_EQ(half, "the vehicle drives at most 1.1 teeth (its sprockets start at 0.5 s, the run ends at 1 s), and "
                  "results from fewer than 2 teeth are inconclusive; raise run.duration");
  EXPECT_EQ(shortDriveWarning(driven("[driver]\nsprocket_speed = 2\n", 3)), "");
  // A ramp that has hardly started counts as no drive.
  EXPECT_EQ(shortDriveWarning(driven("[driver]\nsprocket_speed = 2\ndrive_start = 0.5\n", 0.51)).find("never drives"),
            std::string("the vehicle ").size());
}

/// A ramp of 3 s to 2 rad/s passes 4.8 teeth at the end of the run.
TEST(DriveLength, WarnsOfADriveWithoutSteadyMotion) {
  const std::string slow = "[driver]\nsprocket_speed = 2\ndrive_start = 0.5\ndrive_ramp = 3\n";
  EXPECT_EQ(requestedTeeth(driven(slow, 3.5), true), 0);
  EXPECT_NEAR(requestedTeeth(driven(slow, 4.5), true), teeth(2), 0.01) << "to one of 2000 parts of the time";
  EXPECT_EQ(shortDriveWarning(driven(slow, 3.6)),
            "the steady part of the drive covers less than one sprocket tooth (the ramp ends at 3.5 s, the run ends at "
            "3.6 s), so means over steady motion are inconclusive; raise run.duration");
  EXPECT_EQ(shortDriveWarning(driven(slow, 4.5)), "");
  const std::string course = "[driver.course]\nspeed = 1\nacceleration = 0.25\n";
  EXPECT_NE(shortDriveWarning(driven(course, 4.5)).find("ramp ends at 4.45 s at the earliest"), std::string::npos);
  EXPECT_EQ(shortDriveWarning(driven(course, 5)), "");
}

TEST(DriveLength, TheRemedyOfATableThatStopsIsTheTable) {
  const std::string stops = "[driver.table]\ntime = [0, 0.2, 0.4]\nleft = [0, 5, 0]\nright = [0, 5, 0]\n";
  const auto endsWith = [](const std::string& text, const std::string& end) { return text.ends_with(end); };
  EXPECT_TRUE(endsWith(shortDriveWarning(driven(stops, 2.6)), "; raise the speeds or times of driver.table"));
  EXPECT_TRUE(endsWith(shortDriveWarning(driven(stops, 0.6)), "; raise run.duration")) << "it ends within the table";
  EXPECT_TRUE(endsWith(longerDriveRemedy(driven("[driver]\nsprocket_speed = 2\n", 2.6)), "raise run.duration"));
}

/// A vehicle that only rests, or is pulled by its hitch, is complete without any tooth.
TEST(DriveLength, WhoIsNotAskedToDriveNeedNot) {
  for (const char* driver : {"[driver]\nsprocket_speed = 0\n", "[driver]\nleft = 0\nright = 0\n",
                             "[driver]\ndrive = \"torque\"\ntorque = 0\n",
                             "[driver.table]\ntime = [0, 1]\nleft = [0, 0]\nright = [0, 0]\n"}) {
    EXPECT_FALSE(commandsDrive(driven(driver, 0.1))) << driver;
    EXPECT_EQ(shortDriveWarning(driven(driver, 0.1)), "") << driver;
  }
  for (const char* driver :
       {"[driver]\nleft = 0\nright = 1\n", "[driver]\ndrive = \"torque\"\nleft_torque = 0\nright_torque = -5\n",
        "[driver.course]\nspeed = -1\n", "[driver.table]\ntime = [0, 1]\nleft = [0, 0]\nright = [0, 2]\n"})
    EXPECT_TRUE(commandsDrive(driven(driver, 0.1))) << driver;
}

} // namespace
} // namespace grouser::setup
