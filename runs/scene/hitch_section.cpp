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
  Table<S> t("hitch", "What pulls at the hull, level, from the begin of the drive on; the pull is recorded");
  t.add("kind", &S::kind, "",
        "a constant force; one that grows; a sled that slides with friction; or a carriage that holds the hull at the "
        "tracks' speed less a given slip: its pull is the drawbar pull");
  t.add("position", &S::position, "m",
        "of the hitch in the vehicle frame: from the middle of the sprockets' axle line forward, left, up; \"auto\": "
        "the middle between the rearmost axles of sprocket or idler")
      .atLeast(-100)
      .atMost(100)
      .orWord("auto");
  t.add("start", &S::start, "s", "after the begin of the drive, when it takes hold").atLeast(0).atMost(1e5);
  t.add("ramp", &S::ramp, "s", "over which a constant force comes on, or a carriage takes up its own speed")
      .atLeast(0)
      .atMost(1e3);
  t.add("force", &S::force, "N", "backwards on the hull positive; of a ramp at its begin, 0 where not given")
      .atLeast(-1e8)
      .atMost(1e8);
  t.add("rate", &S::rate, "N/s", "at which the force of a ramp grows").atLeast(-1e8).atMost(1e8);
  t.add("mass", &S::mass, "kg", "of the sled").above(0).atMost(1e7);
  t.add("friction", &S::friction, "-", "of the sled on its ground").atLeast(0).atMost(10);
  t.add("length", &S::length, "m", "of the sled's rope, which is taut as it takes hold; 3 where not given")
      .above(0)
      .atMost(1e3);
  t.add("slip", &S::slip, "-",
        "of the tracks that a carriage imposes: hull speed = (1 - slip) x sprocket speed x pitch radius; below 0 it "
        "pushes")
      .atLeast(-10)
      .atMost(10);
  t.add("stiffness", &S::stiffness, "N/m",
        "of the sled's rope or the carriage's bar; \"auto\": hull (and sled) would swing on it at 10 Hz")
      .above(0)
      .atMost(1e12)
      .orWord("auto");
  t.add("damping_ratio", &S::dampingRatio, "-", "of that swing").atLeast(0).atMost(2);
  return t;
}

struct OwnKey {
  const char *key, *unit;
  bool given;
  HitchKind kind;
  bool needed;
};

void checkHitch(const Section& section, Hitch& h, const Scene& scene) {
  if (!scene.vehicle) section.fail("", "needs a vehicle; add a section [vehicle], or remove this one");
  if (scene.vehicle->chassis == ChassisMount::fixed)
    section.fail("", "pulls at nothing where the hull is held; set vehicle.chassis = \"free\", or remove it");
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
      section.fail(k.key, fmt::format("[{}] has no meaning for hitch.kind = \"{}\"; remove it, or set kind = \"{}\"",
                                      k.unit, base::wordOf(h.kind), base::wordOf(k.kind)));
    if (!k.given && k.needed && k.kind == h.kind)
      section.fail(k.key,
                   fmt::format("[{}] is missing, and hitch.kind = \"{}\" needs it", k.unit, base::wordOf(h.kind)));
  }
  if (h.kind == HitchKind::sled && !h.length) h.length = Hitch::kLength;
}

} // namespace

SectionList hitchSections() { return {optional("hitch", &Scene::hitch, hitchTable(), checkHitch)}; }

} // namespace grouser::scene::detail
