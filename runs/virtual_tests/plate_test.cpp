// SPDX-License-Identifier: BSD-3-Clause
#include "runs/virtual_tests/plate_test.hpp"

#include "base/math.hpp"
#include "runs/jobs/study_place.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/simulation_setup.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

namespace grouser::virtual_tests {

namespace {

constexpr double kCoarsest = 2.0 / 7; // largest grain diameter / distance between the periodic boundaries
constexpr double kPushBedShare = 0.3; // approximate fraction of the wall time spent on the bed

} // namespace

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
  const double expected = bearingPressure(shape, kExpectedAngle, kExpectedSolid * soil.grains.density * jobs::kGravity,
                                          b, 0.5 * sinkage * b);
  return inertialNumber * breadth * std::sqrt(expected / soil.grains.density);
}

BedPreparation PlateTest::preparation(const Soil& soil) const {
  BedPreparation p;
  p.size = bed(soil), p.floor = floor, p.lattice = lattice, p.lift = breadth * soil.grains.diameter();
  p.grading = {fineDepth * breadth * soil.grains.diameter(), coarsening,
               0.5 * kCoarsest * std::min(p.size.width, p.size.length) / (1 + soil.spread)};
  return p;
}

jobs::Table pushPlate(const Soil& given, const PlateTest& test, std::int64_t seed, const std::filesystem::path& folder,
                      const base::Exec& exec, const PlateProgress& report) {
  Soil soil = given;
  soil.grains.young = test.young;
  const double d = soil.grains.diameter(), b = test.breadth * d, speed = test.speed(soil);
  const BedPreparation preparation = test.preparation(soil);
  const BedSize& size = preparation.size;
  const PreparedBed bed =
      keptBed(soil, preparation, seed, folder, exec, [&](const std::string& phase) { report(0, phase); });
  const auto begin = std::chrono::steady_clock::now();
  const double surface = surfaceHeight(bed.grains, size, d), bottom = topUnder(soil, test, bed.grains) + 1e-3 * d;
  // Porosity between the surface and a depth of one breadth.
  const double low = std::max(surface - b, PlateTest::kOffEnds * d * preparation.coarsest(soil));
  const double solid = test.lattice ? solidFraction(bed.grains, size, 0.5 * d, surface - d)
                                    : solidFraction(bed.grains, size, low, surface - PlateTest::kOffEnds * d);
  const double way = bottom - surface + test.sinkage * b;
  const std::string text =
      soil.scene(way / speed, seed, soil.grains.friction, {0, 0, -jobs::kGravity},
                 size.run() + fmt::format("impact_speed = {:.17g}\n", std::max(kSlow, 2 * speed))) +
      floorSections(soil, preparation, seed) + plateSection(soil, test, bottom, speed) +
      "[[grains]]\nform = \"file\"\nfile = \"bed.txt\"\nmaterial = \"grain\"\n";
  coupling::Simulation simulation(setup::simulationSetup(setup::parseScene(text, folder / "push.toml")), exec,
                                  [](double, double) {});
  const auto all = static_cast<std::int64_t>(way / speed / simulation.timeStep());
  jobs::Table table;
  table.names = kPlateColumns;
  const coupling::Surfaces& surfaces = *simulation.surfaces();
  for (int row = 1; row <= test.rows; ++row) {
    const std::int64_t from = simulation.steps(), until = all * row / test.rows;
    while (simulation.steps() < until) {
      jobs::stopStudyOnRequest();
      simulation.advance(std::min<std::int64_t>(until - simulation.steps(), 2000));
    }
    report(kPushBedShare + (1 - kPushBedShare) * row / test.rows, "pushing");
    const double middle = 0.5 * static_cast<double>(from + until) * simulation.timeStep();
    for (std::size_t i = 0; i < surfaces.count(); ++i)
      if (surfaces.surface(i).name == "plate")
        table.rows.push_back({surface - bottom + speed * middle, surfaces.observe(i, simulation.steps()).force.z,
                              1 - solid, static_cast<double>(bed.grains.size()), static_cast<double>(bed.steps),
                              bed.seconds});
    simulation.restartMeans();
  }
  simulation.checkEnergy();
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  for (std::vector<double>& row : table.rows) row.push_back(static_cast<double>(all)), row.push_back(seconds);
  return table;
}

double meanPressure(const jobs::Table& run, double area, double from, double to) {
  const std::size_t sinkage = run.column("sinkage [m]"), force = run.column("force [N]");
  double sum = 0;
  int count = 0;
  for (const std::vector<double>& row : run.rows)
    if (row[sinkage] > from && row[sinkage] <= to) sum += row[force], ++count;
  return count > 0 ? sum / count / area : std::nan("");
}

double meanBearing(PlateShape shape, double angle, double unitWeight, double breadth, double from, double to) {
  // Mean over the interval: the theoretical pressure is linear in the sinkage.
  return bearingPressure(shape, angle, unitWeight, breadth, 0.5 * (from + to));
}

} // namespace grouser::virtual_tests
