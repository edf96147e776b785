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
    {"time_step", "s", "time step"},
    {"rows", "-", "rows of the series written so far"},
    {"frames", "-", "frames written so far"},
    {"steps", "-", "steps since the start"},
    {"ledger_at_start", "J, N s, N m s", "energies and momenta that the ledger counts from"},
    {"energy_guard", "J",
     "values at the last check of the energy guard: error, turnover, dissipated, drive work, elastic, by grains; and "
     "the largest held by grains"},
    {"settled/time", "s", "settling time of the bed"},
    {"settled/agitation", "-", "kinetic energy ratio at its end: mean per grain over m g radius"},
    {"settled/steps", "-", "steps of settling"},
    {"settled/friction", "-", "friction of the bed's preparation; 0: its own"},
    {"settled/highest", "m", "top of the highest grain after settling"},
    {"settled/mean_height", "m", "mean height of the surface after settling"},
    {"taken_out", "-, kg, J, N s", "grains crushed and removed: number, mass, energy, momentum"},
    {"bed/porosity", "-", "fraction of sample points outside all grains"},
    {"bed/porosity_error", "-", "standard error of the porosity"},
    {"bed/coordination", "-", "contacts per grain"},
    {"bed/rattlers", "-", "fraction of grains with fewer than two contacts"},
    {"bed/order", "-", "fraction of grains in crystalline order"},
    {"bed/mean_diameter", "m", "number mean of the grain diameter"},
    {"bed/settled_height", "m", "mean height of the undisturbed surface"},
    {"bed/thickness", "m", "mean height of that surface above the floor"},
    {"bed/highest", "m", "highest point of that surface"},
    {"bed/lowest", "m", "lowest point of that surface"},
    {"bed/grains", "-", "grains in the measurement"},
    {"bed/distance", "mean diameters", "distance between the centres of two grains"},
    {"bed/radial_distribution", "-", "radial distribution function at that distance"},
    {"bed/depth", "m", "depth below the undisturbed surface"},
    {"bed/porosity_at_depth", "-", "porosity at that depth"},
    {"undisturbed_surface", "m", "heights of its nodes"},
    {"lifts", "m", "lifts of objects placed on a settled bed"},
    {"inputs", "-, various",
     "inputs, ten numbers each: step before which it was set, kind, target (track or body), 1 if released, then six "
     "values; kinds in order: sprocket_speed [rad/s], sprocket_torque [N m], throttle [-], hitch_force [N], "
     "hitch_speed [m/s], gravity [m/s2], body_load [N, N m]"},
    {"ground/state", "-", "internal state of a ground that is neither granular nor rigid"},
    {"mechanism/bodies", "m, -, m/s, rad/s", "positions, velocities, springs and energy accounts of all bodies"},
    {"mechanism/worst", "m, -, -",
     "since the last row: largest position error of a joint, most iterations, singular steps"},
    {"mechanism/judged", "-, N, -, -, -",
     "tension in joints: steps, largest valid value, whether it was exceeded, growth of oscillations per step and in "
     "total"},
    {"mechanism/control", "s, -", "adaptive steps: the next, their number, rejected, smallest, largest"},
    {"fluid/steps", "-", "steps of the fluid since the start"},
    {"fluid/particles", "m, m/s, -, m/s2, J/kg",
     "for each particle: position, velocity, compression, acceleration by pairs, and losses by viscosity, density "
     "diffusion and walls"},
    {"fluid/body_loads", "-", "force and torque of the fluid on each body, in quanta"},
    {"fluid/bodies", "m/s2, rad/s2, m/s, rad/s",
     "for each body in the fluid: relaxed acceleration, velocity at the last step of the fluid and sum of those since, "
     "each linear and angular"},
    {"fluid/waited", "-", "steps of the run since the last of the fluid"},
    {"grains/total", "-", "number of grains"},
    {"grains/gone", "-", "ids of removed grains, ascending; all others are in rows by ascending id"},
    {"grains/layout", "-",
     "flags or counts: ledger, planes and floor, friction, rolling, radii, materials, periodic, fixed, plastic, "
     "contact points of a grain with the floor if there can be several"},
    {"grains/position", "unit",
     "x, y, z, as 42-bit integers: low 32 bits of each, then three times their 10 high bits; times the attribute "
     "`unit` "
     "of `grains`: metres"},
    {"grains/velocity", "m/s", ""},
    {"grains/spin", "rad/s", "angular velocity"},
    {"grains/remainders", "-", "rounding remainders of velocity, spin and position"},
    {"grains/radius", "m", "grain radius; no rows if all are equal to the attribute `radius` of `grains`"},
    {"grains/material", "-", "index of the grain's material; no rows if there is one"},
    {"grains/fixed", "-", "1 for fixed grains; no rows if none are fixed"},
    {"grains/crossings", "-", "crossings of periodic boundaries in x and y; no rows without them"},
    {"grains/wall_bits", "-", "one bit for each wall or floor in contact; no rows without them"},
    {"grains/wall_shear", "m", "tangential springs on walls and floor, by grain, then wall; no rows without friction"},
    {"grains/wall_rolling", "rad", "rolling springs in the same order; no rows without rolling friction"},
    {"grains/wall_deepest", "m",
     "overlaps at the end of first loading, in the same order; no rows without plastic contacts"},
    {"grains/wall_origin", "N",
     "elastic forces at the plastic overlap, in the same order; no rows without plastic contacts"},
    {"grains/floor_normal", "-", "normals of the floor contacts of a grain; no rows if it has one at most"},
    {"grains/contacts", "-", "number of contacts of each grain with other grains"},
    {"grains/travelled", "unit", "distance travelled since the neighbour list was built"},
    {"grains/neighbour", "-", "ids of the grains in contact, ascending for each grain, grain by grain"},
    {"grains/contact_shear", "m", "tangential spring of each contact; no rows without friction"},
    {"grains/contact_rolling", "rad", "rolling spring of each contact; no rows without rolling friction"},
    {"grains/contact_deepest", "m", "as wall_deepest, for each contact"},
    {"grains/contact_origin", "N", "as wall_origin, for each contact"},
    {"grains/skin", "-", "skin of the neighbour list over the radius"},
    {"grains/rebuilds", "-", "rebuilds of the neighbour list so far"},
    {"grains/books", "J, N s, N m s", "work and impulses since the start, in units of the ledger"},
    {"surfaces/states", "m, m/s, J, N s, N, N m, W",
     "for each surface: offset, speed, work, turnover, impulse, angular impulse, and sums since the last row of force, "
     "torque, torque about the pivot, power"},
    {"surfaces/mean_steps", "-", "number of steps in these sums"},
    {"surfaces/patches/memories", "-", "contacts of grains with meshes, eight words each"},
    {"surfaces/patches/angles", "rad", "rolling angles of these contacts"},
    {"surfaces/patches/dents", "m", "permanent indentation of these contacts"},
    {"surfaces/patches/sums", "-", "loads and work of these contacts, in quanta"},
    {"surfaces/patches/deepest", "-", "for each part the grain with the largest overlap since the last row"},
    {"mechanism/touching/forces", "-", "forces on each shape of a body, summed since the last row, in units of force"},
    {"vehicle/lift", "m", "lift at which the vehicle was placed"},
    {"vehicle/bodies", "m, -, m/s, rad/s", "positions, velocities, springs and energy accounts of all bodies"},
    {"vehicle/observers", "-, m, N m, W, rad/s, m/s, rad",
     "travel of each track in teeth, pitches and metres; then sums since the last row of torque and power of each, and "
     "their number of steps; sums of the speeds of each sprocket and of the hull at it; heading and roll including "
     "full turns"},
    {"vehicle/driver", "s, m/s, rad/s, m, N m",
     "start of the drive, and of the rest before it, -1: not yet; for a course the integrals of the errors of speed "
     "and of turning, and the distance along it; for a branch that changed the driver during the drive: time, speeds "
     "and torques of the sprockets and speed of the hull at the change"},
    {"vehicle/asked", "-, s, rad/s, N m, m/s",
     "sprockets in the last step: whether they were driven, end time of the step, commanded speeds and torques, left "
     "and right; speed of the hull after it"},
    {"vehicle/hitch", "-, m, m/s",
     "whether the hitch has engaged; horizontal position, heading and speed at that time; position and velocity of the "
     "sled; distance of sled or carriage, speed of the carriage; empty without a hitch"},
    {"vehicle/hitch_books", "J, N, m/s, W, -",
     "work of the hitch since the start, and sums since the last row of force, speed and power, and their number of "
     "steps"},
    {"vehicle/applied_work", "J", "work of loads that were set as inputs, and the rounding error of its sum"},
    {"vehicle/track/states", "m, N/m, J",
     "contacts of shoes with sprocket, wheels, rollers and idler: spring, its stiffness, dissipated energy"},
    {"vehicle/track/sums", "-",
     "sums over these contacts in the last step, in quanta: area, weight, position, force, elastic, dissipated"},
    {"vehicle/ground/states", "m, N/m, J", "the same for shoes on rigid ground"},
    {"vehicle/ground/sums", "-", "sums over these contacts, as for the track"},
    {"vehicle/surfaces/states", "m, N/m, J", "the same for parts on obstacles"},
    {"vehicle/surfaces/sums", "-", "sums over these contacts, as for the track"},
    {"vehicle/stalled_steps", "-", "steps during which driven tracks have not moved the hull"},
    {"vehicle/bed/memories", "-", "contacts of grains with parts, eight words each"},
    {"vehicle/bed/angles", "rad", "rolling angles of these contacts"},
    {"vehicle/bed/dents", "m", "permanent indentation of these contacts"},
    {"vehicle/bed/sums", "-", "loads and work of these contacts, in quanta"},
    {"vehicle/bed/deepest", "-", "for each part the grain with the largest overlap since the last row"},
    {"vehicle/ground_forces", "-", "force on each part, summed since the last row, in units of force"},
    {"vehicle/mean_steps", "-", "number of steps in these sums"},
    {"vehicle/alarm_forces", "-", "the same since the last check of the track"},
    {"vehicle/alarm_steps", "-", "number of steps in these sums"},
    {"vehicle/judged", "-, -, -, s, s, N s, s",
     "growth of oscillations across the tension in the track: per step, and in total; blows: largest ground force over "
     "the weight, its time, and for the current mean its end, impulse, time"},
    {"vehicle/impulse_on_parts", "-", "impulse of the ground since the start, in units of force and steps"},
    {"vehicle/angular_on_parts", "N m s", "angular impulse about the world's origin"},
};

} // namespace

