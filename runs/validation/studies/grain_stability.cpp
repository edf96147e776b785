// SPDX-License-Identifier: BSD-3-Clause
#include "runs/validation/studies/grain_stability.hpp"

#include "base/error.hpp"
#include "base/random.hpp"
#include "base/sphere.hpp"
#include "contact/restitution.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/grain_model.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/step_limit.hpp"
#include "terrain/grain_forces.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace grouser::studies {

using base::Vec3d;
using terrain::Grains;

namespace {

constexpr double kRadius = 0.005, kDensity = 2600; // [m], [kg/m3]
constexpr double kOwnOverlap = 1e-3;               // overlap of a grain under its own weight [radii]
constexpr double kDisturbance = 5e-4; // initial amplitude at the frequency sqrt(k / m) / overlap under own weight
constexpr double kTangentialRatio = 2.0 / 7;
constexpr double kSettleStiffness = 1e5, kSettleZeta = 0.3, kSettleStep = 0.3; // [N/m], [-], [1 / sqrt(k / m)]
constexpr std::uint64_t kSeed = 1, kPurpose = base::purpose("study.stability");

double rate(double stiffness) { return std::sqrt(stiffness / base::sphereMass(kDensity, kRadius)); } // [1/s]

/// Scene of the study. All contacts have c = 2 zeta sqrt(k m), where c = gamma m / 2 between grains and gamma m at a
/// plane.
scene::Scene sceneOf(const RestingGrains& grains, double stiffness, double zeta) {
  std::string text = "version = 1\n[run]\nduration = 1\n";
  for (const char* name : {"grain", "wall"})
    text += fmt::format("[material.{}]\ndensity = {}\nstiffness = {}\ndamping = {}\nfriction = {}\n"
                        "tangential_stiffness_ratio = {}\ntangential_damping_ratio = {}\n",
                        name, kDensity, stiffness, 4 * zeta * rate(stiffness), grains.friction, kTangentialRatio,
                        kTangentialRatio);
  text += fmt::format("[contact.\"grain|wall\"]\ndamping = {}\n", 2 * zeta * rate(stiffness));
  text += fmt::format("[[plane]]\npoint = [0, 0, 0]\nnormal = [0, 0, 1]\nmaterial = \"wall\"\n");
  text += fmt::format("[[grain]]\nposition = [0, 0, {}]\nradius = {}\nmaterial = \"grain\"\n", kRadius, kRadius);
  scene::Scene scene = setup::parseScene(text, "study");
  scene.run.gravity = {0, 0, -kOwnOverlap * kRadius * rate(stiffness) * rate(stiffness)};
  return scene;
}

/// Grains of the scene, with a time step that is not checked.
Grains build(const RestingGrains& grains, double stiffness, double zeta, double timeStep,
             const std::vector<terrain::GrainSpec>& start) {
  const scene::Scene scene = sceneOf(grains, stiffness, zeta);
  setup::Surroundings around;
  around.walls = {{{0, 0, 1}, 0, "wall"}};
  if (grains.box)
    for (const Vec3d& n : {Vec3d{1, 0, 0}, Vec3d{-1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, -1, 0}})
      around.walls.push_back({n, -grains.halfWidth, "wall"});
  terrain::Boundaries boundaries;
  const terrain::GrainModel model = setup::grainModel(scene, setup::grainKinds(scene), timeStep, around, boundaries);
  return Grains(base::cpuExec(1), model, boundaries, start);
}

std::vector<terrain::GrainSpec> places(const terrain::GrainState& state) {
  const base::PositionScale scale = base::positionScale(2 * kRadius);
  std::vector<terrain::GrainSpec> start;
  for (const base::Position& p : state.position) start.push_back({scale.toMetres(p), {}, {}});
  return start;
}

/// Contact springs of `state`.
ContactNetwork networkOf(const RestingGrains& grains) {
  const terrain::GrainState& s = grains.state;
  ContactNetwork network;
  network.spheres = s.rows(), network.tangentialRatio = grains.friction > 0 ? kTangentialRatio : 0;
  std::size_t at = 0;
  for (std::size_t i = 0; i < s.rows(); ++i) {
    for (std::uint32_t k = 0; k < s.contacts[i]; ++k) {
      const std::uint32_t j = s.neighbour[at++];
      if (j < i) continue;
      const base::Vec3i apart = base::difference(s.position[i], s.position[j]);
      network.contacts.push_back({static_cast<std::uint32_t>(i), j, normalized(apart.as<double>())});
    }
    const Vec3d outwards[] = {{0, 0, -1}, {-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}};
    for (unsigned w = 0; w < 5; ++w)
      if (s.wallBits[i] >> w & 1) network.contacts.push_back({static_cast<std::uint32_t>(i), -1, outwards[w]});
  }
  return network;
}

/// Settles the grains; repeatedly resets all velocities to zero.
void settle(RestingGrains& resting, const std::vector<terrain::GrainSpec>& start) {
  Grains grains = build(resting, kSettleStiffness, kSettleZeta, kSettleStep / rate(kSettleStiffness), start);
  const auto advance = [&grains](int steps) {
    for (int i = 0; i < steps; ++i) {
      grains.refreshNeighbours();
      grains.step();
    }
  };
  constexpr int kFall = 4000, kBetween = 500, kTimes = 200;
  constexpr double kAtRest = 1e-5; // mean resultant force / weight of a grain
  advance(kFall);
  for (int k = 0; k < kTimes; ++k) {
    grains.stop();
    advance(kBetween);
    resting.forceRatio = terrain::forceRatio(grains.system());
    if (resting.forceRatio < kAtRest) break;
    jobs::stopStudyOnRequest();
  }
  grains.stop();
  advance(1); // updates the contacts at rest
  resting.state = grains.state();
  resting.network = networkOf(resting);
  resting.frequency = highestFrequency(resting.network);
  resting.gershgorin = gershgorinFrequency(resting.network);
}

} // namespace

