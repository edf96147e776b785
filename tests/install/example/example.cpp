// SPDX-License-Identifier: BSD-3-Clause
#include <grouser/base/error.hpp>
#include <grouser/coupling/simulation.hpp>
#include <grouser/runs/scene/scene.hpp>
#include <grouser/runs/setup/load_scene.hpp>
#include <grouser/runs/setup/simulation_setup.hpp>

#include <cstdio>

int main(int count, char** words) {
  if (count != 2) {
    std::fprintf(stderr, "usage: %s SCENE.toml\n", words[0]);
    return 2;
  }
  try {
    const grouser::scene::Scene scene = grouser::setup::loadScene(words[1], {});
    grouser::coupling::Simulation simulation(grouser::setup::simulationSetup(scene), grouser::base::cpuExec(1),
                                             [](double, double) {});
    while (simulation.time() < scene.run.duration) simulation.step();
    std::printf("state-hash %s step %lld\n", simulation.save().hash().c_str(),
                static_cast<long long>(simulation.steps()));
  } catch (const grouser::base::InputError& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 2;
  }
}
