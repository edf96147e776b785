// SPDX-License-Identifier: BSD-3-Clause
// Steps one simulation on several MPI ranks through the library. Start with mpirun; exit code 0 if all checks pass.
#include <grouser/grouser.hpp>

#include <cstdio>
#include <string>

namespace {

const char* kBed = R"(version = 1
[run]
duration = 1
time_step = 1e-4
[material.glass]
stiffness = 1e4
[[plane]]
material = "glass"
[[grains]]
low = [0, 0, 0]
high = [0.2, 0.1, 0.1]
radius = 0.01
jitter = 0.5
material = "glass"
)";

bool holds(bool right, const char* what) {
  if (!right) std::fprintf(stderr, "wrong: %s\n", what);
  return right;
}

std::string steered(const grouser::Options& options) {
  grouser::Simulation simulation(grouser::Scene::fromText(kBed), options);
  simulation.step(100);
  simulation.setGravity({1, 0, -9});
  simulation.step(100, [] { return true; });
  return simulation.hash();
}

bool refusesOthers(const grouser::Options& options, int rank) {
  grouser::Simulation simulation(grouser::Scene::fromText(kBed), options);
  if (rank == 1) simulation.setGravity({0, 0, -5});
  try {
    simulation.step();
    return holds(false, "ranks that set otherwise stepped on");
  } catch (const grouser::InputError& error) {
    if (!holds(std::string(error.what()).find("rank 1") != std::string::npos, error.what())) return false;
  }
  simulation.step(); // the rejected inputs are gone
  try {
    simulation.step(rank == 1 ? 2 : 1);
    return holds(false, "ranks that step otherwise stepped on");
  } catch (const grouser::InputError&) {
    return true;
  }
}

} // namespace

int main(int count, char** words) {
  const grouser::Ranks ranks(count, words);
  grouser::Options together, alone;
  together.ranks = &ranks, together.threads = alone.threads = 1;
  bool good = holds(ranks.size() > 1, "start this with mpirun");
  good = good && holds(steered(together) == steered(alone), "other bits than one rank");
  good = good && refusesOthers(together, ranks.rank());
  return good ? 0 : 1;
}