RestingGrains oneContact() {
  RestingGrains r;
  r.name = "contact", r.title = "one sphere on a plane", r.vertical = true;
  settle(r, {{{0, 0, kRadius * (1 - kOwnOverlap)}, {}, {}}});
  return r;
}

RestingGrains column(int grains) {
  RestingGrains r;
  r.name = "column", r.title = fmt::format("column of {} spheres", grains), r.vertical = true;
  std::vector<terrain::GrainSpec> start;
  double z = 0;
  for (int i = 0; i < grains; ++i) {
    // The contact below sphere i supports the weight of sphere i and of all spheres above.
    z += (i == 0 ? 1 : 2) * kRadius - (grains - i) * kOwnOverlap * kRadius;
    start.push_back({{0, 0, z}, {}, {}});
  }
  settle(r, start);
  return r;
}

RestingGrains randomBed(int grains, double friction) {
  constexpr double kLoose = 2.3; // initial lattice spacing [radii]
  RestingGrains r;
  r.friction = friction, r.box = true;
  r.name = friction > 0 ? "bed with friction" : "bed";
  const auto side = std::max(2, static_cast<int>(std::lround(std::cbrt(grains))));
  r.halfWidth = 0.5 * side * kLoose * kRadius;
  std::vector<terrain::GrainSpec> start;
  for (int i = 0; i < grains; ++i) {
    const auto id = static_cast<std::uint64_t>(i);
    const auto shake = [&](std::uint64_t a) { return 0.9 * (base::uniform(kSeed, kPurpose, id, a) - 0.5); };
    const double gap = (kLoose - 2) * kRadius, spacing = kLoose * kRadius;
    start.push_back({{(i % side + 0.5) * spacing - r.halfWidth + shake(0) * gap,
                      (i / side % side + 0.5) * spacing - r.halfWidth + shake(1) * gap,
                      (i / (side * side) + 0.5) * spacing + shake(2) * gap},
                     {},
                     {}});
  }
  settle(r, start);
  r.title = fmt::format("random bed of {} spheres, friction {:g}", grains, friction);
  return r;
}

