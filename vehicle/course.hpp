// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace grouser::vehicle {

/// Targets of a closed-loop driver: hull speed, and a circle or a path of points.
struct CourseOptions {
  double speed{};            ///< target hull speed [m/s]; negative is backward; > 0 on a path
  double acceleration{};     ///< for starting, and for stopping at the end of a path [m/s2]
  double curvature{};        ///< of a circle [1/m], left positive; unused on a path
  std::vector<double> x, y;  ///< corners of a path in the world [m]; none, or two at least
  double lookAhead{};        ///< look-ahead distance along the path [m]
  double speedGain{};        ///< gain of the speed error [-]
  double speedIntegral{};    ///< of its integral [1/s]
  double turnGain{};         ///< gain of the turn rate error [-]
  double turnIntegral{};     ///< of its integral [1/s]
  double maxSprocketSpeed{}; ///< sprocket speed limit [rad/s]
  // Vehicle data:
  double tread{};       ///< distance of the tracks' middles [m]
  double pitchRadius{}; ///< [m]
};

/// Hull motion for the driver, at the middle of the ground contact length, on the hull's centre line.
struct HullMotion {
  double x{}, y{};               ///< in the world [m]
  double forwardX{}, forwardY{}; ///< the heading as a unit vector
  double speed{};                ///< along the heading [m/s]
  double turnRate{};             ///< about the vertical, to the left positive [rad/s]
};

/// Controls hull speed and course by the sprocket speeds. At each step, with the target speed v* and the target turn
/// rate r*,
///   v = v* + speedGain e + speedIntegral int e dt,    e = v* - speed,
///   r = r* + turnGain f + turnIntegral int f dt,      f = r* - turnRate,
///   left, right = (v -+ r tread / 2) / pitchRadius.
/// v* rises with the acceleration a to its value, and falls to a path's end as sqrt(2 a way). r* is v* / radius on a
/// circle. On a path it is v* times the curvature of the arc that leads from the hull, along its heading, through the
/// path's point `lookAhead` further on (pure pursuit; Coulter 1992): 2 left / distance^2 with `left` how far that point
/// lies to the left. The integrals compensate slip; they are frozen while a sprocket command exceeds maxSprocketSpeed,
/// and both sides are then scaled down equally.
class Course {
public:
  explicit Course(CourseOptions options);

  /// Sprocket speeds left and right [rad/s], for a step of `dt` [s] that begins `time` [s] after the start of the
  /// drive, or after takeover of a hull with speed `from` [m/s].
  std::array<double, 2> sprocketSpeeds(const HullMotion& motion, double time, double dt, double from = 0);

  /// Arc length of the path point nearest to the hull; never decreases [m].
  double travelled() const { return travelled_; }
  double length() const; ///< of the path [m]

  /// State variables.
  std::vector<double> save() const { return {speedSum_, turnSum_, travelled_}; }
  void restore(const double* saved) { speedSum_ = saved[0], turnSum_ = saved[1], travelled_ = saved[2]; }
  static constexpr std::size_t kSaved = 3;

  const CourseOptions& options() const { return options_; }

private:
  struct Place {
    double x, y, alongX, alongY; ///< and path direction there
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
