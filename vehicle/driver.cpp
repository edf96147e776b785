// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle/driver.hpp"

#include "base/error.hpp"
#include "multibody/time_law.hpp"

#include <utility>

namespace grouser::vehicle {
namespace {

double tableValue(const std::vector<double>& time, const std::vector<double>& value, double t) {
  if (t <= time.front()) return value.front();
  for (std::size_t i = 1; i < time.size(); ++i)
    if (t < time[i]) return value[i - 1] + (value[i] - value[i - 1]) * ((t - time[i - 1]) / (time[i] - time[i - 1]));
  return value.back();
}

} // namespace

double smoothRamp(double time, double start, double duration) {
  if (time < start) return 0;
  if (time >= start + duration) return 1;
  const double s = (time - start) / duration;
  return s * s * (3 - 2 * s);
}

Driver::Driver(DriverOptions options) : options_(std::move(options)) {
  const SpeedTable& table = options_.speeds;
  if (options_.tensionRamp < 0 || options_.weightRamp < 0 || options_.driveRamp < 0)
    throw base::InputError("driver: a ramp lasts less than 0 s");
  if (options_.driveStart < options_.tensionRamp + options_.weightRamp)
    throw base::InputError("driver: the drive starts before tension and weight are up; set it to at least their sum");
  if (table.time.empty() || table.left.size() != table.time.size() || table.right.size() != table.time.size())
    throw base::InputError(
        "driver: the speed table needs at least one row, and as many speeds left and right as times");
  if (multibody::firstOutOfOrder(table.time, true) > 0)
    throw base::InputError("driver: the times of the speed table must rise; a time may stand twice, for a jump");
}

Controls Driver::at(double time) const {
  Controls controls;
  controls.tension = smoothRamp(time, 0, options_.tensionRamp);
  controls.weight = smoothRamp(time, options_.tensionRamp, options_.weightRamp);
  const double drive = smoothRamp(time, options_.driveStart, options_.driveRamp);
  const double t = time - options_.driveStart;
  controls.sprocketSpeed = {drive * tableValue(options_.speeds.time, options_.speeds.left, t),
                            drive * tableValue(options_.speeds.time, options_.speeds.right, t)};
  return controls;
}

} // namespace grouser::vehicle
