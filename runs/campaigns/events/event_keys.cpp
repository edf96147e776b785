// SPDX-License-Identifier: BSD-3-Clause
#include "runs/campaigns/events/event_keys.hpp"

#include "base/error.hpp"
#include "runs/campaigns/sweeps/overrides.hpp"
#include "runs/campaigns/sweeps/sweep_plan.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace grouser::events {

namespace {

/// Keys of every event: vehicle, ground, obstacles, start and drive.
constexpr const char* kOfAll[] = {"vehicle.spec",
                                  "vehicle.position",
                                  "vehicle.heading",
                                  "vehicle.chassis",
                                  "vehicle.tracks",
                                  "terrain.kind",
                                  "terrain.material",
                                  "terrain.heightmap",
                                  "terrain.size",
                                  "terrain.height_range",
                                  "plane",
                                  "box",
                                  "cylinder",
                                  "mesh",
                                  "stop.distance",
                                  "stop.edge",
                                  "driver.left",
                                  "driver.right",
                                  "driver.table",
                                  "driver.torque",
                                  "driver.left_torque",
                                  "driver.torques",
                                  "driver.sprocket_speed",
                                  "driver.right_torque"};

/// True if one key is the other, or a section or list that contains the other.
bool overlap(const std::string& a, const std::string& b) {
  return a == b || a.starts_with(b + ".") || b.starts_with(a + ".");
}

struct Remedy {
  const char *key, *text;
};
constexpr Remedy kRemedies[] = {{"vehicle.spec", "use --vehicle"},
                                {"vehicle.material", "use --set spec.contact.friction_ground"},
                                {"terrain.kind", "use --ground"},
                                {"terrain.material", "use --soil"},
                                {"terrain.grain_radius", "use --grain-radius"},
                                {"terrain.depth", "use --depth"},
                                {sweeps::kSeedKey, "use --seeds"},
                                {"run.gravity", "use --levels for the slope and --gravity for the gravity"},
                                {"driver.sprocket_speed", "use --speed"},
                                {"driver.left", "use --speed"},
                                {"driver.right", "use --speed"},
                                {"driver.course.speed", "use --speed"},
                                {"driver.course.radius", "use --levels"},
                                {"hitch.slip", "use --levels"}};

std::string remedyOf(Event event, const std::string& key) {
  const std::pair<Event, const char*> kObstacles[] = {{Event::step, "box"},
                                                      {Event::gap, "box"},
                                                      {Event::halfRound, "cylinder"},
                                                      {Event::ditch, "terrain.height_range"}};
  for (const auto& [of, obstacle] : kObstacles)
    if (event == of && key == obstacle) return "use --levels";
  if (event == Event::softSoil && key.starts_with("material.")) return "use --levels";
  if (event != Event::drawbar && key == "hitch") return "use the event drawbar";
  for (const Remedy& remedy : kRemedies)
    if (key == remedy.key) return remedy.text;
  const Event scene = event == Event::softSoil ? Event::motionResistance : event;
  return fmt::format("to change it, run the scene of the event: grouser run runs/scenes/event_{}.toml --set ...",
                     base::wordOf(scene));
}

} // namespace

std::vector<std::string> ownedKeys(Event event, const Trial& trial, const Course& course) {
  std::vector<std::string> keys(std::begin(kOfAll), std::end(kOfAll));
  const auto add = [&keys](const std::string& key) {
    if (std::none_of(keys.begin(), keys.end(), [&key](const std::string& k) { return k == key; })) keys.push_back(key);
  };
  if (isCircle(event))
    for (const char* key : {"driver.course.x", "driver.course.y"}) add(key);
  else
    add("driver.course");
  if (event == Event::drawbar)
    for (const char* key : {"hitch.kind", "hitch.force", "hitch.rate"}) add(key);
  else
    add("hitch");
  if (event == Event::acceleration || event == Event::pivotTurn) add("driver.drive_ramp"); // a step input
  if (trial.timed) add("driver.drive_start");
  if (course.rigid()) add("vehicle.material");
  if (course.granular())
    for (const char* key : {"terrain.grain_radius", "terrain.depth", sweeps::kSeedKey}) add(key);
  for (const std::string& set : trial.overrides) {
    const std::string key = sweeps::keyOf(set);
    if (event == Event::softSoil && key == kPhi) continue; // levels are fractions of the user's friction angle
    if (!key.starts_with("box.") && !key.starts_with("cylinder.")) add(key.substr(key.starts_with('~') ? 1 : 0));
  }
  return keys;
}

std::string refusal(const std::vector<std::string>& sets, Event event, const Trial& trial, const Course& course) {
  const std::vector<std::string> owned = ownedKeys(event, trial, course);
  for (const std::string& set : sets) {
    const std::string whole = sweeps::keyOf(set), key = whole.substr(whole.starts_with('~') ? 1 : 0);
    const auto found =
        std::find_if(owned.begin(), owned.end(), [&key](const std::string& k) { return overlap(k, key); });
    if (found != owned.end())
      return fmt::format("--set {}: the event {} sets {} itself; {}", set, base::wordOf(event), *found,
                         remedyOf(event, *found));
    if (key.find('.') == std::string::npos)
      return fmt::format("--set {}: replaces the whole section {}, with the keys that the event {} needs; set single "
                         "keys, e.g. --set {}.KEY=VALUE",
                         set, key, base::wordOf(event), key);
  }
  return "";
}

void refuseOwnedKeys(const std::vector<std::string>& sets, Event event, const Trial& trial, const Course& course) {
  if (const std::string why = refusal(sets, event, trial, course); !why.empty()) throw base::InputError(why);
}

} // namespace grouser::events
