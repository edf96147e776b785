// SPDX-License-Identifier: BSD-3-Clause
#include "runs/virtual_tests/measured_plate.hpp"

#include "base/math.hpp"
#include "runs/jobs/study_place.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/simulation_setup.hpp"
#include "runs/storage/bed_cache.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

namespace grouser::virtual_tests {

namespace {

constexpr int kPlateRows = 300;
constexpr double kAbove = 1e-3;        // [d] initial gap between the plate and the highest grain
constexpr double kHighest = 2;         // [d] assumed height of the highest grain above the mean surface
constexpr double kTall = 2;            // height of the plate / its sinkage, so that no grain rolls onto it
constexpr double kSettlingShare = 0.5; // estimated fraction of the wall time spent on settling

/// Scene file of the test.
std::string sceneText(const Soil& soil, const MeasuredPlateTest& test, std::int64_t seed) {
  const double d = soil.grains.diameter(), speed = test.speed(soil), tall = kTall * test.sinkage;
  const double way = test.sinkage + kHighest * d;
  std::string text = soil.scene(
      way / speed, seed, soil.grains.friction, {0, 0, -jobs::kGravity},
      fmt::format("periodic = [true, true]\nimpact_speed = {:.17g}\n", std::max({kSlow, 2 * speed, soil.impactSpeed})));
  text += fmt::format("[terrain]\nheightmap = \"heightmaps/flat.png\"\nheight_range = [0, 0]\nsize = [{0:.17g}, "
                      "{0:.17g}]\nmaterial = \"grain\"\ngrain_radius = {1:.17g}\ndepth = {2:.17g}\nwalls = false\n",
                      test.bin, soil.grains.radius, test.depth);
  text += soil.spread > 0 ? fmt::format("radius_spread = {:.17g}\n", soil.spread)
                          : std::string("radius_distribution = \"single\"\n");
  if (test.porosity) text += fmt::format("porosity = {:.17g}\n", *test.porosity);
  return text + fmt::format("[[cylinder]]\nname = \"plate\"\nmaterial = \"grain\"\nposition = [{:.17g}, 0, 0]\n"
                            "above_bed = {:.17g}\naxis = [0, 0, 1]\nradius = {:.17g}\nlength = {:.17g}\nvelocity = [0, "
                            "0, {:.17g}]\n",
                            0.5 * test.bin, kAbove * d, 0.5 * test.diameter, tall, -speed);
}

/// The plate of a running test.
class Plate {
public:
  Plate(coupling::Simulation& simulation, const MeasuredPlateTest& test)
      : simulation_(simulation), area_(0.25 * base::kPi * test.diameter * test.diameter),
        halfLength_(0.5 * kTall * test.sinkage) {
    for (std::size_t i = 0; i < simulation.surfaces()->count(); ++i)
      if (simulation.surfaces()->surface(i).name == "plate") index_ = i;
  }

  /// Depth of the plate's lower face below the mean surface of the bed [m].
  double sinkage() const { return simulation_.settled().meanHeight - (observed().position.z - halfLength_); }
  double meanPressure() const { return observed().force.z / area_; } ///< mean since the last row [Pa]

private:
  coupling::Surfaces::Observation observed() const {
    return simulation_.surfaces()->observe(index_, simulation_.steps());
  }

  coupling::Simulation& simulation_;
  double area_, halfLength_;
  std::size_t index_ = 0;
};

/// Porosity of the bed, excluding two mean diameters at the floor and at the surface [-].
double porosityOf(const coupling::Simulation& simulation, const Soil& soil, const MeasuredPlateTest& test) {
  const BedSize size{test.bin, test.bin, test.depth};
  const double off = PlateTest::kOffEnds * soil.grains.diameter();
  return 1 - solidFraction(grainsOf(simulation, size), size, -test.depth + off, simulation.settled().meanHeight - off);
}

} // namespace

double MeasuredPlateTest::speed(const Soil& soil) const {
  PlateTest plate;
  plate.shape = PlateShape::circular, plate.breadth = diameter / soil.grains.diameter();
  plate.sinkage = sinkage / diameter, plate.inertialNumber = inertialNumber;
  return plate.speed(soil);
}

jobs::Table pushMeasuredPlate(const Soil& soil, const MeasuredPlateTest& test, std::int64_t seed,
                              const std::filesystem::path& folder, const base::Exec& exec,
                              const PlateProgress& report) {
  std::optional<storage::BedCache> beds = storage::BedCache::ofUser();
  coupling::Simulation simulation(
      setup::simulationSetup(setup::parseScene(sceneText(soil, test, seed), folder / "push.toml")), exec,
      [&](double, double) {
        jobs::stopStudyOnRequest();
        report(0, "settling the bed");
      },
      {}, beds ? &*beds : nullptr);
  const auto begin = std::chrono::steady_clock::now();
  const double porosity = porosityOf(simulation, soil, test), deepest = test.sinkage;
  const auto grains = static_cast<double>(simulation.ground().grains->count());
  const Plate plate(simulation, test);
  const double speed = test.speed(soil), from = plate.sinkage();
  const auto rowSteps =
      std::max<std::int64_t>(1, std::llround((deepest - from) / speed / kPlateRows / simulation.timeStep()));
  jobs::Table table;
  table.names = kMeasuredPlateColumns;
  while (plate.sinkage() < deepest) {
    const double before = plate.sinkage();
    for (std::int64_t left = rowSteps; left > 0;) {
      jobs::stopStudyOnRequest();
      left -= simulation.advance(left);
    }
    const double now = plate.sinkage();
    table.rows.push_back({0.5 * (before + now), plate.meanPressure(), porosity,
                          simulation.settled().meanHeight + test.depth, grains, simulation.settled().friction});
    simulation.restartMeans();
    report(kSettlingShare + (1 - kSettlingShare) * std::min(1.0, (now - from) / (deepest - from)), "pushing");
  }
  simulation.checkEnergy();
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  for (std::vector<double>& row : table.rows)
    row.push_back(static_cast<double>(simulation.steps())), row.push_back(seconds);
  return table;
}

} // namespace grouser::virtual_tests
