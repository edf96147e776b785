// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle/spec_file.hpp"

#include "base/error.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <unistd.h>

using namespace grouser;

namespace {

const std::string kVehicle = GROUSER_SOURCE_DIR "/assets/vehicles/light_tracked.toml";

/// The shipped file with `from` replaced by `to`, read; the message of the refusal, or "".
std::string refusalAfter(const std::string& from, const std::string& to) {
  std::stringstream text;
  text << std::ifstream(kVehicle).rdbuf();
  std::string content = text.str();
  const std::size_t at = content.find(from);
  if (at == std::string::npos) return "not in the file: " + from;
  content.replace(at, from.size(), to);
  // Named by the process: tests run side by side.
  const auto path = std::filesystem::temp_directory_path() / ("grouser_spec_" + std::to_string(getpid()) + ".toml");
  std::ofstream(path) << content;
  std::string message;
  try {
    vehicle::readVehicleSpec(path.string());
  } catch (const base::InputError& error) {
    message = error.what();
  }
  std::filesystem::remove(path);
  return message;
}

} // namespace

TEST(VehicleSpec, LightVehicle_WeighsFiveTons) {
  const vehicle::VehicleSpec spec = vehicle::readVehicleSpec(kVehicle);
  // Sum of decimal masses: round-off of 5e3.
  EXPECT_NEAR(spec.totalMass(), 5018.0, 1e-11);
  EXPECT_NEAR(spec.groundPinHeight(), -0.40, 1e-15);
  EXPECT_NEAR(spec.groundHeight(), -0.455, 1e-15);
  EXPECT_NEAR(spec.pitchRadius(), 0.245099, 5e-7);
  EXPECT_NEAR(spec.sprocketPinRadius(), 0.249177, 5e-7);
  EXPECT_EQ(std::filesystem::path(spec.meshFolder), std::filesystem::path(GROUSER_SOURCE_DIR "/assets/meshes"));
}

TEST(VehicleSpec, UnknownKey_IsRefusedWithTheNearest) {
  const std::string text = refusalAfter("plate_top", "plate_tip");
  EXPECT_NE(text.find("plate_tip"), std::string::npos) << text;
  EXPECT_NE(text.find("plate_top"), std::string::npos) << text;
}

TEST(VehicleSpec, WrongNumbers_AreRefused) {
  EXPECT_NE(refusalAfter("count = 46", "count = 4").find("shoe.count"), std::string::npos);
  EXPECT_NE(refusalAfter("mass = 8.5", "mass = -8.5").find("shoe.mass"), std::string::npos);
  EXPECT_NE(refusalAfter("pin_damping = 5.0", "").find("pin_damping"), std::string::npos);
}

TEST(VehicleSpec, ImpossibleInertia_IsRefused) {
  for (const char* inertia : {"[0.101, 0.020, 0.080]", "[0.064, 0.145, 0.080]", "[0.064, 0.020, 0.090]"}) {
    const std::string text = refusalAfter("[0.064, 0.020, 0.080]", inertia);
    EXPECT_NE(text.find("no solid body"), std::string::npos) << inertia << text;
  }
}

TEST(VehicleSpec, RollersOfUnequalLists_AreRefused) {
  const std::string text = refusalAfter("x = [0.70, 1.38, 2.06]", "x = [0.70, 1.38]");
  EXPECT_NE(text.find("roller.z"), std::string::npos) << text;
}
