// SPDX-License-Identifier: BSD-3-Clause
#include "runs/campaigns/events/event_table.hpp"

#include "base/error.hpp"
#include "base/math.hpp"
#include "runs/campaigns/events/soil_limits.hpp"
#include "runs/campaigns/sweeps/overrides.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace grouser::events {

namespace {

constexpr double kWay = 5;      // m, distance to drive at half the commanded speed or more
constexpr double kEnd = 0.3;    // m, between the vehicle and the end of the terrain
constexpr double kRunUp = 3;    // m, run-up on slopes: acceleration is slow near the limit
constexpr double kCrawl = 0.4;  // speed over steps, gaps and ditches: share of the commanded speed, and minimum in m/s
constexpr double kBeyond = 0.3; // m, space beyond the end of the course, or for lateral drift
constexpr double kSwerve = 0.2; // width beside a course without grains / its length: obstacles turn vehicles
constexpr double kReferenceRun = 1.7832; // m, contact length of the light vehicle; obstacles scale with it
constexpr double kDitchWidth = 0.16, kDitchMiddle = 0.6; // fractions of the length of ditch.png
constexpr double kSettled = 2;                           // s, time after which every vehicle has settled and drives

double crawl(const Course& c) { return std::max(kCrawl * c.speed, kCrawl); }

double scaleOf(const Course& c) { return c.shape.groundRun() / kReferenceRun; }

/// Rounds to two digits, for readable levels and folder names.
double rounded(double value) {
  const double unit = std::pow(10.0, std::floor(std::log10(std::fabs(value))) - 1);
  return std::round(value / unit) * unit;
}

/// Rounds to three decimals, for levels close to a limit.
double finely(double value) { return std::round(value * 1000) / 1000; }

std::string set(const std::string& key, double value) { return fmt::format("{}={:.6g}", key, value); }
std::string set(const std::string& key, std::initializer_list<double> values) {
  std::vector<std::string> words;
  for (const double v : values) words.push_back(fmt::format("{:.6g}", v));
  return fmt::format("{}=[{}]", key, fmt::join(words, ", "));
}

/// Width of the ground beside the tracks [m]; small for granular beds to save run time.
double sideRoom(const Course& c, double distance) {
  return c.granular() ? std::max(c.margin, kEnd) : kSwerve * distance;
}

/// Straight course: initial position of the vehicle, size of the ground.
struct Straight {
  double start = 0;    ///< x of the sprockets' axle [m]
  double obstacle = 0; ///< x where an obstacle begins [m]
  double length = 0, width = 0;
};

/// `behind`: space for sliding back. `obstacle`: obstacle length, or 0. `runUp`: distance before the measured distance.
Straight straight(const Course& c, Trial& trial, double behind, double obstacle, double drift, double runUp = 0) {
  const double approach = 0.4 * scaleOf(c);
  Straight s;
  s.start = kEnd + behind + c.shape.rear;
  s.obstacle = s.start + c.shape.front + approach;
  trial.distance = obstacle > 0 ? std::max(kWay, approach + c.shape.length() + obstacle) : kWay + runUp;
  s.length = s.start + c.shape.front + trial.distance + 2 * kEnd;
  s.width = 2 * (c.shape.halfWidth + sideRoom(c, trial.distance) + drift);
  const double soft = c.granular() ? c.margin : 0; // the vehicle pushes grains ahead
  s.length += soft;
  trial.overrides.push_back(set("terrain.size", {s.length, s.width}));
  trial.overrides.push_back(set("vehicle.position", {s.start, 0.0}));
  trial.overrides.push_back(set("stop.distance", trial.distance + kBeyond));
  return s;
}

void drive(const Course& c, Trial& trial, double speed) {
  trial.speed = speed;
  trial.overrides.push_back(set("driver.sprocket_speed", speed / c.shape.pitchRadius));
}

/// Gravity for a slope of this tangent.
std::string leaning(const Course& c, double slope, bool sideways) {
  const double g = c.shape.gravity, along = g * slope / std::sqrt(1 + slope * slope),
               down = g / std::sqrt(1 + slope * slope);
  return sideways ? set("run.gravity", {0.0, -along, -down}) : set("run.gravity", {-along, 0.0, -down});
}

/// Box from x to `end` over the whole width, with its top at `top`. The box extends through the whole depth of a bed,
/// and one pad width into deformable soil.
void box(const Course& c, Trial& trial, int number, double x, double end, double width, double top) {
  const double foot = c.rigid() ? 0.0 : c.granular() ? -c.depth : -c.shape.padWidth;
  const std::string key = fmt::format("box.{}.", number);
  trial.overrides.push_back(set(key + "position", {0.5 * (x + end), 0.0, 0.5 * (top + foot)}));
  trial.overrides.push_back(set(key + "size", {end - x, width, top - foot}));
  // Obstacles in the bed touch grains, which requires the same contact law.
  if (c.granular()) trial.overrides.push_back(key + "material=" + c.soil);
}

/// Raises the overlap limit to that of grains below parts, because a coarse grain between track and obstacle edge can
/// support a large part of the vehicle's weight.
void allowDeepOverlap(const Course& c, Trial& trial) {
  if (c.granular()) trial.overrides.push_back(set("run.max_overlap", 1.0));
}

/// A ditch shaped as one period of a cosine, with `level` as steepest slope. The course behind the ditch determines the
/// length of the height-map.
void ditch(const Course& c, Trial& trial, double level) {
  const double approach = 0.4 * scaleOf(c), ends = 2 * kEnd + c.margin;
  const double before = kDitchMiddle - 0.5 * kDitchWidth,
               behind = 1 - before; // share of the length at which the ditch starts
  const double length = std::max({(approach + c.shape.length() + kEnd) / before, (kWay + ends - approach) / behind,
                                  (c.shape.length() + ends) / (behind - kDitchWidth)});
  const double wide = kDitchWidth * length;
  trial.distance = std::max(kWay, approach + wide + c.shape.length());
  trial.overrides = {set("terrain.size", {length, 2 * (c.shape.halfWidth + sideRoom(c, trial.distance))}),
                     set("vehicle.position", {before * length - approach - c.shape.front, 0.0}),
                     set("stop.distance", trial.distance + kBeyond),
                     set("terrain.height_range", {-level * wide / base::kPi, 0.0})};
}

void pivot(const Course& c, Trial& trial) {
  const double omega = c.speed / c.shape.pitchRadius;
  const double reach = std::hypot(std::max(c.shape.front - c.shape.massCentre.x, c.shape.rear + c.shape.massCentre.x),
                                  c.shape.halfWidth);
  const double side = 2 * (1.3 * reach + c.margin);
  trial.angle = base::kPi, trial.rate = 2 * c.speed / c.shape.tread, trial.timed = true;
  trial.overrides = {set("terrain.size", {side, side}),
                     set("vehicle.position", {0.5 * side - c.shape.massCentre.x, 0.0}), set("driver.left", -omega),
                     set("driver.right", omega), set("run.duration", kSettled + 2 * trial.angle / trial.rate)};
}

/// Distance of the sprocket axle from its start, at which stop.distance ends a run on a circle [m]: behind the course
/// for every radius near the commanded one. The point that follows the circle is ahead of the sprocket axle, so the
/// axle moves on a larger circle. Empty if the distance no longer increases at that point of the circle.
std::optional<double> chordBehind(const Course& c, double radius, double path) {
  const auto axle = [&c](double r) { return std::hypot(r, c.shape.controlled.x); };
  double chord = 0;
  for (const double share : {0.9, 1.0, 1.1, 1.2}) {
    const double angle = path / (share * radius);
    if (angle > base::kPi) return {};
    chord = std::max(chord, 2 * axle(share * radius) * std::sin(0.5 * angle));
  }
  constexpr double kRising = 0.95; // share of the diameter
  return chord < kRising * 2 * axle(0.9 * radius) ? std::optional(chord) : std::nullopt;
}

/// `slack`: duration of the drive / duration at full speed.
void circle(const Course& c, Trial& trial, double radius, double slack) {
  const double path = 1.2 * kWay;
  const std::optional<double> chord = chordBehind(c, radius, path + kBeyond);
  trial.distance = path, trial.speed = c.speed, trial.radius = radius, trial.timed = !chord;
  const double reach = c.shape.halfWidth + c.margin + 2 * kEnd, middle = c.shape.controlled.x;
  if (chord) {
    const double angle = std::min((path + kBeyond) / radius, base::kPi), start = kEnd + c.shape.rear;
    const double ahead = radius * std::sin(std::min(angle, base::kPi / 2)), left = radius * (1 - std::cos(angle));
    const double half = left + c.shape.length() + reach; // margin for a vehicle that turns sideways
    trial.overrides = {set("terrain.size", {start + c.shape.massCentre.x + ahead + c.shape.length() + reach, 2 * half}),
                       set("vehicle.position", {start, 0.0}), set("stop.distance", *chord)};
  } else { // several turns about the middle of the ground
    const double half = 1.2 * radius + std::max(c.shape.front - middle, c.shape.rear + middle) + reach;
    trial.overrides = {set("terrain.size", {2 * half, 2 * half}), set("vehicle.position", {half - middle, -radius}),
                       "~stop.distance"};
  }
  for (const std::string& more : {set("driver.course.speed", c.speed), set("driver.course.radius", radius),
                                  set("run.duration", kSettled + slack * path / c.speed)})
    trial.overrides.push_back(more);
}

} // namespace

