// SPDX-License-Identifier: BSD-3-Clause
// Boxes, cylinders and meshes have no images beyond periodic boundaries: positions that require one are rejected.
#include "base/error.hpp"
#include "coupling/simulation.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/simulation_setup.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace grouser::coupling {
namespace {

/// A grain of radius 0.02 m in a ring of 1 m along x, and another surface.
scene::Scene ring(const std::string& surface) {
  return setup::parseScene(
      "version = 1\n[run]\nduration = 1\ntime_step = 1e-4\nperiodic = [true, false]\ndomain_x = "
      "[0, 1]\ngravity = [0, 0, 0]\n[material.soil]\nstiffness = 1e5\n[[grain]]\nposition = [0.5, 0, "
      "1]\nradius = 0.02\nmaterial = \"soil\"\n" +
          surface,
      "ring.toml", {});
}

std::string refusal(const std::string& surface) {
  try {
    setup::simulationSetup(ring(surface));
  } catch (const base::InputError& error) {
    return error.what();
  }
  return "";
}

std::string box(double x, double size, const std::string& more = "") {
  return fmt::format("[[box]]\nmaterial = \"soil\"\nposition = [{}, 0, 0]\nsize = [{}, 0.1, 0.1]\n{}", x, size, more);
}

TEST(SurfacesAtPeriodicBoundaries, KeepAGrainsRadiusAwayOrReachAcross) {
  EXPECT_EQ(refusal(box(0.5, 0.96)), "") << "from 0.02 to 0.98 m: no grain beyond a boundary can touch it";
  EXPECT_NE(refusal(box(0.5, 0.97)), "");
  EXPECT_NE(refusal(box(0.1, 0.2)), "") << "ends at the boundary: grains beyond it would touch it";
  EXPECT_NE(refusal(box(0.95, 0.2)), "");
  EXPECT_NE(refusal(box(1.5, 0.2)), "");
  EXPECT_EQ(refusal(box(0.5, 1)), "");
  EXPECT_EQ(refusal(box(0.6, 1.3)), "");
  const std::string message = refusal(box(0.95, 0.2));
  for (const char* part :
       {"box.0.position", "reaches from x = 0.85 to 1.05 m", "between x = 0.02 and 0.98 m", "across both"})
    EXPECT_NE(message.find(part), std::string::npos) << message;
}

TEST(SurfacesAtPeriodicBoundaries, AreMeasuredAsTheyAreTurned) {
  // 0.6 x 0.1 turned by 45 degrees about y, with z 0.1: (0.6 + 0.1) / sqrt(2) long = 0.495.
  const std::string turned = "axis = [0, 1, 0]\nangle = 45\n";
  EXPECT_EQ(refusal(box(0.27, 0.6, turned)), "") << "from 0.0225 m";
  EXPECT_NE(refusal(box(0.26, 0.6, turned)), "") << "from 0.0125 m";
  EXPECT_NE(refusal(box(0.27, 0.6)), "");
  const auto rod = [](double x, const std::string& axis) {
    return fmt::format(
        "[[cylinder]]\nmaterial = \"soil\"\nposition = [{}, 0, 0]\nradius = 0.05\nlength = 0.6\naxis = {}\n", x, axis);
  };
  EXPECT_EQ(refusal(rod(0.33, "[1, 0, 0]")), "");
  EXPECT_NE(refusal(rod(0.31, "[1, 0, 0]")), "");
  EXPECT_EQ(refusal(rod(0.08, "[0, 1, 0]")), "");
  EXPECT_NE(refusal(rod(0.06, "[0, 1, 0]")), "");
}

TEST(SurfacesAtPeriodicBoundaries, OneThatMovesThereEndsTheRun) {
  Simulation simulation(setup::simulationSetup(ring(box(0.85, 0.2, "velocity = [1, 0, 0]\n"))), base::cpuExec(1),
                        [](double, double) {});
  try {
    while (simulation.time() < 0.1) simulation.step();
    FAIL() << "after 0.03 s it is within a grain's radius of the boundary";
  } catch (const base::SimulationError& error) {
    EXPECT_NE(std::string(error.what()).find("box0 reaches from x = 0.78"), std::string::npos) << error.what();
    EXPECT_NEAR(simulation.time(), 0.03, 2e-4);
  }
  Simulation along(setup::simulationSetup(ring(box(0.85, 0.2, "velocity = [0, 1, 0]\n"))), base::cpuExec(1),
                   [](double, double) {});
  EXPECT_NO_THROW(while (along.time() < 0.1) along.step());
}

} // namespace
} // namespace grouser::coupling
