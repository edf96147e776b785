// SPDX-License-Identifier: BSD-3-Clause
#include "runs/virtual_tests/plate_bed.hpp"

#include "base/sphere.hpp"
#include "runs/jobs/study_place.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/simulation_setup.hpp"
#include "terrain/random_bed.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>

namespace grouser::virtual_tests {

namespace {

constexpr double kRoughFriction = 2;
constexpr double kPorosity = 0.4;      // expected porosity, for the number of grains
constexpr double kRestOfPlates = 1e-4; // [m g r] rest limit: 1/10 of the energy of a grain that moves with a plate
constexpr double kLiftRest = 1e-2;     // [m g r] limit between lifts: the next impact has about 1000 times this energy
constexpr double kBedPatience = 6;     // [s] maximum settling time
constexpr double kFall = 1.5;          // [m/s] approximate impact speed of grains
constexpr int kLatticeLayers = 5;      // layers of a lattice bed
constexpr double kLatticeSpacing = 2.02;

/// The soil with its grain radius multiplied by `scale`.
Soil coarse(const Soil& soil, double scale) {
  Soil other = soil;
  other.grains.radius *= scale;
  return other;
}

double weightTimesRadius(const Soil& soil, const BedGrains& grains) {
  double sum = 0;
  for (const BedGrain& g : grains) sum += base::sphereMass(soil.grains.density, g.radius) * jobs::kGravity * g.radius;
  return sum;
}

/// Scene text of the bed on `below`, with the soil's preparation friction.
std::string sceneOf(const Soil& soil, const BedPreparation& bed, const std::string& below, std::int64_t seed) {
  return soil.prepared().scene(1, seed, soil.preparationFriction, {0, 0, -jobs::kGravity},
                               bed.size.run() + fmt::format("impact_speed = {}\n", kFall)) +
         below;
}

/// Equal spheres in layers, at rest.
PreparedBed layLattice(const Soil& soil, const BedPreparation& bed, std::int64_t seed,
                       const std::filesystem::path& folder, const base::Exec& exec) {
  const double r = soil.grains.radius, high = (kLatticeLayers - 1) * kLatticeSpacing * r + 2.02 * r;
  const std::string text =
      sceneOf(soil, bed, floorSections(soil, bed, seed), seed) +
      fmt::format("[[grains]]\nform = \"lattice\"\nlow = [0, 0, 0]\nhigh = [{:.17g}, {:.17g}, {:.17g}]\nradius = "
                  "{:.17g}\nspacing = {}\njitter = 0.5\nmaterial = \"grain\"\n",
                  bed.size.length, bed.size.width, high, r, kLatticeSpacing);
  coupling::Simulation simulation(setup::simulationSetup(setup::parseScene(text, folder / "lattice.toml")), exec,
                                  [](double, double) {});
  PreparedBed laid{grainsOf(simulation, bed.size), 0, 0};
  comeToRest(simulation, kRestOfPlates * weightTimesRadius(soil, laid.grains), kBedPatience);
  return {grainsOf(simulation, bed.size), simulation.steps(), 0};
}

/// The lifts (layers of loose grains) from which the bed is rained, lowest first.
std::vector<BedGrains> looseLifts(const Soil& soil, const BedPreparation& bed, const BedGrains& floor,
                                  std::int64_t seed) {
  terrain::RandomBedOptions o;
  o.radii = {terrain::RadiusLaw::uniform, soil.grains.radius, soil.spread, {}, {}};
  o.grading = bed.grading, o.depth = bed.size.depth, o.porosity = kPorosity;
  o.roughFloor = bed.floor == BedFloor::fixed, o.periodic = {true, true}, o.seed = static_cast<std::uint64_t>(seed);
  std::vector<terrain::Seed> there;
  for (const BedGrain& g : floor) there.push_back({g.position, g.radius, true});
  const auto surface = terrain::HeightField::flat({0, bed.size.length, 0, bed.size.width}, bed.size.depth);
  const std::vector<terrain::Seed> column = terrain::layGrains(surface, o, there);
  double all = 0, below = 0;
  for (const terrain::Seed& s : column) all += base::sphereVolume(s.radius);
  const std::vector<double> tops = liftTops(bed);
  std::vector<BedGrains> lifts(tops.size());
  std::size_t lift = 0;
  for (const terrain::Seed& s : column) {
    while (lift + 1 < lifts.size() && below / all >= tops[lift] / bed.size.depth) ++lift;
    lifts[lift].push_back({s.centre, s.radius});
    below += base::sphereVolume(s.radius);
  }
  return lifts;
}

/// Raises a lift above the bed.
void raise(BedGrains& lift, const BedGrains& bed) {
  double top = -1e300, bottom = 1e300;
  for (const BedGrain& g : bed) top = std::max(top, g.position.z + g.radius);
  for (const BedGrain& g : lift) bottom = std::min(bottom, g.position.z - g.radius);
  if (bed.empty() || lift.empty()) return;
  for (BedGrain& g : lift) g.position.z += top - bottom + 0.01 * g.radius;
}

PreparedBed rainBed(const Soil& soil, const BedPreparation& bed, std::int64_t seed, const std::filesystem::path& folder,
                    const base::Exec& exec, const std::function<void(const std::string&)>& report) {
  BedGrains floor;
  if (bed.floor == BedFloor::fixed) floor = roughFloor(coarse(soil, bed.coarsest(soil)), bed.size, seed);
  std::vector<BedGrains> lifts = looseLifts(soil, bed, floor, seed);
  const std::string text = sceneOf(soil, bed, floorSections(soil, bed, seed), seed) +
                           "[[grains]]\nform = \"file\"\nfile = \"lift.txt\"\nmaterial = \"grain\"\n";
  PreparedBed made;
  for (std::size_t k = 0; k < lifts.size(); ++k) {
    report(fmt::format("lift {} of {}", k + 1, lifts.size()));
    raise(lifts[k], made.grains);
    made.grains.insert(made.grains.end(), lifts[k].begin(), lifts[k].end());
    writeBed(folder / "lift.txt", made.grains);
    coupling::Simulation simulation(setup::simulationSetup(setup::parseScene(text, folder / "rain.toml")), exec,
                                    [](double, double) {});
    const bool last = k + 1 == lifts.size();
    const double rest = last ? kRestOfPlates : kLiftRest;
    if (const double left = comeToRest(simulation, rest * weightTimesRadius(soil, made.grains), kBedPatience);
        !(left < 1))
      failRestless(seed, kBedPatience, rest * left);
    made.grains = grainsOf(simulation, bed.size);
    made.grains.erase(made.grains.begin(), made.grains.begin() + static_cast<std::ptrdiff_t>(floor.size()));
    made.steps += simulation.steps();
  }
  std::filesystem::remove(folder / "lift.txt");
  return made;
}

} // namespace

double BedPreparation::coarsest(const Soil& soil) const { return grading.scaleAt(size.depth, soil.grains.radius); }

std::string floorSections(const Soil& soil, const BedPreparation& bed, std::int64_t seed) {
  if (bed.floor == BedFloor::fixed) {
    std::string text;
    const Soil below = coarse(soil, bed.coarsest(soil));
    for (const BedGrain& g : roughFloor(below, bed.size, seed))
      text += fmt::format("[[grain]]\nposition = [{:.12g}, {:.12g}, {:.12g}]\nradius = {:.9g}\nmaterial = \"grain\"\n"
                          "fixed = true\n",
                          g.position.x, g.position.y, g.position.z, g.radius);
    // This plane stops small grains that fall through gaps between the fixed grains.
    text += fmt::format("[[plane]]\npoint = [0, 0, {:.12g}]\nmaterial = \"grain\"\n", -roughFloorDepth(below));
    return text;
  }
  SampleGrains floor = soil.grains;
  if (bed.floor == BedFloor::rough) floor.friction = kRoughFriction;
  std::string text = floor.toml("floor") + "[[plane]]\nmaterial = \"floor\"\n";
  if (bed.floor == BedFloor::rough) text += fmt::format("[contact.\"grain|floor\"]\nfriction = {}\n", kRoughFriction);
  return text;
}

std::vector<double> liftTops(const BedPreparation& bed) {
  const double wanted = bed.lift > 0 ? bed.size.depth / bed.lift : 1;
  const int lifts = std::max(1, static_cast<int>(std::lround(wanted)));
  std::vector<double> tops;
  for (int k = 1; k <= lifts; ++k) tops.push_back(bed.size.depth * k / lifts);
  return tops;
}

PreparedBed prepareBed(const Soil& soil, const BedPreparation& bed, std::int64_t seed,
                       const std::filesystem::path& folder, const base::Exec& exec,
                       const std::function<void(const std::string&)>& report) {
  const auto begin = std::chrono::steady_clock::now();
  PreparedBed made =
      bed.lattice ? layLattice(soil, bed, seed, folder, exec) : rainBed(soil, bed, seed, folder, exec, report);
  made.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return made;
}

PreparedBed keptBed(const Soil& soil, const BedPreparation& bed, std::int64_t seed, const std::filesystem::path& folder,
                    const base::Exec& exec, const std::function<void(const std::string&)>& report) {
  constexpr const char* kHead = "# x, y, z, r [m]; steps, seconds: %ld, %lf";
  const std::filesystem::path file = folder / "bed.txt";
  PreparedBed made;
  if (!std::filesystem::exists(file)) {
    made = prepareBed(soil, bed, seed, folder, exec, report);
    writeBed(file, made.grains, fmt::format("; steps, seconds: {}, {:.3f}", made.steps, made.seconds));
  }
  // Read the file even if this call wrote it, so that new and stored beds give bitwise the same results.
  std::ifstream in(file);
  std::string head;
  std::getline(in, head);
  long steps = 0;
  if (std::sscanf(head.c_str(), kHead, &steps, &made.seconds) == 2) made.steps = steps;
  made.grains = readBed(file);
  return made;
}

} // namespace grouser::virtual_tests
