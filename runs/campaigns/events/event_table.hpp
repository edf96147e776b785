// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/enum_words.hpp"
#include "runs/campaigns/events/vehicle_shape.hpp"
#include "runs/scene/choices.hpp"
#include "scm/soil_constants.hpp"

#include <optional>
#include <string>
#include <vector>

/// The standard mobility events, their levels, and the scene overrides of each level.
namespace grouser::events {

enum class Event {
  acceleration,
  grade,
  sideSlope,
  pivotTurn,
  steadyTurn,
  turningRadius,
  step,
  gap,
  ditch,
  halfRound,
  drawbar,
  motionResistance,
  softSoil
};

/// Event with this name. Throws base::InputError, with a list of the events, for an unknown name.
Event eventOf(const std::string& word);
/// All events, in the order of runs and tables.
std::vector<Event> allEvents();

/// Quantity that the levels vary: "tan of the slope [-]", "height of the step [m]"; empty for a single level.
std::string levelText(Event event);
/// Whether the vehicle drives a circle, with its radius as level.
bool isCircle(Event event);
/// Key of the friction angle of deformable soil. The levels of soft_soil are fractions of the user's angle.
inline constexpr const char* kPhi = "scm.phi";
/// Whether a level below another is harder, e.g. a smaller radius.
bool isHarderBelow(Event event);
/// "Up a slope".
std::string titleOf(Event event);

/// Parameters of the courses.
struct Course {
  VehicleShape shape;
  double speed = 0; ///< commanded speed [m/s]
  scene::TerrainKind ground = scene::TerrainKind::rigid;
  double depth = 0;             ///< bed depth [m]
  double margin = 0;            ///< bed width beside the tracks [m]
  double soilFriction = 0;      ///< friction of soil grains [-]
  double rollingFriction = 0;   ///< rolling friction of soil grains [-]
  std::string soil;             ///< material of the bed and of obstacles in it
  scm::SoilConstants constants; ///< constants of deformable soil

  bool rigid() const { return ground == scene::TerrainKind::rigid; }
  bool granular() const { return ground == scene::TerrainKind::granular; }
  bool deformable() const { return ground == scene::TerrainKind::scm; }
};

/// Default levels: three to five, fewer with `quick`; one for events without levels; empty for events that do not apply
/// to the ground.
std::vector<double> levelsOf(Event event, const Course& course, bool quick);
/// Reason why an event is skipped; else empty.
std::string omission(Event event, const Course& course);

/// One level of an event: scene overrides and target motion.
struct Trial {
  std::vector<std::string> overrides; ///< "key=value"
  double distance = 0;                ///< distance to drive [m]; 0 for a pivot turn
  double angle = 0;                   ///< angle to turn [rad]
  double rate = 0;                    ///< commanded turn rate [rad/s], if the verdict depends on it
  double radius = 0;                  ///< commanded radius of a circle to the left [m]
  double speed = 0;                   ///< commanded speed [m/s]
  double slip = 0;                    ///< imposed slip [-]
  bool timed = false;                 ///< the run ends at run.duration, not at a distance
};
Trial trialOf(Event event, double level, const Course& course);

/// Criteria for the verdict go.
struct GoRule {
  double way = 5;      ///< [m] final part of the course over which the mean speed is measured
  double share = 0.5;  ///< minimum of mean speed in that part (or mean turn rate) / commanded value [-]
  double time = 20;    ///< [s] after the start of the drive
  double maxRoll = 30; ///< [deg] maximum roll angle of the hull relative to the plane of the ground
  double radius = 0.1; ///< maximum |driven radius / commanded radius - 1| on a circle [-]
  double turn = 0.9;   ///< minimum of turn rate / commanded turn rate on a circle whose turn rate is commanded [-]
};

/// Analytical limit of an event from geometry and friction.
struct Reference {
  std::string text;                     ///< "friction 0.8"
  std::optional<double> passes, blocks; ///< hardest level that must pass, easiest that must fail; undecided in between
};
/// Reference of an event; empty if the event has no closed-form limit.
std::optional<Reference> referenceOf(Event event, const Course& course);

} // namespace grouser::events

template <> struct grouser::base::EnumWords<grouser::events::Event> {
  using E = events::Event;
  static constexpr EnumWord<E> list[] = {{E::acceleration, "acceleration"},
                                         {E::grade, "grade"},
                                         {E::sideSlope, "side_slope"},
                                         {E::pivotTurn, "pivot_turn"},
                                         {E::steadyTurn, "steady_turn"},
                                         {E::turningRadius, "turning_radius"},
                                         {E::step, "step"},
                                         {E::gap, "gap"},
                                         {E::ditch, "ditch"},
                                         {E::halfRound, "half_round"},
                                         {E::drawbar, "drawbar"},
                                         {E::motionResistance, "motion_resistance"},
                                         {E::softSoil, "soft_soil"}};
};
