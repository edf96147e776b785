// SPDX-License-Identifier: BSD-3-Clause
#include "runs/campaigns/events/event_figures.hpp"

#include "base/math.hpp"
#include "runs/campaigns/events/soil_limits.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace grouser::events {

namespace {

constexpr double kDegrees = 180 / base::kPi;
constexpr const char* kPullColumn = "hitch.pull [N]";
constexpr double kDriverHertz = 30; // cutoff of the low-pass filter for peak accelerations

/// Mean of a column over the second half of the time after `from` [s]; NaN without values.
double lateMean(const sweeps::RunSeries& series, const std::string& column, double from) {
  const std::vector<double>* values = series.of(column);
  if (!values || series.time.empty()) return std::numeric_limits<double>::quiet_NaN();
  const double half = 0.5 * (from + series.time.back());
  double sum = 0;
  int count = 0;
  for (std::size_t i = 0; i < values->size(); ++i)
    if (series.time[i] >= half && std::isfinite((*values)[i])) sum += (*values)[i], ++count;
  return count ? sum / count : std::numeric_limits<double>::quiet_NaN();
}

std::vector<double> slopes(const std::vector<double>& time, const std::vector<double>& values) {
  std::vector<double> found;
  for (std::size_t i = 1; i < time.size(); ++i) found.push_back((values[i] - values[i - 1]) / (time[i] - time[i - 1]));
  return found;
}

void addAcceleration(std::vector<Figure>& figures, const Motion& m, const Trial& trial, const Course& course) {
  // Averaged over 0.1 s, as the speed fluctuates with each sprocket tooth.
  constexpr double kSpan = 0.1;
  std::vector<double> time, speed;
  for (std::size_t i = 0, j = 0; i < m.time.size(); ++i) {
    while (m.time[i] - m.time[j] > kSpan) ++j;
    if (i == j) continue;
    time.push_back(0.5 * (m.time[i] + m.time[j])), speed.push_back((m.way[i] - m.way[j]) / (m.time[i] - m.time[j]));
  }
  figures.push_back({"time to 90 % of the speed [s]", timeAt(time, speed, 0.9 * trial.speed)});
  if (course.rigid())
    figures.push_back(
        {"the same by friction alone [s]", 0.9 * trial.speed / (course.shape.friction * course.shape.gravity)});
}

void addPivot(std::vector<Figure>& figures, const Motion& m, const sweeps::RunSeries& series, double driveStart,
              const Trial& trial, const Course& course) {
  const double rate = lateMotion(m).turnRate(), rp = course.shape.pitchRadius, tread = course.shape.tread;
  const double left = lateMean(series, "vehicle.left.mean_torque [N m]", driveStart),
               right = lateMean(series, "vehicle.right.mean_torque [N m]", driveStart);
  figures.push_back({"rate of turn [rad/s]", rate});
  figures.push_back({"rate over commanded [-]", rate / trial.rate});
  figures.push_back({"moment of the drives [N m]", (right - left) / rp * tread / 2});
  if (!course.rigid()) return;
  const double weight = course.shape.weight(), mu = course.shape.friction;
  const double slip = trial.rate * tread / 2 - rate * tread / 2;
  figures.push_back(
      {"turning moment of friction opposite to the slip [N m]", turningMoment(course.shape, mu, weight, rate, slip)});
  figures.push_back({"turning moment mu W L / 4 [N m]", turningMoment(course.shape, mu, weight)});
}

} // namespace

std::vector<double> lowPass(const std::vector<double>& values, double dt, double cutoff) {
  const double k = std::tan(base::kPi * cutoff * dt);
  std::vector<double> passed = values;
  for (const double angle : {base::kPi / 8, 3 * base::kPi / 8}) { // two pairs of poles
    const double q = 1 / (2 * std::cos(angle)), norm = 1 / (1 + k / q + k * k);
    const double b0 = k * k * norm, a1 = 2 * (k * k - 1) * norm, a2 = (1 - k / q + k * k) * norm;
    double x1 = passed.empty() ? 0 : passed.front(), x2 = x1, y1 = x1, y2 = x1;
    for (double& x : passed) {
      const double y = b0 * (x + 2 * x1 + x2) - a1 * y1 - a2 * y2;
      x2 = x1, x1 = x, y2 = y1, y1 = y;
      x = y;
    }
  }
  return passed;
}

double turningMoment(const VehicleShape& shape, double friction, double weight, double rate, double slipSpeed) {
  const double half = shape.groundRun() / 2, a = std::fabs(slipSpeed / rate);
  if (!(a > 0)) return turningMoment(shape, friction, weight);
  // mu W / L times the integral of x^2 / sqrt(x^2 + a^2) over the ground run.
  const double root = std::sqrt(half * half + a * a);
  const double integral = half * root - a * a * std::asinh(half / a);
  return friction * weight / shape.groundRun() * integral;
}

std::vector<Figure> figuresOf(Event event, const Motion& m, const sweeps::RunSeries& series, double driveStart,
                              const Trial& trial, const Course& course) {
  std::vector<Figure> figures;
  if (m.time.size() < 3) return figures;
  switch (event) {
  case Event::acceleration:
    addAcceleration(figures, m, trial, course);
    break;
  case Event::sideSlope:
    figures.push_back({"drift to the left [m]", m.left.back()});
    figures.push_back({"turned by [deg]", m.turned.back() * kDegrees});
    break;
  case Event::pivotTurn:
    addPivot(figures, m, series, driveStart, trial, course);
    break;
  case Event::steadyTurn:
  case Event::turningRadius: {
    const LateMotion late = lateMotion(m);
    figures.push_back({"radius driven [m]", late.radius()});
    figures.push_back({"rate of turn [rad/s]", late.turnRate()});
    figures.push_back({"lateral acceleration [g]", late.way / late.seconds * late.turnRate() / kGravity});
    break;
  }
  case Event::halfRound: {
    const double dt = (m.time.back() - m.time.front()) / static_cast<double>(m.time.size() - 1);
    if (dt * kDriverHertz < 0.5)
      figures.push_back({"peak vertical acceleration of the hull, 30 Hz [g]",
                         greatest(lowPass(slopes(m.time, m.upSpeed), dt, kDriverHertz)) / kGravity});
    break;
  }
  case Event::drawbar: {
    const double pull = lateMean(series, kPullColumn, driveStart), weight = course.shape.weight();
    figures.push_back({kPull, pull});
    figures.push_back({"pull over weight [-]", pull / weight});
    if (course.rigid()) figures.push_back({"mu W [N]", course.shape.friction * weight});
    if (course.deformable())
      figures.push_back(
          {"thrust less compaction of rigid tracks [N]", trackThrust(course.shape, course.constants, trial.slip) -
                                                             compactionResistance(course.shape, course.constants)});
    break;
  }
  case Event::grade:
  case Event::step:
  case Event::gap:
  case Event::ditch:
  case Event::motionResistance:
  case Event::softSoil:
    break;
  }
  figures.push_back({"greatest roll [deg]", greatest(m.roll) * kDegrees});
  figures.push_back({"greatest pitch [deg]", greatest(m.pitch) * kDegrees});
  return figures;
}

} // namespace grouser::events
