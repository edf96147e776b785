// SPDX-License-Identifier: BSD-3-Clause
#include "runs/campaigns/forecast/probe.hpp"

#include "base/math.hpp"
#include "base/sphere.hpp"
#include "coupling/stage_timer.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/bed_options.hpp"
#include "runs/setup/placement.hpp"
#include "runs/setup/simulation_setup.hpp"
#include "runs/support/line_fit.hpp"
#include "vehicle/spec_file.hpp"
#include "vehicle/wrap.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>

namespace grouser::forecast {

using coupling::Stage;

namespace {

constexpr double kTileGrains = 300;  // minimum number of grains of a tile
constexpr double kTileWidth = 8;     // minimum width [largest grain radii]
constexpr double kNearlyAtRest = 10; // kinetic energy of the copied tile / limit for rest
constexpr double kPrepared = 0.1;    // friction while the tile settles [-]: the middle of the tested range
constexpr int kGroups = 24;

/// Ends the settling of a tile at its time limit.
struct TimeLimitReached {};

/// The bed that settles: the bed of the ground, or of the ground without the objects placed on the bed.
const coupling::BedSetup& settlingBed(const coupling::GroundSetup& whole) {
  const coupling::BedSetup& bed = *whole.grains->bed;
  return bed.alone ? *bed.alone->grains->bed : bed;
}

void advance(coupling::Simulation& simulation, std::int64_t steps) {
  for (std::int64_t i = 0; i < steps;) i += simulation.advance(steps - i);
}

} // namespace

StepTimes timeSteps(coupling::Simulation& simulation, const base::Exec& exec, double seconds, std::int64_t total) {
  StepTimes times;
  const auto left = [&] { return total - simulation.steps(); };
  const Stopwatch all;
  std::int64_t batch = 4;
  while (left() > 0 && (all.seconds() < seconds || times.groups.empty())) {
    StepTimes::Group group;
    if (simulation.ground().grains) group.grains = static_cast<double>(simulation.ground().grains->count());
    // Plain steps, then steps with a stage timer, which adds time on a GPU.
    const std::int64_t taken = std::min(batch, left());
    const Stopwatch plain;
    advance(simulation, taken);
    base::synchronize(exec);
    group.seconds = plain.seconds(), group.steps = static_cast<double>(taken);
    coupling::StageTimer observed(simulation, exec);
    while (left() > 0 && observed.steps() < std::max<std::int64_t>(1, taken / 2)) observed.step();
    double sums[3] = {1e-300, 0, 0};
    for (int s = 0; s < coupling::kStages; ++s) {
      const auto stage = static_cast<Stage>(s);
      const bool ofGrains = stage == Stage::boundaries || stage == Stage::grainStep || stage == Stage::grainStepEnded ||
                            stage == Stage::checks;
      sums[stage == Stage::neighbourList ? 1 : ofGrains ? 0 : 2] += 1e-6 * observed.part(stage).microseconds;
    }
    const double sum = sums[0] + sums[1] + sums[2];
    group.lists = sums[1] / sum, group.parts = sums[2] / sum;
    if (exec.onCpu()) group.seconds += sum, group.steps += static_cast<double>(observed.steps());
    times.groups.push_back(group);
    if (plain.seconds() < seconds / kGroups) batch *= 2;
  }
  return times;
}

StepTimes::Group StepTimes::last() const {
  double whole = 0;
  for (const Group& g : groups) whole += g.seconds;
  Group mean;
  for (auto g = groups.rbegin(); g != groups.rend() && (mean.steps == 0 || mean.seconds < whole / 3); ++g) {
    mean.lists += g->lists * g->seconds, mean.parts += g->parts * g->seconds, mean.grains += g->grains * g->steps;
    mean.steps += g->steps, mean.seconds += g->seconds;
  }
  if (mean.steps == 0) return mean;
  mean.lists /= std::max(1e-300, mean.seconds), mean.parts /= std::max(1e-300, mean.seconds);
  mean.grains /= mean.steps;
  return mean;
}

StepCost costOfRun(const StepTimes& times, double steps, double stride, double later) {
  StepCost cost;
  const auto take = [&](const StepTimes::Group& g, double weight) {
    cost.lists += weight * g.lists * g.seconds;
    cost.parts += weight * stride * g.parts * g.seconds;
    cost.grains += weight * stride * (1 - g.lists - g.parts) * g.seconds;
  };
  double taken = 0;
  for (const StepTimes::Group& g : times.groups) {
    const double share = std::min(1.0, (steps - taken) / std::max(1.0, stride * g.steps));
    if (share <= 0) break;
    take(g, share);
    taken += share * stride * g.steps;
  }
  const StepTimes::Group last = times.last();
  if (taken >= steps || last.steps == 0) return cost;
  double dearer = 1;
  if (later > 1.05 * last.grains) {
    std::vector<double> x, y;
    for (const StepTimes::Group& g : times.groups) x.push_back(g.grains), y.push_back(g.seconds / g.steps);
    const support::LineFit line = support::fitLine(x, y);
    if (line.points > 2 && line.slope > 0) dearer += line.slope * (later - last.grains) * last.steps / last.seconds;
  }
  take(last, dearer * (steps - taken) / (stride * last.steps));
  return cost;
}

double timeOfLists(coupling::Simulation& simulation, const base::Exec& exec) {
  if (!simulation.ground().grains) return 0;
  terrain::Grains& grains = *simulation.ground().grains;
  std::vector<double> times;
  for (int k = 0; k < 3; ++k) {
    grains.invalidateNeighbours();
    const Stopwatch one;
    grains.refreshNeighbours();
    base::synchronize(exec);
    times.push_back(one.seconds());
  }
  return *std::min_element(times.begin(), times.end());
}

SettledTile settleTile(const coupling::GroundSetup& piece, bool prepared, const base::Exec& exec, double seconds) {
  const coupling::GroundSetup& ground = *settlingBed(piece).tile->ground;
  const coupling::BedSetup& bed = *ground.grains->bed;
  const coupling::LaidGround laid = coupling::layGround(ground, exec);
  terrain::Grains& grains = *laid.grains;
  SettledTile tile;
  tile.grains = static_cast<double>(grains.count());
  const Stopwatch settling;
  const coupling::SettleProgress limited = [&](double, double) {
    if (settling.seconds() > seconds) throw TimeLimitReached();
  };
  coupling::SettleReport report;
  try {
    if (prepared)
      coupling::settleWithFriction(bed, grains, kPrepared, limited, report);
    else
      coupling::settleUntilRest(bed, bed.settle, grains, bed.fall, limited, report);
  } catch (const TimeLimitReached&) {
    tile.complete = false;
  }
  tile.steps = static_cast<double>(report.steps), tile.seconds = settling.seconds();
  tile.rebuilds = static_cast<double>(grains.system().rebuilds);
  const double fall = std::sqrt(2 * bed.fall / norm(ground.grains->model.gravity));
  if (!tile.complete) {
    // Grains fall and come to rest about half a second later.
    const double more = std::max(1.2, (fall + 0.5) / (tile.steps + 1) / ground.grains->model.timeStep);
    tile.steps *= more, tile.rebuilds *= more, tile.seconds *= more;
  }
  tile.fallen = std::min(1.0, (fall + 0.1) / (std::max(1.0, tile.steps) * ground.grains->model.timeStep));
  grains.invalidateNeighbours();
  const Stopwatch list;
  grains.refreshNeighbours();
  base::synchronize(exec);
  tile.list = list.seconds();
  tile.falling = std::max(0.2 * tile.seconds, tile.seconds - tile.rebuilds * tile.list) / std::max(1.0, tile.steps);
  const Stopwatch resting;
  std::int64_t steps = 0;
  while (resting.seconds() < 0.05 * seconds) steps += grains.advance(16);
  base::synchronize(exec);
  tile.resting = resting.seconds() / static_cast<double>(std::max<std::int64_t>(1, steps));
  return tile;
}

scene::Scene pieceOf(const scene::Scene& scene, double grains, double most) {
  scene::Scene piece = scene;
  scene::Terrain& t = *piece.terrain;
  const terrain::BedOptions options = setup::bedOptions(scene);
  const double area = t.size[0] * t.size[1], each = area / std::max(1.0, grains);
  const double side = std::max(std::sqrt(kTileGrains * each), kTileWidth * options.largestRadius());
  if (t.depth && t.floor == terrain::FloorShape::flat) {
    // Mean depth of the bed.
    const terrain::HeightField surface = setup::readSurface(scene);
    const std::vector<double>& h = surface.heights();
    const double lowest = *std::min_element(h.begin(), h.end());
    *t.depth += std::accumulate(h.begin(), h.end(), 0.0) / static_cast<double>(h.size()) - lowest;
  }
  t.heightRange = {0, 0}, t.floor = terrain::FloorShape::follow;
  t.porosity.reset(), t.cache = false;
  if (grains > most) {
    const double shrink = std::sqrt(most / grains);
    std::array<double, 2> size{std::max(t.size[0] * shrink, side), std::max(t.size[1] * shrink, side)};
    if (piece.vehicle) {
      // Space for the vehicle at its default position.
      const vehicle::VehicleSpec spec = setup::vehicleSpec(piece);
      const double length = 0.55 * spec.shoe.count * spec.shoe.pitch, width = 2 * (spec.trackOffset + 0.5);
      const double all = std::max(length, width);
      size = {std::max(size[0], piece.vehicle->heading == 0 ? length : all),
              std::max(size[1], piece.vehicle->heading == 0 ? width : all)};
      piece.vehicle->position.reset();
    }
    if (piece.boxes.empty() && piece.cylinders.empty() && piece.meshes.empty() && piece.planes.empty())
      t.size = {std::min(t.size[0], size[0]), std::min(t.size[1], size[1])};
  }
  t.tile = {std::min(side, t.size[0]), std::min(side, t.size[1])};
  return piece;
}

scene::Scene hurried(const scene::Scene& scene) {
  scene::Scene piece = scene;
  piece.driver.tensionRamp = piece.driver.weightRamp = 0.3 * kHurry;
  piece.driver.driveStart = 0.6 * kHurry, piece.driver.driveRamp = 0.4 * kHurry;
  piece.hitch.reset();                            // negligible cost, and might outlast the piece
  if (const auto& course = scene.driver.course) { // too little space for a course: drive straight at its speed
    piece.driver.sprocketSpeed = course->speed / vehicle::readVehicleSpec(piece.vehicle->source()).pitchRadius();
    piece.driver.course.reset();
  }
  return piece;
}

scene::Scene softened(const scene::Scene& scene, double timeStep, double stride) {
  scene::Scene soft = scene;
  soft.run.timeStep = stride * timeStep;
  soft.run.maxOverlap = 0.9;
  const double less = 1 / (stride * stride);
  const auto soften = [](std::optional<double>& value, double by) {
    if (value) *value *= by;
  };
  for (scene::Material& m : soft.materials)
    soften(m.stiffness, less), soften(m.young, less), soften(m.damping, 1 / stride);
  for (scene::ContactPair& c : soft.contacts) soften(c.stiffness, less), soften(c.damping, 1 / stride);
  for (scene::Source& s : soft.sources) s.every = std::max(s.every, *soft.run.timeStep);
  return soft;
}

coupling::SimulationSetup copiedBed(const scene::Scene& piece) {
  coupling::SimulationSetup setup = setup::simulationSetup(piece);
  const auto still = [](coupling::BedSetup& bed) {
    bed.settle.timeLimit = 0;
    auto tile = std::make_shared<coupling::GroundSetup>(*bed.tile->ground);
    tile->grains->bed->settle.kineticEnergy *= kNearlyAtRest;
    tile->grains->bed->settle.forceRatio.reset();
    bed.tile->ground = tile;
  };
  coupling::BedSetup& bed = *setup.ground.grains->bed;
  if (bed.alone) {
    auto alone = std::make_shared<coupling::GroundSetup>(*bed.alone);
    still(*alone->grains->bed);
    bed.alone = alone;
    bed.settle.timeLimit = 0;
  } else {
    still(bed);
  }
  return setup;
}

} // namespace grouser::forecast
