// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"

#include <algorithm>
#include <optional>
#include <vector>

namespace grouser::vehicle {

/// Type of hitch load.
enum class HitchKind {
  force, ///< constant force
  ramp,  ///< increasing force
  sled,  ///< mass on a rope, sliding with friction
  speed  ///< carriage at the track speed reduced by a given slip
};

struct HitchOptions {
  HitchKind kind = HitchKind::force;
  base::Vec3d point;  ///< hitch point in the vehicle frame [m]
  double start{};     ///< delay after the start of the drive [s], >= 0
  double ramp{};      ///< ramp duration of a force or of the carriage speed [s], >= 0
  double force{};     ///< backward positive [N]; initial value of a ramp
  double rate{};      ///< force rate of a ramp [N/s]
  double mass{};      ///< sled mass [kg], > 0
  double friction{};  ///< sled friction on its ground [-], >= 0
  double length{};    ///< rope length of a sled [m], > 0
  double slip{};      ///< track slip imposed by a carriage [-]
  double stiffness{}; ///< stiffness of rope or carriage [N/m], > 0
  double damping{};   ///< damping of rope or carriage [N s/m], >= 0
};

/// Motion of the hitch point at the beginning of a step, in the world.
struct HitchMotion {
  base::Vec3d position;          ///< [m]
  base::Vec3d velocity;          ///< [m/s]
  double forwardX{}, forwardY{}; ///< horizontal hull heading as a unit vector
  double trackSpeed{};           ///< mean sprocket speed times pitch radius [m/s]
};

/// Horizontal hitch force on a hull. With time t since the hitch engaged, horizontal position p and velocity v of the
/// hitch point, heading d, and smooth ramp s(t) from 0 to 1:
///
///   force   F = -s(t) force d
///   ramp    F = -(force + rate t) d
///   sled    F = -T e,  T = max(0, k (l - length) + c l'),  l = |p - q|,  e = (p - q) / l
///           q'' = (T / mass) e + g - friction |g_z| q' / |q'|; at rest it sticks while T and g are below friction
///   speed   F = -(k (x - w) + c (x' - w')) d_0,  x = (p - p_0) d_0,  w' = (1 - s) x'_0 + s (1 - slip) omega r
///
/// q is the horizontal position of the sled, initially `length` behind the hitch and with the velocity of the hitch.
/// p_0, x'_0 and d_0 are values at the engagement of the carriage, which moves on a straight line from p_0 at any pull.
/// The hull follows the carriage to within F / k; on average both have the same speed. Sled and carriage use symplectic
/// Euler; sled friction acts at the end of a step and stops the sled but never reverses it.
class Hitch {
public:
  /// Throws base::InputError for values out of range.
  explicit Hitch(const HitchOptions& options);

  /// Returns the force on the hull at the hitch point [N] for a step of `dt` [s] that begins `sinceDrive` [s] after the
  /// start of the drive (negative: before the start). Call once per step.
  base::Vec3d step(const HitchMotion& motion, double sinceDrive, double dt, const base::Vec3d& gravity);

  /// Overrides the force [N] of a hitch of kind force, or the speed [m/s] of a carriage, from the next step; empty
  /// restores the option value. Ramps still apply. Throws base::InputError for other kinds.
  void command(std::optional<double> value);
  /// Sets the earliest engagement [s] after the start of the drive, for a branch that adds the hitch while driving.
  void holdFrom(double sinceDrive) { late_ = std::max(0.0, sinceDrive - options_.start); }

  /// True once the hitch has engaged.
  bool holds() const { return holds_; }
  /// Distance travelled by sled (along its path) or carriage since engagement [m]; 0 for a force.
  double way() const { return way_; }
  double towedSpeed() const; ///< speed of sled or carriage [m/s]; 0 for a force

  /// State variables.
  std::vector<double> save() const;
  void restore(const std::vector<double>& saved);
  const HitchOptions& options() const { return options_; }

private:
  void takeHold(const HitchMotion& motion);
  base::Vec3d pullSled(const HitchMotion& motion, double dt, const base::Vec3d& gravity);
  base::Vec3d pullCarriage(const HitchMotion& motion, double since, double dt);

  HitchOptions options_;
  bool holds_ = false;
  base::Vec3d origin_;            ///< horizontal position of the hitch point at engagement [m]
  base::Vec3d line_;              ///< heading at engagement
  double begun_{};                ///< speed of the hitch point along line_ at engagement [m/s]
  base::Vec3d place_;             ///< horizontal position of the sled [m]
  base::Vec3d motion_;            ///< velocity of the sled [m/s]
  double way_{};                  ///< distance of sled or carriage since engagement [m]
  double speed_{};                ///< speed of the carriage [m/s]
  double late_{};                 ///< delay of engagement after options_.start [s]
  std::optional<double> command_; ///< see command()
};

} // namespace grouser::vehicle
