// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle/driver.hpp"

#include "base/error.hpp"
#include "multibody/time_law.hpp"

#include <cmath>
#include <fmt/format.h>
#include <utility>

namespace grouser::vehicle {
namespace {

double tableValue(const std::vector<double>& time, const std::vector<double>& value, double t) {
  if (t <= time.front()) return value.front();
  for (std::size_t i = 1; i < time.size(); ++i)
    if (t < time[i]) return value[i - 1] + (value[i] - value[i - 1]) * ((t - time[i - 1]) / (time[i] - time[i - 1]));
  return value.back();
}

} // namespace

double smoothRamp(double time, double start, double duration) {
  if (time < start) return 0;
  if (time >= start + duration) return 1;
  const double s = (time - start) / duration;
  return s * s * (3 - 2 * s);
}

Driver::Driver(DriverOptions options) : options_(std::move(options)) {
  const SpeedTable& table = options_.speeds;
  const TorqueTable& torques = options_.torques;
  if (options_.tensionRamp < 0 || options_.weightRamp < 0 || options_.driveRamp < 0)
    throw base::InputError("driver: ramp durations must be >= 0 s");
  if (options_.driveStart < options_.tensionRamp + options_.weightRamp)
    throw base::InputError(
        "driver: the drive starts before the tension and weight ramps end; set drive_start >= tension_ramp + "
        "weight_ramp");
  if (table.time.empty() || table.left.size() != table.time.size() || table.right.size() != table.time.size())
    throw base::InputError("driver: the speed table needs at least one time, and a left and a right speed for each");
  if (multibody::firstOutOfOrder(table.time, true) > 0)
    throw base::InputError("driver: the times of the speed table must increase; repeat a time for a jump");
  if (torques.time.empty() || torques.left.size() != torques.time.size() ||
      torques.right.size() != torques.time.size() || multibody::firstOutOfOrder(torques.time, true) > 0)
    throw base::InputError("driver: the torque table needs increasing times, and a left and a right torque for each");
  if (options_.course) {
    if (options_.drive == SprocketDrive::torque)
      throw base::InputError("driver: a course requires drive by speed or engine, not by torque");
    course_.emplace(*options_.course);
  }
}

std::string Driver::judge(double time, double speed, double load) {
  if (!waits() || time < options_.driveStart) return "";
  const RestBounds& rest = *options_.rest;
  if (!(std::fabs(speed) <= rest.speed && std::fabs(load - 1) <= rest.load)) {
    restsSince_.reset();
    if (time <= options_.driveStart + rest.timeLimit) return "";
    return fmt::format(
        "the vehicle has not come to rest within driver.rest_time_limit = {:g} s: hull speed along gravity {:.3g} "
        "m/s (driver.rest_speed = {:g}), ground force {:.3g} times the weight (1 +- driver.rest_load = {:g}); "
        "raise these limits, or set driver.drive_start",
        rest.timeLimit, speed, rest.speed, load, rest.load);
  }
  if (!restsSince_) restsSince_ = time;
  if (time >= *restsSince_ + kRestTime) begun_ = time;
  return "";
}

std::vector<double> Handover::save() const {
  return {driven ? 1.0 : 0.0, time, sprocketSpeed[0], sprocketSpeed[1], torque[0], torque[1], hullSpeed};
}

Handover Handover::of(const std::vector<double>& s) {
  if (s.size() != kSaved)
    throw base::InputError("driver: the checkpoint lacks the sprocket commands; resume with the program that wrote it");
  return {s[0] != 0, s[1], {s[2], s[3]}, {s[4], s[5]}, s[6]};
}

std::vector<double> Driver::save() const {
  std::vector<double> saved;
  if (options_.rest) saved = {begun_.value_or(-1), restsSince_.value_or(-1)};
  if (course_)
    for (const double value : course_->save()) saved.push_back(value);
  if (from_)
    for (const double value : from_->save()) saved.push_back(value);
  return saved;
}

void Driver::restore(const std::vector<double>& saved) {
  const std::size_t start = options_.rest ? 2 : 0, own = start + (course_ ? Course::kSaved : 0);
  if (saved.size() != own && saved.size() != own + Handover::kSaved)
    throw base::InputError(
        "driver: the checkpoint was written with a different kind of drive_start or course; resume with "
        "the scene that wrote the checkpoint");
  from_.reset();
  if (saved.size() > own) from_ = Handover::of({saved.begin() + static_cast<std::ptrdiff_t>(own), saved.end()});
  if (course_) course_->restore(saved.data() + start);
  restoreStart(saved);
}

void Driver::takeOver(const std::vector<double>& former, const Handover& from) {
  restoreStart(former);
  if (from.driven) from_ = from;
}

void Driver::restoreStart(const std::vector<double>& saved) {
  if (!options_.rest) return;
  if (saved.size() < 2)
    throw base::InputError("driver: the checkpoint was written with a fixed drive_start, but this scene has \"auto\"; "
                           "resume with the scene that wrote the checkpoint");
  begun_ = saved[0] < 0 ? std::nullopt : std::optional(saved[0]);
  restsSince_ = saved[1] < 0 ? std::nullopt : std::optional(saved[1]);
}

Controls Driver::at(double time) const {
  Controls controls;
  controls.tension = smoothRamp(time, 0, options_.tensionRamp);
  controls.weight = smoothRamp(time, options_.tensionRamp, options_.weightRamp);
  const std::optional<double> start = driveStart();
  if (!start) return controls;
  controls.held = time < *start;
  controls.drive = smoothRamp(time, *start, options_.driveRamp);
  const double t = time - *start;
  controls.sprocketSpeed = {tableValue(options_.speeds.time, options_.speeds.left, t),
                            tableValue(options_.speeds.time, options_.speeds.right, t)};
  if (options_.drive == SprocketDrive::torque)
    controls.torque = {tableValue(options_.torques.time, options_.torques.left, t),
                       tableValue(options_.torques.time, options_.torques.right, t)};
  if (from_) {
    passInto(controls.sprocketSpeed, from_->sprocketSpeed, time);
    if (options_.drive == SprocketDrive::torque) passInto(controls.torque, from_->torque, time);
    return controls;
  }
  for (std::size_t side = 0; side < 2; ++side)
    controls.sprocketSpeed[side] *= controls.drive, controls.torque[side] *= controls.drive;
  return controls;
}

void Commands::layOver(Controls& controls) const {
  if (controls.held) return;
  for (std::size_t side = 0; side < 2; ++side) {
    if (sprocketSpeed[side]) controls.sprocketSpeed[side] = controls.drive * *sprocketSpeed[side];
    if (torque[side]) controls.torque[side] = controls.drive * *torque[side];
    if (throttle[side]) controls.throttle[side] = controls.drive * *throttle[side];
  }
}

/// Blends the commands of a former driver into the commands of this driver.
void Driver::passInto(std::array<double, 2>& asked, const std::array<double, 2>& former, double time) const {
  const double share = smoothRamp(time, from_->time, options_.changeRamp);
  for (std::size_t side = 0; side < 2; ++side) asked[side] = former[side] + share * (asked[side] - former[side]);
}

Controls Driver::step(double time, double dt, const HullMotion& motion) {
  Controls controls = at(time);
  if (!course_ || controls.held) return controls;
  const double began = from_ ? from_->time : *driveStart();
  controls.sprocketSpeed = course_->sprocketSpeeds(motion, time - began, dt, from_ ? from_->hullSpeed : 0);
  if (from_) passInto(controls.sprocketSpeed, from_->sprocketSpeed, time);
  return controls;
}

} // namespace grouser::vehicle
