// SPDX-License-Identifier: BSD-3-Clause
#include "runs/setup/fluid_setup.hpp"

#include "base/math.hpp"
#include "base/rounded.hpp"
#include "coupling/surface_setup.hpp"
#include "fluid/lattice.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/bed_options.hpp"
#include "runs/setup/fluid_bodies.hpp"
#include "runs/setup/lattice.hpp"
#include "runs/setup/obstacles.hpp"
#include "runs/setup/placement.hpp"
#include "runs/setup/time_scales.hpp"

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
    scene.fail("fluid", "level", fmt::format("[m] is below the lowest point of the terrain, {:g} m; raise it", bottom));
  return depth;
}

/// Distance from the nearest solid at rest, negative inside [m].
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

/// Particles below the level, then particles of each box; none inside solids, bodies or regions filled before.
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

/// Moves a position that is less than half a spacing from a body to that distance, along the gradient of the distance:
/// otherwise the lattice particles next to a body would touch its markers.
void keepOff(const StartingBodies& bodies, const fluid::FluidModel& model, Vec3d& place) {
  const double near = 0.5 * model.spacing, probe = 0.01 * model.spacing;
  const auto distance = [&](const Vec3d& p) { return bodies.fromBodies(p, model.spacing); };
  const double d = distance(place);
  if (d >= near) return;
  Vec3d slope;
  for (int a = 0; a < 3; ++a) {
    if (model.dimensions == 2 && a == 1) continue;
    Vec3d up = place, down = place;
    up[a] += probe, down[a] -= probe;
    slope[a] = distance(up) - distance(down);
  }
  if (norm(slope) > 0) place += slope * ((near - d) / norm(slope));
}

fluid::StepLimits limitsOf(const fluid::FluidModel& model) {
  return fluid::stepLimits(model, 0.1 * model.soundSpeed, norm(model.gravity));
}

/// Longest fluid step with loads that may stay constant over several steps of the bodies [s]. If a body moves `gain`
/// times its mass of fluid, pressure responds to its speed within spacing / (sound speed x gain).
double longestStep(const fluid::FluidModel& model, const std::vector<coupling::BodyInFluid>& bodies) {
  double longest = limitsOf(model).least();
  for (const coupling::BodyInFluid& b : bodies)
    if (b.gain > 0) longest = std::min(longest, model.spacing / (model.soundSpeed * b.gain));
  return longest;
}

/// Particles closer to a marker than this are repelled [spacings].
constexpr double kMinDistance = 0.85;

/// Markers of the vehicle in its initial pose [m].
std::vector<Vec3d> markersAtStart(const StartingBodies& bodies, const std::vector<coupling::BodyInFluid>& inFluid) {
  std::vector<Vec3d> all;
  for (const coupling::BodyInFluid& b : inFluid)
    if (bodies.ofVehicle(b.body))
      for (const Vec3d& p : b.markers) all.push_back(bodies.pose(b.body).toWorld(p));
  return all;
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
  const double ofTrack = scene.vehicle ? 2 * greatestTrackSpeed(scene) : 0; // upper track run over the ground
  const double usual = std::max(std::sqrt(2 * fall), ofTrack);
  const double expected = std::max(fluid.expectedSpeed.value_or(usual), fastest);
  m.soundSpeed = fluid.soundSpeed.value_or(fluid::soundSpeedFor(expected, fluid.density * fall, fluid.density));
  constexpr double kMin = 4; // 6 % compression at the bottom, or a Mach number of 1/4
  const double least = kMin * std::max(std::sqrt(fall), fastest);
  if (m.soundSpeed < least || !(m.soundSpeed > 0))
    scene.fail("fluid", fluid.soundSpeed ? "sound_speed" : "expected_speed",
               fmt::format("[m/s] results in a sound speed of {:.4g} m/s, too low for this depth and flow speed; use "
                           "at least {} m/s, preferably {} m/s",
                           m.soundSpeed, base::roundedUp(least, 3), base::roundedUp(2.5 * least, 2)));
  return m;
}

fluid::StepLimits fluidStepLimits(const scene::Scene& scene) { return limitsOf(fluidModel(scene)); }

std::optional<coupling::FluidDomainSetup> fluidSetup(const scene::Scene& scene, double timeStep) {
  if (!scene.fluid) return {};
  coupling::FluidDomainSetup setup;
  fluid::FluidModel& m = setup.fluid.model = fluidModel(scene);
  // In the second layer below a free surface div r is 2.88 of 3 (1.3 spacings; 1.9 of 2 in two dimensions).
  setup.fluid.surfaceDivergence = m.shifting > 0 ? m.dimensions - 0.25 : 0;
  const FluidTank tank = fluidTank(scene);
  const fluid::Distance solid = solids(scene, tank);
  const double depth = std::ceil(m.kernel().support() / m.spacing) * m.spacing;
  const Vec3d out{depth, depth, depth};
  setup.fluid.markers = fluid::wallMarkers(m, solid, tank.low - out, tank.high + out, tank.low);
  const StartingBodies bodies(scene);
  setup.bodies = bodies.inFluid(scene, m), setup.chassis = bodies.chassis();
  setup.stepsPerStep = std::max(1, static_cast<int>(longestStep(m, setup.bodies) / timeStep + 1e-9));
  m.timeStep = setup.stepsPerStep * timeStep;
  // Particles between the parts of a vehicle cannot be moved away; particles that touch parts are omitted.
  const fluid::Distance free = [&](const Vec3d& p) {
    const double d = solid(p), dx = m.spacing;
    if (d < 0 || bodies.empty()) return d;
    return std::min({d, bodies.fromBodies(p, dx), bodies.fromVehicle(p, dx) - 0.5 * dx});
  };
  setup.fluid.particles = particlesOf(scene, m, tank, free);
  if (!bodies.empty())
    for (fluid::FluidParticle& p : setup.fluid.particles) keepOff(bodies, m, p.position);
  if (bodies.chassis())
    setup.fluid.particles = fluid::awayFrom(std::move(setup.fluid.particles), markersAtStart(bodies, setup.bodies),
                                            kMinDistance * m.spacing);
  if (setup.fluid.particles.empty())
    scene.fail(
        "fluid", "",
        "contains no particles: its level and boxes are inside solids or thinner than the spacing; correct them");
  for (const scene::FluidProbe& p : scene.fluid->probes)
    setup.probes.push_back({p.name, p.kind == scene::FluidProbeKind::level, p.position});
  setup.top = tank.high.z;
  setup.partition = partitionOptions(scene, base::positionScale(m.kernel().support()));
  return setup;
}

} // namespace grouser::setup