Event eventOf(const std::string& word) {
  if (const auto event = base::valueOf<Event>(word)) return *event;
  throw base::InputError(
      fmt::format("--only {}: unknown event; events: {}", word, fmt::join(base::wordsOf<Event>(), ", ")));
}

std::vector<Event> allEvents() {
  std::vector<Event> events;
  for (const auto& e : base::EnumWords<Event>::list) events.push_back(e.value);
  return events;
}

std::string levelText(Event event) {
  switch (event) {
  case Event::grade:
  case Event::sideSlope:
    return "tan of the slope [-]";
  case Event::steadyTurn:
  case Event::turningRadius:
    return "radius of the circle [m]";
  case Event::step:
    return "height of the step [m]";
  case Event::gap:
    return "width of the gap [m]";
  case Event::ditch:
    return "steepest slope of the ditch [-]";
  case Event::halfRound:
    return "radius of the half-round [m]";
  case Event::drawbar:
    return "slip [-]";
  case Event::softSoil:
    return "share of the soil's friction coefficients [-]";
  case Event::acceleration:
  case Event::pivotTurn:
  case Event::motionResistance:
    break;
  }
  return "";
}

bool isCircle(Event event) { return event == Event::steadyTurn || event == Event::turningRadius; }

bool isHarderBelow(Event event) { return event == Event::softSoil || isCircle(event); }

