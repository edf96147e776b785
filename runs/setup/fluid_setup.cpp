// SPDX-License-Identifier: BSD-3-Clause
#include "runs/setup/fluid_setup.hpp"

#include "base/math.hpp"
#include "base/rounded.hpp"
#include "coupling/surface_setup.hpp"
#include "fluid/lattice.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/bed_options.hpp"
#include "runs/setup/fluid_bodies.hpp"
#include "runs/setup/mechanism_setup.hpp"
#include "runs/setup/obstacles.hpp"
#include "runs/setup/placement.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace grouser::setup {

using base::Vec3d;

namespace {

/// Top of the fluid at the start [m].
double topOf(const scene::Fluid& fluid) {
  double top = fluid.level.value_or(-base::kInfinity);
  for (const scene::FluidBox& box : fluid.boxes) top = std::max(top, box.high.z);
  return top;
}

/// Greatest depth at the start [m].
double depthOf(const scene::Scene& scene) {
  const double bottom = scene.fluid->tankLow ? scene.fluid->tankLow->z : readSurface(scene).bounds().lowest;
  const double depth = topOf(*scene.fluid) - bottom;
  if (!(depth > 0))
    scene.fail("fluid", "level",
               fmt::format("[m] lies below the lowest point of the terrain, {:g} m; raise it", bottom));
  return depth;
}

/// Distance from everything solid at rest, negative inside [m].
fluid::Distance solids(const scene::Scene& scene, const FluidTank& tank) {
  Vec3d low = tank.low, high = tank.high;
  if (scene.fluid->dimensions == 2) low.y = -base::kInfinity, high.y = base::kInfinity;
  const fluid::Distance walls = fluid::tank(low, high, !scene.fluid->lid);
  const std::vector<coupling::SurfaceSetup> surfaces = surfacesAtRest(scene);
  std::optional<terrain::HeightField> ground;
  if (scene.terrain) ground = readSurface(scene);
  return [walls, surfaces, ground](const Vec3d& p) {
    double d = walls(p);
    for (const coupling::SurfaceSetup& s : surfaces) d = std::min(d, -startingOverlap(s, p, 0));
    if (ground) {
      const terrain::SurfaceJet jet = ground->view().jet(p.x, p.y);
      d = std::min(d, (p.z - jet.h) / std::sqrt(1 + jet.hx * jet.hx + jet.hy * jet.hy));
    }
    return d;
  };
}

bool within(const Vec3d& p, const Vec3d& low, const Vec3d& high, bool plane) {
  for (int a = 0; a < 3; ++a)
    if (!(plane && a == 1) && !(p[a] >= low[a] && p[a] < high[a])) return false;
  return true;
}

/// Particles below the level, then of each box, where neither solids nor bodies nor former ones are.
std::vector<fluid::FluidParticle> particlesOf(const scene::Scene& scene, const fluid::FluidModel& model,
                                              const FluidTank& tank, const fluid::Distance& free) {
  const scene::Fluid& fluid = *scene.fluid;
  const bool plane = fluid.dimensions == 2;
  std::vector<fluid::FluidParticle> all;
  const double level = fluid.level.value_or(-base::kInfinity);
  if (fluid.level) all = fluid::stillFluid(model, free, tank.low, tank.high, level, tank.low);
  for (std::size_t k = 0; k < fluid.boxes.size(); ++k) {
    const scene::FluidBox& box = fluid.boxes[k];
    const fluid::Distance left = [&](const Vec3d& p) {
      bool taken = p.z < level;
      for (std::size_t before = 0; before < k; ++before)
        taken |= within(p, fluid.boxes[before].low, fluid.boxes[before].high, plane);
      return taken ? -1.0 : free(p);
    };
    for (fluid::FluidParticle p : fluid::stillFluid(model, left, box.low, box.high, box.high.z, tank.low))
      p.velocity = box.velocity, all.push_back(p);
  }
  return all;
}

/// Moves a place nearer to a body than half a spacing out to that, along the slope of the distance: the lattice fills
/// the space beside a body as a whole, and its first particles would else touch markers.
void keepOff(const coupling::MechanismSetup& mechanism, const fluid::FluidModel& model, Vec3d& place) {
  const double near = 0.5 * model.spacing, probe = 0.01 * model.spacing, d = distanceFromBodies(mechanism, place);
  if (d >= near) return;
  Vec3d slope;
  for (int a = 0; a < 3; ++a) {
    if (model.dimensions == 2 && a == 1) continue;
    Vec3d up = place, down = place;
    up[a] += probe, down[a] -= probe;
    slope[a] = distanceFromBodies(mechanism, up) - distanceFromBodies(mechanism, down);
  }
  if (norm(slope) > 0) place += slope * ((near - d) / norm(slope));
}

} // namespace

