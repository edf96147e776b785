// SPDX-License-Identifier: BSD-3-Clause
// Keys that an event owns, courses on circles, and closed forms under other gravity.
#include "runs/campaigns/events/event_figures.hpp"
#include "runs/campaigns/events/event_keys.hpp"
#include "runs/campaigns/events/event_plan.hpp"
#include "runs/campaigns/events/soil_limits.hpp"

#include "base/error.hpp"
#include "base/math.hpp"
#include "runs/campaigns/sweeps/overrides.hpp"
#include "runs/scene/scene.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace grouser::events {

namespace {

EventOptions optionsOf(const std::string& event, const std::vector<std::string>& fixed = {}) {
  EventOptions options;
  options.only = {event}, options.fixed = fixed;
  return options;
}

std::string refusal(const EventOptions& options) {
  try {
    planEvents(options);
    return "";
  } catch (const base::InputError& error) {
    return error.what();
  }
}

/// Course of the light vehicle on this kind of ground.
Course courseOn(const std::string& ground, const std::string& vehicle = "light_tracked") {
  EventOptions options = optionsOf("acceleration");
  options.vehicle = vehicle, options.quick = true;
  if (ground != "rigid") options.soil = "lete_sand", options.ground = base::valueOf<scene::TerrainKind>(ground);
  return planEvents(options).course;
}

TEST(EventKeys, ThoseThatGaveWrongVerdictsAreRefused) {
  const auto whole = [](const char* event, const std::string& set) { return refusal(optionsOf(event, {set})); };
  EXPECT_EQ(whole("grade", "run.gravity=[-1, 0, -9.8]"),
            "--set run.gravity=[-1, 0, -9.8]: the event grade sets run.gravity itself; use --levels for the slope and "
            "--gravity for the gravity");
  EXPECT_EQ(whole("drawbar", "hitch.slip=0.1"),
            "--set hitch.slip=0.1: the event drawbar sets hitch.slip itself; use --levels");
  EXPECT_EQ(whole("acceleration", "driver.sprocket_speed=2"),
            "--set driver.sprocket_speed=2: the event acceleration sets driver.sprocket_speed itself; use --speed");
  EXPECT_EQ(whole("grade", "run.gravity.2=-1.62").find("--set run.gravity.2=-1.62: the event grade sets"), 0u);
  const Course course = courseOn("rigid");
  const auto refused = [&course](const char* event, const std::string& set) -> std::string {
    const Event e = eventOf(event);
    try {
      refuseOwnedKeys({set}, e, trialOf(e, levelsOf(e, course, true).front(), course), course);
      return "";
    } catch (const base::InputError& error) {
      return error.what();
    }
  };
  // Components, sections, list entries by index and by name, removals, quotes, and keys that replace owned ones.
  const std::pair<const char*, const char*> others[] = {{"grade", "run.gravity.2=-1.62"},
                                                        {"grade", "run={gravity=[0, 0, -1.62]}"},
                                                        {"grade", "\"run\".gravity=[0, 0, -1.62]"},
                                                        {"grade", "~run.gravity"},
                                                        {"side_slope", "vehicle.chassis=guided"},
                                                        {"drawbar", "hitch={kind=\"speed\", slip=0.5}"},
                                                        {"drawbar", "hitch.kind=force"},
                                                        {"drawbar", "~hitch"},
                                                        {"grade", "hitch.kind=force"},
                                                        {"acceleration", "driver.left=2"},
                                                        {"acceleration", "driver.drive_ramp=5"},
                                                        {"pivot_turn", "driver.drive_ramp=5"},
                                                        {"turning_radius", "driver.drive_start=9"},
                                                        {"pivot_turn", "driver.drive_start=9"},
                                                        {"step", "stop.edge=3"},
                                                        {"grade", "stop={edge=3}"},
                                                        {"acceleration", "driver={sprocket_speed=2}"},
                                                        {"acceleration", "driver.course.speed=1"},
                                                        {"steady_turn", "driver.course.radius=8"},
                                                        {"turning_radius", "driver.course={speed=1, radius=9}"},
                                                        {"steady_turn", "driver.course.x=[0, 1]"},
                                                        {"pivot_turn", "driver.left=1"},
                                                        {"pivot_turn", "run.duration=100"},
                                                        {"step", "box.0.size.2=0.1"},
                                                        {"step", "box.step.position=[0, 0, 0]"},
                                                        {"half_round", "cylinder.half_round.radius=0.1"},
                                                        {"gap", "box.far_slab.size=[1, 1, 1]"},
                                                        {"ditch", "terrain.height_range=[-0.1, 0]"},
                                                        {"ditch", "terrain.heightmap=heightmaps/flat.png"},
                                                        {"grade", "vehicle.heading=90"},
                                                        {"grade", "vehicle.spec=vehicles/robot.toml"},
                                                        {"grade", "vehicle.material=ground"},
                                                        {"motion_resistance", "stop.distance=1"}};
  for (const auto& [event, set] : others)
    EXPECT_EQ(refused(event, set).find(std::string("--set ") + set + ": the event " + event + " sets "), 0u)
        << event << " " << set << ": " << refused(event, set);
  // Whole sections, with keys that the event or an option of the command sets.
  for (const char* set : {"run={duration=5, gravity=[0, 0, -1.62]}", "~output", "scm={c=0}", "spec={}"})
    EXPECT_EQ(refused("drawbar", set).find(std::string("--set ") + set + ": replaces the whole section"), 0u)
        << refused("drawbar", set);
  // Keys that do not define an event.
  for (const char* set : {"spec.contact.friction_ground=0.5", "driver.drive_ramp=0.5", "run.max_overlap=0.5",
                          "vehicle.sphere_radius=0.03", "output.picture=false", "stop.immobile=2"})
    EXPECT_EQ(refused("grade", set), "") << set;
  EXPECT_EQ(refused("steady_turn", "driver.course.turn_gain=1"), "");
  EXPECT_EQ(refused("drawbar", "hitch.stiffness=1e6"), "");
}

TEST(EventKeys, RampsTooLongForTheCourseAreRefused) {
  // At 1.2 m/s, the last 5 m take 4.2 s; a longer ramp lowers the mean speed towards the limit of a go.
  EventOptions options = optionsOf("grade", {"driver.drive_ramp=4.1"});
  options.levels = {0.2}, options.speed = 1.2;
  EXPECT_EQ(refusal(options), "");
  options.fixed = {"driver.drive_ramp=30"};
  EXPECT_EQ(refusal(options).find("--set: driver.drive_ramp = 30 [s] is above 4.17 s"), 0u) << refusal(options);
}

TEST(EventKeys, EveryKeyOfEveryLevelIsRefused) {
  for (const char* ground : {"rigid", "granular", "scm"}) {
    const Course course = courseOn(ground);
    for (const Event event : allEvents())
      for (const double level : levelsOf(event, course, false)) {
        const Trial trial = trialOf(event, level, course);
        for (const std::string& set : trial.overrides)
          if (event == Event::softSoil && sweeps::keyOf(set) == kPhi)
            EXPECT_NO_THROW(refuseOwnedKeys({set}, event, trial, course)) << "levels are fractions of this angle";
          else
            EXPECT_THROW(refuseOwnedKeys({set}, event, trial, course), base::InputError) << ground << " " << set;
        EXPECT_NO_THROW(refuseOwnedKeys({"run.device=cpu", "run.threads=2"}, event, trial, course));
      }
  }
}

/// Value of an override "key=value" or "key=[value, ...]".
std::optional<double> valueOf(const Trial& trial, const std::string& key) {
  for (const std::string& set : trial.overrides)
    if (sweeps::keyOf(set) == key) return std::stod(set.substr(key.size() + (set[key.size() + 1] == '[' ? 2 : 1)));
  return {};
}

TEST(EventCircle, RunEndsBehindTheJudgedPath) {
  for (const char* vehicle : {"light_tracked", "m113_like", "robot"}) {
    const Course course = courseOn("rigid", vehicle);
    for (const Event event : {Event::steadyTurn, Event::turningRadius})
      for (const double radius : {0.3, 0.9, 2.0, 2.5, 3.0, 5.0, 8.0, 20.0, 100.0}) {
        const Trial trial = trialOf(event, radius, course);
        const std::optional<double> stop = valueOf(trial, "stop.distance");
        EXPECT_DOUBLE_EQ(trial.distance, 6);
        EXPECT_GE(*valueOf(trial, "run.duration"), trial.distance / trial.speed + 2);
        EXPECT_EQ(trial.timed, !stop);
        EXPECT_TRUE(stop || radius < 5) << "larger circles end behind their path";
        // The sprocket axle moves on a circle of radius sqrt(R^2 + x^2) about the same point.
        for (const double share : {0.9, 1.0, 1.1})
          for (double way = 0; stop && way <= trial.distance; way += 0.01) {
            const double r = share * radius;
            EXPECT_LT(2 * std::hypot(r, course.shape.controlled.x) * std::fabs(std::sin(way / (2 * r))), *stop)
                << vehicle << " " << radius << " " << share << " " << way;
          }
      }
  }
}

TEST(EventCircle, LevelsAreRadiiOfLeftTurns) {
  EventOptions options = optionsOf("turning_radius");
  options.levels = {1, 4, 2};
  const EventPlan plan = planEvents(options);
  EXPECT_EQ(plan.trials[0].level, 4) << "from the easiest";
  EXPECT_EQ(plan.trials[2].level, 1);
  options.levels = {-3, 3};
  EXPECT_EQ(refusal(options).find("--levels -3: a radius must be above 0"), 0u) << refusal(options);
}

TEST(EventGravity, IsThatOfTheClosedForms) {
  for (const double g : {1.62, 9.81}) {
    EventOptions options = optionsOf("drawbar", {"run.gravity=[0, 0, " + std::to_string(-g) + "]"});
    EXPECT_DOUBLE_EQ(planEvents(options).course.shape.gravity, g);
    options.fixed = {}, options.gravity = g;
    const EventPlan plan = planEvents(options);
    const VehicleShape& s = plan.course.shape;
    EXPECT_DOUBLE_EQ(s.weight(), s.mass * g);
    EXPECT_DOUBLE_EQ(plan.sweep.runs[0].scene.run.gravity.z, -g);
    Motion m;
    for (int i = 0; i < 10; ++i)
      for (auto* column : {&m.time, &m.way, &m.turned, &m.left, &m.roll, &m.pitch, &m.upSpeed}) column->push_back(i);
    const auto figure = [&](Event event, const std::string& name) {
      Trial trial;
      trial.speed = 2.4, trial.rate = 1;
      for (const Figure& f : figuresOf(event, m, {}, 0, trial, plan.course))
        if (f.name == name) return f.value;
      return -1.0;
    };
    EXPECT_DOUBLE_EQ(figure(Event::drawbar, "mu W [N]"), 0.8 * s.mass * g);
    EXPECT_DOUBLE_EQ(figure(Event::acceleration, "the same by friction alone [s]"), 0.9 * 2.4 / (0.8 * g));
    EXPECT_DOUBLE_EQ(figure(Event::pivotTurn, "turning moment mu W L / 4 [N m]"), 0.8 * s.mass * g * s.groundRun() / 4);
    const double crawl = 0.48;
    EXPECT_NEAR(*referenceOf(Event::step, plan.course)->blocks, s.highestStep + crawl * crawl / (2 * g), 1e-12);
    EXPECT_NEAR(*referenceOf(Event::turningRadius, plan.course)->blocks, 0.729 * 1.44 / (0.8 * g), 1e-12);
    // Slopes incline gravity and keep its size.
    options.only = {"grade"}, options.levels = {0.75};
    const base::Vec3d inclined = planEvents(options).sweep.runs[0].scene.run.gravity;
    EXPECT_NEAR(inclined.x, -0.6 * g, 1e-5);
    EXPECT_NEAR(inclined.z, -0.8 * g, 1e-5);
  }
}

TEST(EventGravity, IsThatOfTheSoilLimits) {
  VehicleShape s;
  s.lastWheel = 1.85, s.padWidth = 0.28, s.mass = 5018;
  scm::SoilConstants soil;
  soil.exponent = 0.793, soil.kc = 102000, soil.kphi = 5301000, soil.cohesion = 1300, soil.friction = 0.6,
  soil.shearDisplacement = 0.012;
  s.gravity = 1.62;
  VehicleShape light = s;
  light.mass *= 1.62 / 9.81, light.gravity = 9.81; // the same weight
  EXPECT_DOUBLE_EQ(holdingSlope(s, soil), holdingSlope(light, soil));
  EXPECT_DOUBLE_EQ(trackThrust(s, soil, 0.2), trackThrust(light, soil, 0.2));
  EXPECT_DOUBLE_EQ(compactionResistance(s, soil), compactionResistance(light, soil));
}

TEST(EventGravity, MustBeVerticalAndGivenOnce) {
  EXPECT_EQ(refusal(optionsOf("drawbar", {"run.gravity=[-1, 0, -9]"}))
                .find("--set run.gravity=[-1, 0, -9]: gravity must be vertical"),
            0u);
  EXPECT_NE(refusal(optionsOf("drawbar", {"run.gravity=[0, 0, 0]"})).find("must be vertical"), std::string::npos);
  EXPECT_NE(refusal(optionsOf("drawbar", {"run.gravity=[0, 0, 9.81]"})).find("must be vertical"), std::string::npos);
  EXPECT_NE(refusal(optionsOf("drawbar", {"run.gravity.2=-2"})).find("use --gravity"), std::string::npos);
  EventOptions both = optionsOf("drawbar", {"run.gravity=[0, 0, -2]"});
  both.gravity = 2;
  EXPECT_NE(refusal(both).find("mutually exclusive with --gravity"), std::string::npos);
}

} // namespace

} // namespace grouser::events
