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
    {"rows", "-", "number of rows of the time series written so far"},
    {"frames", "-", "number of frames written so far"},
    {"steps", "-", "number of steps since the start"},
    {"ledger_at_start", "J, N s, N m s", "reference values of the energy and momentum accounting"},
    {"energy_guard", "J",
     "values at the last energy check: integration error, turnover, dissipated energy, drive work, elastic energy, "
     "dissipation by grains; then the maximum elastic energy of the grains at any check"},
    {"settled/time", "s", "settling time of the bed"},
    {"settled/agitation", "-",
     "kinetic energy ratio at the end of settling: mean kinetic energy per grain / (m g radius)"},
    {"settled/steps", "-", "number of settling steps"},
    {"settled/friction", "-", "friction coefficient during settling; 0: friction of the material"},
    {"settled/highest", "m", "highest grain top after settling"},
    {"settled/mean_height", "m", "mean height of the surface after settling"},
    {"taken_out", "-, kg, J, N s", "crushed and removed grains: number, mass, energy, momentum"},
    {"bed/porosity", "-", "fraction of sample points outside all grains"},
    {"bed/porosity_error", "-", "standard error of the porosity"},
    {"bed/coordination", "-", "mean number of contacts per grain"},
    {"bed/rattlers", "-", "fraction of grains with fewer than two contacts"},
    {"bed/order", "-", "fraction of grains in crystalline arrangement"},
    {"bed/mean_diameter", "m", "mean grain diameter (by number)"},
    {"bed/settled_height", "m", "mean height of the undisturbed surface"},
    {"bed/thickness", "m", "mean bed thickness: mean height of the undisturbed surface above the floor"},
    {"bed/highest", "m", "highest point of the undisturbed surface"},
    {"bed/lowest", "m", "lowest point of the undisturbed surface"},
    {"bed/grains", "-", "number of grains in the measurement"},
    {"bed/distance", "mean diameters", "distances of grain centres for bed/radial_distribution"},
    {"bed/radial_distribution", "-", "radial distribution function at the distances bed/distance"},
    {"bed/depth", "m", "depths below the undisturbed surface for bed/porosity_at_depth"},
    {"bed/porosity_at_depth", "-", "porosity at the depths bed/depth"},
    {"undisturbed_surface", "m", "height of the undisturbed surface at each grid node"},
    {"lifts", "m", "heights by which objects placed on the settled bed were raised; negative: lowered"},
    {"inputs", "-, various",
     "inputs, ten numbers each: step before which the input was set, kind, target (track or body), 1 if released, six "
     "values; kinds in order: sprocket_speed [rad/s], sprocket_torque [N m], throttle [-], hitch_force [N], "
     "hitch_speed [m/s], gravity [m/s2], body_load [N, N m]"},
    {"ground/state", "-", "internal state of deformable soil"},
    {"mechanism/bodies", "m, -, m/s, rad/s", "positions, velocities, springs and energy accounts of all bodies"},
    {"mechanism/worst", "m, -, -",
     "since the last row: maximum position error of a joint, maximum iterations, singular steps"},
    {"mechanism/judged", "-, N, -, -, -",
     "tension in joints: number of steps, largest valid value, whether it was exceeded, growth of oscillations per "
     "step and in total"},
    {"mechanism/control", "s, -",
     "adaptive steps: length of the next step, numbers of accepted and rejected steps, smallest and largest step"},
    {"fluid/steps", "-", "number of fluid steps since the start"},
    {"fluid/particles", "m, m/s, -, m/s2, J/kg",
     "for each particle: position, velocity, compression, acceleration due to pair forces, and energy dissipated by "
     "viscosity, density diffusion and walls"},
    {"fluid/body_loads", "-", "force and torque of the fluid on each body, in quanta"},
    {"fluid/bodies", "m/s2, rad/s2, m/s, rad/s",
     "for each body in the fluid: relaxed acceleration, velocity at the last fluid step, sum of the velocities since "
     "then; each linear and angular"},
    {"fluid/waited", "-", "number of steps since the last fluid step"},
    {"grains/total", "-", "number of grains"},
    {"grains/gone", "-", "ids of removed grains, ascending; the rows of the other grains are ordered by id"},
    {"grains/layout", "-",
     "flags or counts: ledger, planes and floor, friction, rolling, radii, materials, periodic, fixed, plastic, and "
     "contact points per grain with the floor if several are possible"},
    {"grains/position", "unit",
     "x, y, z as 42-bit integers: the low 32 bits of each, then the 10 high bits of all three; multiply by the "
     "attribute `unit` of `grains` for metres"},
    {"grains/velocity", "m/s", ""},
    {"grains/spin", "rad/s", "angular velocity"},
    {"grains/remainders", "-", "rounding remainders of velocity, spin and position"},
    {"grains/radius", "m", "grain radius; no rows if all radii equal the attribute `radius` of `grains`"},
    {"grains/material", "-", "material index of each grain; no rows if there is only one material"},
    {"grains/fixed", "-", "1 for fixed grains; no rows if none are fixed"},
    {"grains/crossings", "-",
     "number of crossings of periodic boundaries along x and y; no rows without periodic boundaries"},
    {"grains/wall_bits", "-", "contact flags, one bit for each wall and the floor; no rows without walls and floor"},
    {"grains/wall_shear", "m",
     "tangential springs at walls and floor, ordered by grain, then wall; no rows without friction"},
    {"grains/wall_rolling", "rad",
     "rolling springs at walls and floor, ordered as wall_shear; no rows without rolling friction"},
    {"grains/wall_deepest", "m",
     "overlaps at walls and floor at the end of virgin loading, ordered as wall_shear; no rows without plastic "
     "contacts"},
    {"grains/wall_origin", "N",
     "elastic forces at walls and floor at the plastic overlap, ordered as wall_shear; no rows without plastic "
     "contacts"},
    {"grains/floor_normal", "-",
     "normals of the floor contacts of each grain; no rows if each grain has at most one floor contact"},
    {"grains/contacts", "-", "number of contacts of each grain with other grains"},
    {"grains/travelled", "unit", "distance travelled since the neighbour list was built"},
    {"grains/neighbour", "-", "for each grain, ids of the grains in contact with it, in ascending order"},
    {"grains/contact_shear", "m", "tangential spring of each contact; no rows without friction"},
    {"grains/contact_rolling", "rad", "rolling spring of each contact; no rows without rolling friction"},
    {"grains/contact_deepest", "m", "as wall_deepest, for each grain-grain contact"},
    {"grains/contact_origin", "N", "as wall_origin, for each grain-grain contact"},
    {"grains/skin", "-", "skin distance of the neighbour list / grain radius"},
    {"grains/rebuilds", "-", "number of neighbour-list rebuilds so far"},
    {"grains/books", "J, N s, N m s", "work and impulses since the start, in units of the energy accounting"},
    {"surfaces/states", "m, m/s, J, N s, N, N m, W",
     "for each surface: offset, speed, work, turnover, impulse, angular impulse, and sums since the last row of force, "
     "torque, torque about the pivot, power"},
    {"surfaces/mean_steps", "-", "number of steps in the sums of surfaces/states"},
    {"surfaces/patches/memories", "-", "contacts of grains with meshes, eight words each"},
    {"surfaces/patches/angles", "rad", "rolling angles of the contacts of grains with meshes"},
    {"surfaces/patches/dents", "m", "permanent indentation in the contacts of grains with meshes"},
    {"surfaces/patches/sums", "-", "loads and work of the contacts of grains with meshes, in quanta"},
    {"surfaces/patches/deepest", "-", "for each part, the grain with the maximum overlap since the last row"},
    {"mechanism/touching/forces", "-", "forces on each shape of a body, summed since the last row, in units of force"},
    {"vehicle/lift", "m", "height by which the vehicle was raised for placement"},
    {"vehicle/bodies", "m, -, m/s, rad/s", "positions, velocities, springs and energy accounts of all bodies"},
    {"vehicle/observers", "-, m, N m, W, rad/s, m/s, rad",
     "travel of each track in teeth, pitches and metres; sums since the last row of torque and power of each track, "
     "and number of steps in these sums; sums of the speeds of each sprocket and of the hull at the sprocket; heading "
     "and roll including full turns"},
    {"vehicle/driver", "s, m/s, rad/s, m, N m",
     "start times of the drive and of the rest before it (-1: not yet reached); on a course, integrals of the speed "
     "and yaw-rate errors, and distance along the course; for a branch that changed the driver during the drive, time, "
     "sprocket speeds and torques, and hull speed at the change"},
    {"vehicle/asked", "-, s, rad/s, N m, m/s",
     "sprockets in the last step: whether they were driven, end time of the step, commanded speeds and torques, left "
     "and right; hull speed after the step"},
    {"vehicle/hitch", "-, m, m/s",
     "whether the hitch has engaged; horizontal position, heading and speed at engagement; position and velocity of "
     "the sled; distance of sled or carriage, speed of the carriage; empty without a hitch"},
    {"vehicle/hitch_books", "J, N, m/s, W, -",
     "work of the hitch since the start; sums since the last row of force, speed and power, and number of steps in "
     "these sums"},
    {"vehicle/applied_work", "J", "work of loads applied as inputs, and rounding error of the sum"},
    {"vehicle/track/states", "m, N/m, J",
     "contacts of shoes with sprocket, wheels, rollers and idler: spring deflection, spring stiffness, dissipated "
     "energy"},
    {"vehicle/track/sums", "-",
     "sums over the contacts of shoes with running gear in the last step, in quanta: area, weight, position, force, "
     "elastic energy, dissipated energy"},
    {"vehicle/ground/states", "m, N/m, J",
     "contacts of shoes with rigid ground: spring deflection, spring stiffness, dissipated energy"},
    {"vehicle/ground/sums", "-",
     "sums over the contacts of shoes with rigid ground in the last step, quantities as in vehicle/track/sums"},
    {"vehicle/surfaces/states", "m, N/m, J",
     "contacts of parts with obstacles: spring deflection, spring stiffness, dissipated energy"},
    {"vehicle/surfaces/sums", "-",
     "sums over the contacts of parts with obstacles in the last step, quantities as in vehicle/track/sums"},
    {"vehicle/stalled_steps", "-", "number of steps in which the driven tracks have not moved the hull"},
    {"vehicle/bed/memories", "-", "contacts of grains with parts, eight words each"},
    {"vehicle/bed/angles", "rad", "rolling angles of the contacts of grains with parts"},
    {"vehicle/bed/dents", "m", "permanent indentation in the contacts of grains with parts"},
    {"vehicle/bed/sums", "-", "loads and work of the contacts of grains with parts, in quanta"},
    {"vehicle/bed/deepest", "-", "for each part, the grain with the maximum overlap since the last row"},
    {"vehicle/ground_forces", "-", "force on each part, summed since the last row, in units of force"},
    {"vehicle/mean_steps", "-", "number of steps in the sums of forces since the last row"},
    {"vehicle/alarm_forces", "-", "force on each part, summed since the last check of the track, in units of force"},
    {"vehicle/alarm_steps", "-", "number of steps in the sums of vehicle/alarm_forces"},
    {"vehicle/judged", "-, -, -, s, s, N s, s",
     "growth of transverse track oscillations: per step, and in total; blows: maximum ground force / weight, its time, "
     "and for the current average its end, impulse, duration"},
    {"vehicle/impulse_on_parts", "-", "impulse of the ground since the start, in units of force and steps"},
    {"vehicle/angular_on_parts", "N m s", "angular impulse about the world's origin"},
};

} // namespace

std::vector<support::FileField> checkpointFields() {
  std::map<std::string, const Meaning*> meanings;
  for (const Meaning& m : kMeanings) meanings[m.path] = &m;
  std::vector<support::FileField> fields{
      {"/@scene", "text", "", "", "the resolved scene, TOML; for a cached bed, all inputs of the bed"},
      {"/@inputs", "text", "", "", "hashes of the files referenced by the scene"},
      {"/@commit", "text", "", "", "commit of the program that wrote the file; empty for a cached bed"},
      {"grains@unit", "float64", "", "m", "unit of positions"},
      {"grains@radius", "float64", "", "m", "maximum grain radius"}};
  for (const StoredField& f : storedFields()) {
    auto meaning = meanings.find(f.path);
    const std::string bodies = "mechanism/touching/"; // contacts are stored as for a vehicle
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
