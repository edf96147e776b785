// SPDX-License-Identifier: BSD-3-Clause
#include "runs/storage/checkpoint_fields.hpp"

#include "runs/storage/checkpoint.hpp"

#include <fmt/format.h>

#include <map>
#include <stdexcept>

namespace grouser::storage {

namespace {

struct Meaning {
  const char *path, *unit, *help;
};

constexpr Meaning kMeanings[] = {
    {"time_step", "s", ""},
    {"rows", "-", "of the series that had been written"},
    {"frames", "-", "that had been written"},
    {"steps", "-", "taken since the start"},
    {"ledger_at_start", "J, N s, N m s", "energies and momenta that the ledger counts from"},
    {"energy_guard", "J",
     "at the guard's last look: error, turnover, dissipated, drive work, elastic, by grains; and most held "
     "by grains"},
    {"settled/time", "s", "that the bed took to settle"},
    {"settled/agitation", "-", "mean kinetic energy a grain over m g radius at its end"},
    {"settled/steps", "-", "that it took"},
    {"settled/friction", "-", "with which the bed was prepared; 0: with its own"},
    {"settled/highest", "m", "top of the highest grain then"},
    {"settled/mean_height", "m", "mean of the surface then"},
    {"taken_out", "-, kg, J, N s", "grains crushed and taken out: number, mass, energy, momentum"},
    {"bed/porosity", "-", "share of points that lie in no grain"},
    {"bed/porosity_error", "-", "standard error of that"},
    {"bed/coordination", "-", "contacts a grain"},
    {"bed/rattlers", "-", "share of the grains with fewer than two contacts"},
    {"bed/order", "-", "share of the grains in crystalline surroundings"},
    {"bed/mean_diameter", "m", "by number"},
    {"bed/settled_height", "m", "mean of the undisturbed surface"},
    {"bed/thickness", "m", "mean of that surface above the floor"},
    {"bed/highest", "m", "of that surface"},
    {"bed/lowest", "m", "of that surface"},
    {"bed/grains", "-", "that were looked at"},
    {"bed/distance", "mean diameters", "between the centres of two grains"},
    {"bed/radial_distribution", "-", "how many more grains lie at that distance than by chance"},
    {"bed/depth", "m", "below the undisturbed surface"},
    {"bed/porosity_at_depth", "-", "at that depth"},
    {"undisturbed_surface", "m", "heights of its nodes"},
    {"lifts", "m", "of what was put on a settled bed"},
    {"inputs", "-, various",
     "set from outside, ten numbers a setting: step before which, kind, target (track or body), 1 where released, then "
     "six values; kinds in order: sprocket_speed [rad/s], sprocket_torque [N m], throttle [-], hitch_force [N], "
     "hitch_speed [m/s], gravity [m/s2], body_load [N, N m]"},
    {"ground/state", "-", "of a ground that is neither of grains nor rigid, as it keeps itself"},
    {"mechanism/bodies", "m, -, m/s, rad/s", "places, velocities, springs and books of all bodies"},
    {"mechanism/worst", "m, -, -", "since the last row: widest gap of a joint, most iterations, singular steps"},
    {"mechanism/judged", "-, N, -, -, -",
     "of pull in joints: steps, greatest that is sound, whether it was above, growth of swings a step and in all"},
    {"mechanism/control", "s, -", "of steps that an error controls: the next, how many, rejected, smallest, largest"},
    {"fluid/steps", "-", "of the fluid since the start"},
    {"fluid/particles", "m, m/s, -, m/s2, J/kg",
     "of each particle: place, velocity, compression, acceleration by pairs, and losses by viscosity, density "
     "diffusion "
     "and walls"},
    {"fluid/body_loads", "-", "of the fluid on each body: force and torque, in whole quanta"},
    {"fluid/bodies", "m/s2, rad/s2, m/s, rad/s",
     "of each body in the fluid: relaxed acceleration, velocity at the last step of the fluid and sum of those since, "
     "each linear and angular"},
    {"fluid/waited", "-", "steps of the run since the last of the fluid"},
    {"grains/total", "-", "grains that are there"},
    {"grains/gone", "-", "ids of those that were taken out, ascending; all others stand in rows by ascending id"},
    {"grains/layout", "-",
     "1 or how many: ledger, planes and floor, friction, rolling, radii, materials, periodic, fixed, plastic, places "
     "of "
     "the floor where a grain may touch it in several"},
    {"grains/position", "unit",
     "x, y, z, as 42-bit integers: low 32 bits of each, then three times their 10 high bits; times the attribute "
     "`unit` "
     "of `grains`: metres"},
    {"grains/velocity", "m/s", ""},
    {"grains/spin", "rad/s", "angular velocity"},
    {"grains/remainders", "-", "what rounding has cut off velocity, spin and position"},
    {"grains/radius", "m", "no rows where all are alike: then it is the attribute `radius` of `grains`"},
    {"grains/material", "-", "place among the materials of grains; no rows where there is one"},
    {"grains/fixed", "-", "1 for a grain that never moves; no rows where all may"},
    {"grains/crossings", "-", "of periodic boundaries in x and y; no rows without them"},
    {"grains/wall_bits", "-", "a bit for each wall or floor in touch; no rows without them"},
    {"grains/wall_shear", "m", "of springs on walls and floor, walls within grains; no rows without friction"},
    {"grains/wall_rolling", "rad", "the same of rolling; no rows without rolling friction"},
    {"grains/wall_deepest", "m",
     "the same of the overlap at which first loading ended; no rows without plastic contacts"},
    {"grains/wall_origin", "N",
     "the same of the elastic force at the plastic overlap; no rows without plastic contacts"},
    {"grains/floor_normal", "-", "of the places where a grain touches the floor; no rows where it has one"},
    {"grains/contacts", "-", "other grains in touch with each"},
    {"grains/travelled", "unit", "since the neighbour list was built"},
    {"grains/neighbour", "-", "ids of the grains in touch, ascending for each grain, grain by grain"},
    {"grains/contact_shear", "m", "of the spring of each contact; no rows without friction"},
    {"grains/contact_rolling", "rad", "of each contact; no rows without rolling friction"},
    {"grains/contact_deepest", "m", "as wall_deepest, of each contact"},
    {"grains/contact_origin", "N", "as wall_origin, of each contact"},
    {"grains/skin", "-", "of the neighbour list, as a share of the radius"},
    {"grains/rebuilds", "-", "of the neighbour list so far"},
    {"grains/books", "J, N s, N m s", "work and impulses since the start, in whole units of the ledger"},
    {"surfaces/states", "m, m/s, J, N s, N, N m, W",
     "of each surface: offset, speed, work, turnover, impulse, angular impulse, and sums since the last row of force, "
     "torque, torque about the pivot, power"},
    {"surfaces/mean_steps", "-", "that those sums are over"},
    {"surfaces/patches/memories", "-", "contacts of grains with meshes: eight words each"},
    {"surfaces/patches/angles", "rad", "rolling angles of these"},
    {"surfaces/patches/dents", "m", "of these"},
    {"surfaces/patches/sums", "-", "loads and work of these, in whole units"},
    {"surfaces/patches/deepest", "-", "of each part the grain that it has pressed most since the last row"},
    {"mechanism/touching/forces", "-", "on each shape of a body, summed since the last row, in units of force"},
    {"vehicle/lift", "m", "with which it was set down"},
    {"vehicle/bodies", "m, -, m/s, rad/s", "places, velocities, springs and books of all bodies"},
    {"vehicle/observers", "-, m, N m, W, rad/s, m/s, rad",
     "travel of each track in teeth, pitches and metres; then sums since the last row of torque and power of each, and "
     "of how many steps; sums of the speeds of each sprocket and of the hull at it; heading and roll with their whole "
     "turns"},
    {"vehicle/driver", "s, m/s, rad/s, m, N m",
     "when the drive began, and since when it had rested, -1: not yet; of a course the integrals of the errors of "
     "speed "
     "and of turning, and the way along it; of a branch that changed them under way: when, speeds and torques of the "
     "sprockets and speed of the hull then"},
    {"vehicle/asked", "-, s, rad/s, N m, m/s",
     "of the sprockets in the last step: whether they were driven, when it ended, speeds and torques asked for, left "
     "and right; speed of the hull after it"},
    {"vehicle/hitch", "-, m, m/s",
     "whether it has taken hold; its level place and heading then, and speed; place and velocity of the sled; way of "
     "sled or carriage, speed of the carriage; empty without a hitch"},
    {"vehicle/hitch_books", "J, N, m/s, W, -",
     "its work since the start, and sums since the last row of force, speed and power, and of how many steps"},
    {"vehicle/applied_work", "J", "of loads that were set from outside, and what its sum has rounded off"},
    {"vehicle/track/states", "m, N/m, J",
     "of contacts of shoes with sprocket, wheels, rollers and idler: spring, its stiffness, dissipated"},
    {"vehicle/track/sums", "-",
     "of these in the last step, in whole units: area, weight, place, force, elastic, dissipated"},
    {"vehicle/ground/states", "m, N/m, J", "the same of shoes with rigid ground"},
    {"vehicle/ground/sums", "-", "the same"},
    {"vehicle/surfaces/states", "m, N/m, J", "the same of parts with obstacles"},
    {"vehicle/surfaces/sums", "-", "the same"},
    {"vehicle/stalled_steps", "-", "for which driven tracks have not moved the hull"},
    {"vehicle/bed/memories", "-", "contacts of grains with parts: eight words each"},
    {"vehicle/bed/angles", "rad", "rolling angles of these"},
    {"vehicle/bed/dents", "m", "of these"},
    {"vehicle/bed/sums", "-", "loads and work of these, in whole units"},
    {"vehicle/bed/deepest", "-", "of each part the grain that it has pressed most since the last row"},
    {"vehicle/ground_forces", "-", "of each part, summed since the last row, in units of force"},
    {"vehicle/mean_steps", "-", "that those sums are over"},
    {"vehicle/alarm_forces", "-", "the same since the track was judged last"},
    {"vehicle/alarm_steps", "-", "that those sums are over"},
    {"vehicle/judged", "-, -, -, s, s, N s, s",
     "growth of swings across the pull in the track: a step, and in all; blows: ground force over the weight at most, "
     "when, and of the mean under way until when, impulse, time"},
    {"vehicle/impulse_on_parts", "-", "of the ground since the start, in units of force and steps"},
    {"vehicle/angular_on_parts", "N m s", "the same about the world's origin"},
};

} // namespace

std::vector<support::FileField> checkpointFields() {
  std::map<std::string, const Meaning*> meanings;
  for (const Meaning& m : kMeanings) meanings[m.path] = &m;
  std::vector<support::FileField> fields{
      {"/@scene", "text", "", "", "the resolved scene, TOML; of a kept bed all that it was made of"},
      {"/@inputs", "text", "", "", "hashes of the files that the scene names"},
      {"/@commit", "text", "", "", "of the program that wrote it; empty of a kept bed"},
      {"grains@unit", "float64", "", "m", "that positions count in"},
      {"grains@radius", "float64", "", "m", "of the largest grain"}};
  for (const StoredField& f : storedFields()) {
    auto meaning = meanings.find(f.path);
    const std::string bodies = "mechanism/touching/"; // contacts are stored as those of a vehicle
    if (meaning == meanings.end() && f.path.rfind(bodies, 0) == 0) {
      const std::string same = "vehicle/" + f.path.substr(bodies.size());
      for (const Meaning& m : kMeanings)
        if (m.path == same) meaning = meanings.emplace(f.path, &m).first;
    }
    if (meaning == meanings.end()) throw std::logic_error("checkpoint_fields.cpp says nothing of " + f.path);
    fields.push_back(
        {f.path, f.type, fmt::format("[{}, {}]", f.rows, f.width), meaning->second->unit, meaning->second->help});
    meanings.erase(meaning);
  }
  if (!meanings.empty()) throw std::logic_error(meanings.begin()->first + " of checkpoint_fields.cpp is not stored");
  return fields;
}

} // namespace grouser::storage
