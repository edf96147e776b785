// SPDX-License-Identifier: BSD-3-Clause
// Keys and checks of [hitch].
#include "runs/scene/detail/section_lists.hpp"

#include <fmt/format.h>

namespace grouser::scene::detail {

namespace {

using base::Section;
using base::Table;
using vehicle::HitchKind;

Table<Hitch> hitchTable() {
  using S = Hitch;
  Table<S> t("hitch", "Horizontal load on the hull, applied from the start of the drive; the pull is recorded");
  t.add("kind", &S::kind, "",
        "type of load: force (constant), ramp (force that increases linearly), sled (towed sled with friction) or "
        "speed (carriage that imposes a slip; measures the drawbar pull)");
  t.add("position", &S::position, "m",
        "position of the hitch in the vehicle frame (forward, left, up; origin midway between the sprockets); "
        "\"auto\": midway between the rearmost sprockets or idlers")
      .plausible(0, 20)
      .atLeast(-100)
      .atMost(100)
      .orWord("auto");
  t.add("start", &S::start, "s", "delay of the load after the start of the drive")
      .plausible(0, 300)
      .atLeast(0)
      .atMost(1e5);
  t.add("ramp", &S::ramp, "s", "ramp duration of a constant force, or of the carriage speed")
      .plausible(0, 60)
      .atLeast(0)
      .atMost(1e3);
  t.add("force", &S::force, "N",
        "force on the hull, positive backwards; for kind = \"ramp\": initial force, default: 0")
      .plausible(0, 1e6)
      .atLeast(-1e8)
      .atMost(1e8);
  t.add("rate", &S::rate, "N/s", "for kind = \"ramp\": rate of change of the force")
      .plausible(0, 1e6)
      .atLeast(-1e8)
      .atMost(1e8);
  t.add("mass", &S::mass, "kg", "mass of the sled").plausible(0.1, 1e5).above(0).atMost(1e7);
  t.add("friction", &S::friction, "-", "friction coefficient between sled and ground")
      .plausible(1e-3, 3, "tan of the friction angle, not the angle")
      .atLeast(0)
      .atMost(10);
  t.add("length", &S::length, "m", "length of the sled rope, which is initially taut; default: 3")
      .plausible(0.05, 100)
      .above(0)
      .atMost(1e3);
  t.add("slip", &S::slip, "-",
        "track slip imposed by the carriage: hull speed = (1 - slip) x sprocket speed x pitch radius; 1 holds the hull "
        "still, negative values push the vehicle, up to twice the speed of its tracks")
      .plausible(0, 1)
      .atLeast(-1)
      .atMost(1);
  t.add("stiffness", &S::stiffness, "N/m",
        "stiffness of the rope (sled) or bar (carriage); \"auto\": stiffness for an oscillation of the hull (and sled) "
        "at 10 Hz")
      .plausible(10, 1e9)
      .above(0)
      .atMost(1e12)
      .orWord("auto");
  t.add("damping_ratio", &S::dampingRatio, "-",
        "damping ratio of the oscillation of the hull (and sled) on the rope or bar")
      .atLeast(0)
      .atMost(2);
  return t;
}

struct OwnKey {
  const char *key, *unit;
  bool given;
  HitchKind kind;
  bool needed;
};

void checkHitch(const Section& section, Hitch& h, const Scene& scene) {
  if (!scene.vehicle) section.fail("", "requires a vehicle; add a section [vehicle], or remove this section");
  if (scene.vehicle->chassis == ChassisMount::fixed)
    section.fail("", "has no effect on a fixed hull; set vehicle.chassis = \"free\", or remove it");
  const bool grows = h.kind == HitchKind::ramp;
  const HitchKind pulls = grows ? HitchKind::ramp : HitchKind::force;
  const OwnKey keys[] = {{"force", "N", h.force.has_value(), pulls, !grows},
                         {"rate", "N/s", h.rate.has_value(), HitchKind::ramp, true},
                         {"mass", "kg", h.mass.has_value(), HitchKind::sled, true},
                         {"friction", "-", h.friction.has_value(), HitchKind::sled, true},
                         {"length", "m", h.length.has_value(), HitchKind::sled, false},
                         {"slip", "-", h.slip.has_value(), HitchKind::speed, true},
                         {"stiffness", "N/m", h.stiffness.has_value(),
                          h.kind == HitchKind::sled ? HitchKind::sled : HitchKind::speed, false}};
  for (const OwnKey& k : keys) {
    if (k.given && k.kind != h.kind)
      section.fail(k.key, fmt::format("[{}] has no effect with hitch.kind = \"{}\"; remove it, or set kind = \"{}\"",
                                      k.unit, base::wordOf(h.kind), base::wordOf(k.kind)));
    if (!k.given && k.needed && k.kind == h.kind)
      section.fail(k.key, fmt::format("[{}] is missing, but hitch.kind = \"{}\" requires it; add it", k.unit,
                                      base::wordOf(h.kind)));
  }
  if (h.kind == HitchKind::sled && !h.length) h.length = Hitch::kLength;
}

} // namespace

SectionList hitchSections() { return {optional("hitch", &Scene::hitch, hitchTable(), checkHitch)}; }

} // namespace grouser::scene::detail
