// SPDX-License-Identifier: BSD-3-Clause
#include <grouser/grouser.hpp>

#include <cstdio>

int main(int count, char** words) try {
  grouser::Simulation simulation(grouser::Scene::fromFile(count > 1 ? words[1] : "scene.toml"));
  grouser::Vehicle vehicle = simulation.vehicle();
  while (simulation.time() < 1) {
    const double speed = 2 + 4 * (0.3 - vehicle.state().speed); // towards 0.3 m/s [rad/s]
    vehicle.setSprocketSpeed(speed, speed);
    simulation.stepFor(0.01);
  }
  std::printf("%.3f m/s, state hash %s\n", vehicle.state().speed, simulation.hash().c_str());
} catch (const grouser::Error& error) {
  std::fprintf(stderr, "error: %s\n", error.what());
  return 2;
}
