// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle/consistent_gear.hpp"

#include "vehicle/wrap.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace grouser::vehicle {
namespace {

constexpr double kGap = 0.005;  // [m] minimum gap between wheels
constexpr int kMoreShoes = 60;  // maximum change of the number of shoes
constexpr int kSteps = 8;       // number of tried steps of each length
constexpr double kStep = 0.004; // [m]

double rounded(double x) { return std::floor(1e4 * x + 0.5) / 1e4; }

/// Distance between the axles of the sprocket and of the road wheel nearest to it [m].
double nearestWheel(const VehicleSpec& s) {
  const double beside = s.sprocketPinRadius() + s.roadWheel.radius + 0.05;
  const double near =
      s.outward() > 0 ? s.roadWheel.firstX : -(s.roadWheel.firstX + (s.roadWheel.count - 1) * s.roadWheel.spacing);
  return near > 0.5 * beside ? near : beside;
}

/// Returns the gear with the idler axle `away` from the sprocket axle, and the last road wheel `end` before the idler.
VehicleSpec stretched(const VehicleSpec& given, double away, double end) {
  VehicleSpec s = given;
  const double side = s.outward(), ratio = away / std::fabs(given.idler.x);
  const double first = nearestWheel(given), last = away - end;
  s.idler.x = rounded(side * away);
  if (s.roadWheel.count > 1) s.roadWheel.spacing = rounded((last - first) / (s.roadWheel.count - 1));
  s.roadWheel.firstX = side > 0 ? rounded(first) : rounded(-first - s.roadWheel.spacing * (s.roadWheel.count - 1));
  // Scale x of the rollers: the upper strand then has the same height at each roller as before.
  for (double& x : s.roller.x) x = rounded(ratio * x);
  return s;
}

/// Idler distance for which the loop length equals the total length of the shoes [m].
std::optional<double> closingDistance(const VehicleSpec& s, double end) {
  const double loop = s.shoe.count * s.shoe.pitch;
  double low = nearestWheel(s) + end, high = std::max(2 * low, loop);
  const auto longer = [&](double away) { return hullLength(stretched(s, away, end)) > loop; };
  if (longer(low) || !longer(high)) return {};
  for (int i = 0; i < 40; ++i) (longer(0.5 * (low + high)) ? high : low) = 0.5 * (low + high);
  return low;
}

std::optional<VehicleSpec> soundGear(const VehicleSpec& spec, const std::function<bool(const VehicleSpec&)>& sound) {
  const double least = spec.idler.radius + spec.roadWheel.radius + kGap;
  for (int e = 0; e < kSteps; ++e) {
    const double end = least + 2 * e * kStep;
    const std::optional<double> away = closingDistance(spec, end);
    if (!away) continue;
    for (int i = 0; i <= 2 * kSteps; ++i)
      for (int lower = 0; lower < kSteps / 2; ++lower) {
        VehicleSpec s = stretched(spec, *away + (i % 2 == 1 ? -1 : 1) * (i + 1) / 2 * kStep, end);
        if (s.roadWheel.count > 1 && s.roadWheel.spacing < 2 * s.roadWheel.radius + 0.5 * kGap) continue;
        for (double& z : s.roller.z) z = rounded(z - 1e-3 * lower);
        if (sound(s)) return s;
        if (s.roller.z.empty()) break;
      }
  }
  return {};
}

} // namespace

std::string consistentKeys(const VehicleSpec& spec, const std::function<bool(const VehicleSpec&)>& sound) {
  for (int i = 0; i <= 2 * kMoreShoes; ++i) {
    VehicleSpec asked = spec;
    asked.shoe.count += (i % 2 == 1 ? 1 : -1) * (i + 1) / 2;
    if (asked.shoe.count < 1) continue;
    const std::optional<VehicleSpec> s = soundGear(asked, sound);
    if (!s) continue;
    std::string text =
        fmt::format("road_wheel.count = {}, road_wheel.first_x = {:g}, road_wheel.spacing = {:g}, "
                    "shoe.count = {}, idler.x = {:g}",
                    s->roadWheel.count, s->roadWheel.firstX, s->roadWheel.spacing, s->shoe.count, s->idler.x);
    if (!s->roller.x.empty())
      text += fmt::format(", roller.x = [{:g}], roller.z = [{:g}]", fmt::join(s->roller.x, ", "),
                          fmt::join(s->roller.z, ", "));
    return text;
  }
  return "";
}

} // namespace grouser::vehicle