std::string titleOf(Event event) {
  switch (event) {
  case Event::acceleration:
    return "acceleration to full speed";
  case Event::grade:
    return "up a slope, from rest";
  case Event::sideSlope:
    return "along a side slope";
  case Event::pivotTurn:
    return "a turn on the spot";
  case Event::steadyTurn:
    return "a circle at constant speed";
  case Event::turningRadius:
    return "the smallest circle at constant speed";
  case Event::step:
    return "up a step";
  case Event::gap:
    return "across a gap between slabs";
  case Event::ditch:
    return "through a ditch";
  case Event::halfRound:
    return "over a half-round";
  case Event::drawbar:
    return "drawbar pull at imposed slip";
  case Event::motionResistance:
    return "straight on at constant speed";
  case Event::softSoil:
    return "straight on over soil of decreasing strength";
  }
  return "";
}

std::string omission(Event event, const Course& course) {
  if (event == Event::softSoil && course.rigid()) return "rigid ground has no strength to vary; set --soil";
  if (event == Event::gap && !course.rigid())
    return "a gap between slabs does not depend on the soil; use --soil rigid";
  return "";
}

std::vector<double> levelsOf(Event event, const Course& c, bool quick) {
  if (!omission(event, c).empty()) return {};
  using Levels = std::vector<double>;
  const double scale = scaleOf(c), mu = c.shape.friction, high = c.shape.highestStep;
  const GapBounds gap = gapBounds(c.shape);
  const auto all = [quick](const Levels& whole, const Levels& few) { return quick ? few : whole; };
  switch (event) {
  case Event::grade:
    return c.rigid() ? Levels{finely(0.5 * mu), finely(0.98 * mu), finely(1.02 * mu)}
                     : all({0.1, 0.2, 0.3, 0.4, 0.5}, {0.2, 0.4});
  case Event::sideSlope: {
    const double limit = std::min(mu, tippingSlope(c.shape));
    return c.rigid() ? Levels{finely(0.5 * limit), finely(0.95 * limit), finely(1.05 * limit)}
                     : all({0.1, 0.3, 0.5}, {0.3});
  }
  case Event::steadyTurn:
    return {rounded(8 * scale)};
  case Event::turningRadius: {
    const double tread = c.shape.tread;
    return all({rounded(2 * tread), rounded(tread), rounded(0.5 * tread), rounded(0.25 * tread)},
               {rounded(tread), rounded(0.5 * tread)});
  }
  case Event::step:
    return c.rigid() ? Levels{rounded(0.5 * high), rounded(0.8 * high), rounded(1.05 * high)}
                     : all({rounded(0.3 * high), rounded(0.5 * high), rounded(0.7 * high)}, {rounded(0.5 * high)});
  case Event::gap:
    return {finely(0.95 * gap.sure), finely(0.5 * (gap.sure + gap.level)), finely(1.05 * gap.level),
            finely(1.5 * gap.level)};
  case Event::ditch:
    return c.rigid() ? Levels{0.3, 0.6, 0.9} : all({0.2, 0.3, 0.4}, {0.3});
  case Event::halfRound:
    return c.rigid() ? Levels{rounded(0.1 * scale), rounded(0.2 * scale), rounded(0.3 * scale)}
                     : all({rounded(0.1 * scale), rounded(0.2 * scale)}, {rounded(0.15 * scale)});
  case Event::drawbar:
    return c.rigid() ? Levels{0.05, 0.2, 0.5} : all({0.05, 0.1, 0.2, 0.3, 0.5, 0.7}, {0.1, 0.2, 0.4});
  case Event::softSoil:
    return all({0.2, 0.4, 0.6, 0.8, 1.0}, {0.4, 1.0});
  case Event::acceleration:
  case Event::pivotTurn:
  case Event::motionResistance:
    break;
  }
  return {0.0};
}

