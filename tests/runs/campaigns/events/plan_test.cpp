// SPDX-License-Identifier: BSD-3-Clause
// Limits of events from the vehicle geometry, and every scene with every shipped vehicle.
#include "runs/campaigns/events/event_plan.hpp"
#include "runs/campaigns/events/event_report.hpp"
#include "runs/campaigns/events/soil_limits.hpp"

#include "base/error.hpp"
#include "base/math.hpp"
#include "runs/campaigns/sweeps/scene_check.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/load_scene.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

namespace grouser::events {

namespace {

/// A box of 2 x 0.5 m with its centre of mass at `ahead` from its middle and at `height`.
VehicleShape boxShape(double ahead, double height) {
  VehicleShape s;
  s.rear = s.front = 1, s.diagonal = 2.06, s.firstWheel = -0.8, s.lastWheel = 0.8;
  s.massCentre = {ahead, height}, s.halfWidth = 0.6;
  return s;
}

TEST(StepBound, LoopsAreAsLongAsBeltsInClosedForm) {
  const double r = 0.2, apart = 3;
  const std::vector<SideDisc> two{{{0, 0.1}, r}, {{apart, 0.1}, r}};
  // Polygons of 96 corners: shorter than the arcs by pi^2 / (6 96^2) = 1.8e-4, or 2.2e-4 for smaller arcs.
  const double belt = 2 * apart + 2 * base::kPi * r;
  EXPECT_LE(shortestLoop(two), belt);
  EXPECT_NEAR(shortestLoop(two), belt, 2e-4 * 2 * base::kPi * r);
  EXPECT_EQ(shortestLoop(two, {1, -0.3}), shortestLoop(two)) << "below the loop the point has no effect";
  // From a point at the height of the centres, tangents of sqrt(a^2 - r^2) lead to rims acos(r / a) below the line of
  // centres; from there the arcs continue to the top.
  const double a = 1.2, b = apart - a;
  const double arcs = r * (3 * base::kPi - std::acos(r / a) - std::acos(r / b));
  const double notched = apart + std::sqrt(a * a - r * r) + std::sqrt(b * b - r * r) + arcs;
  EXPECT_LE(shortestLoop(two, {a, 0.1}), notched + 1e-12);
  EXPECT_NEAR(shortestLoop(two, {a, 0.1}), notched, 3e-4 * arcs);
}

TEST(StepBound, IsAboveWhatIsClimbedAndDoesNotForgetTheArms) {
  EventOptions options;
  options.only = {"step"}, options.levels = {0.3};
  const auto boundOf = [&options](const std::vector<std::string>& changes) {
    options.fixed = changes;
    return planEvents(options).course.shape.highestStep;
  };
  const double free = boundOf({});
  EXPECT_GT(free, 0.67) << "the light vehicle has climbed this step";
  EXPECT_LT(free, 1.0);
  std::printf("highest step: %.3f m\n", free);
  EXPECT_LT(boundOf({"spec.arm.suspension=rigid"}), free - 0.05);
  EXPECT_GT(boundOf({"spec.chassis.centre=[1.6, 0, 0.10]"}), free);
  EXPECT_LT(boundOf({"spec.chassis.centre=[1.437, 0, 0.25]"}), free);
  for (const char* vehicle : {"m113_like", "robot"}) {
    options.vehicle = vehicle, options.fixed = {};
    const EventPlan plan = planEvents(options);
    const VehicleShape& s = plan.course.shape;
    EXPECT_GT(s.highestStep, 0.3 * s.massCentre.z) << vehicle;
    EXPECT_LT(s.highestStep, 0.5 * s.length()) << vehicle;
  }
}

TEST(VehicleShape, GapsAndTippingFollowTheCentreOfMass) {
  const VehicleShape box = boxShape(0.1, 0.4);
  EXPECT_DOUBLE_EQ(gapBounds(box).sure, 0.7);
  EXPECT_DOUBLE_EQ(gapBounds(box).level, 0.9);
  EXPECT_DOUBLE_EQ(gapBounds(box).never, 2.06);
  EXPECT_DOUBLE_EQ(tippingSlope(box), 1.5);
}

TEST(EventPlan, EveryEventTakesEveryReadyVehicle) {
  for (const char* vehicle : {"light_tracked", "m113_like", "robot"}) {
    EventOptions options;
    options.vehicle = vehicle;
    const EventPlan plan = planEvents(options); // loads and checks every run's scene
    for (const PlannedTrial& t : plan.trials) EXPECT_FALSE(t.runs.empty());
    EXPECT_EQ(plan.trials.size(), 30u) << vehicle;
    EXPECT_GT(plan.course.shape.diagonal, plan.course.shape.length());
    EXPECT_TRUE(plan.omitted.contains(Event::softSoil));
    // The shipped scene with another vehicle.
    for (const Event event : allEvents())
      EXPECT_NO_THROW(sweeps::checkScene(
          setup::loadScene(sceneOf(event), {std::string("vehicle.spec=vehicles/") + vehicle + ".toml"})))
          << base::wordOf(event) << " " << vehicle;
  }
}

TEST(EventPlan, OnASoilHasSeedsAndItsGrains) {
  EventOptions options;
  options.soil = "lete_sand", options.quick = true, options.only = {"step", "soft_soil", "grade"};
  const EventPlan plan = planEvents(options);
  EXPECT_EQ(plan.seeds, 2);
  EXPECT_EQ(plan.sweep.runs.size(), 2u * (2 + 1 + 2));
  EXPECT_EQ(plan.sweep.runs[0].name, "grade=0.2,seed=1");
  EXPECT_EQ(plan.sweep.runs[4].scene.boxes.at(0).material, "lete_sand"); // material of the step, in a Hertz bed
  const scene::Scene& weak = plan.sweep.runs[6].scene;
  EXPECT_EQ(plan.sweep.runs[6].name, "soft_soil=0.4,seed=1");
  const auto bed = std::find_if(weak.materials.begin(), weak.materials.end(),
                                [](const scene::Material& m) { return m.name == "lete_sand"; });
  ASSERT_NE(bed, weak.materials.end());
  EXPECT_DOUBLE_EQ(bed->friction, 0.4 * 0.5);              // from assets/soils/lete_sand.toml
  EXPECT_NEAR(*weak.terrain->grainRadius, 0.28 / 6, 1e-5); // a sixth of a pad's width, in four digits
  EXPECT_EQ(weak.terrain->porosity, 0.42) << "deep enough for grains prepared to the soil's porosity";
  EXPECT_TRUE(weak.terrain->granular());
}

TEST(EventPlan, OnDeformableSoilHasOneRunALevelAndNoGrains) {
  EventOptions options;
  options.soil = "lete_sand", options.ground = scene::TerrainKind::scm;
  options.only = {"grade", "soft_soil", "gap"}, options.quick = true;
  const EventPlan plan = planEvents(options);
  EXPECT_EQ(plan.seeds, 1);
  EXPECT_EQ(plan.sweep.runs.size(), 2u + 2) << "two levels of soils";
  EXPECT_TRUE(plan.omitted.contains(Event::gap));
  EXPECT_FALSE(plan.shoesAlone());
  EXPECT_EQ(plan.groundText(), "lete_sand (deformable soil)");
  for (const sweeps::SweepRun& run : plan.sweep.runs) {
    EXPECT_TRUE(run.scene.terrain->deformable()) << run.name;
    EXPECT_EQ(run.scene.terrain->material, "lete_sand") << run.name;
    EXPECT_FALSE(run.scene.terrain->depth) << run.name;
  }
  EXPECT_EQ(plan.sweep.runs[0].name, "grade=0.2");
  // 0.4 of the tangent of 31.1 degrees (the soil file), in six digits.
  const sweeps::SweepRun& weakest = plan.sweep.runs[2];
  EXPECT_EQ(weakest.name, "soft_soil=0.4");
  EXPECT_NEAR(*weakest.scene.scm->frictionAngle, std::atan(0.4 * std::tan(31.1 * base::kPi / 180)) * 180 / base::kPi,
              1e-4);
  options.fixed = {"scm.c=500"}, options.only = {"grade"}, options.levels = {0.2};
  EXPECT_DOUBLE_EQ(planEvents(options).course.constants.cohesion, 500);
}

TEST(EventPlan, HasARunForEachDrawOfTheConstants) {
  EventOptions options;
  options.soil = "lete_sand", options.ground = scene::TerrainKind::scm, options.draws = 3;
  options.only = {"grade"}, options.levels = {0.2, 0.4};
  const EventPlan plan = planEvents(options);
  ASSERT_EQ(plan.sweep.runs.size(), 6u);
  EXPECT_EQ(plan.sweep.runs[4].name, "grade=0.4,draw=2");
  EXPECT_EQ(plan.sweep.runs[4].scene.scm->constantsDraw, 2);
  EXPECT_TRUE(plan.random());
  options.fixed = {"scm.constants_draw=1"};
  EXPECT_THROW(planEvents(options), base::InputError) << "three runs of one sample";
  options.fixed = {}, options.ground = scene::TerrainKind::granular;
  EXPECT_THROW(planEvents(options), base::InputError);
}

TEST(EventPlan, ObstaclesReachIntoDeformableSoil) {
  Course course;
  course.shape = boxShape(0, 0.4), course.shape.padWidth = 0.28, course.speed = 1, course.soil = "lete_sand";
  course.ground = scene::TerrainKind::scm;
  const std::vector<std::string> sets = trialOf(Event::step, 0.2, course).overrides;
  const auto ends = [&sets](const char* key, const char* end) {
    return std::any_of(sets.begin(), sets.end(),
                       [&](const std::string& s) { return s.starts_with(key) && s.ends_with(end); });
  };
  EXPECT_TRUE(ends("box.0.size=", ", 0.48]")) << fmt::format("{}", fmt::join(sets, " "));
  EXPECT_TRUE(ends("box.0.position=", ", -0.04]"));
  for (const std::string& set : sets) EXPECT_EQ(set.find("material"), std::string::npos) << set;
}

TEST(EventPlan, GrainsTooCoarseForTheRunningGearMeetTheShoesAlone) {
  EventOptions options;
  options.soil = "lete_sand", options.quick = true, options.only = {"pivot_turn"};
  EXPECT_EQ(planEvents(options).sweep.runs[0].scene.vehicle->soilContact, scene::SoilContact::shoes) << "four per pad";
  options.grainRadius = 0.0135;
  EXPECT_EQ(planEvents(options).sweep.runs[0].scene.vehicle->soilContact, scene::SoilContact::all) << "ten per pad";
  options.grainRadius.reset(), options.fixed = {"vehicle.soil_contact=all"};
  EXPECT_EQ(planEvents(options).sweep.runs[0].scene.vehicle->soilContact, scene::SoilContact::all) << "set by the user";
  EXPECT_FALSE(planEvents(options).shoesAlone());
  options.fixed.clear();
  EXPECT_TRUE(planEvents(options).shoesAlone());
}

TEST(EventPlan, ExpectsRunsToEndBehindTheirCourse) {
  EventOptions options;
  options.only = {"grade"}, options.levels = {0.4};
  const EventPlan grade = planEvents(options);
  // 8 m at 1.2 m/s, plus a fifth, plus 1.2 s before the drive; the time limit is 22 s.
  EXPECT_DOUBLE_EQ(grade.sweep.runs[0].expectedEnd, 1.2 + 1.2 * 8 / 1.2);
  EXPECT_EQ(grade.sweep.runs[0].scene.run.duration, 22);
  options.only = {"drawbar"}, options.levels = {0.6, 0.2}; // sorted from the easiest
  const EventPlan drawbar = planEvents(options);
  const auto driving = [&](std::size_t run) { return drawbar.sweep.runs[run].expectedEnd - 1.2; };
  EXPECT_NEAR(driving(1), 2 * driving(0), 1e-12) << "half as fast"; // round-off of some seconds
  options.only = {"pivot_turn"}, options.levels = {};
  const EventPlan turn = planEvents(options);
  EXPECT_EQ(turn.sweep.runs[0].expectedEnd, turn.sweep.runs[0].scene.run.duration);
}

TEST(EventPlan, RigidGroundLeavesRoomForATurnOfATenthOfARadian) {
  for (const char* event : {"step", "gap", "ditch"}) {
    EventOptions options;
    options.vehicle = "robot", options.only = {event};
    const EventPlan plan = planEvents(options);
    const scene::Scene& scene = plan.sweep.runs[0].scene;
    const double aside = 0.1 * plan.trials[0].trial.distance, half = plan.course.shape.halfWidth + aside;
    EXPECT_GT(0.5 * scene.terrain->size[1], half) << event;
    for (const scene::BoxSection& box : scene.boxes) EXPECT_GT(0.5 * box.size.y, half) << event;
  }
}

TEST(EventPlan, LeansGravityAndKeepsItsSize) {
  EventOptions options;
  options.only = {"grade"}, options.levels = {0.75};
  const base::Vec3d g = planEvents(options).sweep.runs[0].scene.run.gravity;
  EXPECT_NEAR(g.x, -9.81 * 0.6, 1e-5); // six digits
  EXPECT_NEAR(g.z, -9.81 * 0.8, 1e-5);
  EXPECT_EQ(g.y, 0);
}

TEST(EventPlan, RefusesWhatIsNone) {
  const auto fault = [](const EventOptions& options) -> std::string {
    try {
      planEvents(options);
      return "";
    } catch (const base::InputError& error) {
      return error.what();
    }
  };
  EventOptions options;
  options.only = {"jump"};
  EXPECT_NE(fault(options).find("--only jump: unknown event; events: acceleration, grade"), std::string::npos);
  options = {}, options.vehicle = "tank";
  EXPECT_NE(fault(options).find("--vehicle tank: unknown vehicle; choose one of light_tracked, m113_like, robot"),
            std::string::npos);
  options = {}, options.soil = "cheese";
  EXPECT_NE(fault(options).find("--soil cheese: is neither rigid nor a known soil"), std::string::npos);
  options = {}, options.soil = "my/sand.toml";
  EXPECT_NE(fault(options).find("--soil my/sand.toml: requires the name of a soil"), std::string::npos);
  options = {}, options.levels = {0.5};
  EXPECT_NE(fault(options).find("--levels: requires a single event"), std::string::npos);
  options.only = {"step"}, options.levels = {INFINITY};
  EXPECT_NE(fault(options).find("--levels: must be distinct"), std::string::npos);
  // Errors name the option of the value, or --set.
  options = {}, options.only = {"drawbar"}, options.levels = {100};
  EXPECT_EQ(fault(options).find("--levels 100: hitch.slip = 100"), 0u) << fault(options);
  options = {}, options.only = {"step"}, options.speed = 1e9;
  EXPECT_EQ(fault(options).find("--speed: driver.sprocket_speed"), 0u) << fault(options);
  options = {}, options.only = {"step"}, options.soil = "dry_sand", options.quick = true, options.depth = 1e-3;
  EXPECT_EQ(fault(options).find("--depth: terrain.depth"), 0u) << fault(options);
  options.depth.reset(), options.grainRadius = 1;
  EXPECT_EQ(fault(options).find("--grain-radius: terrain.depth"), 0u) << fault(options);
  options = {}, options.only = {"step"}, options.fixed = {"driver.drive_ramp=-1"}, options.speed = 1;
  EXPECT_EQ(fault(options).find("--set: driver.drive_ramp"), 0u) << fault(options);
  options = {}, options.seeds = 3;
  EXPECT_NE(fault(options).find("--seeds: has no effect on rigid ground"), std::string::npos);
  options.soil = "lete_sand", options.ground = scene::TerrainKind::scm;
  EXPECT_NE(fault(options).find("--seeds: has no effect on deformable soil"), std::string::npos);
  options = {}, options.ground = scene::TerrainKind::scm;
  EXPECT_EQ(fault(options).find("--ground scm: requires a soil; set --soil"), 0u) << fault(options);
  options = {}, options.only = {"soft_soil"};
  EXPECT_NE(fault(options).find("--only soft_soil: rigid ground has no strength to vary"), std::string::npos);
}

/// The light vehicle of the common closed forms: W 49.21 kN, L 1.85 m, b 0.28 m; published constants of LETE sand.
Course lightOnSand() {
  Course c;
  c.shape = boxShape(0, 0.4);
  c.shape.firstWheel = 0, c.shape.lastWheel = 1.85, c.shape.padWidth = 0.28, c.shape.mass = 49.21e3 / kGravity;
  c.ground = scene::TerrainKind::scm;
  c.constants.exponent = 0.793, c.constants.kc = 102000, c.constants.kphi = 5301000, c.constants.cohesion = 1300;
  c.constants.friction = std::tan(31.1 * base::kPi / 180), c.constants.shearDisplacement = 0.012;
  return c;
}

TEST(SoilLimits, AreThoseOfARigidTrack) {
  const Course c = lightOnSand();
  // Five digits: integrals of the exponential by hand.
  EXPECT_NEAR(std::atan(holdingSlope(c.shape, c.constants)) * 180 / base::kPi, 32.44, 0.005);
  for (const auto& [slip, force] : {std::pair{0.02, 21429.0}, {0.05, 27008.0}, {0.1, 29019.0}, {0.2, 30026.0}})
    EXPECT_NEAR(trackThrust(c.shape, c.constants, slip), force, 5) << slip;
  EXPECT_NEAR(compactionResistance(c.shape, c.constants), 2 * 0.5 * 35.705, 0.02) << "for both tracks";
  Course sticky = c;
  sticky.constants.cohesion = 1e6;
  EXPECT_TRUE(std::isinf(holdingSlope(sticky.shape, sticky.constants)));
  EXPECT_FALSE(referenceOf(Event::grade, sticky)) << "it stays on any slope";
}

TEST(SoilLimits, BlockSlopesAboveTheHoldingOne) {
  Course c = lightOnSand();
  const std::optional<Reference> grade = referenceOf(Event::grade, c), side = referenceOf(Event::sideSlope, c);
  ASSERT_TRUE(grade && side);
  EXPECT_NEAR(*grade->blocks, std::tan(32.44 * base::kPi / 180), 2e-4);
  EXPECT_FALSE(grade->passes);
  EXPECT_EQ(side->blocks, grade->blocks);
  c.shape.massCentre.z = 2; // tips first: 0.6 / 2
  EXPECT_DOUBLE_EQ(*referenceOf(Event::sideSlope, c)->blocks, 0.3);
  EXPECT_FALSE(referenceOf(Event::step, c));
}

TEST(EventLimits, LieBetweenTheLastGoAndTheFirstNoGo) {
  Course course;
  course.shape = boxShape(0, 0.45), course.shape.friction = 0.8;
  std::vector<EventRow> rows;
  for (const auto& [level, gos] : {std::pair{0.4, 1}, {0.784, 1}, {0.816, 0}}) {
    EventRow row;
    row.event = Event::grade, row.level = level, row.runs = 1, row.gos = gos;
    rows.push_back(row);
  }
  std::vector<EventLimit> limits = eventLimits(rows, course);
  ASSERT_EQ(limits.size(), 1u);
  EXPECT_EQ(limits[0].go, 0.784);
  EXPECT_EQ(limits[0].noGo, 0.816);
  EXPECT_EQ(limits[0].agrees, true);
  rows[2].gos = 1;
  EXPECT_EQ(eventLimits(rows, course)[0].agrees, false); // friction 0.8 blocks 0.816
  EXPECT_FALSE(eventLimits(rows, course)[0].noGo);
  rows[0].gos = 0;
  EXPECT_FALSE(eventLimits(rows, course)[0].go); // a go above a no-go has no effect
}

TEST(EventLimits, OfAHarderLowerLevelLieBelowTheGo) {
  Course course;
  course.shape = boxShape(0, 0.45), course.shape.friction = 0.8;
  const auto limitOf = [&course](Event event, const std::vector<std::pair<double, int>>& levels) {
    std::vector<EventRow> rows;
    for (const auto& [level, gos] : levels) {
      EventRow row;
      row.event = event, row.level = level, row.runs = 1, row.gos = gos;
      rows.push_back(row);
    }
    return eventLimits(rows, course).at(0);
  };
  for (const Event event : {Event::steadyTurn, Event::turningRadius, Event::softSoil}) {
    const EventLimit between = limitOf(event, {{3, 0}, {8, 1}});
    EXPECT_EQ(between.go, 8);
    EXPECT_EQ(between.noGo, 3);
    EXPECT_EQ(limitText(between), "between 8 and 3") << "in any order of the levels";
    EXPECT_EQ(limitText(limitOf(event, {{8, 1}, {3, 0}})), "between 8 and 3");
    EXPECT_EQ(limitText(limitOf(event, {{3, 1}, {8, 1}})), "below 3");
    EXPECT_EQ(limitText(limitOf(event, {{3, 0}, {8, 0}})), "above 8");
    EXPECT_EQ(limitText(limitOf(event, {{3, 1}, {8, 0}})), "above 8") << "a go below a no-go has no effect";
  }
  EXPECT_EQ(limitText(limitOf(Event::step, {{0.1, 1}, {0.2, 1}})), "above 0.2");
  // v^2 / (mu g) is 5.1 m at 6.3 m/s; a go may be slower.
  course.speed = 6.3;
  const EventLimit turning = limitOf(Event::turningRadius, {{3, 0}, {8, 1}});
  ASSERT_TRUE(turning.reference && turning.reference->blocks);
  EXPECT_NEAR(*turning.reference->blocks, 0.729 * 6.3 * 6.3 / (0.8 * 9.81), 1e-12);
  EXPECT_EQ(turning.agrees, true);
  EXPECT_EQ(limitOf(Event::turningRadius, {{3, 1}, {8, 1}}).agrees, false) << "no vehicle turns within 3 m";
}

TEST(EventRow, TellsWhyOfTheRunThatDecides) {
  EventRow row;
  EXPECT_EQ(row.why(), "");
  row.each = {{"step=1,seed=1", "pending", ""}, {"step=1,seed=2", "failed", "energy"}};
  EXPECT_EQ(row.why(), "energy");
  row.each.push_back({"step=1,seed=3", "go", "5.0 m in 6 s"});
  EXPECT_EQ(row.why(), "5.0 m in 6 s");
  row.each.push_back({"step=1,seed=4", "no-go", "throws a track"});
  EXPECT_EQ(row.why(), "throws a track") << "one no-go invalidates the level";
  row.event = Event::drawbar, row.runs = row.gos = 2;
  row.each = {{"a", "go", "drawbar pull 19 kN"}, {"b", "go", "drawbar pull 23 kN"}};
  row.figures = {{"drawbar pull [N]", {}, {21e3, 25e3}}};
  EXPECT_EQ(row.why(), "mean pull 21 kN");
  row.gos = 1, row.each[1] = {"b", "no-go", "required towing force 2 kN"};
  EXPECT_EQ(row.why(), "required towing force 2 kN");
}

} // namespace

} // namespace grouser::events
