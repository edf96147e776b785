// SPDX-License-Identifier: BSD-3-Clause
#include "runs/virtual_tests/repose.hpp"

#include "base/math.hpp"
#include "runs/jobs/study_place.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/simulation_setup.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace grouser::virtual_tests {

namespace {

constexpr double kLift = 12;    // [d] as in beds for plates
constexpr double kImpact = 0.5; // [m/s] impact speed of flowing grains, for the time step of Hertz' contacts

/// A bed that is tilted by rotating gravity.
class Slope {
public:
  Slope(const Soil& soil, const BedPreparation& bed, std::int64_t seed, const std::filesystem::path& folder,
        const base::Exec& exec)
      : exec_(exec) {
    const std::string text = soil.scene(1, seed, soil.grains.friction, {0, 0, -jobs::kGravity},
                                        bed.size.run() + fmt::format("impact_speed = {}\n", kImpact)) +
                             floorSections(soil, bed, seed) +
                             "[[grains]]\nform = \"file\"\nfile = \"bed.txt\"\nmaterial = \"grain\"\n";
    setup_ = setup::simulationSetup(setup::parseScene(text, folder / "tilt.toml"));
    simulation_ = std::make_unique<coupling::Simulation>(setup_, exec_, [](double, double) {});
    for (const BedGrain& g : grainsOf(*simulation_, bed.size))
      mass_ += soil.grains.density * 4 * base::kPi / 3 * g.radius * g.radius * g.radius;
  }

  /// Holds a tilt [deg] for `time` [s]; returns the root mean square speed of the grains at the end [m/s].
  double hold(double tilt, double time) {
    const double angle = tilt * base::kPi / 180;
    const base::Vec3d gravity{jobs::kGravity * base::sin(angle), 0, -jobs::kGravity * base::cos(angle)};
    coupling::SimulationState state = simulation_->save();
    setup_.gravity = gravity;
    setup_.ground.grains->model.gravity = gravity;
    const double before = potential();
    simulation_ = std::make_unique<coupling::Simulation>(setup_, exec_, state);
    // The rotation of gravity does no work: the energy ledger starts with the changed potential energy.
    coupling::Ledger start;
    start.setCounted(state.ledgerAtStart);
    start.potential += potential() - before;
    state.ledgerAtStart = start.counted();
    simulation_ = std::make_unique<coupling::Simulation>(setup_, exec_, state);
    const std::int64_t until = simulation_->steps() + std::llround(time / simulation_->timeStep());
    while (simulation_->steps() < until) {
      jobs::stopStudyOnRequest();
      simulation_->advance(std::min<std::int64_t>(until - simulation_->steps(), 2000));
    }
    return std::sqrt(2 * simulation_->ground().grains->ledger().kinetic / mass_);
  }

private:
  double potential() const { return simulation_->ground().grains->ledger().potential; } ///< [J]

  base::Exec exec_;
  double mass_ = 0; ///< [kg] mass of all grains, including the fixed grains of the floor
  coupling::SimulationSetup setup_;
  std::unique_ptr<coupling::Simulation> simulation_;
};

} // namespace

jobs::Table tiltBed(const Soil& soil, const ReposeTest& test, std::int64_t seed, const std::filesystem::path& folder,
                    const base::Exec& exec, const PlateProgress& report) {
  const double d = soil.grains.diameter();
  BedPreparation bed;
  bed.size = {test.length * d, test.width * d, test.depth * d};
  bed.lift = kLift * d;
  const PreparedBed prepared =
      keptBed(soil, bed, seed, folder, exec, [&](const std::string& phase) { report(0, phase); });
  const double surface = surfaceHeight(prepared.grains, bed.size, d);
  const double off = PlateTest::kOffEnds * d;
  const double porosity = 1 - solidFraction(prepared.grains, bed.size, off, surface - off);
  Slope slope(soil, bed, seed, folder, exec);
  const double time = test.stage * std::sqrt(d / jobs::kGravity), unit = std::sqrt(jobs::kGravity * d);
  jobs::Table table;
  table.names = kReposeColumns;
  bool flowing = false;
  for (double tilt = test.from; tilt <= test.most && tilt > 0; tilt += flowing ? -test.down : test.up) {
    const double speed = slope.hold(tilt, time) / unit;
    table.rows.push_back({tilt, speed, porosity});
    report(std::min(0.9, 0.3 + 0.6 * tilt / test.most), flowing ? "tilting back" : "tilting");
    flowing = flowing || speed > test.flows;
    if (flowing && speed < test.rests) break;
  }
  return table;
}

ReposeAngles reposeAngles(const jobs::Table& run, const ReposeTest& test) {
  ReposeAngles angles{base::kNaN, base::kNaN};
  for (const std::vector<double>& row : run.rows) {
    if (std::isnan(angles.starts) && row[1] > test.flows) angles.starts = row[0];
    if (!std::isnan(angles.starts) && row[1] < test.rests) angles.repose = row[0];
  }
  return angles;
}

} // namespace grouser::virtual_tests
