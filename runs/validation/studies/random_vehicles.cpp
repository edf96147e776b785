// SPDX-License-Identifier: BSD-3-Clause
#include "runs/validation/studies/random_vehicles.hpp"

#include "base/error.hpp"
#include "runs/jobs/study_place.hpp"
#include "runs/setup/step_limit.hpp"
#include "runs/support/locations.hpp"
#include "runs/validation/studies/random_draw.hpp"
#include "vehicle/spec_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace grouser::studies {

namespace {

constexpr std::uint64_t kPurpose = base::purpose("study.random_vehicles");
constexpr double kStart = 0.12, kUntil = 0.4, kWindow = 0.15; // [s]
constexpr double kLightPad = 0.28, kLightRadius = 0.2451;     // light vehicle, reference for grain sizes and speeds
constexpr double kLightMass = 5018;

std::string triple(const base::Vec3d& v, double times) {
  return fmt::format("[{:.6g}, {:.6g}, {:.6g}]", times * v.x, times * v.y, times * v.z);
}

/// Adds or removes shoes, and changes idler position and track-ground contact length by half as many pitches. Adds or
/// removes a road wheel if the remaining space allows it.
std::string gear(Draw& draw, vehicle::VehicleSpec& s) {
  const int more = draw.once(0.5) ? draw.of(-2, 4) : 0;
  s.shoe.count += more, s.idler.x += 0.5 * s.outward() * more * s.shoe.pitch;
  const int wheels = draw.once(0.3) ? draw.of(-1, 1) : 0;
  const double run = s.groundRun() + 0.5 * more * s.shoe.pitch;
  const auto spaced = [&](int count) { return run / (count - 1); };
  for (const int less : {0, 1, 2})
    if (s.roadWheel.count + wheels - less >= 3 &&
        spaced(s.roadWheel.count + wheels - less) > 2.1 * s.roadWheel.radius) {
      s.roadWheel.count += wheels - less;
      break;
    }
  s.roadWheel.spacing = spaced(s.roadWheel.count);
  // If the sprocket is at the front, the first wheel is the rearmost wheel, next to the idler.
  if (s.sprocketInFront()) s.roadWheel.firstX -= 0.5 * more * s.shoe.pitch;
  s.trackOffset *= draw.once(0.3) ? draw.in(1, 1.2) : 1;
  return fmt::format("[spec.vehicle]\ntrack_offset = {:.6g}\n[spec.road_wheel]\ncount = {}\nspacing = {:.7g}\n"
                     "first_x = {:.7g}\n",
                     s.trackOffset, s.roadWheel.count, s.roadWheel.spacing, s.roadWheel.firstX);
}

std::string masses(Draw& draw, vehicle::VehicleSpec& s) {
  const double before = s.totalMass(), hull = draw.over(0.5, 2), shoe = draw.over(0.5, 2);
  const double run = s.groundRun();
  s.chassis.mass *= hull, s.shoe.mass *= shoe;
  s.chassis.centre.x += draw.in(-0.1, 0.1) * run, s.chassis.centre.z += draw.in(-0.05, 0.1) * run;
  s.arm.preload *= s.totalMass() / before * draw.in(0.9, 1.1);
  return fmt::format(
      "[spec.chassis]\nmass = {:.6g}\ninertia = {}\ncentre = {}\n[spec.shoe]\ncount = {}\nmass = {:.6g}\n"
      "inertia = {}\npin_damping = {:.4g}\n",
      s.chassis.mass, triple(s.chassis.inertia, hull), triple(s.chassis.centre, 1), s.shoe.count, s.shoe.mass,
      triple(s.shoe.inertia, shoe), s.shoe.pinDamping * draw.over(0.3, 3));
}

std::string springs(Draw& draw, const vehicle::VehicleSpec& s, bool& rigidArms) {
  const double tension = draw.over(0.1, 10);
  std::string text = fmt::format("[spec.idler]\nx = {:.7g}\npreload = {:.6g}\nstiffness = {:.6g}\n", s.idler.x,
                                 tension * s.idler.preload, std::max(1.0, tension) * s.idler.stiffness);
  rigidArms = s.arm.suspension == vehicle::Suspension::rigid || draw.once(0.2);
  if (rigidArms)
    text += "[spec.arm]\nsuspension = \"rigid\"\n";
  else
    text += fmt::format("[spec.arm]\nstiffness = {:.6g}\ndamping = {:.6g}\npreload = {:.6g}\n",
                        s.arm.stiffness * draw.over(0.5, 3), s.arm.damping * draw.over(0.3, 3), s.arm.preload);
  return text + fmt::format("[spec.contact]\nfoundation_modulus = {:.5g}\nfriction_inside = {:.4g}\nfriction_ground = "
                            "{:.4g}\n",
                            s.contact.foundationModulus * draw.over(0.3, 3), draw.in(0.1, 0.6), draw.in(0.2, 1.2));
}

std::string driver(Draw& draw, const vehicle::VehicleSpec& s, const std::string& kind) {
  std::string text = fmt::format("[driver]\ntension_ramp = 0.04\nweight_ramp = 0.08\ndrive_start = {:g}\n", kStart);
  const double omega = draw.over(0.5, 10) * std::sqrt(kLightRadius / s.pitchRadius()), side = draw.in(0.2, 0.9);
  if (kind == "torque") // up to the traction limit
    return text + fmt::format("drive = \"torque\"\ntorque = {:.6g}\ndrive_ramp = 0.1\n",
                              draw.in(-1, 1) * 0.4 * s.totalMass() * jobs::kGravity * s.pitchRadius());
  if (kind == "reversal")
    return text +
           fmt::format("[driver.table]\ntime = [0, 0.1, 0.15, 1]\nleft = [0, {0:.5g}, {1:.5g}, {1:.5g}]\nright = "
                       "[0, {0:.5g}, {1:.5g}, {1:.5g}]\n",
                       omega, -omega);
  const double left = kind == "pivot" ? -omega : kind == "turn" ? side * omega : omega;
  return text + fmt::format("left = {:.5g}\nright = {:.5g}\ndrive_ramp = {:.3g}\n", left, omega, draw.over(0.03, 0.15));
}

/// Scene sections of ground and obstacles; `start`: x of the sprocket axle [m].
std::string ground(Draw& draw, const vehicle::VehicleSpec& s, RandomVehicle& random, double& start) {
  const double scale = 2 * s.shoe.padHalfWidth / kLightPad, room = 0.9 * scale;
  const double reach = s.sprocketPinRadius() + 2 * s.shoe.pitch, idler = s.idlerPinRadius() + s.shoe.pitch;
  const double rear = std::min(-reach, s.idler.x - idler), front = std::max(reach, s.idler.x + idler);
  start = room - rear;
  const double length = front - rear + 2 * room, width = 2 * (s.trackOffset + s.shoe.padHalfWidth + 0.6 * scale);
  const std::string flat = fmt::format("heightmap = \"heightmaps/flat.png\"\nsize = [{:.6g}, {:.6g}]\n", length, width);
  random.onBed = draw.once(0.3);
  if (random.onBed) {
    // With this stiffness, the relative overlap is the same as under the light vehicle.
    const double stiffness = 1e6 * s.totalMass() / (kLightMass * scale) * draw.over(0.5, 3);
    return fmt::format(
        "[material.soil]\ndensity = {:.5g}\nstiffness = {:.5g}\nrestitution = {:.3g}\nfriction = {:.3g}\n"
        "[terrain]\n{}height_range = [0, {:.4g}]\nmaterial = \"soil\"\ngrain_radius = {:.5g}\nlayers = 3\n"
        "arrangement = \"lattice\"\nwall_friction = 0.5\nsettle_kinetic_energy = {:.3g}\n",
        draw.in(1500, 3000), stiffness, draw.in(0.1, 0.8), draw.in(0.2, 0.9), flat, 0.05 * scale,
        draw.in(0.045, 0.06) * scale, 1e-2 * s.totalMass() * scale / kLightMass);
  }
  random.bump = draw.once(0.2);
  std::string text = fmt::format("[material.ground]\nstiffness = 1e7\nrestitution = 0.3\nfriction = 0.8\n[terrain]\n"
                                 "{}height_range = [0, 0]\nkind = \"rigid\"\nmaterial = \"ground\"\n",
                                 flat);
  if (random.bump)
    text += fmt::format("[[cylinder]]\nposition = [{:.6g}, {:.6g}, 0]\naxis = [0, 1, 0]\nradius = {:.4g}\nlength = "
                        "{:.5g}\nmaterial = \"ground\"\n",
                        start + s.chassis.centre.x + draw.in(-0.5, 0.5) * scale, s.trackOffset,
                        draw.over(0.01, 0.1) * scale, 4 * s.shoe.padHalfWidth);
  return text;
}

} // namespace

