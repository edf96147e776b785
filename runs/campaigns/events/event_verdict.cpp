// SPDX-License-Identifier: BSD-3-Clause
#include "runs/campaigns/events/event_verdict.hpp"

#include "base/error.hpp"
#include "base/math.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace grouser::events {

double greatest(const std::vector<double>& values) {
  double most = 0;
  for (const double v : values) most = std::max(most, std::fabs(v));
  return most;
}

namespace {

const std::vector<double>& columnOf(const sweeps::RunSeries& series, const std::string& name) {
  if (const std::vector<double>* values = series.of(name)) return *values;
  throw base::InputError(
      fmt::format("timeseries.csv has no column {}: another version wrote it; repeat the runs with --force", name));
}

/// Time at which a quantity reaches `end`, and its mean rate over the last `stretch` before `end`.
struct Passage {
  double at = 0, rate = 0;
};
std::optional<Passage> passage(const std::vector<double>& time, const std::vector<double>& value, double end,
                               double stretch) {
  const double at = timeAt(time, value, end), from = stretch < end ? timeAt(time, value, end - stretch) : 0.0;
  if (std::isnan(at) || std::isnan(from)) return {};
  return Passage{at, std::min(stretch, end) / std::max(at - from, 1e-9)};
}

} // namespace

double timeAt(const std::vector<double>& time, const std::vector<double>& value, double level) {
  for (std::size_t i = 0; i < time.size(); ++i) {
    if (value[i] < level) continue;
    if (i == 0) return time[0];
    return time[i - 1] + (time[i] - time[i - 1]) * (level - value[i - 1]) / (value[i] - value[i - 1]);
  }
  return std::numeric_limits<double>::quiet_NaN();
}

Motion motionOf(const sweeps::RunSeries& series, double driveStart, const std::optional<SidePoint>& onPath) {
  const auto& x = columnOf(series, "vehicle.position.x [m]");
  const auto& y = columnOf(series, "vehicle.position.y [m]");
  const auto& heading = columnOf(series, "vehicle.heading [rad]");
  const auto& roll = columnOf(series, "vehicle.roll_angle [rad]");
  const auto& pitch = columnOf(series, "vehicle.pitch_angle [rad]");
  const auto& up = columnOf(series, "vehicle.velocity.z [m/s]");
  Motion m;
  std::size_t first = 0;
  while (first < series.time.size() && series.time[first] < driveStart) ++first;
  const SidePoint point = onPath.value_or(SidePoint{});
  // Position of the point: rotated by roll, pitch (nose up) and heading.
  const auto place = [&](std::size_t i) {
    const double above = point.z * std::cos(roll[i]), left = -point.z * std::sin(roll[i]);
    const double ahead = point.x * std::cos(pitch[i]) - above * std::sin(pitch[i]);
    const double c = std::cos(heading[i]), s = std::sin(heading[i]);
    return std::pair{x[i] + c * ahead - s * left, y[i] + s * ahead + c * left};
  };
  double path = 0, turned = 0;
  for (std::size_t i = first; i < series.time.size(); ++i) {
    if (i > first) {
      const auto [toX, toY] = place(i);
      const auto [fromX, fromY] = place(i - 1);
      path += std::hypot(toX - fromX, toY - fromY);
      turned += std::remainder(heading[i] - heading[i - 1], 2 * base::kPi);
    }
    m.time.push_back(series.time[i] - driveStart);
    m.way.push_back(onPath ? path : x[i] - x[first]);
    m.turned.push_back(turned);
    m.left.push_back(y[i] - y[first]);
    m.roll.push_back(roll[i]), m.pitch.push_back(pitch[i]), m.upSpeed.push_back(up[i]);
  }
  return m;
}

LateMotion lateMotion(const Motion& m) {
  if (m.time.size() < 3) return {};
  const std::size_t half = m.time.size() / 2;
  return {m.way.back() - m.way[half], m.turned.back() - m.turned[half], m.time.back() - m.time[half]};
}

