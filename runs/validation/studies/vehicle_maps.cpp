// SPDX-License-Identifier: BSD-3-Clause
#include "runs/validation/studies/vehicle_maps.hpp"

#include "base/error.hpp"
#include "base/math.hpp"
#include "runs/jobs/study_place.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/vehicle_setup.hpp"
#include "vehicle/spec_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace grouser::studies {

namespace fs = std::filesystem;

namespace {

constexpr double kStep = 1e-4;      // [s] step of maps without a step axis: the automatic step on rigid ground
constexpr double kDriveStart = 0.2; // [s] start of the drive
constexpr double kHardStart = 0.05; // [s] drive ramp of a hard start
constexpr int kLinePoints = 25;     // number of points of a predicted line
constexpr const char* kStepAxis = "step [s]";
constexpr const char* kLongestLine = "longest step accepted by grouser";

struct Drive {
  double speed = 2;   ///< sprocket speed [rad/s]
  double ramp = 0.2;  ///< [s]
  double length = 9;  ///< length of the ground [m]
  double until = 0.7; ///< end of the run [s]; the last 0.3 s are compared
};

/// The vehicle is set down on rigid, level ground from a height of 5 mm. `driver`: keys of the drive, which starts at
/// kDriveStart. `obstacles`: scene sections.
VehicleCase setDown(double length, const std::string& driver, const std::string& obstacles, double until,
                    const std::string& place = "") {
  VehicleCase c;
  c.run = "threads = 1\n";
  c.scene = fmt::format(
      "[material.ground]\nstiffness = 1e7\nrestitution = 0.3\nfriction = 0.8\n"
      "[terrain]\nheightmap = \"heightmaps/flat.png\"\nsize = [{:g}, 2.6]\nheight_range = [0, 0.05]\nkind = \"rigid\"\n"
      "material = \"ground\"\n{}[driver]\ntension_ramp = 0.05\nweight_ramp = 0.1\ndrive_start = {:g}\n{}"
      "[vehicle]\nsphere_radius = 0.03\n{}",
      length, obstacles, kDriveStart, driver, place);
  c.from = until - 0.3, c.until = until;
  return c;
}

/// The vehicle is set down on rigid, level ground without obstacles, and then drives.
VehicleCase onRigidGround(const Drive& drive, std::vector<SpecChange> changes = {}, const std::string& run = "") {
  VehicleCase c =
      setDown(drive.length, fmt::format("sprocket_speed = {:.9g}\ndrive_ramp = {:g}\n", drive.speed, drive.ramp), "",
              drive.until);
  c.run += run, c.changes = std::move(changes);
  return c;
}

/// The vehicle is set down on a coarse bed of three layers and drives.
VehicleCase onBed(double radius, std::vector<SpecChange> changes, int seed = 1) {
  VehicleCase c;
  c.run = fmt::format("seed = {}\n", seed);
  c.scene = fmt::format(
      "[material.soil]\ndensity = 2500\nstiffness = 1e6\nrestitution = 0.5\nfriction = 0.5\n"
      "[terrain]\nheightmap = \"heightmaps/flat.png\"\nsize = [4.2, 2.6]\nheight_range = [0, 0.05]\nmaterial = "
      "\"soil\"\n"
      "grain_radius = {:g}\nlayers = 3\narrangement = \"lattice\"\nwall_friction = 0.5\nsettle_kinetic_energy = 1e-2\n"
      "[driver]\nsprocket_speed = 2\ntension_ramp = 0.05\nweight_ramp = 0.1\ndrive_start = {:g}\ndrive_ramp = 0.1\n"
      "[vehicle]\nsphere_radius = 0.03\n",
      radius, kDriveStart);
  c.changes = std::move(changes);
  c.from = 0.3, c.until = 0.5;
  return c;
}

vehicle::VehicleSpec shippedSpec(const fs::path& folder) {
  const scene::Scene scene = sceneOf(onRigidGround({}), kStep, folder);
  return vehicle::readVehicleSpec(scene.vehicle->source());
}

std::vector<double> between(double low, double high, int count) {
  std::vector<double> values;
  for (int i = 0; i < count; ++i) values.push_back(low * base::exp(base::log(high / low) * i / (count - 1)));
  return values;
}

std::string triple(const base::Vec3d& v, double times) {
  return fmt::format("[{:.9g}, {:.9g}, {:.9g}]", times * v.x, times * v.y, times * v.z);
}

/// Points over a quantity and the step. The steps are fractions of the longest step of the program, which is a line.
VehicleMap overSteps(VehicleMap map, const std::vector<double>& xs, const std::vector<double>& shares,
                     const std::function<VehicleCase(double)>& make, const fs::path& folder) {
  for (const double x : xs) {
    const VehicleCase what = make(x);
    const double longest = longestStep(what, folder);
    for (const double share : shares) map.points.push_back({x, share * longest, what, share * longest});
  }
  PredictedLine limit{kLongestLine, {}, {}};
  const auto [low, high] = std::minmax_element(xs.begin(), xs.end());
  std::vector<double> at;
  if (map.x.logarithmic) at = between(*low, *high, kLinePoints);
  for (int i = 0; i < kLinePoints && !map.x.logarithmic; ++i) {
    const double share = static_cast<double>(i) / (kLinePoints - 1); // its square makes points denser at small values
    at.push_back(*low + (*high - *low) * share * share);
  }
  for (const double x : at) limit.x.push_back(x), limit.y.push_back(longestStep(make(x), folder));
  map.lines.push_back(limit);
  return map;
}

VehicleMap speedAndTension(bool quick, const fs::path& folder) {
  VehicleMap map{"tension",
                 "sprocket speed (reached within 0.05 s) and tension; step 1e-4 s",
                 {"preload of an idler [N]"},
                 {"sprocket speed [rad/s]"}};
  const vehicle::VehicleSpec spec = shippedSpec(folder);
  const std::vector<double> preloads =
      quick ? std::vector<double>{300, 9200} : std::vector<double>{100, 1000, 9200, 30e3, 90e3};
  const std::vector<double> speeds = quick ? std::vector<double>{2, 40} : std::vector<double>{3, 10, 30, 60, 100};
  for (const double preload : preloads)
    for (const double speed : speeds) {
      const Drive drive{speed, kHardStart, 8 + 0.4 * speed * spec.pitchRadius(), 0.7};
      // Higher preloads also raise the stiffness, so that the deflection of the spring does not change.
      const double stiffness = spec.idler.stiffness * std::max(1.0, preload / spec.idler.preload);
      map.points.push_back({preload, speed,
                            onRigidGround(drive, {{"idler", "preload", fmt::format("{:g}", preload)},
                                                  {"idler", "stiffness", fmt::format("{:g}", stiffness)}}),
                            kStep});
    }
  // A strand that moves at v has the tension lambda v^2. Above the speed of this line, both strands exceed the preload.
  const double lambda = spec.shoe.mass / spec.shoe.pitch;
  PredictedLine taut{"centrifugal tension lambda v^2 exceeds the preload", {}, {}};
  // Each strand accelerates half the track; on a smooth ramp, with 1.5 times the mean acceleration.
  PredictedLine start{"track acceleration exceeds the preload", {}, {}};
  const double pulled = 0.5 * spec.shoe.mass * spec.shoe.count * 1.5 * spec.pitchRadius() / kHardStart; // [N s]
  for (const double preload : between(preloads.front(), preloads.back(), kLinePoints)) {
    const double speed = std::sqrt(0.5 * preload / lambda) / spec.pitchRadius();
    const auto add = [&](PredictedLine& line, double y) {
      if (y >= speeds.front() && y <= speeds.back()) line.x.push_back(preload), line.y.push_back(y);
    };
    add(taut, speed), add(start, 0.5 * preload / pulled);
  }
  map.lines = {taut, start};
  return map;
}

/// Scales mass and suspension stiffness by the same factor, so that the ride height does not change.
std::vector<SpecChange> heavier(const vehicle::VehicleSpec& s, double times) {
  const double mass = s.chassis.mass + (times - 1) * s.totalMass();
  const auto scaled = [times](double value) { return fmt::format("{:.9g}", times * value); };
  return {{"chassis", "mass", fmt::format("{:.9g}", mass)},
          {"chassis", "inertia", triple(s.chassis.inertia, mass / s.chassis.mass)},
          {"arm", "stiffness", scaled(s.arm.stiffness)},
          {"arm", "damping", scaled(s.arm.damping)},
          {"arm", "preload", scaled(s.arm.preload)}};
}

VehicleMap grainsAndWeight(bool quick, const fs::path& folder) {
  VehicleMap map{"grains",
                 "grain size and weight, on a bed with a stiffness of 1e6 N/m; step 1e-4 s",
                 {"grain radius [m]"},
                 {"weight / weight of the shipped vehicle [-]"}};
  map.onBed = true;
  const vehicle::VehicleSpec spec = shippedSpec(folder);
  const std::vector<double> radii = quick ? std::vector<double>{0.05} : std::vector<double>{0.025, 0.035, 0.05};
  const std::vector<double> weights = quick ? std::vector<double>{1} : std::vector<double>{0.5, 1, 3, 10};
  for (const double radius : radii)
    for (const double weight : weights)
      map.points.push_back({radius, weight, onBed(radius, heavier(spec, weight)), kStep});
  // A single grain carries a road wheel and overlaps with the grain below by one radius.
  PredictedLine pressed{"a single grain under a road wheel overlaps by its radius", {}, {}};
  const double wheels = 2.0 * spec.roadWheel.count;
  for (const double radius : between(radii.front(), radii.back(), kLinePoints)) {
    const double weight = 1e6 * radius * wheels / (spec.totalMass() * jobs::kGravity);
    if (weight >= weights.front() && weight <= weights.back()) pressed.x.push_back(radius), pressed.y.push_back(weight);
  }
  map.lines = {pressed};
  return map;
}

/// Scatter between seeds, which is the reference for differences on beds. Not run with --quick.
VehicleMap seeds(bool quick, const fs::path& folder) {
  VehicleMap map{"seeds", "beds with different seeds, grain radius 0.05 m", {"seed", false}, {kStepAxis}};
  map.onBed = true;
  constexpr int kSeeds = 4;
  for (int seed = 1; seed <= kSeeds && !quick; ++seed)
    map.points.push_back({seed * 1.0, kStep, onBed(0.05, {}, seed), kStep});
  const double longest = longestStep(onBed(0.05, {}), folder);
  map.lines = {{kLongestLine, {1, kSeeds}, {longest, longest}}};
  return map;
}

VehicleMap stiffness(bool quick, const fs::path& folder) {
  const VehicleMap map{"stiffness", "stiffness of shoes and wheels", {"foundation modulus [N/m3]"}, {kStepAxis}};
  const vehicle::VehicleSpec spec = shippedSpec(folder);
  const auto make = [&](double modulus) {
    // The relaxation time keeps the damping ratio constant.
    const double relaxation = spec.contact.relaxationTime * std::sqrt(spec.contact.foundationModulus / modulus);
    return onRigidGround({}, {{"contact", "foundation_modulus", fmt::format("{:.9g}", modulus)},
                              {"contact", "relaxation_time", fmt::format("{:.9g}", relaxation)}});
  };
  return overSteps(map, quick ? std::vector<double>{1e10} : std::vector<double>{1e8, 1e9, 1e10, 1e11}, mapShares(quick),
                   make, folder);
}

VehicleMap drop(bool quick, const fs::path& folder) {
  const VehicleMap map{"drop", "drop height", {"height [m]"}, {kStepAxis}};
  const auto make = [](double height) {
    VehicleCase c = onRigidGround({});
    c.scene = "[material.ground]\nstiffness = 1e7\nrestitution = 0.3\nfriction = 0.8\n"
              "[terrain]\nheightmap = \"heightmaps/flat.png\"\nsize = [8, 2.6]\nheight_range = [0, 0.05]\n"
              "kind = \"rigid\"\nmaterial = \"ground\"\n"
              "[driver]\nsprocket_speed = 0\ntension_ramp = 0.05\nweight_ramp = 0\ndrive_start = 0.05\n" +
              fmt::format("[vehicle]\nposition = [2.5, 0]\nclearance = {:.9g}\nsphere_radius = 0.03\n", height);
    const double lands = 0.05 + std::sqrt(2 * height / jobs::kGravity);
    c.from = lands + 0.2, c.until = lands + 0.5;
    return c;
  };
  return overSteps(map, quick ? std::vector<double>{0.3} : std::vector<double>{0.01, 0.1, 0.3, 1, 3, 9},
                   mapShares(quick), make, folder);
}

VehicleMap speeds(bool quick, const fs::path& folder) {
  const VehicleMap map{"speed", "speed (reached within 0.2 s)", {"sprocket speed [rad/s]", false}, {kStepAxis}};
  const auto make = [](double speed) { return onRigidGround({speed, 0.2, 9 + 0.1 * speed, 0.7}); };
  return overSteps(map, quick ? std::vector<double>{20} : std::vector<double>{0, 5, 10, 20}, mapShares(quick), make,
                   folder);
}

/// Drives forward, and 0.1 s later backward at the same speed; the shoes slide.
VehicleMap reversal(bool quick, const fs::path& folder) {
  const VehicleMap map{
      "reversal", "drives reversed within 0.1 s", {"sprocket speed, forward and back [rad/s]", false}, {kStepAxis}};
  const auto make = [](double speed) {
    return setDown(12,
                   fmt::format("[driver.table]\ntime = [0, 0.2, 0.3, 0.4, 1]\nleft = [0, {0:g}, {0:g}, {1:g}, {1:g}]\n"
                               "right = [0, {0:g}, {0:g}, {1:g}, {1:g}]\n",
                               speed, -speed),
                   "", kDriveStart + 0.8, "position = [5, 0]\n");
  };
  return overSteps(map, quick ? std::vector<double>{5} : std::vector<double>{2, 5, 10, 20}, mapShares(quick), make,
                   folder);
}

/// The vehicle is set down with the middle of the left track on a half-round and the right track on the ground, and
/// then drives.
VehicleMap bump(bool quick, const fs::path& folder) {
  const VehicleMap map{"bump", "one track on a bump", {"radius of the half-round [m]", false}, {kStepAxis}};
  const auto make = [&folder](double radius) {
    const vehicle::VehicleSpec spec = shippedSpec(folder);
    const double start = 2, middle = start + spec.chassis.centre.x;
    return setDown(8, "sprocket_speed = 2\ndrive_ramp = 0.2\n",
                   fmt::format("[[cylinder]]\nposition = [{:.6g}, {:.6g}, 0]\naxis = [0, 1, 0]\nradius = {:g}\n"
                               "length = {:.6g}\nmaterial = \"ground\"\n",
                               middle, spec.trackOffset, radius, 4 * spec.shoe.padHalfWidth),
                   0.9, fmt::format("position = [{:g}, 0]\n", start));
  };
  return overSteps(map, quick ? std::vector<double>{0.1} : std::vector<double>{0.03, 0.1, 0.2}, mapShares(quick), make,
                   folder);
}

/// The vehicle drives off a ledge at 10 rad/s; its centre of mass starts 0.3 m before the edge.
VehicleMap ledge(bool quick, const fs::path& folder) {
  const VehicleMap map{"ledge", "driven off a ledge at 10 rad/s", {"height [m]", false}, {kStepAxis}};
  const auto make = [&folder](double height) {
    const vehicle::VehicleSpec spec = shippedSpec(folder);
    const double start = 1, edge = start + spec.chassis.centre.x + 0.3;
    return setDown(10, "sprocket_speed = 10\ndrive_ramp = 0.2\n",
                   fmt::format("[[box]]\nposition = [{:.6g}, 0, {:.6g}]\nsize = [{:.6g}, 2.6, {:.6g}]\n"
                               "material = \"ground\"\n",
                               0.5 * edge, 0.5 * height, edge, height),
                   1.8, fmt::format("position = [{:g}, 0]\n", start));
  };
  return overSteps(map, quick ? std::vector<double>{0.3} : std::vector<double>{0.1, 0.3, 0.5}, mapShares(quick), make,
                   folder);
}

VehicleMap gravity(bool quick, const fs::path& folder) {
  const VehicleMap map{"gravity", "gravity", {"gravity / 9.81 m/s2 [-]", false}, {kStepAxis}};
  const auto make = [](double g) {
    return onRigidGround({}, {}, fmt::format("gravity = [0, 0, {:.9g}]\n", -g * jobs::kGravity));
  };
  return overSteps(map, quick ? std::vector<double>{0, 10} : std::vector<double>{0, 0.17, 1, 3, 6, 10},
                   mapShares(quick), make, folder);
}

VehicleMap masses(bool quick, const fs::path& folder) {
  const VehicleMap map{"mass", "mass ratio", {"mass of the hull / mass of a shoe [-]"}, {kStepAxis}};
  const vehicle::VehicleSpec spec = shippedSpec(folder);
  const auto make = [&](double ratio) {
    const double mass = spec.chassis.mass / ratio;
    return onRigidGround({}, {{"shoe", "mass", fmt::format("{:.9g}", mass)},
                              {"shoe", "inertia", triple(spec.shoe.inertia, mass / spec.shoe.mass)}});
  };
  return overSteps(map, quick ? std::vector<double>{1.4e3} : std::vector<double>{65, 150, 435, 1.4e3}, mapShares(quick),
                   make, folder);
}

VehicleMap inertias(bool quick, const fs::path& folder) {
  const VehicleMap map{"inertia", "inertia ratio", {"m l^2 / 12 of a shoe / its moment of inertia [-]"}, {kStepAxis}};
  const vehicle::VehicleSpec spec = shippedSpec(folder);
  const double solid = spec.shoe.mass * spec.shoe.halfLength * spec.shoe.halfLength / 3;
  const auto make = [&](double ratio) {
    return onRigidGround({}, {{"shoe", "inertia", triple(spec.shoe.inertia, solid / ratio / spec.shoe.inertia.y)}});
  };
  return overSteps(map, quick ? std::vector<double>{2} : std::vector<double>{0.2, 0.655, 2, 6}, mapShares(quick), make,
                   folder);
}

using Make = VehicleMap (*)(bool, const fs::path&);
const std::vector<std::pair<std::string, Make>>& makers() {
  static const std::vector<std::pair<std::string, Make>> all = {{"tension", speedAndTension},
                                                                {"grains", grainsAndWeight},
                                                                {"seeds", seeds},
                                                                {"stiffness", stiffness},
                                                                {"drop", drop},
                                                                {"gravity", gravity},
                                                                {"mass", masses},
                                                                {"inertia", inertias},
                                                                {"speed", speeds},
                                                                {"reversal", reversal},
                                                                {"bump", bump},
                                                                {"ledge", ledge}};
  return all;
}

} // namespace

std::vector<std::string> vehicleMapNames() {
  std::vector<std::string> names;
  for (const auto& [name, make] : makers()) names.push_back(name);
  return names;
}

std::vector<double> mapShares(bool quick) {
  return quick ? std::vector<double>{0.99, 1.5} : std::vector<double>{0.5, 0.99, 1.5};
}

VehicleMap vehicleMap(const std::string& name, bool quick, const fs::path& folder) {
  for (const auto& [known, make] : makers())
    if (known == name) return make(quick, folder);
  throw base::InputError(
      fmt::format("--maps: unknown map \"{}\"; choose from {}", name, fmt::join(vehicleMapNames(), ", ")));
}

} // namespace grouser::studies
