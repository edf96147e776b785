// SPDX-License-Identifier: BSD-3-Clause
#include "runs/virtual_tests/sample.hpp"

#include "base/sphere.hpp"
#include "runs/jobs/study_place.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/simulation_setup.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace grouser::virtual_tests {

double SampleGrains::mass() const { return base::sphereMass(density, radius); }

std::string SampleGrains::toml(const std::string& name) const {
  if (!law.empty())
    return fmt::format("[material.{}]\ndensity = {:.17g}\nfriction = {:.17g}\n{}", name, density, friction, law);
  const std::string spring = young > 0 ? fmt::format("law = \"hertz\"\nyoung = {:.17g}\n", young)
                                       : fmt::format("stiffness = {:.17g}\n", stiffness);
  return fmt::format("[material.{}]\ndensity = {:.17g}\n{}restitution = {:.17g}\nfriction = {:.17g}\n"
                     "rolling_friction = {:.17g}\n",
                     name, density, spring, restitution, friction, rollingFriction);
}

Sample buildSample(const std::string& toml, const base::Exec& exec) {
  const coupling::SimulationSetup setup = setup::simulationSetup(setup::parseScene(toml, "sample.toml"));
  return {setup.timeStep, coupling::buildGround(setup.ground, exec)};
}

void advanceSample(terrain::Grains& grains, std::int64_t steps) {
  for (std::int64_t i = 0; i < steps; ++i) {
    grains.refreshNeighbours();
    grains.step();
  }
}

double bringToRest(Sample& sample, double energyRatio, double limit) {
  terrain::Grains& grains = sample.grains();
  const terrain::GrainModel& model = grains.model();
  const double unit = model.mass * norm(model.gravity) * 2 * model.radius *
                      static_cast<double>(std::max<std::size_t>(1, grains.count()));
  const auto every = std::max<std::int64_t>(1, static_cast<std::int64_t>(0.02 / model.timeStep));
  int calm = 0;
  double time = 0;
  while (time < limit) {
    jobs::stopStudyOnRequest();
    advanceSample(grains, every);
    time += static_cast<double>(every) * model.timeStep;
    const terrain::GrainLedger ledger = grains.ledger();
    calm = ledger.kinetic + ledger.rotational < energyRatio * unit ? calm + 1 : 0;
    if (calm >= 3) return time;
  }
  return -time;
}

} // namespace grouser::virtual_tests
