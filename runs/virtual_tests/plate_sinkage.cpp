// SPDX-License-Identifier: BSD-3-Clause
#include "runs/virtual_tests/plate_sinkage.hpp"

#include "base/error.hpp"
#include "base/math.hpp"
#include "runs/jobs/study_place.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/simulation_setup.hpp"
#include "runs/support/line_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>

namespace grouser::virtual_tests {

namespace {

using base::Vec3d;
using jobs::Table;

constexpr int kRows = 1200;                        // number of rows if the loading ends at the greatest sinkage
constexpr int kFiner = 4;                          // rows per sinkage in unloading / rows per sinkage in loading
constexpr std::size_t kSmooth = 8;                 // number of rows averaged to detect a pressure
constexpr double kUnloaded = 0.02;                 // pressure at the end of unloading / greatest pressure
constexpr double kBack = 0.1;                      // [breadths] maximum lift of the plate
constexpr double kBedShare = 0.5;                  // approximate fraction of the wall time spent on the bed
constexpr std::size_t kShows = 32;                 // number of latest rows used for the apparent modulus
constexpr int kHeldRows = 16, kSettledRows = 4;    // rows of the hold; number of last ones that are averaged
constexpr double kHeld = 2;                        // hold time / travel time of waves to the floor and back
constexpr double kSlopeFrom = 0.2, kSlopeTo = 0.8; // pressure range for the stiffness / greatest pressure

/// A plate on its bed. It can move down and up; the contact history is kept.
class Press {
public:
  Press(const Soil& soil, const PlateSinkage& test, const BedPreparation& preparation, double surface, double bottom,
        std::int64_t seed, const std::filesystem::path& folder, const base::Exec& exec)
      : exec_(exec), area_(test.strip.area(soil)), surface_(surface), bottom_(bottom),
        velocity_(test.pace(soil).first()) {
    const std::string text =
        soil.scene(1, seed, soil.grains.friction, {0, 0, -jobs::kGravity},
                   preparation.size.run() + fmt::format("impact_speed = {:.17g}\n",
                                                        std::max({kSlow, 2 * test.fastest(soil), soil.impactSpeed}))) +
        floorSections(soil, preparation, seed) + plateSection(soil, test.strip, bottom, velocity_) +
        "[[grains]]\nform = \"file\"\nfile = \"bed.txt\"\nmaterial = \"grain\"\n";
    setup_ = setup::simulationSetup(setup::parseScene(text, folder / "push.toml"));
    simulation_ = std::make_unique<coupling::Simulation>(setup_, exec_, [](double, double) {});
    for (std::size_t i = 0; i < simulation_->surfaces()->count(); ++i)
      if (simulation_->surfaces()->surface(i).name == "plate") plate_ = i;
    height_ = plateHeight();
  }

  struct Row {
    double sinkage, pressure; ///< [m], [Pa], means over the time of the row
  };
  /// Advances until the plate has moved by about `way` [m].
  Row go(double way) { return wait(way / std::fabs(velocity_)); }
  /// Advances by about `time` [s].
  Row wait(double time) {
    const std::int64_t until =
        simulation_->steps() + std::max<std::int64_t>(1, std::llround(time / simulation_->timeStep()));
    const double before = sinkage();
    while (simulation_->steps() < until) {
      jobs::stopStudyOnRequest();
      simulation_->advance(std::min<std::int64_t>(until - simulation_->steps(), 2000));
    }
    const double force = simulation_->surfaces()->observe(plate_, simulation_->steps()).force.z;
    simulation_->restartMeans();
    return {0.5 * (before + sinkage()), force / area_};
  }
  /// Sets the downward velocity [m/s].
  void move(double velocity) {
    simulation_->checkEnergy();
    const coupling::SimulationState state = simulation_->save();
    coupling::SurfaceSetup& plate = setup_.ground.surfaces[plate_];
    const Vec3d centre = simulation_->surfaces()->pose(plate_, simulation_->steps()).position;
    coupling::SurfaceMotionLaw law;
    law.pivot = centre, law.velocity = {0, 0, -velocity}, law.start = simulation_->time();
    plate.motion = coupling::SurfaceMotion(law, centre);
    simulation_.reset();
    simulation_ = std::make_unique<coupling::Simulation>(setup_, exec_, state);
    simulation_->restartMeans();
    velocity_ = velocity;
  }
  double velocity() const { return velocity_; } ///< downwards [m/s]
  double sinkage() const { return surface_ - bottom_ + height_ - plateHeight(); }
  std::int64_t steps() const { return simulation_->steps(); }
  void check() { simulation_->checkEnergy(); }

private:
  double plateHeight() const { return simulation_->surfaces()->pose(plate_, simulation_->steps()).position.z; }

