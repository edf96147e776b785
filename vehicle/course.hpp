// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace grouser::vehicle {

/// Targets of a closed-loop driver: hull speed, and a circle or a path through given points.
struct CourseOptions {
  double speed{};            ///< target hull speed [m/s]; negative is backward; > 0 on a path
  double acceleration{};     ///< acceleration at the start, deceleration at the end of a path [m/s2]
  double curvature{};        ///< curvature of a circle [1/m], left positive; unused on a path
  std::vector<double> x, y;  ///< corners of a path in the world [m]; none, or at least two
  double lookAhead{};        ///< look-ahead distance along the path [m]
  double speedGain{};        ///< proportional gain for the speed error [-]
  double speedIntegral{};    ///< integral gain for the speed error [1/s]
  double turnGain{};         ///< proportional gain for the yaw-rate error [-]
  double turnIntegral{};     ///< integral gain for the yaw-rate error [1/s]
  double maxSprocketSpeed{}; ///< sprocket speed limit [rad/s]
  // Vehicle dimensions:
  double tread{};       ///< distance between the track centre lines [m]
  double pitchRadius{}; ///< [m]
};

/// Hull motion for the driver, at the middle of the track-ground contact length, on the hull's centre plane.
struct HullMotion {
  double x{}, y{};               ///< position in the world [m]
  double forwardX{}, forwardY{}; ///< heading as a unit vector
  double speed{};                ///< speed along the heading [m/s]
  double turnRate{};             ///< turn rate about the vertical, left positive [rad/s]
};

/// Controls hull speed and course by the sprocket speeds. In each step, with target speed v* and target turn rate
/// r*,
///   v = v* + speedGain e + speedIntegral int e dt,    e = v* - speed,
///   r = r* + turnGain f + turnIntegral int f dt,      f = r* - turnRate,
///   left, right = (v -+ r tread / 2) / pitchRadius.
/// v* rises with the acceleration a, and decreases towards the end of a path as sqrt(2 a distance). On a circle, r* is
/// v* / radius. On a path, r* is v* times the curvature 2 left / distance^2 of the arc that is tangent to the hull's
/// heading and ends at the path point `lookAhead` further on (pure pursuit; Coulter 1992); `left` is the lateral
/// offset of this point. The integrals compensate slip. While a sprocket command exceeds maxSprocketSpeed, the
/// integrals are frozen, and the commands of both sides are reduced by the same factor.
class Course {
public:
  explicit Course(CourseOptions options);

  /// Returns the left and right sprocket speeds [rad/s] for a step of `dt` [s] that begins `time` [s] after the
  /// start of the drive, or after a takeover at a hull speed `from` [m/s].
  std::array<double, 2> sprocketSpeeds(const HullMotion& motion, double time, double dt, double from = 0);

  /// Arc length of the path point nearest to the hull [m]; never decreases.
  double travelled() const { return travelled_; }
  double length() const; ///< path length [m]

  /// State variables.
  std::vector<double> save() const { return {speedSum_, turnSum_, travelled_}; }
  void restore(const double* saved) { speedSum_ = saved[0], turnSum_ = saved[1], travelled_ = saved[2]; }
  static constexpr std::size_t kSaved = 3;

  const CourseOptions& options() const { return options_; }

private:
  struct Place {
    double x, y, alongX, alongY; ///< point on the path, and path direction
  };
  Place placeAt(double way) const; ///< extrapolated beyond the end
  void follow(const HullMotion& motion);
  bool onPath() const { return options_.x.size() > 1; }

  CourseOptions options_;
  std::vector<double> ways_; ///< arc lengths of the corners [m]
  double speedSum_ = 0;      ///< speedIntegral int e dt [m/s]
  double turnSum_ = 0;       ///< turnIntegral int f dt [rad/s]
  double travelled_ = 0;     ///< [m]
};

} // namespace grouser::vehicle
