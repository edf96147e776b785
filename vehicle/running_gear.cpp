// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle/running_gear.hpp"

#include "base/math.hpp"
#include "vehicle/consistent_gear.hpp"
#include "vehicle/wrap.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fmt/format.h>
#include <functional>
#include <utility>
#include <vector>

namespace grouser::vehicle {
namespace {

using base::kPi;

/// Tolerated initial overlap of a wheel and a plate [m]; it causes about 1 kN for the default vehicle's widest roller
/// at 1e10 N/m3.
constexpr double kTouch = 1e-4;
constexpr double kGravity = 9.80665; // [m/s2]

double distance(double x0, double z0, double x1, double z1) {
  return std::sqrt((x1 - x0) * (x1 - x0) + (z1 - z0) * (z1 - z0));
}

/// Key that may be changed to fix a fault.
struct Knob {
  std::string section, key, unit;
  std::string name; ///< in advice: "roller.z[1]"
  double value{}, step{};
  std::function<void(VehicleSpec&, double)> set;
};

struct Fault {
  std::vector<Knob> knobs; ///< the message names the first key
  std::string what;
  std::string advice; ///< remedy, if no value of a key fixes the fault
  bool closure = false;
};

/// Key of a numeric value; a length unless `unit` differs.
Knob knob(const std::string& section, const std::string& key, double value, double step,
          std::function<void(VehicleSpec&, double)> set, const std::string& unit = "m") {
  return {section, key, unit, section + "." + key, value, step, std::move(set)};
}
/// Key with textual advice only.
Knob named(const std::string& section, const std::string& key, const std::string& unit) {
  return knob(section, key, 0, 0, {}, unit);
}

Knob spacing(const VehicleSpec& s) {
  return knob("road_wheel", "spacing", s.roadWheel.spacing, 0.005,
              [](VehicleSpec& v, double x) { v.roadWheel.spacing = x; });
}
Knob firstX(const VehicleSpec& s) {
  return knob("road_wheel", "first_x", s.roadWheel.firstX, 0.005,
              [](VehicleSpec& v, double x) { v.roadWheel.firstX = x; });
}
Knob wheelZ(const VehicleSpec& s) {
  return knob("road_wheel", "z", s.roadWheel.z, 0.005, [](VehicleSpec& v, double z) { v.roadWheel.z = z; });
}
Knob wheelCount(const VehicleSpec& s) {
  return knob(
      "road_wheel", "count", s.roadWheel.count, 1,
      [](VehicleSpec& v, double n) { v.roadWheel.count = static_cast<int>(n); }, "-");
}
Knob wheelRadius(const VehicleSpec& s) {
  return knob("road_wheel", "radius", s.roadWheel.radius, 0.005,
              [](VehicleSpec& v, double r) { v.roadWheel.radius = r; });
}
Knob teeth(const VehicleSpec& s) {
  return knob(
      "sprocket", "teeth", s.sprocket.teeth, 1,
      [](VehicleSpec& v, double n) { v.sprocket.teeth = static_cast<int>(n); }, "-");
}
Knob idlerX(const VehicleSpec& s) {
  return knob("idler", "x", s.idler.x, 0.005, [](VehicleSpec& v, double x) { v.idler.x = x; });
}
Knob idlerRadius(const VehicleSpec& s) {
  return knob("idler", "radius", s.idler.radius, 0.005, [](VehicleSpec& v, double r) { v.idler.radius = r; });
}
Knob idlerZ(const VehicleSpec& s) {
  return knob("idler", "z", s.idler.z, 0.005, [](VehicleSpec& v, double z) { v.idler.z = z; });
}
Knob pitch(const VehicleSpec& s) {
  return knob("shoe", "pitch", s.shoe.pitch, 0.001, [](VehicleSpec& v, double p) { v.shoe.pitch = p; });
}
Knob plateTop(const VehicleSpec& s) {
  return knob("shoe", "plate_top", s.shoe.plateTop, 0.001, [](VehicleSpec& v, double z) { v.shoe.plateTop = z; });
}
Knob rollerRadius(const VehicleSpec& s) {
  return knob("roller", "radius", s.roller.radius, 0.005, [](VehicleSpec& v, double r) { v.roller.radius = r; });
}
Knob slideMin(const VehicleSpec& s) {
  return knob("idler", "slide_min", s.idler.slideMin, 0.005, [](VehicleSpec& v, double x) { v.idler.slideMin = x; });
}
Knob ofRoller(const VehicleSpec& s, const char* key, std::size_t i) {
  const bool isX = key[0] == 'x';
  Knob k = knob("roller", key, isX ? s.roller.x[i] : s.roller.z[i], isX ? 0.005 : 0.001,
                [isX, i](VehicleSpec& v, double p) { (isX ? v.roller.x : v.roller.z)[i] = p; });
  k.name += fmt::format("[{}]", i);
  return k;
}

/// Key for the common height of all rollers.
Knob rollersZ(const VehicleSpec& s) {
  Knob k = knob("roller", "z", s.roller.z.empty() ? 0 : s.roller.z.front(), 0.001,
                [](VehicleSpec& v, double z) { std::fill(v.roller.z.begin(), v.roller.z.end(), z); });
  k.name = "every entry of roller.z";
  return k;
}
Knob maximumFold(const VehicleSpec& s) {
  return knob(
      "shoe", "maximum_fold", s.shoe.maximumFold, 0.01, [](VehicleSpec& v, double a) { v.shoe.maximumFold = a; },
      "rad");
}

/// Wheel in the track plane.
struct Wheel {
  enum class Kind { sprocket, idler, road, roller } kind;
  std::size_t number;
  double x, z, radius;

