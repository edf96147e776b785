// SPDX-License-Identifier: BSD-3-Clause
// Verdicts and results of synthetic motions.
#include "runs/campaigns/events/event_figures.hpp"
#include "runs/campaigns/events/event_report.hpp"
#include "runs/campaigns/events/event_verdict.hpp"

#include "base/math.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace grouser::events {

namespace {

constexpr double kRow = 0.02; // s

/// A motion along x with the speed of each segment: {seconds, m/s}.
Motion straightOn(const std::vector<std::pair<double, double>>& stretches) {
  Motion m;
  double time = 0, way = 0;
  const auto add = [&] {
    m.time.push_back(time), m.way.push_back(way);
    for (auto* column : {&m.turned, &m.left, &m.roll, &m.pitch, &m.upSpeed}) column->push_back(0);
  };
  add();
  for (const auto& [seconds, speed] : stretches)
    for (int i = 0; i < std::lround(seconds / kRow); ++i) time += kRow, way += speed * kRow, add();
  return m;
}

Trial course(double distance, double speed) {
  Trial trial;
  trial.distance = distance, trial.speed = speed;
  return trial;
}

TEST(EventVerdict, IsGoAtHalfTheSpeedAndNoGoBelow) {
  EXPECT_TRUE(judge(straightOn({{10, 0.51}}), course(5, 1)).go);
  const Verdict slow = judge(straightOn({{15, 0.49}}), course(5, 1));
  EXPECT_FALSE(slow.go);
  EXPECT_NE(slow.why.find("too slow"), std::string::npos) << slow.why;
}

TEST(EventReport, CountsRunsInWordsThatFit) {
  const auto text = [](int incomplete, int pending) {
    EventRow row;
    row.incomplete = incomplete, row.pending = pending;
    return eventsText({row}, {}, {});
  };
  EXPECT_NE(text(1, 1).find("1 of its runs is incomplete"), std::string::npos) << text(1, 1);
  EXPECT_NE(text(1, 1).find("1 of its runs is pending"), std::string::npos) << text(1, 1);
  EXPECT_NE(text(2, 3).find("2 of its runs are incomplete"), std::string::npos) << text(2, 3);
  EXPECT_NE(text(2, 3).find("3 of its runs are pending"), std::string::npos) << text(2, 3);
}

TEST(EventVerdict, LooksAtTheLastFiveMetresAlone) {
  // 3 m in 6 s, then 5 m at 0.8 m/s: the mean over the whole path would be 0.65.
  EXPECT_TRUE(judge(straightOn({{6, 0.5}, {8, 0.8}}), course(8, 1.5)).go);
  EXPECT_FALSE(judge(straightOn({{3.75, 0.8}, {10, 0.55}}), course(8, 1.5)).go);
}

TEST(EventVerdict, AsksForTwentySecondsAndTheWholeWay) {
  const Verdict late = judge(straightOn({{16, 0}, {6, 1}}), course(5, 1));
  EXPECT_FALSE(late.go);
  EXPECT_NE(late.why.find("exceeds the time limit"), std::string::npos) << late.why;
  const Verdict stuck = judge(straightOn({{4, 1}, {10, 0}}), course(5, 1));
  EXPECT_FALSE(stuck.go);
  EXPECT_EQ(stuck.why, "covers 4.0 of 5.0 m");
  EXPECT_EQ(judge(straightOn({{5, -1}}), course(5, 1)).why, "covers 0.0 of 5.0 m");
  EXPECT_FALSE(stuck.isIncomplete);
  const Verdict shortened = judge(straightOn({{2, 0.6}}), course(5, 1));
  EXPECT_TRUE(shortened.isIncomplete) << shortened.why;
  EXPECT_FALSE(judge(straightOn({{2, 0.4}}), course(5, 1)).isIncomplete) << "too slow in any case";
  EXPECT_EQ(judge(Motion(), course(5, 1)).why, "never drove");
}

TEST(EventVerdict, EndsAtThirtyDegreesOfRoll) {
  Motion m = straightOn({{10, 1}});
  m.roll[100] = -29.9 * base::kPi / 180;
  EXPECT_TRUE(judge(m, course(5, 1)).go);
  m.roll[100] = -30.1 * base::kPi / 180;
  EXPECT_FALSE(judge(m, course(5, 1)).go);
}

TEST(EventVerdict, OfATurnIsOfItsRate) {
  Trial half;
  half.angle = base::kPi, half.rate = 1;
  const auto turning = [](double rate) {
    Motion m = straightOn({{15, 0}});
    for (std::size_t i = 0; i < m.time.size(); ++i) m.turned[i] = rate * m.time[i];
    return m;
  };
  EXPECT_TRUE(judge(turning(0.52), half).go);
  EXPECT_FALSE(judge(turning(0.48), half).go);
  EXPECT_EQ(judge(turning(0.1), half).why, "turns only 86 degrees");
  EXPECT_FALSE(judge(turning(-1), half).go);
}

TEST(EventVerdict, KnowsWhichFailuresAreTheVehicles) {
  using base::Cause;
  const auto failed = [](Cause cause) { return judgeFailure({output::RunStatus::failed, "the run's message", cause}); };
  for (const Cause cause : {Cause::thrownTrack, Cause::noRest, Cause::skippingTrack, Cause::offTerrain})
    EXPECT_TRUE(failed(cause).known) << base::wordOf(cause);
  EXPECT_FALSE(failed(Cause::unstableContacts).known);
  EXPECT_FALSE(failed(Cause::unknown).known);
  EXPECT_EQ(failed(Cause::unknown).why, "the run's message");
}

TEST(EventMotion, BeginsWithTheDriveAndUnwindsTheHeading) {
  sweeps::RunSeries series;
  series.columns = {"vehicle.position.x [m]",   "vehicle.position.y [m]",    "vehicle.heading [rad]",
                    "vehicle.roll_angle [rad]", "vehicle.pitch_angle [rad]", "vehicle.velocity.z [m/s]"};
  series.time = {0, 1, 2, 3};
  series.values = {{0, 2, 5, 5}, {0, 1, 1, 5}, {0, 3.0, -3.0, -2.5}, {0, 0, 0, 0}, {0, 0, 0, 0}, {0, 0, 0, 0}};
  const Motion straight = motionOf(series, 0.5, std::nullopt), path = motionOf(series, 0.5, SidePoint{});
  ASSERT_EQ(straight.time.size(), 3u);
  EXPECT_DOUBLE_EQ(straight.time[0], 0.5);
  EXPECT_DOUBLE_EQ(straight.way[2], 3);
  EXPECT_DOUBLE_EQ(path.way[2], 3 + 4);
  EXPECT_DOUBLE_EQ(straight.left[2], 4);
  // From 3.0 via pi to -3.0 = 3.283, then half a radian further.
  EXPECT_NEAR(straight.turned[1], 2 * base::kPi - 6, 1e-12); // round-off of numbers about 6
  EXPECT_NEAR(straight.turned[2], 2 * base::kPi - 5.5, 1e-12);
}

/// Rows of a vehicle whose point `on` (relative to the sprocket axle) drives a circle of this radius to the left,
/// level, at a constant speed, from rest of a second.
sweeps::RunSeries circling(const SidePoint& on, double radius, double speed, double seconds) {
  sweeps::RunSeries series;
  series.columns = {"vehicle.position.x [m]",   "vehicle.position.y [m]",    "vehicle.heading [rad]",
                    "vehicle.roll_angle [rad]", "vehicle.pitch_angle [rad]", "vehicle.velocity.z [m/s]"};
  series.values.resize(6);
  for (int i = 0; i < std::lround((1 + seconds) / kRow); ++i) {
    const double time = kRow * i, turned = std::max(0.0, time - 1) * speed / radius;
    const double heading = std::remainder(turned, 2 * base::kPi);
    series.time.push_back(time);
    series.values[0].push_back(radius * std::sin(turned) - on.x * std::cos(turned));
    series.values[1].push_back(radius * (1 - std::cos(turned)) - on.x * std::sin(turned));
    series.values[2].push_back(heading);
    for (int c = 3; c < 6; ++c) series.values[c].push_back(0);
  }
  return series;
}

double figureOf(const std::vector<Figure>& figures, const std::string& name) {
  for (const Figure& f : figures)
    if (f.name == name) return f.value;
  ADD_FAILURE() << "no figure " << name;
  return 0;
}

TEST(EventCircle, IsThatOfTheControlledPointAndNotOfTheSprocketAxle) {
  Course c;
  c.shape.controlled = {1.437, -0.38};
  Trial trial = course(6, 1.2);
  for (const double radius : {0.4, 1.0, 3.0, 8.0}) {
    const sweeps::RunSeries series = circling(c.shape.controlled, radius, 1.2, 5.5);
    const Motion motion = motionOf(series, 1, c.shape.controlled);
    // Chords of rows: shorter than their arcs by (speed row / radius)^2 / 24.
    const double chords = std::pow(1.2 * kRow / radius, 2) / 24 + 1e-9;
    trial.radius = radius, trial.rate = 1.2 / radius;
    EXPECT_TRUE(judge(motion, trial).go) << judge(motion, trial).why;
    for (const Event event : {Event::steadyTurn, Event::turningRadius}) {
      const std::vector<Figure> figures = figuresOf(event, motion, series, 1, trial, c);
      EXPECT_NEAR(figureOf(figures, "radius driven [m]"), radius, radius * chords) << "the axle's is larger";
      EXPECT_NEAR(figureOf(figures, "lateral acceleration [g]"), 1.44 / radius / 9.81, chords);
    }
  }
}

TEST(EventCircle, IsNoGoOffTheCircleOrTooSlow) {
  const SidePoint on{1.4, 0};
  Trial trial = course(6, 1.2);
  trial.radius = 3;
  const auto verdict = [&](double radius, double speed) {
    return judge(motionOf(circling(on, radius, speed, 6 / speed + 0.5), 1, on), trial);
  };
  EXPECT_TRUE(verdict(3.27, 1.2).go);
  EXPECT_EQ(verdict(3.34, 1.2).why, "drives a radius of 3.34 m, commanded 3 m");
  EXPECT_EQ(verdict(2.66, 1.2).why, "drives a radius of 2.66 m, commanded 3 m");
  EXPECT_EQ(verdict(-3, 1.2).why, "does not turn to the left");
  EXPECT_FALSE(verdict(1e9, 1.2).go) << "straight on";
  EXPECT_TRUE(verdict(3, 0.7).go) << "more than half the speed";
  trial.rate = 1.2 / 3; // turning_radius: at the stated speed
  EXPECT_TRUE(verdict(3, 1.1).go);
  EXPECT_EQ(verdict(3, 1.05).why, "turns at 0.35 rad/s, commanded 0.4 rad/s");
  const Verdict shortened = judge(motionOf(circling(on, 3, 1.2, 1), 1, on), trial);
  EXPECT_EQ(shortened.why, "run.duration ends the drive after 1.2 of 6.0 m at 1.2 m/s; raise it");
  EXPECT_TRUE(shortened.isIncomplete);
}

TEST(EventCircle, PointFollowsRollAndPitch) {
  // A point 2 m below the axle swings by 2 sin(0.1) m as the vehicle pitches or rolls by 0.1 rad.
  for (const std::size_t column : {3u, 4u}) {
    sweeps::RunSeries series = circling({}, 1, 0, 1);
    for (std::size_t i = 60; i < series.time.size(); ++i) series.values[column][i] = 0.1;
    const Motion motion = motionOf(series, 1, SidePoint{0, -2});
    EXPECT_NEAR(motion.way.back(), 2 * std::sin(0.1), 1e-12);
  }
}

TEST(EventFigures, LowPassKeepsLevelsAndHalvesThePowerAtItsCutoff) {
  constexpr double kDt = 0.005, kCutoff = 30;
  const auto gainAt = [&](double hertz) {
    std::vector<double> wave;
    for (int i = 0; i < 4000; ++i) wave.push_back(std::sin(2 * base::kPi * hertz * kDt * i));
    const std::vector<double> passed = lowPass(wave, kDt, kCutoff);
    double in = 0, out = 0;
    for (std::size_t i = 2000; i < wave.size(); ++i) in += wave[i] * wave[i], out += passed[i] * passed[i];
    return std::sqrt(out / in);
  };
  // The bilinear transform is exact at the cutoff; sums over 2000 rows of waves with whole periods.
  EXPECT_NEAR(gainAt(kCutoff), std::sqrt(0.5), 1e-6);
  EXPECT_NEAR(gainAt(1), 1, 1e-6);
  // 1 / sqrt(1 + (tan(pi f dt) / tan(pi fc dt))^8)
  const double ratio = std::tan(base::kPi * 60 * kDt) / std::tan(base::kPi * kCutoff * kDt);
  EXPECT_NEAR(gainAt(60), 1 / std::sqrt(1 + std::pow(ratio, 8)), 1e-6);
  EXPECT_DOUBLE_EQ(lowPass({2, 2, 2}, kDt, kCutoff)[2], 2);
}

TEST(EventFigures, TurningMomentIsTheIntegralOverTheGroundRun) {
  VehicleShape shape;
  shape.firstWheel = -0.9, shape.lastWheel = 0.9;
  EXPECT_DOUBLE_EQ(turningMoment(shape, 0.8, 1000), 0.8 * 1000 * 1.8 / 4);
  EXPECT_DOUBLE_EQ(turningMoment(shape, 0.8, 1000, 0.5, 0), turningMoment(shape, 0.8, 1000));
  // Midpoint rule: error of h^2 times the second derivative, 1e-7 of the moment with 1000 pieces.
  double sum = 0;
  const int n = 1000;
  for (int i = 0; i < n; ++i) {
    const double x = -0.9 + 1.8 * (i + 0.5) / n, across = 0.5 * x;
    sum += std::fabs(x) * std::fabs(across) / std::hypot(across, 0.2);
  }
  EXPECT_NEAR(turningMoment(shape, 0.8, 1000, 0.5, 0.2), 0.8 * 1000 * sum / n, 1e-6 * 360);
}

} // namespace

} // namespace grouser::events
