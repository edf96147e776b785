// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vehicle/course.hpp"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace grouser::vehicle {

/// Speeds of the two sprockets over time: linear between the points, constant outside them. Positive is forward: a
/// rotation about +y moves the top of the sprocket towards +x and its bottom towards -x, so that the track in ground
/// contact moves backward under the hull.
struct SpeedTable {
  std::vector<double> time;  ///< [s] from the start of the drive, increasing; a repeated time is a jump
  std::vector<double> left;  ///< [rad/s]
  std::vector<double> right; ///< [rad/s]
};

/// Criteria for a vehicle at rest; the drive starts when they are satisfied.
struct RestBounds {
  double speed = 0.01;  ///< maximum speed of the hull's centre of mass along gravity [m/s]
  double load = 0.05;   ///< maximum deviation of ground force / weight from 1 [-]
  double timeLimit = 5; ///< maximum waiting time after the weight ramp [s]
};

/// Type of sprocket command.
enum class SprocketDrive {
  speed,  ///< imposed speeds
  torque, ///< torques
  engine  ///< engine torques, with governors at the commanded speeds
};

/// Torques of the two sprockets over time, like SpeedTable.
struct TorqueTable {
  std::vector<double> time;  ///< [s]
  std::vector<double> left;  ///< [N m], forward positive
  std::vector<double> right; ///< [N m]
};

struct DriverOptions {
  double tensionRamp = 0.15;        ///< duration of the tensioner preload ramp from 0 to 1 [s]
  double weightRamp = 0.3;          ///< subsequent ramp of weight and arm preload from 0 to 1 [s]
  double driveStart = 0.45;         ///< start time of the sprockets [s], >= tensionRamp + weightRamp
  double driveRamp = 0.3;           ///< duration of the sprocket speed ramp from 0 to the table's value [s]
  double changeRamp = 0.3;          ///< duration of the blend from another driver's commands at takeover [s]
  std::optional<RestBounds> rest{}; ///< if set, waits for rest, at least until driveStart
  SpeedTable speeds{{0}, {0}, {0}};
  SprocketDrive drive = SprocketDrive::speed;
  TorqueTable torques{{0}, {0}, {0}};    ///< table for SprocketDrive::torque
  std::optional<CourseOptions> course{}; ///< closed-loop control instead of the speed table
};

/// Driver commands at one time.
struct Controls {
  double tension = 1;                              ///< factor of the tensioner preload, 0..1
  double weight = 1;                               ///< factor of the vehicle weight and the arm preload, 0..1
  std::array<double, 2> sprocketSpeed{0, 0};       ///< left, right [rad/s]
  std::array<double, 2> torque{0, 0};              ///< left, right [N m]; for torque drive
  bool held = true;                                ///< true: sprockets with torque drive are locked
  double drive = 0;                                ///< drive ramp factor, 0..1; included in speeds and torques
  std::array<std::optional<double>, 2> throttle{}; ///< engine throttles, -1..1; empty: set by the governors
};

/// External commands, left and right, that override the driver; empty: no override.
struct Commands {
  std::array<std::optional<double>, 2> sprocketSpeed{}; ///< [rad/s]
  std::array<std::optional<double>, 2> torque{};        ///< [N m]
  std::array<std::optional<double>, 2> throttle{};      ///< engine throttles [-], -1..1
  /// Writes the commands to `controls` once the drive has started, scaled by the drive ramp.
  void layOver(Controls& controls) const;
};

/// Sprocket commands of a driver when another driver takes over.
struct Handover {
  bool driven = false;                       ///< false: the drive had not started
  double time = 0;                           ///< [s]
  std::array<double, 2> sprocketSpeed{0, 0}; ///< left, right [rad/s]
  std::array<double, 2> torque{0, 0};        ///< [N m]
  double hullSpeed = 0;                      ///< hull speed along the heading [m/s]

  std::vector<double> save() const;
  /// Throws base::InputError if the size does not match.
  static Handover of(const std::vector<double>& saved);
  static constexpr std::size_t kSaved = 7;
};

/// Open- or closed-loop driver that applies tension, then weight, then drive, each with a smooth ramp. Without ramps,
/// force peaks are higher: tension 16 kN instead of 7 kN, drive to 5 rad/s 99 kN instead of 11 kN (ramp of 0.8 s).
class Driver {
public:
  /// Throws base::InputError for negative times, columns of unequal length or decreasing table times.
  explicit Driver(DriverOptions options);
  /// Returns the controls without a course, which requires the hull motion.
  Controls at(double time) const;
  /// Returns the controls for a step of `dt` [s] that begins at `time`, with course control. Call once per step.
  Controls step(double time, double dt, const HullMotion& motion);
  const Course* course() const { return course_ ? &*course_ : nullptr; }

  /// True while the driver waits for the vehicle to come to rest.
  bool waits() const { return options_.rest && !begun_; }
  /// Checks for rest at `time` [s], from the hull speed along gravity [m/s] and the mean ground force / weight [-]
  /// since the last call. The drive starts when both have been within their bounds for kRestTime. Call at fixed
  /// intervals. Returns an error message after the time limit, else "".
  std::string judge(double time, double speed, double load);
  /// Start time of the drive [s]; empty until the vehicle is at rest.
  std::optional<double> driveStart() const { return options_.rest ? begun_ : options_.driveStart; }

  /// Takes over from a driver with other speeds, torques or course; `former`: save() of that driver. If the drive has
  /// started, commands blend over changeRamp; table times still count from the start of the drive, and a course starts
  /// at the current hull speed. If the drive has not started, the former driver has no effect.
  void takeOver(const std::vector<double>& former, const Handover& from);
  /// End time of the speed ramp [s] for a drive that began at `start`.
  double rampEnds(double start) const { return from_ ? from_->time + options_.changeRamp : start + options_.driveRamp; }

  /// State variables for checkpoints and hashes: start time and time since rest (-1: not at rest), state of the course,
  /// and takeover. Empty if the start is fixed and the driver has neither a course nor a takeover.
  std::vector<double> save() const;
  void restore(const std::vector<double>& saved);
  const DriverOptions& options() const { return options_; }

private:
  void restoreStart(const std::vector<double>& saved);
  void passInto(std::array<double, 2>& asked, const std::array<double, 2>& former, double time) const;
  static constexpr double kRestTime = 0.05; ///< [s]

  DriverOptions options_;
  std::optional<Course> course_;
  std::optional<double> begun_, restsSince_; ///< [s]
  std::optional<Handover> from_;             ///< former driver, after takeover during the drive
};

/// 3 s^2 - 2 s^3 with s = (time - start) / duration clamped to [0, 1]; a step if duration is 0.
double smoothRamp(double time, double start, double duration);

} // namespace grouser::vehicle
