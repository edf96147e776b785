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

/// Reads the shipped file with `from` replaced by `to`; returns the error message, or "".
std::string refusalAfter(const std::string& from, const std::string& to) {
  std::stringstream text;
  text << std::ifstream(kVehicle).rdbuf();
  std::string content = text.str();
  const std::size_t at = content.find(from);
  if (at == std::string::npos) return "not in the file: " + from;
  content.replace(at, from.size(), to);
  // The process id is part of the name: tests run in parallel.
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
    EXPECT_NE(text.find("not physical"), std::string::npos) << inertia << text;
  }
}

TEST(VehicleSpec, RollersOfUnequalLists_AreRefused) {
  const std::string text = refusalAfter("x = [0.70, 1.38, 2.06]", "x = [0.70, 1.38]");
  EXPECT_NE(text.find("roller.z"), std::string::npos) << text;
}

namespace {

/// A modified key, as passed by a scene.
vehicle::SpecKey changed(const std::string& section, const std::string& key, base::Node::List list) {
  return {section, key, base::Node{"scene.toml:7", std::move(list)}, ""};
}
vehicle::SpecKey changed(const std::string& section, const std::string& key, double value) {
  return {section, key, base::Node{"scene.toml:7", value}, ""};
}

std::string refusalOf(const vehicle::SpecSource& source) {
  try {
    vehicle::readVehicleSpec(source);
  } catch (const base::InputError& error) {
    return error.what();
  }
  return "";
}

} // namespace

TEST(VehicleSpec, ChangedKeysStandInPlaceOfTheFiles) {
  const vehicle::VehicleSpec spec =
      vehicle::readVehicleSpec({kVehicle, {changed("shoe", "pin_damping", 7.5), changed("idler", "preload", 9000.0)}});
  EXPECT_EQ(spec.shoe.pinDamping, 7.5);
  EXPECT_EQ(spec.idler.preload, 9000);
  EXPECT_EQ(spec.shoe.mass, 8.5);
}

TEST(VehicleSpec, FaultOfAChangedKeyNamesBothPlaces) {
  const std::string text = refusalOf({kVehicle, {changed("road_wheel", "spacing", 0.2)}});
  for (const char* word : {"scene.toml:7", "light_tracked.toml", "road_wheel.spacing = 0.2", "overlap"})
    EXPECT_NE(text.find(word), std::string::npos) << word << ": " << text;
}

TEST(VehicleSpec, WithoutRollersNothingIsAskedOfThem) {
  const base::Node::List none;
  const vehicle::VehicleSpec spec =
      vehicle::readVehicleSpec({kVehicle, {changed("roller", "x", none), changed("roller", "z", none)}});
  EXPECT_TRUE(spec.roller.x.empty());
  EXPECT_NEAR(spec.totalMass(), 5018 - 6 * 6, 1e-11);
}

TEST(VehicleSpec, SprungArmsNeedTheirSpring) {
  for (const char* line : {"stiffness = 7700.0 ", "damping = 300.0 ", "preload = 5000.0 "}) {
    const std::string text = refusalAfter(line, "# ");
    EXPECT_NE(text.find("required for sprung arms"), std::string::npos) << line << text;
    EXPECT_EQ(refusalAfter(line, "suspension = \"rigid\" # "), "") << line;
  }
}

TEST(VehicleSpec, EnginesAreCheckedTogether) {
  const std::string engine = "[engine]\nspeed = [0.0, 100.0]\ntorque = [300.0, 200.0]\nratio = 20.0\n"
                             "governed_speed = 150.0\ndroop = 10.0\ninertia = 40.0\n\n[contact]";
  EXPECT_EQ(refusalAfter("[contact]", engine), "");
  const auto broken = [&](const std::string& from, const std::string& to) {
    std::string text = engine;
    return refusalAfter("[contact]", text.replace(text.find(from), from.size(), to));
  };
  EXPECT_NE(broken("[300.0, 200.0]", "[300.0]").find("engine.torque"), std::string::npos);
  EXPECT_NE(broken("[0.0, 100.0]", "[100.0, 0.0]").find("does not increase"), std::string::npos);
  EXPECT_NE(broken("[300.0, 200.0]", "[0.0, 0.0]").find("0 at all speeds"), std::string::npos);
  EXPECT_NE(broken("inertia = 40.0\n", "").find("inertia"), std::string::npos);
}
