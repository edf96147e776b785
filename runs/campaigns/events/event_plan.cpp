// SPDX-License-Identifier: BSD-3-Clause
#include "runs/campaigns/events/event_plan.hpp"

#include "base/error.hpp"
#include "runs/campaigns/events/event_keys.hpp"
#include "runs/campaigns/sweeps/check_cases.hpp"
#include "runs/campaigns/sweeps/overrides.hpp"
#include "runs/campaigns/sweeps/scene_check.hpp"
#include "runs/scene/scene.hpp"
#include "runs/scene/soil.hpp"
#include "runs/setup/load_scene.hpp"
#include "runs/setup/scm_setup.hpp"
#include "runs/support/locations.hpp"
#include "vehicle/spec_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string_view>

namespace grouser::events {

namespace fs = std::filesystem;
using base::InputError;

namespace {

constexpr const char* kRigid = "rigid";
constexpr double kLightRadius = 0.2451, kLightSpeed = 1.2; // m, m/s: of the light vehicle
constexpr double kFewOnPad = 6;               // grains per pad width; with four, tracks skip teeth (docs/events.md)
constexpr double kSphere = 0.02 / 0.28;       // radius of the parts' spheres over pad width
constexpr double kStart = 1.2, kSlower = 1.2; // start of the drive [s]; duration / duration at full speed

/// Names of the built-in vehicles.
std::vector<std::string> readyVehicles() {
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(support::shareFolder() / "assets" / "vehicles", error))
    if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

/// Vehicle file by name or path, in the working directory or the assets.
std::string vehicleFile(const std::string& word) {
  const bool isPath = word.find('/') != std::string::npos || word.ends_with(".toml");
  std::vector<fs::path> tried;
  const fs::path found =
      support::findInput(isPath ? word : "vehicles/" + word + ".toml", fs::current_path() / "events.toml", tried);
  if (found.empty() || word.empty())
    throw InputError(fmt::format("--vehicle {}: unknown vehicle; choose one of {}, or set the path of a vehicle file",
                                 word, fmt::join(readyVehicles(), ", ")));
  return fs::absolute(found).lexically_normal().string();
}

scene::Soil soilOf(const std::string& word) {
  if (word.find('/') != std::string::npos || word.ends_with(".toml"))
    throw InputError(fmt::format(
        "--soil {}: requires the name of a soil, not a file; move the file to ./soils/ and use its name without .toml",
        word));
  std::vector<fs::path> tried;
  const fs::path here = fs::current_path() / "events.toml", file = scene::findSoil(word, here, tried);
  if (file.empty())
    throw InputError(
        fmt::format("--soil {}: is neither {} nor a known soil; {}", word, kRigid, scene::soilHint(word, here)));
  return scene::readSoil(file);
}

/// Gravity of the events [m/s2]: --gravity, or run.gravity of --set, which must be vertical as the ground is level.
/// Slopes own run.gravity, and refuse it later.
double gravityOf(const EventOptions& options, const std::vector<Event>& events) {
  const bool sloping =
      std::any_of(events.begin(), events.end(), [](Event e) { return e == Event::grade || e == Event::sideSlope; });
  std::vector<std::string> sets;
  for (const std::string& set : options.fixed) {
    const std::string key = sweeps::keyOf(set);
    if (key != "run.gravity" && !key.starts_with("run.gravity.")) continue;
    if (options.gravity) throw InputError(fmt::format("--set {}: mutually exclusive with --gravity; remove one", set));
    if (key != "run.gravity" && !sloping)
      throw InputError(fmt::format("--set {}: sets one component; use --gravity, or run.gravity=[0, 0, -9.81]", set));
    sets.push_back(set);
  }
  if (options.gravity || sloping || sets.empty()) return options.gravity.value_or(kGravity);
  const base::Vec3d g = setup::loadScene(sceneOf(Event::acceleration), sets).run.gravity;
  if (g.x != 0 || g.y != 0 || !(g.z < 0))
    throw InputError(
        fmt::format("--set {}: gravity must be vertical and downward, as in [0, 0, -9.81]; for slopes, use "
                    "the events grade and side_slope",
                    sets.front()));
  return -g.z;
}

/// Vehicle with the user's overrides.
vehicle::VehicleSpec specOf(const std::string& file, const EventOptions& options) {
  std::vector<std::string> sets = {fmt::format("vehicle.spec=\"{}\"", file)};
  for (const std::string& set : options.fixed)
    if (set.starts_with("spec.")) sets.push_back(set);
  const scene::Scene scene = setup::loadScene(sceneOf(Event::acceleration), sets);
  return vehicle::readVehicleSpec(scene.vehicle->source());
}

void refuseGrainOptions(const EventOptions& options, bool rigid) {
  for (const auto& [given, name] : {std::pair{options.grainRadius.has_value(), "--grain-radius"},
                                    {options.depth.has_value(), "--depth"},
                                    {options.seeds.has_value(), "--seeds"}})
    if (given)
      throw InputError(
          rigid
              ? fmt::format("{}: has no effect on rigid ground; set --soil, or remove the option", name)
              : fmt::format("{}: has no effect on deformable soil; set --ground granular, or remove the option", name));
}

/// Soil constants with the user's overrides.
scm::SoilConstants constantsOf(const EventOptions& options, const std::string& file) {
  std::vector<std::string> sets = {fmt::format("vehicle.spec=\"{}\"", file), "terrain.kind=\"scm\"",
                                   fmt::format("terrain.material=\"{}\"", options.soil)};
  for (const std::string& set : options.fixed)
    if (set.starts_with("spec.") || set.starts_with("scm.")) sets.push_back(set);
  return setup::scmSetup(setup::loadScene(sceneOf(Event::acceleration), sets))->soil;
}

Course courseOf(const EventOptions& options, const std::vector<Event>& events, const std::string& file,
                double& grainRadius) {
  Course c;
  c.shape = shapeOf(specOf(file, options), gravityOf(options, events));
  c.speed = options.speed.value_or(std::round(100 * kLightSpeed * std::sqrt(c.shape.pitchRadius / kLightRadius)) / 100);
  c.ground = groundOf(options), c.soil = options.soil;
  if (!c.granular()) refuseGrainOptions(options, c.rigid());
  if (c.rigid()) return c;
  if (options.soil == kRigid)
    throw InputError(
        fmt::format("--ground {}: requires a soil; set --soil (`grouser soils` lists them)", base::wordOf(c.ground)));
  const scene::Soil soil = soilOf(options.soil);
  if (c.deformable()) {
    c.constants = constantsOf(options, file);
    return c;
  }
  const double pad = c.shape.padWidth;
  const BedCare& care = options.care();
  grainRadius = options.grainRadius.value_or(pad / (2 * care.grainsOnPad));
  c.depth = options.depth.value_or(pad * care.depth);
  c.margin = pad * care.margin;
  c.soilFriction = soil.material.friction, c.rollingFriction = soil.material.rollingFriction;
  return c;
}

/// Overrides common to all runs of these events.
std::vector<std::string> commonOf(const EventOptions& options, const EventPlan& plan) {
  std::vector<std::string> sets = {fmt::format("vehicle.spec=\"{}\"", plan.vehicleFile),
                                   fmt::format("vehicle.sphere_radius={:.3g}", kSphere * plan.course.shape.padWidth),
                                   "output.plots=false", "output.picture_width=800",
                                   fmt::format("output.frames={}", options.frames)};
  if (options.gravity) sets.push_back(fmt::format("run.gravity=[0, 0, {}]", -*options.gravity));
  if (plan.course.rigid()) return sets;
  sets.push_back(fmt::format("terrain.kind=\"{}\"", base::wordOf(plan.course.ground)));
  sets.push_back(fmt::format("terrain.material=\"{}\"", options.soil));
  if (plan.course.deformable()) return sets;
  sets.push_back(fmt::format("terrain.grain_radius={:.4g}", plan.grainRadius));
  sets.push_back(fmt::format("terrain.depth={:.4g}", plan.course.depth));
  if (plan.course.shape.padWidth < kFewOnPad * 2 * plan.grainRadius)
    sets.emplace_back("vehicle.soil_contact=\"shoes\"");
  return sets;
}

/// Key that has different values in the runs of a level.
std::string keyOfNumber(const EventPlan& plan) { return plan.draws > 0 ? sweeps::kDrawKey : sweeps::kSeedKey; }

std::string runName(Event event, double level, int number, const EventPlan& plan) {
  std::string name(base::wordOf(event));
  if (!levelText(event).empty()) name += fmt::format("={:g}", level);
  if (plan.random()) name += fmt::format(",{}={}", plan.draws > 0 ? "draw" : "seed", number);
  return name;
}

/// Expected time at which the vehicle completes the course [s]; at most `limit`, the duration of the scene.
double expectedEnd(const PlannedTrial& planned, double limit) {
  const Trial& trial = planned.trial;
  if (trial.timed) return limit;
  const double speed = planned.event == Event::drawbar ? (1 - planned.level) * trial.speed : trial.speed;
  return speed > 0 ? std::min(limit, kStart + kSlower * trial.distance / speed) : limit;
}

std::vector<Event> chosen(const EventOptions& options) {
  if (options.only.empty()) return allEvents();
  std::set<Event> asked;
  for (const std::string& word : options.only) asked.insert(eventOf(word));
  return {asked.begin(), asked.end()};
}

/// Levels in the order of the tables, easiest first.
std::vector<double> easiestFirst(Event event, std::vector<double> levels) {
  std::sort(levels.begin(), levels.end());
  if (isHarderBelow(event)) std::reverse(levels.begin(), levels.end());
  return levels;
}

void checkLevels(const EventOptions& options, const std::vector<Event>& events) {
  if (options.levels.empty()) return;
  if (events.size() != 1 || options.only.empty() || levelText(events[0]).empty())
    throw InputError("--levels: requires a single event with levels; set --only, e.g. --only step");
  std::vector<double> sorted = options.levels;
  std::sort(sorted.begin(), sorted.end());
  if (isCircle(events[0]) && !(sorted.front() > 0))
    throw InputError(fmt::format("--levels {:g}: a radius must be above 0; both events with circles turn to the left, "
                                 "and the vehicle is symmetric",
                                 sorted.front()));
  if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end() || !(sorted.front() > 0) ||
      !std::isfinite(sorted.back()))
    throw InputError("--levels: must be distinct, finite and above 0");
}

/// Error message that names the user's option instead of the --set that the command derived from it.
std::string namingUserOption(const std::string& fault, const EventOptions& options, Event event, double level) {
  static constexpr std::string_view kSet = "--set: ";
  if (!fault.starts_with(kSet)) return fault;
  const std::string rest = fault.substr(kSet.size());
  for (const std::string& set : options.fixed)
    if (rest.starts_with(set.substr(0, set.find('=')))) return fault;
  if (options.depth && rest.starts_with("terrain.depth")) return fmt::format("--depth: {}", rest);
  if (options.grainRadius && (rest.starts_with("terrain.grain_radius") || rest.starts_with("terrain.depth")))
    return fmt::format("--grain-radius: {}", rest);
  if (options.speed && rest.starts_with("driver.")) return fmt::format("--speed: {}", rest);
  if (!options.levels.empty()) return fmt::format("--levels {:g}: {}", level, rest);
  return fmt::format("event {}: {}", base::wordOf(event), rest);
}

/// A long ramp of the drive lowers the mean speed on the course: with a ramp of (course / speed), it is two thirds of
/// the commanded speed, and a go requires half of it.
void checkRamp(const scene::Scene& scene, const Trial& trial) {
  if (!(trial.speed > 0) || scene.driver.course) return;
  const double longest = std::max(scene::Driver{}.rampOfDrive(), GoRule{}.way / trial.speed);
  if (scene.driver.rampOfDrive() > longest)
    scene.fail("driver", "drive_ramp",
               fmt::format("[s] is above {:.3g} s, the time for the course at {:g} m/s, so that the ramp would decide "
                           "the verdict; lower it",
                           longest, trial.speed));
}

/// Loads the scene of a run. Checks only the first seed or draw, because the others differ only in random numbers.
void load(sweeps::SweepRun& run, const EventOptions& options, const PlannedTrial& planned, int number) {
  try {
    run.scene = setup::loadScene(run.file, run.overrides);
    checkRamp(run.scene, planned.trial);
    if (number == 1) sweeps::checkScene(run.scene);
  } catch (const InputError& fault) {
    throw InputError(namingUserOption(fault.what(), options, planned.event, planned.level));
  }
}

} // namespace

