// SPDX-License-Identifier: BSD-3-Clause
#include "runs/bevameter/plate_sinkage.hpp"

#include "base/error.hpp"
#include "base/math.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/studies/common.hpp"
#include "runs/support/line_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>

namespace grouser::bevameter {

namespace {

using base::Vec3d;
using studies::BedGrains;
using studies::Soil;
using studies::Table;

constexpr double kExpectedAngle = 24 * base::kPi / 180, kExpectedSolid = 0.59; // for the speed only
constexpr double kSlow = 0.1;                      // [m/s] for the step of Hertz' contacts, unless a plate is faster
constexpr int kRows = 1200;                        // of the loading, if it goes to the greatest sinkage
constexpr int kFiner = 4;                          // rows of unloading are so many times closer
constexpr std::size_t kSmooth = 8;                 // rows whose mean says that a pressure is reached
constexpr double kUnloaded = 0.02;                 // of the greatest pressure
constexpr double kBack = 0.1;                      // [breadths] that a plate is lifted at most
constexpr double kBedShare = 0.5;                  // of a run's time, about
constexpr double kSlopeFrom = 0.2, kSlopeTo = 0.8; // of the greatest pressure, between which stiffnesses are taken

/// A plate with the bed below it, that goes up and down without losing what contacts remember.
class Press {
public:
  Press(const Soil& soil, const PlateSinkage& test, const studies::BedPreparation& preparation, double surface,
        double bottom, std::int64_t seed, const std::filesystem::path& folder, const base::Exec& exec)
      : exec_(exec), area_(test.strip.area(soil)), surface_(surface), bottom_(bottom), speed_(test.speed(soil)) {
    const std::string text =
        soil.scene(1, seed, soil.grains.friction, {0, 0, -studies::kGravity},
                   preparation.size.run() +
                       fmt::format("impact_speed = {:.17g}\n", std::max({kSlow, 2 * speed_, soil.impactSpeed}))) +
        studies::floorSections(soil, preparation, seed) + studies::plateSection(soil, test.strip, bottom, speed_) +
        "[[grains]]\nform = \"file\"\nfile = \"bed.txt\"\nmaterial = \"grain\"\n";
    setup_ = setup::simulationSetup(setup::parseScene(text, folder / "push.toml"));
    simulation_ = std::make_unique<simulation::Simulation>(setup_, exec_, [](double, double) {});
    for (std::size_t i = 0; i < simulation_->surfaces()->count(); ++i)
      if (simulation_->surfaces()->surface(i).name == "plate") plate_ = i;
    height_ = plateHeight();
  }

  struct Row {
    double sinkage, pressure; ///< [m], [Pa], means over the way
  };
  /// Goes on by about `way` [m].
  Row go(double way) {
    const std::int64_t from = simulation_->steps();
    const std::int64_t until = from + std::max<std::int64_t>(1, std::llround(way / speed_ / simulation_->timeStep()));
    const double before = sinkage();
    while (simulation_->steps() < until) {
      studies::stopStudyIfAsked();
      simulation_->advance(std::min<std::int64_t>(until - simulation_->steps(), 2000));
    }
    const double force = simulation_->surfaces()->observe(plate_, simulation_->steps()).force.z;
    simulation_->restartMeans();
    return {0.5 * (before + sinkage()), force / area_};
  }
  /// From here on down (1) or up (-1).
  void turn(int direction) {
    simulation_->checkEnergy();
    const simulation::SimulationState state = simulation_->save();
    setup::SurfaceSetup& plate = setup_.ground.surfaces[plate_];
    const Vec3d centre = simulation_->surfaces()->pose(plate_, simulation_->steps()).position;
    setup::SurfaceMotionLaw law;
    law.pivot = centre, law.velocity = {0, 0, -direction * speed_}, law.start = simulation_->time();
    plate.motion = setup::SurfaceMotion(law, centre);
    simulation_.reset();
    simulation_ = std::make_unique<simulation::Simulation>(setup_, exec_, state);
    simulation_->restartMeans();
  }
  double sinkage() const { return surface_ - bottom_ + height_ - plateHeight(); }
  std::int64_t steps() const { return simulation_->steps(); }
  void check() { simulation_->checkEnergy(); }

private:
  double plateHeight() const { return simulation_->surfaces()->pose(plate_, simulation_->steps()).position.z; }