  std::string name() const {
    switch (kind) {
    case Kind::sprocket:
      return "sprocket";
    case Kind::idler:
      return "idler";
    case Kind::road:
      return fmt::format("road wheel {}", number);
    case Kind::roller:
      return fmt::format("roller {}", number);
    }
    return "";
  }
};

/// `idler`: x of its axle [m]. The radius of the sprocket is the radius of the engaged pins; the teeth extend further.
std::vector<Wheel> wheelsOf(const VehicleSpec& s, double idler) {
  using Kind = Wheel::Kind;
  std::vector<Wheel> all{{Kind::sprocket, 0, 0, 0, s.sprocketPinRadius()},
                         {Kind::idler, 0, idler, s.idler.z, s.idler.radius}};
  for (int i = 0; i < s.roadWheel.count; ++i)
    all.push_back({Kind::road, static_cast<std::size_t>(i), s.roadWheel.firstX + i * s.roadWheel.spacing, s.roadWheel.z,
                   s.roadWheel.radius});
  for (std::size_t i = 0; i < s.roller.x.size(); ++i)
    all.push_back({Kind::roller, i, s.roller.x[i], s.roller.z[i], s.roller.radius});
  return all;
}

/// Keys that may be changed if two wheels overlap; `a` comes before `b` in wheelsOf().
std::vector<Knob> knobsOf(const VehicleSpec& s, const Wheel& a, const Wheel& b) {
  using Kind = Wheel::Kind;
  if (b.kind == Kind::roller && a.kind == Kind::road)
    return {ofRoller(s, "z", b.number), rollersZ(s), rollerRadius(s), wheelZ(s), wheelRadius(s),
            ofRoller(s, "x", b.number)};
  if (b.kind == Kind::roller)
    return {ofRoller(s, "x", b.number), rollerRadius(s), ofRoller(s, "z", b.number), idlerX(s)};
  if (a.kind == Kind::road) return {spacing(s), wheelCount(s), wheelRadius(s)};
  if (a.kind == Kind::sprocket && b.kind == Kind::road) return {firstX(s), wheelRadius(s), teeth(s), wheelZ(s)};
  if (a.kind == Kind::sprocket) return {idlerX(s), idlerRadius(s), teeth(s)};

  return {spacing(s), firstX(s),      slideMin(s),    wheelCount(s),
          idlerX(s),  wheelRadius(s), idlerRadius(s), idlerZ(s)}; // idler and road wheel
}

std::optional<Fault> overlapOfWheels(const VehicleSpec& s, double idler, const char* where) {
  const std::vector<Wheel> all = wheelsOf(s, idler);
  for (std::size_t i = 0; i < all.size(); ++i)
    for (std::size_t j = i + 1; j < all.size(); ++j) {
      const Wheel &a = all[i], &b = all[j];
      const double overlap = a.radius + b.radius - distance(a.x, a.z, b.x, b.z);
      if (overlap >= 0)
        return Fault{knobsOf(s, a, b),
                     fmt::format("makes {} and {} overlap by {:.1f} mm{}", a.name(), b.name(), 1e3 * overlap, where),
                     ""};
    }
  return {};
}

/// Inward fold angle at which the plates of neighbouring shoes touch [rad].
double plateFold(const ShoeSpec& shoe) {
  return shoe.plateTop > 0 ? 2 * base::atan2(0.5 * shoe.pitch - shoe.halfLength, shoe.plateTop) : kPi;
}

/// Checks for overlap between shoes, in line and folded about a wheel, and between the two tracks.
std::optional<Fault> shoeFault(const VehicleSpec& s) {
  if (const double overlap = s.shoe.padHalfWidth - s.trackOffset; overlap >= 0)
    return Fault{
        {knob("vehicle", "track_offset", s.trackOffset, 0.01, [](VehicleSpec& v, double y) { v.trackOffset = y; })},
        fmt::format("makes left and right shoes overlap by {:.1f} mm", 2e3 * overlap),
        ""};
  const Knob half =
      knob("shoe", "half_length", s.shoe.halfLength, 0.001, [](VehicleSpec& v, double x) { v.shoe.halfLength = x; });
  if (const double overlap = 2 * s.shoe.halfLength - s.shoe.pitch; overlap >= 0)
    return Fault{{half, pitch(s)},
                 fmt::format("makes the plates and pads of neighbouring shoes overlap by {:.1f} mm; shoe.half_length "
                             "must be in (0, {:g})",
                             1e3 * overlap, 0.5 * s.shoe.pitch),
                 ""};
  const double fold = plateFold(s.shoe);
  if (s.shoe.maximumFold > fold)
    return Fault{
        {maximumFold(s), half, plateTop(s), pitch(s)},
        fmt::format("lets the plates of neighbouring shoes touch at {:.4f} rad, below shoe.maximum_fold", fold),
        ""};
  if (const double step = 2 * kPi / s.sprocket.teeth; step > s.shoe.maximumFold)
    return Fault{{teeth(s), maximumFold(s)},
                 fmt::format("folds neighbouring shoes by {:.4f} rad, more than shoe.maximum_fold = {:g}; at least "
                             "{:.0f} teeth are required",
                             step, s.shoe.maximumFold, std::ceil(2 * kPi / s.shoe.maximumFold)),
                 ""};
  if (const double step = 2 * base::asin(0.5 * s.shoe.pitch / s.idlerPinRadius()); step > s.shoe.maximumFold)
    return Fault{{idlerRadius(s), pitch(s), maximumFold(s)},
                 fmt::format("folds neighbouring shoes by {:.4f} rad, more than shoe.maximum_fold = {:g}", step,
                             s.shoe.maximumFold),
                 ""};
  const double least = s.smallestWheel();
  if (const double overlap = s.shoe.hornHeight - least; overlap >= 0)
    return Fault{{knob("shoe", "horn_height", s.shoe.hornHeight, 0.001,
                       [](VehicleSpec& v, double h) { v.shoe.hornHeight = h; })},
                 fmt::format("lets horns reach {:.1f} mm beyond the axles of the smallest wheels; it must be in "
                             "(0, {:g})",
                             1e3 * overlap, least),
                 ""};
  return {};
}

/// Checks that the shoes under the road wheels are the lowest of the track.
std::optional<Fault> groundLineFault(const VehicleSpec& s) {
  const double ground = s.groundPinHeight();
  const auto above = [&](const char* name, double pins, const Knob& other, const Knob& another) {
    return Fault{
        {wheelZ(s), other, another, wheelRadius(s)},
        fmt::format("puts the pins in ground contact at z = {:.4f} m, {:.1f} mm above the lowest pins on the {}",
                    ground, 1e3 * (ground - pins), name),
        ""};
  };
  if (ground >= -s.sprocketPinRadius()) return above("sprocket", -s.sprocketPinRadius(), teeth(s), pitch(s));
  if (ground >= s.idler.z - s.idlerPinRadius())
    return above("idler", s.idler.z - s.idlerPinRadius(), idlerZ(s), idlerRadius(s));
  const double pivot = s.roadWheel.z + s.arm.length * base::sin(s.arm.pivotAngle);
  if (const double under = ground + s.shoe.plateTop - pivot; under >= 0)
    return Fault{{knob(
                     "arm", "pivot_angle", s.arm.pivotAngle, 0.05,
                     [](VehicleSpec& v, double a) { v.arm.pivotAngle = a; }, "rad")},
                 fmt::format("puts the arm pivots {:.1f} mm below the plates in ground contact", 1e3 * under),
                 ""};
  return {};
}

/// Gap between a wheel and the plates of a shoe [m]; negative if they overlap.
double gapToShoe(const VehicleSpec& s, const Wrap& wrap, int shoe, const Wheel& wheel) {
  const PlanePoint c = wrap.shoeCentre(shoe);
  const double angle = wrap.shoeAngle(shoe), ax = base::cos(angle), az = base::sin(angle);
  const double u = (wheel.x - c.x) * ax + (wheel.z - c.z) * az, w = -(wheel.x - c.x) * az + (wheel.z - c.z) * ax;
  const double du = std::max(std::fabs(u) - s.shoe.halfLength, 0.0);
  const double dw = std::max({w - s.shoe.plateTop, s.shoe.padBottom - w, 0.0});
  if (du > 0 || dw > 0) return std::sqrt(du * du + dw * dw) - wheel.radius;
  return -wheel.radius - std::min(s.shoe.plateTop - w, w - s.shoe.padBottom);
}

bool insideLoop(const Wrap& wrap, double x, double z) {
  bool inside = false;
  for (std::size_t i = 0; i < wrap.pins.size(); ++i) {
    const PlanePoint a = wrap.pins[i], b = wrap.pins[(i + 1) % wrap.pins.size()];
    if ((a.z > z) != (b.z > z) && x < a.x + (z - a.z) / (b.z - a.z) * (b.x - a.x)) inside = !inside;
  }
  return inside;
}

/// Checks for overlap between the wheels and the shoes of the closed loop.
std::optional<Fault> loopFault(const VehicleSpec& s, const Wrap& wrap) {
  using Kind = Wheel::Kind;
  if (auto fault = overlapOfWheels(s, wrap.idlerX + s.outward() * s.idler.slideMin,
                                   s.sprocketInFront() ? " at the idler's front stop" : " at the idler's rear stop"))
    return fault;
  for (const Wheel& wheel : wheelsOf(s, wrap.idlerX)) {
    if (wheel.kind == Kind::sprocket) continue; // it touches only the pin bosses
    const std::vector<Knob> knobs =
        wheel.kind == Kind::roller
            ? std::vector{ofRoller(s, "z", wheel.number), rollerRadius(s), ofRoller(s, "x", wheel.number)}
        : wheel.kind == Kind::road ? std::vector{firstX(s), spacing(s), wheelRadius(s), wheelZ(s)}
                                   : std::vector{idlerX(s), idlerRadius(s)};
    if (!insideLoop(wrap, wheel.x, wheel.z))
      return Fault{knobs, fmt::format("puts the axle of {} outside the track loop", wheel.name()), ""};
    for (int i = 0; i < s.shoe.count; ++i)
      if (const double overlap = -gapToShoe(s, wrap, i, wheel); overlap > kTouch)
        return Fault{knobs, fmt::format("makes {} and shoe {} overlap by {:.1f} mm", wheel.name(), i, 1e3 * overlap),
                     ""};
  }
  return {};
}

/// Checks the suspension and the centre of mass.
std::optional<Fault> suspensionFault(const VehicleSpec& s) {
  const double last = s.lastWheelX();
  const Vec3d c = s.chassis.centre;
  const Fault tips{{named("chassis", "centre", "m")}, "", ""};
  if (c.x <= s.roadWheel.firstX || c.x >= last) {
    Fault f = tips;
    const double beyond = c.x >= last ? c.x - last : s.roadWheel.firstX - c.x;
    f.what = fmt::format("lies {:.1f} mm {} all road wheels, so that the vehicle tips over", 1e3 * beyond,
                         c.x >= last ? "ahead of" : "behind");
    f.advice = fmt::format("choose its x in ({:.4f}, {:.4f})", s.roadWheel.firstX, last);
    return f;
  }
  if (const double beside = std::fabs(c.y) - s.trackOffset; beside >= 0) {
    Fault f = tips;
    f.what = fmt::format("lies {:.1f} mm outside the tracks, so the vehicle would tip over", 1e3 * beside);
    f.advice = fmt::format("choose its y in ({:g}, {:g})", -s.trackOffset, s.trackOffset);
    return f;
  }
  if (s.arm.suspension == Suspension::rigid) return {};
  const double load = s.totalMass() * kGravity / (2 * s.roadWheel.count); // on a wheel [N]
  const double lever = s.arm.length * base::cos(s.arm.pivotAngle);
  const double turn = (load - s.arm.preload) * lever; // [N m] torque of the bar beyond its preload
  constexpr double kMaxTurn = 0.5;                    // [rad] largest accepted arm rotation
  if (std::fabs(turn) <= kMaxTurn * s.arm.stiffness && s.arm.stiffness > 0) return {};
  const bool soft = load * lever > kMaxTurn * s.arm.stiffness;
  Fault f;
  if (soft) {
    f.knobs = {named("arm", "stiffness", "N m/rad")};
    f.what = fmt::format(
        "lets the hull sink by {:.0f} mm on its arms under {:.0f} N per wheel",
        s.arm.stiffness > 0 ? 1e3 * lever * std::min(1.0, std::fabs(turn) / s.arm.stiffness) : 1e3 * lever, load);
    f.advice = fmt::format("set arm.stiffness = {:.0f}", std::ceil(std::max(load, s.arm.preload) * lever / 0.15));
  } else {
    f.knobs = {named("arm", "preload", "N")};
    f.what = fmt::format("lifts the hull by {:.0f} mm on its arms at a wheel load of {:.0f} N",
                         1e3 * lever * std::min(1.0, std::fabs(turn) / s.arm.stiffness), load);
    f.advice = fmt::format("set arm.preload = {:.0f}", load);
  }
  return f;
}

/// Checks that the tensioner spring pushes the idler away from the sprocket, and that the idler is between its stops.
std::optional<Fault> tensionFault(const VehicleSpec& s) {
  const double weight = s.totalMass() * kGravity, tenth = std::floor(0.2 * weight);
  const Fault preload{{named("idler", "preload", "N")}, "", fmt::format("set idler.preload = {:.0f}", tenth)};
  if (s.idler.preload <= 0) {
    Fault f = preload;
    f.what = "leaves the track slack, so that the sprocket skips teeth; usual is 10 % of the weight in each strand";
    return f;
  }
  if (s.idler.preload > 2 * weight) {
    Fault f = preload;
    f.what = fmt::format("tensions each strand by more than the vehicle's weight of {:.0f} N; it must be in (0, "
                         "{:.0f}], usual is a tenth of the weight in each strand",
                         weight, 2 * weight);
    return f;
  }
  if (const double travel = s.idler.preload / s.idler.stiffness; travel > 0.5 * std::fabs(s.idler.x))
    return Fault{{named("idler", "stiffness", "N/m")},
                 fmt::format("requires a compression of {:.0f} mm for idler.preload = {:g} N, but the idler is only "
                             "{:.0f} mm from the sprocket",
                             1e3 * travel, s.idler.preload, 1e3 * std::fabs(s.idler.x)),
                 fmt::format("set idler.stiffness = {:.0f}", std::ceil(s.idler.preload / 0.03))};
  if (s.idler.stopStiffness < s.idler.stiffness)
    return Fault{{named("idler", "stop_stiffness", "N/m")},
                 fmt::format("is softer than the tensioner spring, idler.stiffness = {:g} N/m", s.idler.stiffness),
                 fmt::format("set idler.stop_stiffness = {:.3g}", 10 * s.idler.stiffness)};
  if (s.idler.slideMax <= 0)
    return Fault{{named("idler", "slide_max", "m")},
                 fmt::format("keeps the idler at its {} stop, where the spring cannot tension the track",
                             s.sprocketInFront() ? "rear" : "front"),
                 "set idler.slide_max = 0.025"};
  return {};
}

/// Checks the foundation modulus under the wheel loads: at an overlap d, the force on a strip of width w under
/// a wheel of radius R is 4/3 w sqrt(2 R) d^1.5 times the modulus.
std::optional<Fault> foundationFault(const VehicleSpec& s) {
  const double load = s.totalMass() * kGravity / (2 * s.roadWheel.count); // on a wheel [N]
  const double strip = 8.0 / 3 * s.shoe.padHalfWidth * std::sqrt(2 * s.roadWheel.radius);
  const double most = 0.1 * (s.shoe.plateTop - s.shoe.padBottom); // [m]
  const double least = load / (strip * most * std::sqrt(most));
  // On its whole pad, a shoe under a wheel yields by at most a tenth of the height of the pad below the pins.
  const double pad = load / (4 * s.shoe.halfLength * s.shoe.padHalfWidth * -0.1 * s.shoe.padBottom);
  if (s.contact.padModulus && *s.contact.padModulus < pad)
    return Fault{
        {named("contact", "pad_modulus", "N/m3")},
        fmt::format("is too soft: under {:.0f} N, the load of a road wheel, the pad of a shoe yields by more than "
                    "a tenth of its height of {:.0f} mm; at least {:.2e} is required",
                    load, -1e3 * s.shoe.padBottom, pad),
        fmt::format("set contact.pad_modulus = {:.1e}", 3 * pad)};
  if (s.contact.foundationModulus >= least) return {};
  return Fault{{named("contact", "foundation_modulus", "N/m3")},
               fmt::format("is too soft: road wheels sink into the shoes by more than a tenth of their {:.0f} mm "
                           "under {:.0f} N each; at least {:.2e} is required",
                           10e3 * most, load, least),
               fmt::format("set contact.foundation_modulus = {:.1e}", 10 * least)};
}

std::optional<Fault> firstFault(const VehicleSpec& s) {
  if (auto fault = shoeFault(s)) return fault;
  if (auto fault = overlapOfWheels(s, s.idler.x, "")) return fault;
  if (auto fault = groundLineFault(s)) return fault;
  if (auto fault = tensionFault(s)) return fault;
  const std::optional<Wrap> wrap = findWrap(s);
  if (!wrap) return Fault{{named("shoe", "count", "-")}, "", "", true};
  if (auto fault = loopFault(s, *wrap)) return fault;
  if (auto fault = suspensionFault(s)) return fault;
  return foundationFault(s);
}

/// Nearest value of a key without a fault, searched in fine, then coarse steps, as text ("0.385"); empty if none.
std::string mendingValue(const VehicleSpec& spec, const Knob& k) {
  constexpr int kCoarse = 80, kRatio = 10;
  const int fine = k.name == "idler.radius" ? 400 : 80; // loops close only in a narrow range of radii
  const double from = std::floor(k.value / k.step + 0.5) * k.step;
  for (int i = 0; i <= 2 * (fine + kCoarse); ++i) {
    const int n = (i + 1) / 2;
    const double away = (n <= fine ? n : fine + kRatio * (n - fine)) * k.step;
    const double value = from + (i % 2 == 1 ? -away : away);
    const bool place = k.key == "x" || k.key == "z" || k.key == "slide_min" || k.key == "pivot_angle";
    if (!place && value < 0.5 * k.step) continue; // lengths must stay positive
    // Test the value as it will be read from the file.
    std::string text = fmt::format("{:.6g}", std::floor(1e9 * value + 0.5) / 1e9);
    VehicleSpec other = spec;
    k.set(other, std::strtod(text.c_str(), nullptr));
    if (!firstFault(other)) return text;
  }
  return "";
}

/// Advice with a set of keys that together fix the fault; empty if no such set was found.
std::string combinedAdvice(const VehicleSpec& spec) {
  const std::string keys = consistentKeys(spec, [](const VehicleSpec& other) { return !firstFault(other); });
  return keys.empty() ? "" : "set together " + keys;
}

/// Alternative advice that preserves a requested number of wheels.
std::string adviceToKeep(const VehicleSpec& spec, const Knob& k) {
  const std::string keys = k.key == "count" ? combinedAdvice(spec) : "";
  return keys.empty() ? "" : fmt::format("; or, to keep {} = {:g}, {}", k.name, k.value, keys);
}

/// Adds the remedy to a fault, at the key to be changed.
SpecFault withAdvice(const VehicleSpec& spec, const Fault& fault) {
  const auto faultAt = [&fault](const Knob& k, const std::string& advice) {
    return SpecFault{k.section, k.key,
                     fmt::format("[{}]{} {}; {}", k.unit, fault.closure ? ":" : "", fault.what, advice)};
  };
  const Knob& first = fault.knobs.front();
  if (!fault.advice.empty()) return faultAt(first, fault.advice);
  std::string names;
  for (const Knob& k : fault.knobs) {
    if (const std::string value = mendingValue(spec, k); !value.empty())
      return faultAt(k, fmt::format("set {} = {}{}", k.name, value, adviceToKeep(spec, k)));
    names += (names.empty() ? "" : ", ") + k.name;
  }
  const std::string keys = combinedAdvice(spec);
  return faultAt(first,
                 fmt::format("no single change of {} removes the fault{}{}", names, keys.empty() ? "" : "; ", keys));
}

} // namespace

std::optional<SpecFault> runningGearFault(const VehicleSpec& spec) {
  std::optional<Fault> fault = firstFault(spec);
  if (!fault) return {};
  if (fault->closure) {
    const ClosureFault open = closureFault(spec, [](const VehicleSpec& other) { return !firstFault(other); });
    fault->what = open.gap, fault->advice = open.advice;
    for (const Knob& k : {idlerZ(spec), wheelZ(spec), pitch(spec), teeth(spec)})
      if (fault->advice.empty())
        if (const std::string value = mendingValue(spec, k); !value.empty())
          fault->advice = fmt::format("set {} = {}", k.name, value);
    if (const std::string keys = fault->advice.empty() ? combinedAdvice(spec) : ""; fault->advice.empty())
      fault->advice = "no single change of idler.x, shoe.count, idler.z, road_wheel.z, shoe.pitch or sprocket.teeth "
                      "removes the fault" +
                      (keys.empty() ? "" : "; " + keys);
  }
  return withAdvice(spec, *fault);
}

} // namespace grouser::vehicle
