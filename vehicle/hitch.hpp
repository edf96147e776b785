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
  sled,  ///< a mass on a rope, which slides with friction
  speed  ///< a carriage at the speed of the tracks less a given slip
};

struct HitchOptions {
  HitchKind kind = HitchKind::force;
  base::Vec3d point;  ///< hitch point in the vehicle frame [m]
  double start{};     ///< time after the start of the drive [s], >= 0
  double ramp{};      ///< ramp of a force or of a carriage's own speed [s], >= 0
  double force{};     ///< backward positive [N]; initial value of a ramp
  double rate{};      ///< of a ramp [N/s]
  double mass{};      ///< of a sled [kg], > 0
  double friction{};  ///< of a sled on its ground [-], >= 0
  double length{};    ///< of its rope [m], > 0
  double slip{};      ///< track slip imposed by a carriage [-]
  double stiffness{}; ///< of rope or carriage [N/m], > 0
  double damping{};   ///< of either [N s/m], >= 0
};

/// Hitch point at the beginning of a step, in the world.
struct HitchMotion {
  base::Vec3d position;          ///< [m]
  base::Vec3d velocity;          ///< [m/s]
  double forwardX{}, forwardY{}; ///< the hull's heading, level, as a unit vector
  double trackSpeed{};           ///< mean of the sprockets' speeds times the pitch radius [m/s]
};

/// A horizontal force on a hull, and its source. With t the time since the hitch engaged, p and v the level place and
/// velocity of its point, d the hull's heading, s(t) the smooth ramp from 0 to 1:
///
///   force   F = -s(t) force d
///   ramp    F = -(force + rate t) d
///   sled    F = -T e,  T = max(0, k (l - length) + c l'),  l = |p - q|,  e = (p - q) / l
///           q'' = (T / mass) e + g - friction |g_z| q' / |q'|; at rest it stays there as long as T and g bear less
///   speed   F = -(k (x - w) + c (x' - w')) d_0,  x = (p - p_0) d_0,  w' = (1 - s) x'_0 + s (1 - slip) omega r
///
/// q is the sled's position on its own level, initially `length` behind the hitch with the same velocity; p_0, x'_0 and
/// d_0 are the values when the carriage engaged: it runs on a straight line from there, and its drive carries the pull.
/// A carriage holds the hull to within F / k; on average the hull has its speed. Sled and carriage step by symplectic
/// Euler; friction of the sled acts at the end of its step and can only stop it.
class Hitch {
public:
  /// Throws base::InputError on values out of their ranges.
  explicit Hitch(const HitchOptions& options);

  /// Force on the hull at the hitch point [N], for a step of `dt` [s] that begins `sinceDrive` [s] after the start of
  /// the drive (negative: before). Call once per step.
  base::Vec3d step(const HitchMotion& motion, double sinceDrive, double dt, const base::Vec3d& gravity);

  /// Overrides the force [N] of a hitch of kind force, or the speed [m/s] of a carriage, from the next step; empty:
  /// value of the options. Ramps still apply. Throws base::InputError for other kinds.
  void command(std::optional<double> value);
  /// Earliest engagement [s] after the start of the drive, for a branch that adds the hitch during the drive.
  void holdFrom(double sinceDrive) { late_ = std::max(0.0, sinceDrive - options_.start); }

  /// True once engaged.
  bool holds() const { return holds_; }
  /// Distance of sled (along its path) or carriage since engagement [m]; 0 for a force.
  double way() const { return way_; }
  double towedSpeed() const; ///< of sled or carriage [m/s]; 0 for a force

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
  base::Vec3d origin_;            ///< horizontal position of the hitch at engagement [m]
  base::Vec3d line_;              ///< heading at engagement
  double begun_{};                ///< speed of the hitch along it at engagement [m/s]
  base::Vec3d place_;             ///< of the sled, level [m]
  base::Vec3d motion_;            ///< its velocity [m/s]
  double way_{};                  ///< of sled or carriage [m]
  double speed_{};                ///< of the carriage [m/s]
  double late_{};                 ///< delay of engagement after options_.start [s]
  std::optional<double> command_; ///< see command()
};

} // namespace grouser::vehicle