  base::Exec exec_;
  double area_, surface_, bottom_, speed_;
  double height_ = 0; ///< [m] of the plate's centre at the start
  std::size_t plate_ = 0;
  setup::SimulationSetup setup_;
  std::unique_ptr<simulation::Simulation> simulation_;
};

/// Mean pressure of the last rows of a phase.
double recentPressure(const std::vector<std::vector<double>>& rows, double phase) {
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t k = rows.size(); k > 0 && count < kSmooth && rows[k - 1][0] == phase; --k)
    sum += rows[k - 1][2], ++count;
  return count == kSmooth ? sum / static_cast<double>(count) : std::nan("");
}

std::vector<std::vector<double>> pushed(Press& press, const PlateSinkage& test, double breadth,
                                        const studies::PlateProgress& tell) {
  std::vector<std::vector<double>> rows;
  const double deepest = test.strip.sinkage * breadth, step = deepest / kRows;
  const auto record = [&](double phase, const Press::Row& row) { rows.push_back({phase, row.sinkage, row.pressure}); };
  double reached = 0;
  while (press.sinkage() < deepest && !(reached >= test.mostPressure)) {
    record(0, press.go(step));
    reached = recentPressure(rows, 0);
    const double share = std::max(press.sinkage() / deepest, reached / test.mostPressure);
    tell(kBedShare + (1 - kBedShare) * 0.9 * std::clamp(share, 0.0, 1.0), "loading");
  }
  const double most = recentPressure(rows, 0), turned = press.sinkage();
  press.turn(-1);
  while (press.sinkage() > turned - kBack * breadth && !(recentPressure(rows, 1) < kUnloaded * most))
    record(1, press.go(step / kFiner)), tell(1 - 0.07 * (1 - kBedShare), "unloading");
  press.turn(1);
  while (press.sinkage() < turned + step) record(2, press.go(step / kFiner)), tell(1, "reloading");
  press.check();
  return rows;
}

/// Slope of the pressure over the sinkage in one phase, between two shares of `most`.
double slopeOf(const Table& run, double phase, double most) {
  std::vector<double> z, p;
  for (const std::vector<double>& row : run.rows)
    if (row[0] == phase && row[2] > kSlopeFrom * most && row[2] < kSlopeTo * most)
      z.push_back(row[1]), p.push_back(row[2]);
  const support::LineFit line = support::fitLine(z, p);
  return line.hasError() ? line.slope : std::numeric_limits<double>::quiet_NaN();
}

} // namespace

double PlateSinkage::speed(const Soil& soil) const {
  const double b = strip.breadth * soil.grains.diameter();
  const double bears =
      studies::bearingPressure(strip.shape, kExpectedAngle, kExpectedSolid * soil.grains.density * studies::kGravity, b,
                               0.5 * strip.sinkage * b);
  return strip.inertialNumber * strip.breadth * std::sqrt(std::min(pace, bears) / soil.grains.density);
}

studies::BedPreparation PlateSinkage::preparation(const Soil& soil) const {
  studies::BedPreparation p = strip.preparation(soil);
  p.lift = lift * soil.grains.diameter();
  return p;
}

Table pushStrip(const Soil& soil, const PlateSinkage& test, std::int64_t seed, const std::filesystem::path& folder,
                const base::Exec& exec, const studies::PlateProgress& tell) {
  const double d = soil.grains.diameter(), b = test.strip.breadth * d;
  const studies::BedPreparation preparation = test.preparation(soil);
  const std::size_t lifts = studies::liftTops(preparation).size();
  std::size_t lift = 0;
  const studies::PreparedBed bed =
      studies::keptBed(soil, preparation, seed, folder, exec, [&](const std::string& phase) {
        tell(kBedShare * static_cast<double>(lift++) / static_cast<double>(lifts), phase);
      });
  const auto begin = std::chrono::steady_clock::now();
  const double surface = studies::surfaceHeight(bed.grains, preparation.size, d);
  const double bottom = studies::topUnder(soil, test.strip, bed.grains) + 1e-3 * d;
  // Of the breadth below the surface, where the plate works.
  const double off = studies::PlateTest::kOffEnds * d;
  const double low = std::max(surface - b, off * preparation.coarsest(soil));
  const double solid = studies::solidFraction(bed.grains, preparation.size, low, surface - off);
  Press press(soil, test, preparation, surface, bottom, seed, folder, exec);
  Table table;
  table.names = kSinkageColumns;
  table.rows = pushed(press, test, b, tell);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  for (std::vector<double>& row : table.rows)
    for (const double same : {1 - solid, static_cast<double>(bed.grains.size()), static_cast<double>(bed.steps),
                              bed.seconds, static_cast<double>(press.steps()), seconds})
      row.push_back(same);
  return table;
}

SinkageCurve loadingCurve(const Table& run) {
  SinkageCurve curve;
  const std::size_t phase = run.column("phase"), z = run.column("sinkage [m]"), p = run.column("pressure [Pa]");
  for (const std::vector<double>& row : run.rows)
    if (row[phase] == 0) curve.sinkage.push_back(row[z]), curve.pressure.push_back(row[p]);
  return curve;
}

Unloading unloadingOf(const Table& run) {
  Unloading u;
  std::vector<std::vector<double>> loading;
  for (const std::vector<double>& row : run.rows)
    if (row[0] == 0) loading.push_back(row);
  u.from = recentPressure(loading, 0);
  u.stiffness = slopeOf(run, 1, u.from), u.reloading = slopeOf(run, 2, u.from);
  return u;
}

} // namespace grouser::bevameter
