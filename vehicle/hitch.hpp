// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/vec.hpp"

#include <algorithm>
#include <optional>
#include <vector>

namespace grouser::vehicle {

/// What hangs on the hitch.
enum class HitchKind {
  force, ///< a force that does not change
  ramp,  ///< a force that grows
  sled,  ///< a mass on a rope, which slides with friction
  speed  ///< a carriage at the speed of the tracks less a given slip
};

struct HitchOptions {
  HitchKind kind = HitchKind::force;
  base::Vec3d point;  ///< where it pulls, in the vehicle frame [m]
  double start{};     ///< after the begin of the drive [s], >= 0
  double ramp{};      ///< over which a force or a carriage's own speed comes on [s], >= 0
  double force{};     ///< backwards positive [N]; of a ramp at its begin
  double rate{};      ///< of a ramp [N/s]
  double mass{};      ///< of a sled [kg], > 0
  double friction{};  ///< of a sled on its ground [-], >= 0
  double length{};    ///< of its rope [m], > 0
  double slip{};      ///< of the tracks, that a carriage imposes [-]
  double stiffness{}; ///< of rope or carriage [N/m], > 0
  double damping{};   ///< of either [N s/m], >= 0
};

/// The hitch point as a step begins, in the world.
struct HitchMotion {
  base::Vec3d position;          ///< [m]
  base::Vec3d velocity;          ///< [m/s]
  double forwardX{}, forwardY{}; ///< the hull's heading, level, as a unit vector
  double trackSpeed{};           ///< mean of the sprockets' speeds times the pitch radius [m/s]
};

/// A level force on a hull, and what exerts it. With t the time since the hitch took hold, p and v the level place and
/// velocity of its point, d the hull's heading, s(t) the smooth ramp from 0 to 1:
///
///   force   F = -s(t) force d
///   ramp    F = -(force + rate t) d
///   sled    F = -T e,  T = max(0, k (l - length) + c l'),  l = |p - q|,  e = (p - q) / l
///           q'' = (T / mass) e + g - friction |g_z| q' / |q'|; at rest it stays there as long as T and g bear less
///   speed   F = -(k (x - w) + c (x' - w')) d_0,  x = (p - p_0) d_0,  w' = (1 - s) x'_0 + s (1 - slip) omega r
///
/// q is the sled's place on a level of its own, at first `length` behind the hitch and as fast as that; p_0, x'_0 and
/// d_0 are those of the moment when the carriage took hold: it runs on a straight line from there, and what drives it
/// bears the pull. A carriage holds the hull to within F / k; by its time average the speed of the hull is its own.
/// Sled and carriage step by symplectic Euler; the friction of the sled is taken at the end of its step, never farther
/// than to rest.
class Hitch {
public:
  /// Throws base::InputError on values out of their ranges.
  explicit Hitch(const HitchOptions& options);

  /// Force on the hull at the hitch point [N], for a step of `dt` [s] that begins `sinceDrive` [s] after the drive
  /// (negative: before it). Once a step.
  base::Vec3d step(const HitchMotion& motion, double sinceDrive, double dt, const base::Vec3d& gravity);

  /// From the next step on the force [N] of a hitch of kind force, or the speed [m/s] of a carriage, in place of what
  /// the options say; empty: as they say. Ramps stay. Throws base::InputError on another kind.
  void command(std::optional<double> value);
  /// Keeps it from taking hold before this time after the drive [s], in a branch that adds it under way.
  void holdFrom(double sinceDrive) { late_ = std::max(0.0, sinceDrive - options_.start); }

  /// Has it taken hold?
  bool holds() const { return holds_; }
  /// Way of sled or carriage since the hitch took hold [m]: of a sled along its path; 0 of a force.
  double way() const { return way_; }
  double towedSpeed() const; ///< of sled or carriage [m/s]; 0 of a force

  /// All that changes.
  std::vector<double> save() const;
  void restore(const std::vector<double>& saved);
  const HitchOptions& options() const { return options_; }

private:
  void takeHold(const HitchMotion& motion);
  base::Vec3d pullSled(const HitchMotion& motion, double dt, const base::Vec3d& gravity);
  base::Vec3d pullCarriage(const HitchMotion& motion, double since, double dt);

  HitchOptions options_;
  bool holds_ = false;
  base::Vec3d origin_;            ///< level place of the hitch when it took hold [m]
  base::Vec3d line_;              ///< its heading then
  double begun_{};                ///< speed of the hitch along it then [m/s]
  base::Vec3d place_;             ///< of the sled, level [m]
  base::Vec3d motion_;            ///< its velocity [m/s]
  double way_{};                  ///< of sled or carriage [m]
  double speed_{};                ///< of the carriage [m/s]
  double late_{};                 ///< behind options_.start, when it takes hold [s]
  std::optional<double> command_; ///< see command()
};

} // namespace grouser::vehicle
