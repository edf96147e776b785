// SPDX-License-Identifier: BSD-3-Clause
#include "runs/studies/plate_test.hpp"

#include "base/math.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/studies/common.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace grouser::studies {

namespace {

constexpr double kGravity = 9.81;
constexpr double kExpectedAngle = 24 * base::kPi / 180, kExpectedSolid = 0.59; // for the speed only
constexpr double kRoughFriction = 2;
constexpr double kOffEnds = 2;    // [d] left out below and above where porosity is measured
constexpr int kLatticeLayers = 5; // as the beds of before had
constexpr double kLatticeSpacing = 2.02;
constexpr double kRestAgain = 1e-5, kPatience = 3; // of m g r; [s]

/// What bears the bed, as sections of a scene.
std::string floorSections(const Soil& soil, const PlateTest& test, std::int64_t seed) {
  if (test.floor == BedFloor::fixed) {
    std::string text;
    for (const BedGrain& g : roughFloor(soil, test.bed(soil), seed))
      text += fmt::format("[[grain]]\nposition = [{:.12g}, {:.12g}, {:.12g}]\nradius = {:.9g}\nmaterial = \"grain\"\n"
                          "fixed = true\n",
                          g.position.x, g.position.y, g.position.z, g.radius);
    return text;
  }
  SampleGrains floor = soil.grains;
  if (test.floor == BedFloor::rough) floor.friction = kRoughFriction;
  std::string text = floor.toml("floor") + "[[plane]]\nmaterial = \"floor\"\n";
  if (test.floor == BedFloor::rough) text += fmt::format("[contact.\"grain|floor\"]\nfriction = {}\n", kRoughFriction);
  return text;
}

/// Equal spheres in layers, at rest.
BedGrains layLattice(const Soil& soil, const BedSize& size, const std::string& below, std::int64_t seed,
                     const std::filesystem::path& folder, const base::Exec& exec) {
  const double r = soil.grains.radius, high = (kLatticeLayers - 1) * kLatticeSpacing * r + 2.02 * r;
  const std::string text =
      soil.scene(1, seed, soil.grains.friction, {0, 0, -kGravity}, size.run()) + below +
      fmt::format("[[grains]]\nform = \"lattice\"\nlow = [0, 0, 0]\nhigh = [{:.17g}, {:.17g}, {:.17g}]\nradius = "
                  "{:.17g}\nspacing = {}\njitter = 0.5\nmaterial = \"grain\"\n",
                  size.length, size.width, high, r, kLatticeSpacing);
  simulation::Simulation simulation(setup::simulationSetup(setup::parseScene(text, folder / "lattice.toml")), exec,
                                    [](double, double) {});
  comeToRest(simulation, kRestAgain, kPatience);
  return grainsOf(simulation, size);
}

std::string plateSection(const Soil& soil, const PlateTest& test, double bottom, double speed) {
  const double d = soil.grains.diameter(), b = test.breadth * d, tall = 2 * (1 + test.sinkage) * b;
  const BedSize size = test.bed(soil);
  const std::string place =
      fmt::format("name = \"plate\"\nmaterial = \"grain\"\nposition = [{:.17g}, {:.17g}, {:.17g}]\nvelocity = [0, 0, "
                  "{:.17g}]\n",
                  0.5 * size.length, 0.5 * size.width, bottom + 0.5 * tall, -speed);
  if (test.shape == PlateShape::strip)
    return "[[box]]\n" + place + fmt::format("size = [{:.17g}, {:.17g}, {:.17g}]\n", b, size.width + 4 * d, tall);
  return "[[cylinder]]\n" + place +
         fmt::format("axis = [0, 0, 1]\nradius = {:.17g}\nlength = {:.17g}\n", 0.5 * b, tall);
}

/// Highest top of the grains that the plate will meet first [m].
double topUnder(const Soil& soil, const PlateTest& test, const BedGrains& bed) {
  const BedSize size = test.bed(soil);
  const double reach = 0.5 * test.breadth * soil.grains.diameter();
  double top = -1e300;
  for (const BedGrain& g : bed) {
    const double x = g.position.x - 0.5 * size.length;
    const double y = test.shape == PlateShape::strip ? 0 : g.position.y - 0.5 * size.width;
    if (std::hypot(x, y) < reach + g.radius) top = std::max(top, g.position.z + g.radius);
  }
  return top;
}

} // namespace