Trial trialOf(Event event, double level, const Course& c) {
  Trial trial;
  const double scale = scaleOf(c);
  switch (event) {
  case Event::acceleration: {
    straight(c, trial, 0, 0, 0);
    drive(c, trial, 2 * c.speed);
    return trial;
  }
  case Event::grade:
    straight(c, trial, c.shape.length(), 0, 0, kRunUp);
    trial.overrides.push_back(leaning(c, level, false));
    break;
  case Event::sideSlope:
    straight(c, trial, 0, 0, c.shape.tread);
    trial.overrides.push_back(leaning(c, level, true));
    break;
  case Event::pivotTurn:
    pivot(c, trial);
    return trial;
  case Event::steadyTurn:
    circle(c, trial, level, 2);
    return trial;
  case Event::turningRadius:
    circle(c, trial, level, 1.5);
    trial.rate = c.speed / level;
    return trial;
  case Event::step: {
    const Straight s = straight(c, trial, 0, 0.3 * scale, 0);
    box(c, trial, 0, s.obstacle, s.length, s.width, level);
    allowDeepOverlap(c, trial);
    break;
  }
  case Event::gap: {
    const Straight s = straight(c, trial, 0, level, 0);
    const double depth = scale; // gap depth
    box(c, trial, 0, 0, s.obstacle, s.width, depth);
    box(c, trial, 1, s.obstacle + level, s.length, s.width, depth);
    break;
  }
  case Event::ditch:
    ditch(c, trial, level);
    break;
  case Event::halfRound: {
    const Straight s = straight(c, trial, 0, 2 * level, 0);
    trial.overrides.push_back(set("cylinder.0.position", {s.obstacle + level, 0.0, 0.0}));
    trial.overrides.push_back(set("cylinder.0.radius", level));
    trial.overrides.push_back(set("cylinder.0.length", s.width));
    if (c.granular()) trial.overrides.push_back("cylinder.0.material=" + c.soil);
    allowDeepOverlap(c, trial);
    break;
  }
  case Event::drawbar:
    straight(c, trial, 0, 0, 0);
    trial.distance = 2 * c.shape.groundRun(); // the means cover the second half
    sweeps::putOverride(trial.overrides, set("stop.distance", trial.distance));
    trial.slip = level;
    trial.overrides.push_back(set("hitch.slip", level));
    break;
  case Event::motionResistance:
    straight(c, trial, 0, 0, 0);
    break;
  case Event::softSoil:
    straight(c, trial, 0, 0, 0);
    if (c.deformable()) {
      trial.overrides.push_back(set(kPhi, std::atan(level * c.constants.friction) * 180 / base::kPi));
      break;
    }
    trial.overrides.push_back(set("material." + c.soil + ".friction", level * c.soilFriction));
    trial.overrides.push_back(set("material." + c.soil + ".rolling_friction", level * c.rollingFriction));
    break;
  }
  const bool crawls = event == Event::step || event == Event::gap || event == Event::ditch;
  drive(c, trial, crawls ? crawl(c) : c.speed);
  return trial;
}

