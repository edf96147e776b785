// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/enum_words.hpp"
#include "runs/campaigns/events/vehicle_shape.hpp"
#include "runs/scene/choices.hpp"
#include "scm/soil_constants.hpp"

#include <optional>
#include <string>
#include <vector>

/// The standard mobility events: which there are, at which levels, and what a level sets in the event's scene.
namespace grouser::events {

enum class Event {
  acceleration,
  grade,
  sideSlope,
  pivotTurn,
  steadyTurn,
  step,
  gap,
  ditch,
  halfRound,
  drawbar,
  motionResistance,
  softSoil
};

/// Says which events there are. Throws base::InputError for a word that is none of them.
Event eventOf(const std::string& word);
/// In the order in which they are run and listed.
std::vector<Event> allEvents();

/// What an event's level is: "tan of the slope [-]", "height of the step [m]"; empty where it has one level only.
std::string levelText(Event event);
/// "Up a slope".
std::string titleOf(Event event);

/// What the courses are made for.
struct Course {
  VehicleShape shape;
  double speed = 0; ///< commanded [m/s]
  scene::TerrainKind ground = scene::TerrainKind::rigid;
  double depth = 0;             ///< of the bed [m]
  double margin = 0;            ///< of a bed beside the tracks [m]
  double soilFriction = 0;      ///< of the soil's grains [-]
  double rollingFriction = 0;   ///< of the soil's grains [-]
  std::string soil;             ///< material of the bed and of what stands in it
  scm::SoilConstants constants; ///< of deformable soil

  bool rigid() const { return ground == scene::TerrainKind::rigid; }
  bool granular() const { return ground == scene::TerrainKind::granular; }
  bool deformable() const { return ground == scene::TerrainKind::scm; }
};

/// Levels that are run where none are given: three to five, or with `quick` those that tell most. Of events with one
/// level what it is, of those that this ground has not none.
std::vector<double> levelsOf(Event event, const Course& course, bool quick);
/// Why an event is left out; empty where it is not.
std::string omission(Event event, const Course& course);

/// One level of an event: what it sets in the scene, and by what it is judged.
struct Trial {
  std::vector<std::string> overrides; ///< "key=value"
  double distance = 0;                ///< to be driven [m]; of a turn on the spot 0
  double angle = 0;                   ///< to be turned [rad]
  double rate = 0;                    ///< commanded, of the turn [rad/s]
  double speed = 0;                   ///< commanded [m/s]
  double slip = 0;                    ///< imposed [-]
};
Trial trialOf(Event event, double level, const Course& course);

/// What geometry and friction say of an event's limit.
struct Reference {
  std::string text;                     ///< "friction 0.8"
  std::optional<double> passes, blocks; ///< up to and from which level; in between it does not say
};
/// Of a level; empty where nothing is known of it.
std::optional<Reference> referenceOf(Event event, const Course& course);

} // namespace grouser::events

template <> struct grouser::base::EnumWords<grouser::events::Event> {
  using E = events::Event;
  static constexpr EnumWord<E> list[] = {{E::acceleration, "acceleration"},
                                         {E::grade, "grade"},
                                         {E::sideSlope, "side_slope"},
                                         {E::pivotTurn, "pivot_turn"},
                                         {E::steadyTurn, "steady_turn"},
                                         {E::step, "step"},
                                         {E::gap, "gap"},
                                         {E::ditch, "ditch"},
                                         {E::halfRound, "half_round"},
                                         {E::drawbar, "drawbar"},
                                         {E::motionResistance, "motion_resistance"},
                                         {E::softSoil, "soft_soil"}};
};