std::vector<support::FileField> checkpointFields() {
  std::map<std::string, const Meaning*> meanings;
  for (const Meaning& m : kMeanings) meanings[m.path] = &m;
  std::vector<support::FileField> fields{
      {"/@scene", "text", "", "", "the resolved scene, TOML; for a cached bed all its inputs"},
      {"/@inputs", "text", "", "", "hashes of the files that the scene names"},
      {"/@commit", "text", "", "", "commit of the program that wrote the file; empty for a cached bed"},
      {"grains@unit", "float64", "", "m", "unit of positions"},
      {"grains@radius", "float64", "", "m", "radius of the largest grain"}};
  for (const StoredField& f : storedFields()) {
    auto meaning = meanings.find(f.path);
    const std::string bodies = "mechanism/touching/"; // contacts are stored as those of a vehicle
    if (meaning == meanings.end() && f.path.rfind(bodies, 0) == 0) {
      const std::string same = "vehicle/" + f.path.substr(bodies.size());
      for (const Meaning& m : kMeanings)
        if (m.path == same) meaning = meanings.emplace(f.path, &m).first;
    }
    if (meaning == meanings.end()) throw std::logic_error("checkpoint_fields.cpp has no description of " + f.path);
    fields.push_back(
        {f.path, f.type, fmt::format("[{}, {}]", f.rows, f.width), meaning->second->unit, meaning->second->help});
    meanings.erase(meaning);
  }
  if (!meanings.empty()) throw std::logic_error(meanings.begin()->first + " of checkpoint_fields.cpp is not stored");
  return fields;
}

} // namespace grouser::storage