namespace {

/// Reason why a motion on a circle is a no-go; empty if the vehicle follows the circle.
std::string leavesCircle(const Motion& motion, const Trial& trial, const GoRule& rule) {
  const LateMotion late = lateMotion(motion);
  if (!(late.turned > 0)) return "does not turn to the left";
  if (!(std::fabs(late.radius() / trial.radius - 1) <= rule.radius))
    return fmt::format("drives a radius of {:.3g} m, commanded {:.3g} m", late.radius(), trial.radius);
  if (trial.rate > 0 && !(late.turnRate() >= rule.turn * trial.rate))
    return fmt::format("turns at {:.3g} rad/s, commanded {:.3g} rad/s", late.turnRate(), trial.rate);
  return "";
}

} // namespace

Verdict judge(const Motion& motion, const Trial& trial, const GoRule& rule) {
  if (motion.time.empty()) return {false, "never drove"};
  const double roll = greatest(motion.roll) * 180 / base::kPi;
  if (roll >= rule.maxRoll) return {false, fmt::format("roll angle reaches {:.0f} degrees", roll)};
  if (trial.angle > 0) {
    const auto turn = passage(motion.time, motion.turned, trial.angle, trial.angle);
    const double most = *std::max_element(motion.turned.begin(), motion.turned.end()) * 180 / base::kPi;
    if (!turn) {
      const LateMotion late = lateMotion(motion);
      if (late.seconds > 0 && late.turned >= rule.share * trial.rate * late.seconds)
        return {false, fmt::format("run.duration ends the turn after {:.0f} degrees; raise it", most), true};
      return {false, fmt::format("turns only {:.0f} degrees", most)};
    }
    if (turn->at > rule.time) return {false, fmt::format("exceeds the time limit: {:.1f} s for the turn", turn->at)};
    const bool quick = turn->rate >= rule.share * trial.rate;
    return {quick, fmt::format("{:.0f} degrees in {:.1f} s{}", trial.angle * 180 / base::kPi, turn->at,
                               quick ? "" : ": too slow")};
  }
  const auto drove = passage(motion.time, motion.way, trial.distance, rule.way);
  const double most = *std::max_element(motion.way.begin(), motion.way.end());
  // A shorter path says nothing about the steady radius.
  if (trial.radius > 0 && most >= 0.5 * trial.distance)
    if (const std::string why = leavesCircle(motion, trial, rule); !why.empty()) return {false, why};
  if (!drove) {
    const LateMotion late = lateMotion(motion);
    if (late.seconds > 0 && late.way >= rule.share * trial.speed * late.seconds)
      return {false,
              fmt::format("run.duration ends the drive after {:.1f} of {:.1f} m at {:.2g} m/s; raise it", most,
                          trial.distance, late.way / late.seconds),
              true};
    return {false, fmt::format("covers {:.1f} of {:.1f} m", std::max(0.0, most), trial.distance)};
  }
  if (drove->at > rule.time) return {false, fmt::format("exceeds the time limit: {:.1f} s", drove->at)};
  const bool quick = drove->rate >= rule.share * trial.speed;
  return {quick, fmt::format("{:.1f} m in {:.1f} s{}", trial.distance, drove->at, quick ? "" : ": too slow")};
}

FailureVerdict judgeFailure(const sweeps::SweepOutcome& outcome) {
  using base::Cause;
  constexpr std::pair<Cause, const char*> kOfTheVehicle[] = {{Cause::thrownTrack, "throws a track"},
                                                             {Cause::skippingTrack, "a track skips teeth"},
                                                             {Cause::noRest, "does not come to rest"},
                                                             {Cause::offTerrain, "leaves the ground"}};
  for (const auto& [cause, why] : kOfTheVehicle)
    if (outcome.cause == cause) return {true, why};
  return {false, outcome.message};
}

} // namespace grouser::events
