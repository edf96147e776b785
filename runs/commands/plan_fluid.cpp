// SPDX-License-Identifier: BSD-3-Clause
#include "base/counted.hpp"
#include "runs/commands/plan.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/fluid_bodies.hpp"
#include "runs/setup/fluid_setup.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace grouser::commands {

std::string fluidText(const scene::Scene& scene, double timeStep) {
  if (!scene.fluid) return {};
  constexpr double kBytes = 600; // memory per particle or marker
  const auto setup = setup::fluidSetup(scene, timeStep);
  const fluid::FluidModel& m = setup->fluid.model;
  const setup::FluidTank tank = setup::fluidTank(scene);
  std::string text;
  const auto line = [&text](const std::string& what, const std::string& value) {
    text += fmt::format("  {:<24} {}\n", what, value);
  };
  std::size_t ofBodies = 0;
  for (const coupling::BodyInFluid& b : setup->bodies) ofBodies += b.markers.size();
  const std::size_t particles = setup->fluid.particles.size(), walls = setup->fluid.markers.size();
  line("fluid", fmt::format("{}, markers: {} of walls, {} of bodies; about {:.1f} MiB",
                            base::counted(static_cast<std::int64_t>(particles), "particle"), walls, ofBodies,
                            kBytes * static_cast<double>(particles + walls + ofBodies) / 1048576));
  const base::Vec3d size = tank.high - tank.low;
  line("  tank", m.dimensions == 2 ? fmt::format("{:g} x {:g} m", size.x, size.z)
                                   : fmt::format("{:g} x {:g} x {:g} m", size.x, size.y, size.z));
  for (int a = 0; a < 3; ++a) {
    const double parts = size[a] / m.spacing;
    if (!(m.dimensions == 2 && a == 1) && !(a == 2 && !scene.fluid->lid) && std::fabs(parts - std::round(parts)) > 1e-6)
      line("",
           fmt::format("the length along {} is not a multiple of the spacing; the wall position is off by up to {:g} m",
                       "xyz"[a], 0.5 * m.spacing));
  }
  line("  sound speed", fmt::format("{:.4g} m/s", m.soundSpeed));
  const fluid::StepLimits limits = setup::fluidStepLimits(scene);
  line("  maximum time step",
       fmt::format("{:.3g} s for sound, {:.3g} s for gravity{}", limits.sound, limits.force,
                   m.viscosity > 0 ? fmt::format(", {:.3g} s for viscosity", limits.viscous) : ""));
  if (scene.vehicle && scene.fluid->level) {
    const double volume = setup::StartingBodies(scene).vehicleBelow(*scene.fluid->level);
    line("  vehicle", fmt::format("displaces {:.4g} m3 below the level: buoyancy at rest {:.4g} N", volume,
                                  m.density * norm(m.gravity) * volume));
  }
  if (setup->stepsPerStep > 1)
    line("  step", fmt::format("{:.4g} s: {} steps of the run", m.timeStep, setup->stepsPerStep));
  std::map<std::string, double> gains;
  for (const coupling::BodyInFluid& b : setup->bodies) gains[b.column] = std::max(gains[b.column], b.gain);
  for (const auto& [column, gain] : gains)
    if (gain > 1)
      line("  added mass", fmt::format("{}: the fluid near the body has up to {:.3g} times the mass of the body; "
                                       "its pressure responds within {:.0f} steps",
                                       column, gain, std::ceil(1 + gain)));
  return text;
}

} // namespace grouser::commands