  base::Exec exec_;
  double area_, surface_, bottom_, velocity_;
  double height_ = 0; ///< [m] initial height of the plate's centre
  std::size_t plate_ = 0;
  coupling::SimulationSetup setup_;
  std::unique_ptr<coupling::Simulation> simulation_;
};

/// Mean pressure of the last `last` rows of a phase; NaN if there are fewer.
double recentPressure(const std::vector<std::vector<double>>& rows, double phase, std::size_t last = kSmooth) {
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t k = rows.size(); k > 0 && count < last && rows[k - 1][0] == phase; --k)
    sum += rows[k - 1][2], ++count;
  return count == last ? sum / static_cast<double>(count) : std::nan("");
}

/// Loads, holds, unloads and reloads a plate at the speeds of PlatePace.
class Course {
public:
  Course(Press& press, const PlateSinkage& test, const PlatePace& pace, const PlateProgress& report)
      : press_(press), pace_(pace), report_(report), most_(test.maxPressure),
        deepest_(test.strip.sinkage * pace.breadth), step_(deepest_ / kRows) {}

  std::vector<std::vector<double>> rows() {
    load();
    const double most = recentPressure(rows_, 0), turned = press_.sinkage();
    hold();
    begin(-1);
    while (press_.sinkage() > turned - kBack * pace_.breadth && !(recentPressure(rows_, 1) < kUnloaded * most))
      row(1, step_ / kFiner), report_(1 - 0.07 * (1 - kBedShare), "unloading");
    begin(1);
    while (press_.sinkage() < turned + step_) row(2, step_ / kFiner), report_(1, "reloading");
    press_.check();
    return std::move(rows_);
  }

private:
  void load() {
    double reached = 0;
    while (press_.sinkage() < deepest_ && !(reached >= most_)) {
      row(0, step_);
      reached = recentPressure(rows_, 0);
      const double share = std::max(press_.sinkage() / deepest_, reached / most_);
      report_(kBedShare + (1 - kBedShare) * 0.9 * std::clamp(share, 0.0, 1.0), "loading");
    }
  }

  void hold() {
    const double time = kHeld * pace_.wavesBack(shown());
    press_.move(0);
    for (int k = 0; k < kHeldRows; ++k) {
      const Press::Row held = press_.wait(time / kHeldRows);
      rows_.push_back({3, held.sinkage, held.pressure});
    }
  }

  void begin(int direction) {
    press_.move(direction * pace_.first());
    sinkage_.clear(), pressure_.clear();
  }

  void row(double phase, double way) {
    const Press::Row next = press_.go(way);
    rows_.push_back({phase, next.sinkage, next.pressure});
    sinkage_.push_back(next.sinkage), pressure_.push_back(next.pressure);
    if (sinkage_.size() % kSmooth != 0) return;
    const double now = std::fabs(press_.velocity()), speed = pace_.next(now, shown());
    if (speed != now) press_.move(std::copysign(speed, press_.velocity()));
  }

  double shown() const { return apparentModulus(sinkage_, pressure_, pace_.breadth, kShows); }

  Press& press_;
  PlatePace pace_;
  const PlateProgress& report_;
  double most_, deepest_, step_;
  std::vector<std::vector<double>> rows_;
  std::vector<double> sinkage_, pressure_; ///< rows of the present phase
};

/// Slope of the pressure over the sinkage in one phase, for pressures from 20 to 80 % of `most`.
double slopeOf(const jobs::Table& run, double phase, double most) {
  std::vector<double> z, p;
  for (const std::vector<double>& row : run.rows)
    if (row[0] == phase && row[2] > kSlopeFrom * most && row[2] < kSlopeTo * most)
      z.push_back(row[1]), p.push_back(row[2]);
  const support::LineFit line = support::fitLine(z, p);
  return line.hasError() ? line.slope : std::numeric_limits<double>::quiet_NaN();
}

} // namespace