RandomVehicle randomVehicle(std::uint64_t seed, int number) {
  Draw draw(seed, kPurpose, number);
  RandomVehicle random;
  random.number = number;
  random.base = kRandomBases[static_cast<std::size_t>(std::max(0, draw.of(-1, 2)))]; // light_tracked twice as often
  random.drive = kRandomDrives[static_cast<std::size_t>(draw.of(0, 4))];
  const std::string file = (support::shareFolder() / "assets" / "vehicles" / (random.base + ".toml")).string();
  vehicle::VehicleSpec spec = vehicle::readVehicleSpec(file);
  std::string changes = gear(draw, spec);
  changes += masses(draw, spec), changes += springs(draw, spec, random.rigidArms);
  double start = 0;
  const std::string around = ground(draw, spec, random, start), drives = driver(draw, spec, random.drive);
  const double g = jobs::kGravity * (draw.once(0.25) ? draw.in(0, 3) : 1);
  const double lean = !random.onBed && draw.once(0.3) ? draw.in(-0.3, 0.3) : 0, down = 1 / std::sqrt(1 + lean * lean);
  random.stepShare = draw.once(0.5) ? 0 : draw.in(0.4, 1.1);
  random.what.ownVehicle = true;
  random.what.run =
      fmt::format("seed = {}\nthreads = 1\ngravity = [0, {:.6g}, {:.6g}]\n", number + 1, -g * lean * down, -g * down);
  random.what.scene = around + drives +
                      fmt::format("[vehicle]\nspec = \"{}\"\nsphere_radius = {:.4g}\nposition = [{:.6g}, 0]\n", file,
                                  0.22 * spec.shoe.padHalfWidth, start) +
                      changes;
  random.what.from = kUntil - kWindow, random.what.until = kUntil;
  return random;
}

