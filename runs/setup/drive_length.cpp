// SPDX-License-Identifier: BSD-3-Clause
#include "runs/setup/drive_length.hpp"

#include "base/math.hpp"
#include "runs/scene/scene.hpp"
#include "runs/setup/placement.hpp"
#include "vehicle/driver.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace grouser::setup {

namespace {

bool anyIsNot0(const std::vector<double>& values) {
  return std::any_of(values.begin(), values.end(), [](double v) { return v != 0; });
}

/// Distance of the outer track / distance of the hull on a circle [-].
double outerTrack(const scene::Driver& driver, const vehicle::VehicleSpec& spec) {
  if (!driver.course || !driver.course->radius) return 1;
  return 1 + spec.trackOffset / std::fabs(*driver.course->radius);
}

/// Duration of the drive ramp [s].
double rampOf(const scene::Scene& scene) {
  const auto& course = scene.driver.course;
  return course ? std::fabs(course->speed) / course->acceleration : scene.driver.rampOfDrive();
}

} // namespace

bool commandsDrive(const scene::Scene& scene) {
  if (!scene.vehicle) return false;
  const scene::Driver& d = scene.driver;
  if (d.course) return d.course->speed != 0;
  if (d.drive == vehicle::SprocketDrive::torque) return anyIsNot0(d.torques().left) || anyIsNot0(d.torques().right);
  return anyIsNot0(d.speeds().left) || anyIsNot0(d.speeds().right);
}

double requestedTeeth(const scene::Scene& scene, bool steady) {
  const scene::Driver& d = scene.driver;
  const double time = scene.run.duration - d.driveBegins();
  if (!(time > 0)) return 0;
  if (d.drive == vehicle::SprocketDrive::torque) return base::kInfinity;
  const vehicle::VehicleSpec spec = vehicleSpec(scene);
  vehicle::DriverOptions options;
  options.tensionRamp = options.weightRamp = options.driveStart = 0, options.driveRamp = d.rampOfDrive();
  options.speeds = {d.speeds().time, d.speeds().left, d.speeds().right};
  const vehicle::Driver driver(options);
  const double outer = outerTrack(d, spec);
  const double from = steady ? rampOf(scene) : 0;
  constexpr int kParts = 2000;
  std::array<double, 2> turned{}; // [rad]
  for (int i = 0; i < kParts; ++i) {
    const double t = time * (i + 0.5) / kParts;
    if (t < from) continue;
    std::array<double, 2> speed = driver.at(t).sprocketSpeed;
    if (d.course)
      speed.fill(std::min(std::fabs(d.course->speed), d.course->acceleration * t) * outer / spec.pitchRadius());
    for (std::size_t side = 0; side < 2; ++side) turned[side] += std::fabs(speed[side]) * time / kParts;
  }
  return std::max(turned[0], turned[1]) * spec.sprocket.teeth / (2 * base::kPi);
}

std::string longerDriveRemedy(const scene::Scene& scene) {
  const auto& table = scene.driver.table;
  const bool standsAtLast = table && table->left.back() == 0 && table->right.back() == 0;
  return standsAtLast && scene.run.duration >= scene.driver.driveBegins() + table->time.back()
             ? "raise the speeds or times of driver.table"
             : "raise run.duration";
}

std::string shortDriveWarning(const scene::Scene& scene) {
  if (!commandsDrive(scene)) return {};
  const double teeth = requestedTeeth(scene);
  if (teeth >= kFewestTeeth) {
    if (requestedTeeth(scene, true) >= 1) return {};
    return fmt::format("the steady part of the drive covers less than one sprocket tooth (the ramp ends at {:.4g} s{}, "
                       "the run ends at {:g} s), so means over steady motion are inconclusive; {}",
                       scene.driver.driveBegins() + rampOf(scene), scene.driver.driveStart ? "" : " at the earliest",
                       scene.run.duration, longerDriveRemedy(scene));
  }
  return fmt::format(
      "the vehicle {} (its sprockets start at {:.4g} s{}, the run ends at {:g} s){}; {}",
      teeth >= kMinTeeth ? fmt::format("drives at most {:.2g} teeth", teeth) : "never drives",
      scene.driver.driveBegins(), scene.driver.driveStart ? "" : " at the earliest", scene.run.duration,
      teeth >= kMinTeeth ? fmt::format(", and results from fewer than {:g} teeth are inconclusive", kFewestTeeth) : "",
      longerDriveRemedy(scene));
}

} // namespace grouser::setup
