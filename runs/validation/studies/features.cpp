// SPDX-License-Identifier: BSD-3-Clause
#include "runs/validation/studies/features.hpp"

#include "base/error.hpp"
#include "coupling/settled_ground.hpp"
#include "coupling/simulation.hpp"
#include "runs/output/frames_file.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/simulation_setup.hpp"
#include "runs/support/stopwatch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace grouser::studies {

namespace {

constexpr double kFeatureRadius = 0.01, kFeatureStiffness = 1e5; // [m], [N/m]
constexpr int kLayers = 6, kTile = 12;                           // number of layers; grains per side of the tile
constexpr double kFeatureSpacing = 2.1;                          // [radii] lattice spacing
constexpr std::int64_t kCompared = 300;                          // number of steps before states are compared
constexpr std::int64_t kOutputEvery = 100;                       // number of steps between outputs

/// Lines "key = value" of one section, from lines of the form "section: key = value".
std::string keysOf(const std::string& keys, const std::string& section) {
  std::string found;
  std::istringstream lines(keys);
  for (std::string line; std::getline(lines, line);)
    if (line.rfind(section + ": ", 0) == 0) found += line.substr(section.size() + 2) + "\n";
  return found;
}

/// Ground of the scene with these keys.
std::vector<terrain::GrainSpec> placesOf(const coupling::GroundSetup& setup, const base::Exec& exec) {
  const coupling::LaidGround ground = coupling::buildGround(setup, exec);
  const terrain::GrainSnapshot at = ground.grains->snapshot();
  std::vector<terrain::GrainSpec> start;
  for (std::size_t i = 0; i < at.position.size(); ++i) {
    terrain::GrainSpec grain{at.position[i], {}, {}};
    grain.radius = at.radius.empty() ? ground.grains->model().radius : static_cast<double>(at.radius[i]);
    grain.fixed = !at.fixed.empty() && at.fixed[i] != 0;
    start.push_back(grain);
  }
  return start;
}

coupling::GroundSetup groundOf(const FeaturesCommand& c, const std::string& keys) {
  return setup::simulationSetup(setup::parseScene(featureScene(c.grains, keys), "features.toml")).ground;
}

void advance(terrain::Grains& grains, std::int64_t steps) {
  for (std::int64_t i = 0; i < steps;) i += grains.advance(steps - i);
}

/// Calls `turn(false)` and `turn(true)` in pairs with alternating order. `turn` returns the time per step.
template <class Turn> void inPairs(int pairs, const Turn& turn, jobs::Table& table) {
  turn(false), turn(true); // warm-up, which allocates memory and builds neighbour lists
  for (int k = 0; k < pairs; ++k) {
    jobs::stopStudyOnRequest();
    double without = 0, with = 0;
    if (k % 2 == 0)
      without = turn(false), with = turn(true);
    else
      with = turn(true), without = turn(false);
    table.rows.push_back({without, with, 0, 0, 0, 0, 0});
  }
}

void fill(jobs::Table& table, double bytesWithout, double bytesWith, double grainsWithout, double grainsWith,
          bool same) {
  for (std::vector<double>& row : table.rows)
    row[2] = bytesWithout, row[3] = bytesWith, row[4] = grainsWithout, row[5] = grainsWith, row[6] = same ? 1 : 0;
}

/// Number of steps that take about `seconds`, estimated from a first measurement.
template <class Step> std::int64_t stepsIn(double seconds, const Step& step) {
  step(5);
  const support::Stopwatch start;
  step(20);
  return std::max<std::int64_t>(20, std::llround(seconds / (start.seconds() / 20)));
}

std::string hashOfGrains(const terrain::Grains& grains) { return terrain::hashOf(grains.state(), base::Comm()).hex(); }

double bytesOf(const terrain::Grains& grains) {
  return static_cast<double>(grains.system().deviceBytes()) / static_cast<double>(grains.count());
}

} // namespace

std::string featureScene(int grains, const std::string& keys) {
  const double cell = kFeatureSpacing * kFeatureRadius;
  const int side = std::max(kTile, static_cast<int>(std::lround(std::sqrt(grains / double(kLayers)) / kTile)) * kTile);
  std::string material = "restitution = 0.3\n" + keysOf(keys, "material"), terrain = keysOf(keys, "terrain");
  if (material.find("\nfriction") == std::string::npos) material += "friction = 0.5\n";
  if (material.find("young") == std::string::npos) material += fmt::format("stiffness = {:g}\n", kFeatureStiffness);
  if (terrain.find("arrangement") == std::string::npos)
    terrain += fmt::format("arrangement = \"lattice\"\nlayers = {}\nspacing = {:g}\n", kLayers, kFeatureSpacing);
  return fmt::format("version = 1\n[run]\nduration = 10\nperiodic = [true, true]\n{}[material.soil]\n{}[terrain]\n"
                     "heightmap = \"heightmaps/flat.png\"\nsize = [{:.17g}, {:.17g}]\nheight_range = [0, 0]\n"
                     "material = \"soil\"\ngrain_radius = {:g}\ntile = [{:.17g}, {:.17g}]\nsettle_time_limit = 20\n"
                     "settle_kinetic_energy = 1e-3\ncache = false\n{}",
                     keysOf(keys, "run"), material, side * cell, side * cell, kFeatureRadius, kTile * cell,
                     kTile * cell, terrain);
}

