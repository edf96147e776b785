// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vehicle/course.hpp"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace grouser::vehicle {

/// Speeds of the two sprockets over time: linear between the points, constant outside them.
/// Forward is positive: a turn about +y takes the top of the sprocket to +x and its bottom to -x, so that the ground
/// run moves back under the hull.
struct SpeedTable {
  std::vector<double> time;  ///< [s] from the begin of the drive, rising; a time given twice is a jump
  std::vector<double> left;  ///< [rad/s]
  std::vector<double> right; ///< [rad/s]
};

/// When a vehicle that was set down rests: it drives off then.
struct RestBounds {
  double speed = 0.01;  ///< of the hull's centre of mass along gravity, at most [m/s]
  double load = 0.05;   ///< ground force / weight, from 1 at most [-]
  double timeLimit = 5; ///< after the weight's ramp [s]
};

/// What the driver gives the sprockets.
enum class SprocketDrive {
  speed,  ///< their speeds, whatever torque that takes
  torque, ///< torques
  engine  ///< what engines give that governors hold at the speeds
};

/// Torques of the two sprockets over time, as a SpeedTable.
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
  double changeRamp = 0.3;          ///< the same from those of another driver, which it takes over from [s]
  std::optional<RestBounds> rest{}; ///< wait until it rests, and no less than until driveStart
  SpeedTable speeds{{0}, {0}, {0}};
  SprocketDrive drive = SprocketDrive::speed;
  TorqueTable torques{{0}, {0}, {0}};    ///< where torques are given
  std::optional<CourseOptions> course{}; ///< closed loop, instead of the speeds
};

/// What the driver asks for at one time.
struct Controls {
  double tension = 1;                              ///< factor on the tensioner's preload, 0..1
  double weight = 1;                               ///< factor on the vehicle's weight and the arms' preload, 0..1
  std::array<double, 2> sprocketSpeed{0, 0};       ///< left, right [rad/s]
  std::array<double, 2> torque{0, 0};              ///< left, right [N m]; where not speeds are given
  bool held = true;                                ///< sprockets that torques drive are held still
  double drive = 0;                                ///< ramp of the drive, 0..1; speeds and torques have it in them
  std::array<std::optional<double>, 2> throttle{}; ///< of the engines, -1..1; empty: the governors'
};

/// What is set from outside in place of the driver, left and right; empty: the driver's.
struct Commands {
  std::array<std::optional<double>, 2> sprocketSpeed{}; ///< [rad/s]
  std::array<std::optional<double>, 2> torque{};        ///< [N m]
  std::array<std::optional<double>, 2> throttle{};      ///< of the engines [-], -1..1
  /// Puts them into `controls` once the drive has begun, with its ramp.
  void layOver(Controls& controls) const;
};

/// What the sprockets were given by a driver that another one takes over from.
struct Handover {
  bool driven = false;                       ///< false: they were held still, the drive had not begun
  double time = 0;                           ///< [s]
  std::array<double, 2> sprocketSpeed{0, 0}; ///< left, right [rad/s]
  std::array<double, 2> torque{0, 0};        ///< [N m]
  double hullSpeed = 0;                      ///< along the heading [m/s]

  std::vector<double> save() const;
  /// Throws base::InputError where these are not its numbers.
  static Handover of(const std::vector<double>& saved);
  static constexpr std::size_t kSaved = 7;
};

/// Tension, then weight, then drive, each on a smooth ramp: a step of the tension gives peaks of 16 kN where a ramp
/// gives 7 kN, a step of the drive to 5 rad/s 99 kN where a ramp of 0.8 s gives 11 kN.
class Driver {
public:
  /// Throws base::InputError on negative times, unequal columns or falling table times.
  explicit Driver(DriverOptions options);
  /// Without a course, which needs the hull's motion.
  Controls at(double time) const;
  /// The same for a step of `dt` [s] that begins at `time`, with a course that follows the hull. Once a step.
  Controls step(double time, double dt, const HullMotion& motion);
  const Course* course() const { return course_ ? &*course_ : nullptr; }

  /// Whether the drive waits for a vehicle at rest.
  bool waits() const { return options_.rest && !begun_; }
  /// Tells a driver that waits how the vehicle lies at `time` [s]: hull's speed along gravity [m/s], mean ground force
  /// since the last call over the weight [-]. It drives off when both have lain within their bounds for kRestTime. To
  /// be called at fixed steps. Returns what is wrong when the time limit has passed, else "".
  std::string judge(double time, double speed, double load);
  /// When the drive began, or begins for sure [s]; empty while the vehicle is not at rest.
  std::optional<double> driveStart() const { return options_.rest ? begun_ : options_.driveStart; }

  /// Takes over from a driver of other speeds, torques or course, whose save() is `former`. Under way what was asked
  /// for then passes into what this one asks for over changeRamp; the times of tables still count from the begin of the
  /// drive, a course takes up its speed from the hull's. Before the drive all is as if it had been there from the
  /// start.
  void takeOver(const std::vector<double>& former, const Handover& from);
  /// When the speeds are those of the table [s], of a drive that began at `start`.
  double rampEnds(double start) const { return from_ ? from_->time + options_.changeRamp : start + options_.driveRamp; }

  /// All that changes, for checkpoint and hash: when it began, since when it has been at rest, -1 for never; then what
  /// a course remembers, and what it took over under way. Empty where the start is fixed and there is neither.
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
  std::optional<Handover> from_;             ///< of a driver that it took over from under way
};

/// 3 s^2 - 2 s^3 of s = (time - start) / duration, held to 0 before and 1 after; a step where duration is 0.
double smoothRamp(double time, double start, double duration);

} // namespace grouser::vehicle