double PlateSinkage::fastest(const Soil& soil) const {
  const double b = strip.breadth * soil.grains.diameter();
  const double bears = bearingPressure(
      strip.shape, kExpectedAngle, kExpectedSolid * soil.grains.density * jobs::kGravity, b, 0.5 * strip.sinkage * b);
  return strip.inertialNumber * strip.breadth * std::sqrt(std::min(quiet, bears) / soil.grains.density);
}

PlatePace PlateSinkage::pace(const Soil& soil) const {
  PlatePace p;
  p.density = kExpectedSolid * soil.grains.density, p.breadth = strip.breadth * soil.grains.diameter();
  p.depth = strip.bed(soil).depth, p.added = added, p.fastest = fastest(soil), p.firstModulus = firstModulus;
  return p;
}

BedPreparation PlateSinkage::preparation(const Soil& soil) const {
  BedPreparation p = strip.preparation(soil);
  p.lift = lift * soil.grains.diameter();
  return p;
}

jobs::Table pushStrip(const Soil& soil, const PlateSinkage& test, std::int64_t seed,
                      const std::filesystem::path& folder, const base::Exec& exec, const PlateProgress& report) {
  const double d = soil.grains.diameter(), b = test.strip.breadth * d;
  const BedPreparation preparation = test.preparation(soil);
  const std::size_t lifts = liftTops(preparation).size();
  std::size_t lift = 0;
  const PreparedBed bed = keptBed(soil, preparation, seed, folder, exec, [&](const std::string& phase) {
    report(kBedShare * static_cast<double>(lift++) / static_cast<double>(lifts), phase);
  });
  const auto begin = std::chrono::steady_clock::now();
  const double surface = surfaceHeight(bed.grains, preparation.size, d);
  const double bottom = topUnder(soil, test.strip, bed.grains) + 1e-3 * d;
  // Porosity between the surface and a depth of one breadth.
  const double off = PlateTest::kOffEnds * d;
  const double low = std::max(surface - b, off * preparation.coarsest(soil));
  const double solid = solidFraction(bed.grains, preparation.size, low, surface - off);
  Press press(soil, test, preparation, surface, bottom, seed, folder, exec);
  jobs::Table table;
  table.names = kSinkageColumns;
  table.rows = Course(press, test, test.pace(soil), report).rows();
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  for (std::vector<double>& row : table.rows)
    for (const double same : {1 - solid, static_cast<double>(bed.grains.size()), static_cast<double>(bed.steps),
                              bed.seconds, static_cast<double>(press.steps()), seconds})
      row.push_back(same);
  return table;
}

SinkageCurve loadingCurve(const jobs::Table& run) {
  SinkageCurve curve;
  const std::size_t phase = run.column("phase"), z = run.column("sinkage [m]"), p = run.column("pressure [Pa]");
  for (const std::vector<double>& row : run.rows)
    if (row[phase] == 0) curve.sinkage.push_back(row[z]), curve.pressure.push_back(row[p]);
  return curve;
}

double addedByMotion(const jobs::Table& run) {
  std::vector<std::vector<double>> before, held;
  for (const std::vector<double>& row : run.rows)
    if (row[0] == 0 || row[0] == 3) (row[0] == 0 ? before : held).push_back(row);
  return 1 - recentPressure(held, 3, kSettledRows) / recentPressure(before, 0);
}

Unloading unloadingOf(const jobs::Table& run) {
  Unloading u;
  std::vector<std::vector<double>> loading;
  for (const std::vector<double>& row : run.rows)
    if (row[0] == 0) loading.push_back(row);
  u.from = recentPressure(loading, 0);
  u.stiffness = slopeOf(run, 1, u.from), u.reloading = slopeOf(run, 2, u.from);
  return u;
}

} // namespace grouser::virtual_tests
