// SPDX-License-Identifier: BSD-3-Clause
#include "runs/setup/time_scales.hpp"

#include "base/math.hpp"
#include "base/rounded.hpp"
#include "base/table.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/scene_surfaces.hpp"
#include "runs/setup/vehicle_setup.hpp"
#include "vehicle/engine.hpp"
#include "vehicle/spec_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <utility>

namespace grouser::setup {

using base::Vec3d;

namespace {

using Fail = std::function<void(const std::string&)>;

Fail failsIn(const scene::Scene& scene, const std::string& list, std::size_t number, const std::string& key) {
  return [&scene, list, number, key](const std::string& message) { scene.fail(list, number, key, message); };
}
Fail failsIn(const scene::Scene& scene, const std::string& section, const std::string& key) {
  return [&scene, section, key](const std::string& message) { scene.fail(section, key, message); };
}

/// Adds the smallest gap between two different times of a table, among gaps that begin before `end`.
void addTable(std::vector<TimeScale>& scales, const std::vector<double>& times, double end, const Fail& fail) {
  double smallest = std::numeric_limits<double>::infinity();
  std::size_t at = 0;
  for (std::size_t i = 1; i < times.size() && times[i - 1] < end; ++i)
    if (const double gap = times[i] - times[i - 1]; gap > 0 && gap < smallest) smallest = gap, at = i;
  if (at == 0) return;
  scales.push_back({smallest, false,
                    fmt::format("the interval of {:.4g} s from {:.9g} to {:.9g} s", smallest, times[at - 1], times[at]),
                    "s", fail});
}

void addPeriod(std::vector<TimeScale>& scales, double time, const char* what, const char* unit, const Fail& fail) {
  scales.push_back({time, true, fmt::format("a {} of {:.4g} s", what, time), unit, fail});
}

void addRamp(std::vector<TimeScale>& scales, double time, const Fail& fail) {
  if (time > 0) scales.push_back({time, false, fmt::format("the ramp of {:.4g} s", time), "s", fail});
}

/// Returns true if rotation changes the region that a surface occupies, unlike a rod about its own axis or a plane
/// about its normal.
bool turnMoves(const SceneSurface& s) {
  const Vec3d& spin = *s.section.spin;
  const Vec3d axis = rotate(s.start.orientation, {0, 0, 1});
  const bool round = s.geometry.shape != terrain::SurfaceShape::box && !s.mesh;
  const Vec3d arm = s.section.pivot ? s.start.position - *s.section.pivot : Vec3d{};
  // Rounding of numbers typed with nine digits.
  constexpr double kAligned = 1e-9;
  const bool aligned = norm(cross(spin, axis)) <= kAligned * norm(spin);
  const bool plane = s.geometry.shape == terrain::SurfaceShape::plane;
  const bool centred = plane || norm(cross(spin, arm)) <= kAligned * norm(spin) * norm(s.geometry.half);
  return !(round && aligned && centred);
}

void addSurfaces(std::vector<TimeScale>& scales, const scene::Scene& scene) {
  for (const SceneSurface& s : surfacesOf(scene)) {
    const scene::SurfaceSection& section = s.section;
    const auto fails = [&](const char* key) { return failsIn(scene, s.list(), s.number, key); };
    const bool moves = section.start.value_or(0) < scene.run.duration;
    if (moves && section.amplitude && norm2(*section.amplitude) > 0 && *section.frequency > 0)
      addPeriod(scales, 1 / *section.frequency, "period", "Hz", fails("frequency"));
    if (moves && section.spin && norm2(*section.spin) > 0 && turnMoves(s))
      addPeriod(scales, 2 * base::kPi / norm(*section.spin), "turn", "rad/s", fails("spin"));
    if (section.load && *section.load != 0) addRamp(scales, section.loadRamp.value_or(0), fails("load_ramp"));
  }
}

void addDrives(std::vector<TimeScale>& scales, const scene::Scene& scene) {
  const std::vector<scene::DriveSection>& drives = scene.mechanism.drives;
  for (std::size_t k = 0; k < drives.size(); ++k) {
    const scene::DriveSection& d = drives[k];
    if (d.amplitude != 0) addPeriod(scales, 1 / d.frequency, "period", "Hz", failsIn(scene, "drive", k, "frequency"));
    addTable(scales, d.time, scene.run.duration, failsIn(scene, "drive", k, "time"));
  }
}

/// Adds a revolution of the smallest wheel at the speed of a course.
void addCourseTurns(std::vector<TimeScale>& scales, const scene::Scene& scene) {
  const double speed = std::fabs(scene.driver.course->speed);
  if (speed == 0) return;
  const double smallest = vehicle::readVehicleSpec(scene.vehicle->source()).smallestWheel();
  addPeriod(scales, 2 * base::kPi * smallest / speed, "turn of the smallest wheel", "m/s",
            [&scene](const std::string& message) {
              if (scene.document) scene.document->root().section("driver").section("course").fail("speed", message);
              scene.fail("driver.course", "speed", message);
            });
}

/// Adds the fastest rotation that the driver prescribes: of a sprocket, or of the smallest wheel in the track.
void addTurns(std::vector<TimeScale>& scales, const scene::Scene& scene) {
  if (scene.driver.course) return addCourseTurns(scales, scene);
  const scene::SpeedTable table = scene.driver.speeds();
  const char* key = scene.driver.sprocketSpeed ? "sprocket_speed" : "left";
  double speed = 0;
  for (std::size_t i = 0; i < table.time.size() && table.time[i] < scene.run.duration; ++i)
    for (const auto& [side, rate] : {std::pair{"left", table.left[i]}, {"right", table.right[i]}}) {
      if (std::fabs(rate) <= speed) continue;
      speed = std::fabs(rate);
      if (!scene.driver.sprocketSpeed) key = side;
    }
  if (speed == 0) return;
  const vehicle::VehicleSpec spec = vehicle::readVehicleSpec(scene.vehicle->source());
  const double smallest = spec.smallestWheel();
  const double quicker = std::max(1.0, spec.pitchRadius() / smallest);
  const Fail fails = [&scene, key](const std::string& message) {
    if (scene.driver.table && scene.document)
      scene.document->root().section("driver").section("table").fail(key, message);
    scene.fail("driver", key, message);
  };
  addPeriod(scales, 2 * base::kPi / (quicker * speed), quicker > 1 ? "turn of the smallest wheel" : "turn", "rad/s",
            fails);
}

void addDriver(std::vector<TimeScale>& scales, const scene::Scene& scene) {
  if (!scene.vehicle) return;
  const scene::Driver& d = scene.driver;
  addRamp(scales, d.tensionRamp, failsIn(scene, "driver", "tension_ramp"));
  if (d.tensionRamp < scene.run.duration) addRamp(scales, d.weightRamp, failsIn(scene, "driver", "weight_ramp"));
  if (d.driveBegins() >= scene.run.duration) return;
  addRamp(scales, d.rampOfDrive(), failsIn(scene, "driver", "drive_ramp"));
  addTurns(scales, scene);
  if (d.torqueTable)
    addTable(scales, d.torqueTable->time, scene.run.duration - d.driveBegins(), [&scene](const std::string& message) {
      if (scene.document) scene.document->root().section("driver").section("torques").fail("time", message);
      scene.fail("driver.torques", "time", message);
    });
  if (!d.table) return;
  const Fail atTable = [&scene](const std::string& message) {
    if (scene.document) scene.document->root().section("driver").section("table").fail("time", message);
    scene.fail("driver.table", "time", message);
  };
  addTable(scales, d.table->time, scene.run.duration - d.driveBegins(), atTable);
}

/// Adds oscillations of the vehicle's springs and stops with the mass of their own parts only; attached masses make
/// oscillations slower. Integration is implicit: stable at any step, but unresolved oscillations are damped.
void addVehicle(std::vector<TimeScale>& scales, const scene::Scene& scene) {
  if (!scene.vehicle) return;
  const vehicle::SpecSource file = scene.vehicle->source();
  const vehicle::VehicleSpec s = vehicle::readVehicleSpec(file);
  const auto add = [&](const char* section, const char* key, const char* unit, double stiffness, double inertia) {
    if (!(stiffness > 0)) return;
    const double period = 2 * base::kPi * std::sqrt(inertia / stiffness);
    scales.push_back({period, true, fmt::format("an oscillation of {:.4g} s", period), unit,
                      [file, section, key](const std::string& message) {
                        vehicle::refuse(file, {section, key, message});
                      }});
  };
  // Moment of inertia about the pivot: arm, and mass of the wheel at its end.
  const double arm = s.arm.inertia.y + s.arm.mass * 0.25 * s.arm.length * s.arm.length +
                     s.roadWheel.mass * s.arm.length * s.arm.length;
  if (s.arm.suspension == vehicle::Suspension::sprung) add("arm", "stiffness", "N m/rad", s.arm.stiffness, arm);
  // Governor with the inertia of engine and sprocket, without the track.
  if (s.engine && scene.driver.drive == vehicle::SprocketDrive::engine)
    add("engine", "droop", "rad/s", vehicle::governorSlope(*s.engine) * vehicle::governorSlope(*s.engine),
        (s.engine->inertia + s.sprocket.inertia.y) * (s.engine->inertia + s.sprocket.inertia.y));
  add("idler", "stiffness", "N/m", s.idler.stiffness, s.idler.carrierMass + s.idler.mass);
  add("idler", "stop_stiffness", "N/m", s.idler.stopStiffness, s.idler.carrierMass + s.idler.mass);
}

/// Adds the oscillation of the hull on its hitch, which is integrated explicitly.
void addHitch(std::vector<TimeScale>& scales, const scene::Scene& scene) {
  if (!scene.vehicle || !scene.hitch) return;
  const vehicle::VehicleSpec spec = vehicle::readVehicleSpec(scene.vehicle->source());
  const scene::Hitch& h = *scene.hitch;
  if (scene.driver.driveBegins() + h.start < scene.run.duration && h.kind != vehicle::HitchKind::ramp)
    addRamp(scales, h.ramp, failsIn(scene, "hitch", "ramp"));
  if (const double stiffness = hitchStiffness(h, spec); stiffness > 0)
    addPeriod(scales, 2 * base::kPi * std::sqrt(hitchedMass(h, spec) / stiffness), "period", "N/m",
              failsIn(scene, "hitch", "stiffness"));
}

} // namespace

double greatestTrackSpeed(const scene::Scene& scene) {
  if (scene.driver.course) return std::fabs(scene.driver.course->speed);
  const scene::SpeedTable table = scene.driver.speeds();
  double rate = 0;
  for (std::size_t i = 0; i < table.time.size() && table.time[i] < scene.run.duration; ++i)
    rate = std::max({rate, std::fabs(table.left[i]), std::fabs(table.right[i])});
  return rate * vehicle::readVehicleSpec(scene.vehicle->source()).pitchRadius();
}

std::vector<TimeScale> timeScales(const scene::Scene& scene) {
  std::vector<TimeScale> scales;
  addSurfaces(scales, scene), addDrives(scales, scene), addDriver(scales, scene);
  addVehicle(scales, scene), addHitch(scales, scene);
  return scales;
}

double resolvingStep(const std::vector<TimeScale>& scales, double stepsPerPeriod) {
  double step = std::numeric_limits<double>::infinity();
  for (const TimeScale& s : scales) step = std::min(step, s.time / stepsPerPeriod);
  return step;
}

void checkTimeScales(const scene::Scene& scene, double timeStep) {
  // Relative tolerance of step numbers, since steps are printed and typed with a few digits.
  constexpr double kDigits = 1e-6;
  const double wanted = scene.run.stepsPerPeriod;
  for (const TimeScale& s : timeScales(scene)) {
    const double steps = s.time / timeStep;
    if (steps >= wanted * (1 - kDigits)) continue;
    s.fail(fmt::format("[{}] is under-resolved: {} spans {:.3g} of the required {:g} time steps of {:.4g} s "
                       "(run.steps_per_period); set run.time_step to {} s or less, or to \"auto\"{}, or lower "
                       "run.steps_per_period",
                       s.unit, s.what, steps, wanted, timeStep, base::roundedDown(s.time / wanted, 4),
                       s.repeats ? "" : ", or make it a jump (a time given twice, a ramp of 0 s)"));
  }
}

double largestTurn(const scene::RunSettings& run) { return 2 * base::kPi / run.stepsPerPeriod; }

} // namespace grouser::setup
