// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tests/runs/folder_fixture.hpp"

#include <filesystem>
#include <string>

namespace grouser::test {

/// A linear soil of grains of 10 mm, with damping proportional to the radius.
inline constexpr const char* kLoam = R"(version = 1
[soil]
title = "loam"
description = "of tests"
calibrated = true
[material]
density = 2600
law = "linear"
stiffness = 2e5
damping = 50
friction = 0.45
rolling_friction = 0.1
cohesion = 3
[bed]
grain_radius = 0.01
radius_spread = 0.2
porosity = 0.41
calibrated_radii = [0.008, 0.02]
[[published]]
quantity = "phi"
value = 30
unit = "deg"
low = 29
source = "a book"
[[reached]]
quantity = "phi"
value = 29.5
half_width = 0.5
unit = "deg"
grain_radius = 0.01
command = "a command"
)";

/// A single grain of a material.
inline std::string grainOf(const std::string& material, double radius, const std::string& more = "") {
  return "version = 1\n[run]\nduration = 1\n" + more +
         "[[grain]]\nposition = [0, 0, 1]\nradius = " + std::to_string(radius) + "\nmaterial = \"" + material + "\"\n";
}

/// A bed of a material.
inline std::string bedOf(const std::string& material, const std::string& more = "") {
  return "version = 1\n[run]\nduration = 1\n[terrain]\nheightmap = \"heightmaps/flat.png\"\nsize = [1, 1]\n"
         "height_range = [0, 0]\ngrain_radius = 0.02\nmaterial = \"" +
         material + "\"\n" + more;
}

/// A test with a folder that contains this soil as soils/loam.toml.
class SoilTest : public FolderTest {
protected:
  void SetUp() override {
    FolderTest::SetUp();
    std::filesystem::create_directories(folder_ / "soils");
    put(folder_ / "soils/loam.toml", kLoam);
  }
};

} // namespace grouser::test
