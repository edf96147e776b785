// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle/course.hpp"

#include "base/error.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace grouser::vehicle {

Course::Course(CourseOptions options) : options_(std::move(options)) {
  const std::vector<double>&x = options_.x, &y = options_.y;
  if (x.size() != y.size() || x.size() == 1)
    throw base::InputError("driver.course: x and y of a path must have equal lengths, at least 2");
  if (!(options_.acceleration > 0) || !(options_.tread > 0) || !(options_.pitchRadius > 0) ||
      !(options_.maxSprocketSpeed > 0))
    throw base::InputError("driver.course: acceleration, tread, pitch radius and maximum sprocket speed must be > 0");
  if (onPath() && (!(options_.lookAhead > 0) || options_.speed < 0))
    throw base::InputError("driver.course: a path requires look_ahead > 0 and speed >= 0");
  double way = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (i > 0) {
      const double dx = x[i] - x[i - 1], dy = y[i] - y[i - 1], stretch = std::sqrt(dx * dx + dy * dy);
      if (!(stretch > 0))
        throw base::InputError("driver.course: two consecutive points of the path coincide; remove one");
      way += stretch;
    }
    ways_.push_back(way);
  }
}

double Course::length() const { return ways_.empty() ? 0 : ways_.back(); }

Course::Place Course::placeAt(double way) const {
  std::size_t i = 1;
  while (i + 1 < ways_.size() && way > ways_[i]) ++i;
  const double stretch = ways_[i] - ways_[i - 1];
  const double dx = (options_.x[i] - options_.x[i - 1]) / stretch, dy = (options_.y[i] - options_.y[i - 1]) / stretch;
  const double s = way - ways_[i - 1];
  return {options_.x[i - 1] + s * dx, options_.y[i - 1] + s * dy, dx, dy};
}

/// Advances to the nearest path point within lookAhead; points further on are ignored, since a path may cross itself.
void Course::follow(const HullMotion& m) {
  double nearest = 1e300, found = travelled_;
  for (std::size_t i = 1; i < ways_.size(); ++i) {
    const double from = std::max(ways_[i - 1], travelled_), to = std::min(ways_[i], travelled_ + options_.lookAhead);
    if (from > to) continue;
    const Place p = placeAt(0.5 * (ways_[i - 1] + ways_[i]));
    const double middle = 0.5 * (ways_[i - 1] + ways_[i]);
    const double way = std::clamp(middle + (m.x - p.x) * p.alongX + (m.y - p.y) * p.alongY, from, to);
    const double dx = m.x - (p.x + (way - middle) * p.alongX), dy = m.y - (p.y + (way - middle) * p.alongY);
    const double away = dx * dx + dy * dy;
    if (away < nearest) nearest = away, found = way;
  }
  travelled_ = found;
}

std::array<double, 2> Course::sprocketSpeeds(const HullMotion& m, double time, double dt, double from) {
  const CourseOptions& o = options_;
  double speed = std::min(std::fabs(o.speed - from), o.acceleration * std::max(0.0, time)), curvature = o.curvature;
  if (o.speed < from) speed = -speed;
  if (from != 0) speed += from; // preserves the sign of a zero
  if (onPath()) {
    follow(m);
    speed = std::min(speed, std::sqrt(2 * o.acceleration * std::max(0.0, length() - travelled_)));
    const Place ahead = placeAt(travelled_ + o.lookAhead);
    const double dx = ahead.x - m.x, dy = ahead.y - m.y;
    // The lower bound of the squared distance limits the curvature if the point ahead is near.
    curvature = 2 * (m.forwardX * dy - m.forwardY * dx) / std::max(dx * dx + dy * dy, 0.01 * o.lookAhead * o.lookAhead);
  }
  const double turn = speed * curvature, missing = speed - m.speed, missingTurn = turn - m.turnRate;
  const double speedSum = speedSum_ + o.speedIntegral * missing * dt;
  const double turnSum = turnSum_ + o.turnIntegral * missingTurn * dt;
  const double v = speed + o.speedGain * missing + speedSum;
  const double side = 0.5 * o.tread * (turn + o.turnGain * missingTurn + turnSum);
  const double left = (v - side) / o.pitchRadius, right = (v + side) / o.pitchRadius;
  const double most = std::max(std::fabs(left), std::fabs(right));
  if (most > o.maxSprocketSpeed) return {left * (o.maxSprocketSpeed / most), right * (o.maxSprocketSpeed / most)};
  speedSum_ = speedSum, turnSum_ = turnSum;
  return {left, right};
}

} // namespace grouser::vehicle
