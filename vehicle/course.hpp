// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace grouser::vehicle {

/// What a closed-loop driver is to hold: the hull's speed, and a circle or a path of points.
struct CourseOptions {
  double speed{};            ///< of the hull [m/s]; backwards below 0, on a path above 0
  double acceleration{};     ///< at which that speed is taken up, and given up at a path's end [m/s2]
  double curvature{};        ///< of a circle [1/m], to the left positive; without meaning on a path
  std::vector<double> x, y;  ///< corners of a path in the world [m]; none, or two at least
  double lookAhead{};        ///< along the path [m]
  double speedGain{};        ///< of the error of speed [-]
  double speedIntegral{};    ///< of its integral [1/s]
  double turnGain{};         ///< of the error of the rate of turn [-]
  double turnIntegral{};     ///< of its integral [1/s]
  double maxSprocketSpeed{}; ///< of a sprocket [rad/s]
  // Of the vehicle:
  double tread{};       ///< distance of the tracks' middles [m]
  double pitchRadius{}; ///< [m]
};

/// The hull as a driver sees it: the middle of the ground run, on the hull's centre line.
struct HullMotion {
  double x{}, y{};               ///< in the world [m]
  double forwardX{}, forwardY{}; ///< the heading as a unit vector
  double speed{};                ///< along the heading [m/s]
  double turnRate{};             ///< about the vertical, to the left positive [rad/s]
};

/// Holds a hull's speed and course by the speeds of the sprockets. At each step, with the wanted speed v* and the
/// wanted rate of turn r*,
///   v = v* + speedGain e + speedIntegral int e dt,    e = v* - speed,
///   r = r* + turnGain f + turnIntegral int f dt,      f = r* - turnRate,
///   left, right = (v -+ r tread / 2) / pitchRadius.
/// v* rises with the acceleration a to its value, and falls to a path's end as sqrt(2 a way). r* is v* / radius on a
/// circle. On a path it is v* times the curvature of the arc that leads from the hull, along its heading, through the
/// path's point `lookAhead` further on (pure pursuit; Coulter 1992): 2 left / distance^2 with `left` how far that point
/// lies to the left. The integrals make up for slip; they stand still while a sprocket is asked for more than
/// maxSprocketSpeed, where both sides are scaled down alike.
class Course {
public:
  explicit Course(CourseOptions options);

  /// Sprocket speeds left and right [rad/s], for a step of `dt` [s] that begins `time` [s] after the drive, or after it
  /// took over a hull that went at `from` [m/s].
  std::array<double, 2> sprocketSpeeds(const HullMotion& motion, double time, double dt, double from = 0);

  /// Way along the path of the place nearest to the hull that it has come to; never falls [m].
  double travelled() const { return travelled_; }
  double length() const; ///< of the path [m]

  /// All that changes.
  std::vector<double> save() const { return {speedSum_, turnSum_, travelled_}; }
  void restore(const double* saved) { speedSum_ = saved[0], turnSum_ = saved[1], travelled_ = saved[2]; }
  static constexpr std::size_t kSaved = 3;

  const CourseOptions& options() const { return options_; }

private:
  struct Place {
    double x, y, alongX, alongY; ///< and the path's direction there
  };
  Place placeAt(double way) const; ///< beyond the end on the last stretch's line
  void follow(const HullMotion& motion);
  bool onPath() const { return options_.x.size() > 1; }

  CourseOptions options_;
  std::vector<double> ways_; ///< of the corners from the first [m]
  double speedSum_ = 0;      ///< speedIntegral int e dt [m/s]
  double turnSum_ = 0;       ///< turnIntegral int f dt [rad/s]
  double travelled_ = 0;     ///< [m]
};

} // namespace grouser::vehicle