FluidTank fluidTank(const scene::Scene& scene) {
  const scene::Fluid& fluid = *scene.fluid;
  if (fluid.tankLow) return {*fluid.tankLow, *fluid.tankHigh};
  const terrain::HeightFieldBounds bounds = readSurface(scene).bounds();
  const terrain::Rectangle area = *terrainArea(scene);
  const double top = std::max(topOf(fluid), bounds.highest);
  return {{area.xMin, area.yMin, bounds.lowest}, {area.xMax, area.yMax, top + std::max(0.5, top - bounds.lowest)}};
}

fluid::FluidModel fluidModel(const scene::Scene& scene) {
  const scene::Fluid& fluid = *scene.fluid;
  fluid::FluidModel m;
  m.dimensions = fluid.dimensions, m.spacing = fluid.spacing, m.smoothing = fluid.smoothing;
  m.density = fluid.density, m.viscosity = fluid.viscosity;
  m.artificialViscosity = fluid.artificialViscosity, m.diffusion = fluid.diffusion, m.shifting = fluid.shifting;
  m.gravity = scene.run.gravity;
  const double fall = norm(m.gravity) * depthOf(scene);
  double fastest = 0;
  for (const scene::FluidBox& box : fluid.boxes) fastest = std::max(fastest, norm(box.velocity));
  const double expected = std::max(fluid.expectedSpeed.value_or(std::sqrt(2 * fall)), fastest);
  m.soundSpeed = fluid.soundSpeed.value_or(fluid::soundSpeedFor(expected, fluid.density * fall, fluid.density));
  constexpr double kLeast = 4; // compression at the bottom 6 %, Mach number a quarter
  const double least = kLeast * std::max(std::sqrt(fall), fastest);
  if (m.soundSpeed < least || !(m.soundSpeed > 0))
    scene.fail("fluid", fluid.soundSpeed ? "sound_speed" : "expected_speed",
               fmt::format("[m/s] makes sound travel at {:.4g} m/s, too slow for this depth and speed; the least is "
                           "{} m/s, better {} m/s",
                           m.soundSpeed, base::roundedUp(least, 3), base::roundedUp(2.5 * least, 2)));
  return m;
}

fluid::StepLimits fluidStepLimits(const scene::Scene& scene) {
  const fluid::FluidModel m = fluidModel(scene);
  return fluid::stepLimits(m, 0.1 * m.soundSpeed, norm(m.gravity));
}

std::optional<coupling::FluidDomainSetup> fluidSetup(const scene::Scene& scene, double timeStep) {
  if (!scene.fluid) return {};
  coupling::FluidDomainSetup setup;
  fluid::FluidModel& m = setup.fluid.model = fluidModel(scene);
  m.timeStep = timeStep;
  // In the second layer below a free surface div r is 2.88 of 3 (1.3 spacings; 1.9 of 2 in two dimensions).
  setup.fluid.surfaceDivergence = m.shifting > 0 ? m.dimensions - 0.25 : 0;
  const FluidTank tank = fluidTank(scene);
  const fluid::Distance solid = solids(scene, tank);
  const double depth = std::ceil(m.kernel().support() / m.spacing) * m.spacing;
  const Vec3d out{depth, depth, depth};
  setup.fluid.markers = fluid::wallMarkers(m, solid, tank.low - out, tank.high + out, tank.low);
  coupling::MechanismSetup mechanism;
  if (scene.mechanism.touches()) mechanism = mechanismSetup(scene), setup.bodies = bodiesInFluid(scene, mechanism, m);
  const fluid::Distance free = [&](const Vec3d& p) {
    const double d = solid(p);
    return mechanism.shapes.empty() || d < 0 ? d : std::min(d, distanceFromBodies(mechanism, p));
  };
  setup.fluid.particles = particlesOf(scene, m, tank, free);
  if (!mechanism.shapes.empty())
    for (fluid::FluidParticle& p : setup.fluid.particles) keepOff(mechanism, m, p.position);
  if (setup.fluid.particles.empty())
    scene.fail("fluid", "",
               "holds no particle: its level and boxes lie in solids or are thinner than the spacing; "
               "correct them");
  for (const scene::FluidProbe& p : scene.fluid->probes)
    setup.probes.push_back({p.name, p.kind == scene::FluidProbeKind::level, p.position});
  setup.top = tank.high.z;
  return setup;
}

} // namespace grouser::setup