const std::vector<Feature>& features() {
  const auto ledgerOff = [](coupling::GroundSetup& g) { g.grains->model.ledger = false; };
  const auto radii = [](coupling::GroundSetup& g) { g.grains->model.smallestRadius = 0.5 * g.grains->model.radius; };
  const std::string random = "terrain: arrangement = \"random\"\nterrain: depth = 0.12\n";
  static const std::vector<Feature> all = {
      {"friction", "friction = 0.5, compared with 0", "material: friction = 0\n", ""},
      {"rolling", "rolling_friction = 0.1", "", "material: rolling_friction = 0.1\n"},
      {"cohesion", "cohesion = 0.05 J/m2", "", "material: cohesion = 0.05\n"},
      {"hertz", "law = \"hertz\"", "", "material: law = \"hertz\"\nmaterial: young = 1e7\n"},
      {"double", "precision = \"double\"", "", "run: precision = \"double\"\n"},
      {"radii", "one (equal) radius per grain", "", "", false, false, radii},
      {"random_radii", "arrangement = \"random\" with radii +- 25 %, on a bed of its own", "", random, true},
      {"grading", "coarsening = 0.1 below 0.05 m, compared with random radii", random,
       random + "terrain: fine_depth = 0.05\nterrain: coarsening = 0.1\nterrain: coarsest_radius = 0.016\n", true},
      {"no_ledger", "no energy accounting (internal option)", "", "", false, false, ledgerOff},
      {"off_rolling", "rolling_friction = 0", "", "material: rolling_friction = 0\n", false, true},
      {"off_cohesion", "cohesion = 0", "", "material: cohesion = 0\n", false, true},
      {"off_linear", "law = \"linear\"", "", "material: law = \"linear\"\n", false, true},
      {"off_single", "precision = \"single\"", "", "run: precision = \"single\"\n", false, true},
      {"off_floor", "floor = \"follow\"", "", "terrain: floor = \"follow\"\n", false, true}};
  return all;
}

jobs::Table measureFeature(const FeaturesCommand& c, const Feature& feature, const base::Exec& exec) {
  const coupling::GroundSetup base = groundOf(c, "");
  coupling::GroundSetup setups[] = {groundOf(c, feature.without), groundOf(c, feature.with)};
  if (feature.change) feature.change(setups[1]);
  std::vector<terrain::GrainSpec> start;
  if (!feature.ownBeds) start = placesOf(base, exec);
  coupling::LaidGround grounds[2];
  for (int k = 0; k < 2; ++k)
    grounds[k] =
        feature.ownBeds ? coupling::buildGround(setups[k], exec) : coupling::layGround(setups[k], exec, {}, &start);
  const auto grainsOf = [&](bool with) -> terrain::Grains& { return *grounds[with ? 1 : 0].grains; };
  for (const bool with : {false, true}) advance(grainsOf(with), kCompared);
  const bool same = hashOfGrains(grainsOf(false)) == hashOfGrains(grainsOf(true));
  const std::int64_t steps = stepsIn(c.turn, [&](std::int64_t n) {
    advance(grainsOf(false), n);
    base::synchronize(exec);
  });
  jobs::Table table{kFeatureColumns, {}};
  inPairs(
      c.pairs,
      [&](bool with) {
        terrain::Grains& grains = grainsOf(with);
        const support::Stopwatch begin;
        advance(grains, steps);
        base::synchronize(exec);
        return 1e9 * begin.seconds() / static_cast<double>(steps) / static_cast<double>(grains.count());
      },
      table);
  fill(table, bytesOf(grainsOf(false)), bytesOf(grainsOf(true)), static_cast<double>(grainsOf(false).count()),
       static_cast<double>(grainsOf(true).count()), same);
  return table;
}

jobs::Table measureOutput(const FeaturesCommand& c, const base::Exec& exec, const std::filesystem::path& folder) {
  coupling::LaidGround ground = coupling::buildGround(groundOf(c, ""), exec);
  terrain::Grains& grains = *ground.grains;
  output::FramesFile frames(folder, {}, {});
  const auto write = [&] {
    grains.ledger(); // as in a run, for an output row
    const terrain::GrainSnapshot at = grains.snapshot({true});
    output::Frame frame;
    frame.step = grains.steps(), frame.time = static_cast<double>(grains.steps());
    for (const base::Vec3d& p : at.position)
      frame.positions.push_back({static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)});
    frame.radii.assign(at.position.size(), static_cast<float>(kFeatureRadius));
    frame.velocities = at.velocity, frame.ids = at.id;
    frame.contactForces = at.contactForce, frame.withContactForces = true;
    frames.add(frame);
  };
  const auto step = [&](std::int64_t n) {
    advance(grains, n);
    base::synchronize(exec);
  };
  const std::int64_t turns = std::max<std::int64_t>(1, stepsIn(c.turn, step) / kOutputEvery);
  jobs::Table table{kFeatureColumns, {}};
  inPairs(
      c.pairs,
      [&](bool with) {
        const support::Stopwatch begin;
        for (std::int64_t k = 0; k < turns; ++k) {
          step(kOutputEvery);
          if (with) write();
        }
        return 1e9 * begin.seconds() / static_cast<double>(turns * kOutputEvery) / static_cast<double>(grains.count());
      },
      table);
  const auto n = static_cast<double>(grains.count());
  fill(table, bytesOf(grains), bytesOf(grains), n, n, true);
  return table;
}

FeatureCost costOf(const jobs::Table& table) {
  FeatureCost cost;
  const std::vector<double> a = table.values("without [ns]"), b = table.values("with [ns]");
  cost.without = jobs::interval95(a).value, cost.with = jobs::interval95(b).value;
  cost.difference = jobs::pairedChange(a, b), cost.relative = jobs::pairedDifference(a, b);
  cost.bytesWithout = table.values("bytes without").front(), cost.bytesWith = table.values("bytes with").front();
  cost.sameState = table.values("same state").front() != 0;
  return cost;
}

bool FeatureCost::isNothing() const {
  return sameState && bytesWith == bytesWithout && std::fabs(difference.value) <= difference.halfWidth;
}

} // namespace grouser::studies