fs::path sceneOf(Event event) {
  // Soft soil uses the scene of motion resistance with another material.
  const Event file = event == Event::softSoil ? Event::motionResistance : event;
  return support::shareFolder() / "runs" / "scenes" / fmt::format("event_{}.toml", base::wordOf(file));
}

scene::TerrainKind groundOf(const EventOptions& options) {
  using scene::TerrainKind;
  return options.ground.value_or(options.soil == kRigid ? TerrainKind::rigid : TerrainKind::granular);
}

std::string soilWord(const EventOptions& options) {
  return groundOf(options) == scene::TerrainKind::rigid ? kRigid : options.soil;
}

std::string EventPlan::groundText() const {
  return course.rigid() ? kRigid : course.soil + (course.deformable() ? " (deformable soil)" : "");
}

bool EventPlan::shoesAlone() const {
  return course.granular() && sweep.runs.front().scene.vehicle->soilContact == scene::SoilContact::shoes;
}

EventPlan planEvents(const EventOptions& options) {
  const std::vector<Event> events = chosen(options);
  checkLevels(options, events);
  sweeps::checkGivenOnce(options.fixed);
  EventPlan plan;
  plan.vehicleFile = vehicleFile(options.vehicle);
  plan.course = courseOf(options, events, plan.vehicleFile, plan.grainRadius);
  plan.seeds = plan.course.granular() ? options.seeds.value_or(options.care().seeds) : 1;
  plan.draws = options.draws;
  if (plan.draws > 0 && !plan.course.deformable())
    throw InputError("--draws: requires deformable soil; set --ground scm, or remove --draws");
  for (const std::string& set : options.fixed)
    if (plan.draws > 0 && sweeps::keyOf(set) == sweeps::kDrawKey)
      throw InputError(fmt::format("--set {}: mutually exclusive with --draws; remove one", set));
  const std::vector<std::string> common = commonOf(options, plan);
  plan.sweep.keys = {"event", keyOfNumber(plan)};
  for (const Event event : events) {
    if (const std::string why = omission(event, plan.course); !why.empty()) {
      plan.omitted[event] = why;
      continue;
    }
    const std::vector<double> levels =
        options.levels.empty() ? levelsOf(event, plan.course, options.quick) : easiestFirst(event, options.levels);
    if (event == Event::softSoil && options.only.empty())
      if (std::string why = refusal(options.fixed, event, trialOf(event, levels.front(), plan.course), plan.course);
          !why.empty()) {
        plan.omitted[event] = std::move(why);
        continue;
      }
    for (const double level : levels) {
      PlannedTrial planned{event, level, trialOf(event, level, plan.course), {}};
      refuseOwnedKeys(options.fixed, event, planned.trial, plan.course);
      for (int number = 1; number <= std::max(plan.seeds, plan.draws); ++number) {
        sweeps::SweepRun run;
        run.file = sceneOf(event);
        run.name = runName(event, level, number, plan);
        run.overrides = common;
        for (const std::string& set : planned.trial.overrides) sweeps::putOverride(run.overrides, set);
        if (plan.random()) run.overrides.push_back(fmt::format("{}={}", keyOfNumber(plan), number));
        for (const std::string& set : options.fixed)
          if (event != Event::softSoil || sweeps::keyOf(set) != kPhi) sweeps::putOverride(run.overrides, set);
        run.values = {fmt::format("{}={:g}", base::wordOf(event), level), fmt::format("{}", number)};
        load(run, options, planned, number);
        run.expectedEnd = expectedEnd(planned, run.scene.run.duration);
        planned.runs.push_back(plan.sweep.runs.size());
        plan.sweep.runs.push_back(std::move(run));
      }
      plan.trials.push_back(std::move(planned));
    }
  }
  if (plan.sweep.runs.empty())
    throw InputError(fmt::format("{} {}: {}", options.onlyOption, base::wordOf(plan.omitted.begin()->first),
                                 plan.omitted.begin()->second));
  plan.sweep.scene = plan.sweep.runs.front().file;
  return plan;
}

} // namespace grouser::events