double predictedLimit(const RestingGrains& grains, double zeta) {
  return contact::stableStep(grains.frequency, zeta * grains.frequency);
}

double calmLimit(const RestingGrains& grains, double stiffness, double zeta) {
  return setup::stepLimit(sceneOf(grains, stiffness, zeta)).calm;
}

GrainStabilityCell tryCell(const RestingGrains& resting, double stiffness, double zeta, double timeStep) {
  GrainStabilityCell cell;
  cell.stiffness = stiffness, cell.zeta = zeta, cell.timeStep = timeStep;
  cell.scaled = timeStep * rate(stiffness);
  cell.ofLimit = cell.scaled / predictedLimit(resting, zeta);
  cell.calm = timeStep <= calmLimit(resting, stiffness, zeta);
  Grains grains = build(resting, stiffness, zeta, timeStep, places(resting.state));
  terrain::GrainState state = resting.state;
  const double speed = kDisturbance * kOwnOverlap * kRadius * rate(stiffness);
  for (std::size_t i = 0; i < state.rows(); ++i) {
    const auto random = [&](std::uint64_t k) {
      return static_cast<float>(speed * 2 * (base::uniform(kSeed, kPurpose, i, 10 + k) - 0.5));
    };
    state.velocity[i] = resting.vertical ? base::Vec3f{0, 0, random(2)} : base::Vec3f{random(0), random(1), random(2)};
    if (resting.state.rows() == 1) state.velocity[i].z = static_cast<float>(speed);
  }
  grains.restore(state);
  const double mass = grains.model().mass;
  double first = 0;
  for (const base::Vec3f& v : state.velocity) first += 0.5 * mass * dot(v.as<double>(), v.as<double>());
  constexpr int kLookEvery = 5;
  cell.stable = true;
  try {
    for (int i = 0; i < kStabilitySteps && cell.stable; ++i) {
      grains.refreshNeighbours();
      grains.step();
      if (i % kLookEvery) continue;
      const terrain::GrainLedger ledger = grains.ledger();
      cell.growth = std::max(cell.growth, (ledger.kinetic + ledger.rotational) / first);
      cell.stable = cell.growth <= kGrowth; // also false for NaN
    }
  } catch (const base::SimulationError&) {
    cell.stable = false, cell.stopped = true;
  }
  return cell;
}

StabilityAxes stabilityAxes(bool quick) {
  StabilityAxes axes;
  axes.stiffness = quick ? std::vector<double>{1e5} : std::vector<double>{1e4, 1e5, 1e6};
  axes.zeta = quick ? std::vector<double>{0, 0.3, 1} : std::vector<double>{0, 0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 1, 2};
  for (int k = 1; k <= (quick ? 6 : 22); ++k) axes.scaled.push_back((quick ? 0.4 : 0.1) * k);
  axes.ofLimit = {0.95, 1.05};
  if (!quick) axes.ofLimit = {0.5, 0.8, 0.9, 0.95, 0.98, 1.02, 1.05, 1.1, 1.25, 1.5};
  return axes;
}

GrainStabilityMap stabilityMap(const RestingGrains& grains, const StabilityAxes& axes) {
  GrainStabilityMap map{grains, {}};
  for (const double stiffness : axes.stiffness)
    for (const double zeta : axes.zeta) {
      const double limit = predictedLimit(grains, zeta);
      for (const double scaled : axes.scaled)
        map.cells.push_back(tryCell(grains, stiffness, zeta, scaled / rate(stiffness)));
      for (const double share : axes.ofLimit)
        map.cells.push_back(tryCell(grains, stiffness, zeta, share * limit / rate(stiffness)));
      jobs::stopStudyOnRequest();
    }
  return map;
}

} // namespace grouser::studies
