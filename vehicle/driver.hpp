// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vehicle/course.hpp"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace grouser::vehicle {

/// Speeds of the two sprockets over time: linear between the points, constant outside them.
/// Forward is positive: a turn about +y takes the top of the sprocket to +x and its bottom to -x, so that the track in
/// ground contact moves back under the hull.
struct SpeedTable {
  std::vector<double> time;  ///< [s] from the start of the drive, increasing; a repeated time is a jump
  std::vector<double> left;  ///< [rad/s]
  std::vector<double> right; ///< [rad/s]
};

/// Criteria for rest after settling, at which the vehicle drives off.
struct RestBounds {
  double speed = 0.01;  ///< largest speed of the hull's centre of mass along gravity [m/s]
  double load = 0.05;   ///< largest deviation of ground force / weight from 1 [-]
  double timeLimit = 5; ///< after the weight's ramp [s]
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
  double tensionRamp = 0.15;        ///< tensioner's preload from 0 to its full force [s]
  double weightRamp = 0.3;          ///< then weight and the arms' preload from 0 to full [s]
  double driveStart = 0.45;         ///< time at which the sprockets begin to turn [s], >= tensionRamp + weightRamp
  double driveRamp = 0.3;           ///< sprocket speed from 0 to the table's value [s]
  double changeRamp = 0.3;          ///< blending from the commands of another driver at takeover [s]
  std::optional<RestBounds> rest{}; ///< wait for rest, at least until driveStart
  SpeedTable speeds{{0}, {0}, {0}};
  SprocketDrive drive = SprocketDrive::speed;
  TorqueTable torques{{0}, {0}, {0}};    ///< for drive by torque
  std::optional<CourseOptions> course{}; ///< closed loop, instead of the speeds
};

/// Driver commands at one time.
struct Controls {
  double tension = 1;                              ///< factor on the tensioner's preload, 0..1
  double weight = 1;                               ///< factor on the vehicle's weight and the arms' preload, 0..1
  std::array<double, 2> sprocketSpeed{0, 0};       ///< left, right [rad/s]
  std::array<double, 2> torque{0, 0};              ///< left, right [N m]; for drive by torque
  bool held = true;                                ///< sprockets with torque drive are locked
  double drive = 0;                                ///< ramp of the drive, 0..1; included in speeds and torques
  std::array<std::optional<double>, 2> throttle{}; ///< of the engines, -1..1; empty: set by the governors
};

/// External commands that replace the driver's, left and right; empty: the driver's.
struct Commands {
  std::array<std::optional<double>, 2> sprocketSpeed{}; ///< [rad/s]
  std::array<std::optional<double>, 2> torque{};        ///< [N m]
  std::array<std::optional<double>, 2> throttle{};      ///< of the engines [-], -1..1
  /// Writes them to `controls` once the drive has begun, with its ramp.
  void layOver(Controls& controls) const;
};

/// Sprocket commands of a driver at takeover by another one.
struct Handover {
  bool driven = false;                       ///< false: the drive had not begun
  double time = 0;                           ///< [s]
  std::array<double, 2> sprocketSpeed{0, 0}; ///< left, right [rad/s]
  std::array<double, 2> torque{0, 0};        ///< [N m]
  double hullSpeed = 0;                      ///< along the heading [m/s]

  std::vector<double> save() const;
  /// Throws base::InputError if the size is wrong.
  static Handover of(const std::vector<double>& saved);
  static constexpr std::size_t kSaved = 7;
};

/// Tension, then weight, then drive, each with a smooth ramp: a step of the tension causes peaks of 16 kN, a ramp 7 kN;
/// a step of the drive to 5 rad/s 99 kN, a ramp of 0.8 s 11 kN.
class Driver {
public:
  /// Throws base::InputError on negative times, unequal columns or falling table times.
  explicit Driver(DriverOptions options);
  /// Controls without a course, which needs the hull's motion.
  Controls at(double time) const;
  /// The same for a step of `dt` [s] that begins at `time`, with course control. Call once per step.
  Controls step(double time, double dt, const HullMotion& motion);
  const Course* course() const { return course_ ? &*course_ : nullptr; }

  /// True while the drive waits for the vehicle to rest.
  bool waits() const { return options_.rest && !begun_; }
  /// Checks for rest at `time` [s]: hull speed along gravity [m/s], mean ground force since the last call over weight
  /// [-]. The drive starts when both have stayed within their bounds for kRestTime. Call at fixed steps. Returns an
  /// error message after the time limit, else "".
  std::string judge(double time, double speed, double load);
  /// Start time of the drive [s]; empty while the vehicle is not at rest.
  std::optional<double> driveStart() const { return options_.rest ? begun_ : options_.driveStart; }

  /// Takes over from a driver with other speeds, torques or course, whose save() is `former`. During the drive,
  /// commands blend over changeRamp; table times still count from the start of the drive, and a course starts at the
  /// hull's speed. Before the drive the former driver has no effect.
  void takeOver(const std::vector<double>& former, const Handover& from);
  /// End time of the speed ramp [s] for a drive that began at `start`.
  double rampEnds(double start) const { return from_ ? from_->time + options_.changeRamp : start + options_.driveRamp; }

  /// State variables, for checkpoint and hash: start time, time since rest, -1 for none; then the state of the course,
  /// and the takeover. Empty if the start is fixed and there is neither.
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

/// 3 s^2 - 2 s^3 of s = (time - start) / duration, held to 0 before and 1 after; a step where duration is 0.
double smoothRamp(double time, double start, double duration);

} // namespace grouser::vehicle