BedSize PlateTest::bed(const Soil& soil) const {
  const double d = soil.grains.diameter(), b = breadth * d;
  return {bin * b, shape == PlateShape::strip ? thickness * d : bin * b, depth * b};
}

double PlateTest::area(const Soil& soil) const {
  const double b = breadth * soil.grains.diameter();
  return shape == PlateShape::strip ? b * bed(soil).width : 0.25 * base::kPi * b * b;
}

double PlateTest::speed(const Soil& soil) const {
  const double d = soil.grains.diameter(), b = breadth * d;
  const double expected =
      bearingPressure(shape, kExpectedAngle, kExpectedSolid * soil.grains.density * kGravity, b, 0.5 * sinkage * b);
  return inertialNumber * breadth * std::sqrt(expected / soil.grains.density);
}

Table pushPlate(const Soil& soil, const PlateTest& test, std::int64_t seed, const std::filesystem::path& folder,
                const std::filesystem::path& keep, const base::Exec& exec) {
  const double d = soil.grains.diameter(), b = test.breadth * d, speed = test.speed(soil);
  const BedSize size = test.bed(soil);
  const std::string below = floorSections(soil, test, seed);
  BedGrains bed;
  if (test.lattice) {
    bed = layLattice(soil, size, below, seed, folder, exec);
  } else {
    bed = pourBed(soil, size, below, seed, folder, exec);
  }
  // Grains of the floor have the first ids, and stand in sections of their own.
  if (test.floor == BedFloor::fixed)
    bed.erase(bed.begin(), bed.begin() + static_cast<std::ptrdiff_t>(roughFloor(soil, size, seed).size()));
  writeBed(folder / "bed.txt", bed);
  if (!keep.empty()) writeBed(keep, bed);
  const double surface = surfaceHeight(bed, size, d), bottom = topUnder(soil, test, bed) + 1e-3 * d;
  const double solid = test.lattice ? solidFraction(bed, size, 0.5 * d, surface - d)
                                    : solidFraction(bed, size, kOffEnds * d, surface - kOffEnds * d);
  const double way = bottom - surface + test.sinkage * b;
  const std::string text = soil.scene(way / speed, seed, soil.grains.friction, {0, 0, -kGravity}, size.run()) + below +
                           plateSection(soil, test, bottom, speed) +
                           "[[grains]]\nform = \"file\"\nfile = \"bed.txt\"\nmaterial = \"grain\"\n";
  simulation::Simulation simulation(setup::simulationSetup(setup::parseScene(text, folder / "push.toml")), exec,
                                    [](double, double) {});
  const auto all = static_cast<std::int64_t>(way / speed / simulation.timeStep());
  Table table;
  table.names = kPlateColumns;
  const simulation::Surfaces& surfaces = *simulation.surfaces();
  for (int row = 1; row <= test.rows; ++row) {
    const std::int64_t from = simulation.steps(), until = all * row / test.rows;
    while (simulation.steps() < until) {
      stopStudyIfAsked();
      simulation.advance(std::min<std::int64_t>(until - simulation.steps(), 2000));
    }
    const double middle = 0.5 * static_cast<double>(from + until) * simulation.timeStep();
    for (std::size_t i = 0; i < surfaces.count(); ++i)
      if (surfaces.surface(i).name == "plate")
        table.rows.push_back({surface - bottom + speed * middle, surfaces.observe(i, simulation.steps()).force.z,
                              1 - solid, static_cast<double>(bed.size())});
    simulation.restartMeans();
  }
  simulation.checkEnergy();
  return table;
}

double meanPressure(const Table& run, double area, double from, double to) {
  const std::size_t sinkage = run.column("sinkage [m]"), force = run.column("force [N]");
  double sum = 0;
  int count = 0;
  for (const std::vector<double>& row : run.rows)
    if (row[sinkage] > from && row[sinkage] <= to) sum += row[force], ++count;
  return count > 0 ? sum / count / area : std::nan("");
}

double meanBearing(PlateShape shape, double angle, double unitWeight, double breadth, double from, double to) {
  // The theory is linear in the sinkage.
  return bearingPressure(shape, angle, unitWeight, breadth, 0.5 * (from + to));
}

} // namespace grouser::studies