RandomOutcome tryRandomVehicle(const RandomVehicle& vehicle, const TrialPlace& place) {
  RandomOutcome outcome;
  double step = 0;
  try {
    step = vehicle.stepShare > 0 ? vehicle.stepShare * longestStep(vehicle.what, place.folder)
                                 : setup::chooseTimeStep(sceneOf(vehicle.what, 0, place.folder));
  } catch (const base::InputError& error) {
    outcome.trials = {VehicleTrial{}};
    outcome.trials[0].end = TrialEnd::refused, outcome.trials[0].cause = error.what();
    return outcome;
  }
  outcome.trials = {tryVehicle(vehicle.what, step, place)};
  if (outcome.trials[0].end == TrialEnd::refused || vehicle.onBed) return outcome;
  outcome.trials.push_back(tryVehicle(vehicle.what, step / kFinerRatio, place));
  if (!figuresDisagree(outcome.trials[0], outcome.trials[1], vehicle.onBed)) return outcome;
  for (const double share : kNeighbourShares) {
    outcome.trials.push_back(tryVehicle(vehicle.what, share * step, place));
    outcome.trials.push_back(tryVehicle(vehicle.what, share * step / kFinerRatio, place));
  }
  return outcome;
}

Judgement judgeRandom(const RandomVehicle& vehicle, const RandomOutcome& outcome) {
  const VehicleTrial& run = outcome.trials.at(0);
  if (outcome.trials.size() > 1) {
    std::vector<TrialPair> pairs;
    for (std::size_t i = 0; i + 1 < outcome.trials.size(); i += 2)
      pairs.push_back({outcome.trials[i], outcome.trials[i + 1]});
    return judge(pairs, vehicle.onBed);
  }
  if (run.end == TrialEnd::refused) return {MapVerdict::refused, run.cause};
  if (run.end == TrialEnd::stopped)
    return {run.blamed == base::Cause::unknown ? MapVerdict::wrongCause : MapVerdict::stopped, run.cause};
  const MapFigures& f = run.figures;
  if (!(std::fabs(f.energyResidual) <= kMaxResidual))
    return {MapVerdict::silentlyWrong, fmt::format("the energy residual is {:.3g} of the turnover", f.energyResidual)};
  for (const ComparedFigure& c : comparedFigures(true))
    if (c.value != &MapFigures::sinkage && !std::isfinite(f.*c.value))
      return {MapVerdict::silentlyWrong, fmt::format("{} is {}, not a finite number", c.name, f.*c.value)};
  return {MapVerdict::sound, ""};
}

} // namespace grouser::studies