namespace {

std::optional<Reference> soilReference(Event event, const Course& c) {
  if (event != Event::grade && event != Event::sideSlope) return {};
  const double holds = holdingSlope(c.shape, c.constants), tipping = tippingSlope(c.shape);
  if (event == Event::sideSlope && tipping < holds)
    return Reference{fmt::format("none above {:.3g}: tips over", tipping), {}, tipping};
  if (!std::isfinite(holds)) return {};
  return Reference{fmt::format("none above {:.3g}: W sin a = c A + W cos a tan phi", holds), {}, holds};
}

} // namespace

std::optional<Reference> referenceOf(Event event, const Course& c) {
  if (c.deformable()) return soilReference(event, c);
  if (!c.rigid()) return {};
  const double mu = c.shape.friction, tipping = tippingSlope(c.shape);
  switch (event) {
  case Event::grade:
    return Reference{fmt::format("friction {:g}", mu), mu, mu};
  case Event::sideSlope:
    return mu < tipping ? Reference{fmt::format("friction {:g}; tips at {:.3g}", mu, tipping), mu, mu}
                        : Reference{fmt::format("tips at {:.4g}", tipping), tipping, tipping};
  case Event::step: {
    const double high = c.shape.highestStep + crawl(c) * crawl(c) / (2 * c.shape.gravity);
    return Reference{
        fmt::format("none above {:.3g} m: centre of mass over the edge, suspension arms free", high), {}, high};
  }
  case Event::gap: {
    const GapBounds g = gapBounds(c.shape);
    return Reference{
        fmt::format("all up to {:.3g} m (wheels), above {:.3g} m by friction at the far wall, none above {:.3g} m",
                    g.sure, g.level, g.never),
        g.sure, g.never};
  }
  case Event::ditch:
    return Reference{fmt::format("all up to friction {:g}", mu), mu, {}};
  case Event::turningRadius: {
    // The lateral acceleration of a go: radius and turn rate are at least 0.9 of the commanded ones.
    const GoRule rule;
    const double least = rule.turn * rule.turn * (1 - rule.radius) * c.speed * c.speed / (mu * c.shape.gravity);
    return Reference{fmt::format("none below {:.3g} m: lateral acceleration mu g", least), {}, least};
  }
  case Event::acceleration:
  case Event::pivotTurn:
  case Event::steadyTurn:
  case Event::halfRound:
  case Event::drawbar:
  case Event::motionResistance:
  case Event::softSoil:
    break;
  }
  return {};
}

} // namespace grouser::events
